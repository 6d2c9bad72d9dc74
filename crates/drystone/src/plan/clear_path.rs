//! Blocks that can leave along a straight line, past all that remain.
//!
//! Other blocks are in the way of a block, or not, whether anything stands or not; so this is looked up for each block and
//! direction once. The fewer blocks there are, the more can leave. Two things follow.
//!
//! *Locked blocks.* Take blocks away that can leave, whatever falls, until none can. What remains is locked: in every
//! order one of these blocks would have to be the first to go, and it cannot.
//!
//! *The trap.* If blocks Q that are there leave a block X no way in, every structure with all of Q and without X is lost, for
//! what grows from it has all of Q as well.
//!
//! Where blocks leave together (`together.rs`), a *unit* is one of these groups, or a block alone; else units are blocks.

use super::directions::{along_faces, at_contacts, merged};
use crate::contact::{Contact, tolerance_of};
use crate::error::SceneError;
use crate::formulate::{Assemble, Assembly, BlockSet};
use crate::geometry::{Piece, Sweeping, dot, unit};
use crate::scene::SceneOf;
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;

/// The cosine with which a direction looks against a contact that stops it, far above what facets' normals are off by where a
/// direction lies in them.
const AGAINST: f64 = 0.1;

/// A first move is one if it is so many contact tolerances long, and a second if the cosine of its angle with the first is less.
const TURNS: f64 = 10.0;
const SAME_WAY: f64 = 0.99;

/// How far from lying in a face, or from facing one another, faces may be that guide a move, as sine and one less the cosine; and
/// lengths of first moves that differ by so small a share are the same.
const GUIDES: f64 = 1e-6;

/// Most lengths of a first move that are tried with a second, and planes of a body that they come from.
const MOST_STOPS: usize = 32;

/// How blocks may leave along straight lines.
#[derive(Debug, Clone, PartialEq)]
pub struct ClearPath {
    /// Directions to try first, of any length. The others are: against gravity, along the axes, and along and across the
    /// block's contacts; where these give no order, also those square to one or two faces of the block and of what is near.
    pub directions: Vec<[f64; 3]>,
    /// How many straight moves a block may leave by: one, or two of which the first ends.
    pub moves: usize,
    /// Most blocks that may leave together where blocks lock one another in. One: each leaves alone.
    pub together: usize,
    /// Bodies that are only in the way, each by its convex pieces.
    pub obstacles: Vec<Vec<Piece>>,
}

impl Default for ClearPath {
    /// Each alone, by one move.
    fn default() -> Self {
        Self { directions: Vec::new(), moves: 1, together: 1, obstacles: Vec::new() }
    }
}

/// Why a block cannot leave.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocked {
    /// The body that cannot leave, an index of the scene.
    pub body: usize,
    /// For each direction looked at, which bodies are in the way; obstacles are counted on from the bodies.
    pub ways: Vec<([f64; 3], Vec<usize>)>,
}

/// How a block leaves: straight moves one after the other, each a unit vector and a length in metres.
///
/// The last goes on as far as one likes; its length is when the box around the block is out of the boxes around all that
/// remains.
pub type Moves = Vec<([f64; 3], f64)>;

/// What is in the way of a unit in one direction, when everything is there.
#[derive(Debug, Clone)]
struct InTheWay {
    units: BlockSet,
    /// Fixed bodies by their index in the scene, and obstacles.
    fixed: Vec<usize>,
}

impl InTheWay {
    fn is_free(&self, set: &BlockSet) -> bool {
        self.fixed.is_empty() && !self.units.iter().any(|other| set.contains(other))
    }
}

/// For each unit the directions in which it may leave, and what is in the way.
#[derive(Debug)]
pub(super) struct Paths<'a> {
    assembly: &'a Assembly,
    /// The blocks of each unit.
    units: Vec<Vec<usize>>,
    /// Of every body, then of every obstacle, with the contact tolerance that it allows, metres.
    swept: Vec<Sweeping>,
    tolerances: Vec<f64>,
    /// How many straight moves a unit may leave by, one or two.
    moves: usize,
    directions: Vec<Vec<[f64; 3]>>,
    /// For each unit and direction, once it is asked for.
    known: Vec<Vec<OnceCell<InTheWay>>>,
    /// Ways of two moves, once they are asked for.
    known_turns: RefCell<HashMap<(usize, BlockSet), Option<Moves>>>,
    faces_tried: bool,
}

impl<'a> Paths<'a> {
    /// Takes a scene's assembly, and how blocks may leave. Directions along faces come with [`Paths::try_faces`].
    ///
    /// # Errors
    /// [`SceneError::BadParameter`] for a direction that is zero or not finite.
    pub fn new<S: Assemble>(scene: &SceneOf<S>, assembly: &'a Assembly, clear: &ClearPath) -> Result<Self, SceneError> {
        let mut given = Vec::new();
        for direction in &clear.directions {
            let size = direction.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
            let along = unit(direction.map(|x| x / size)).filter(|_| size.is_finite());
            given.push(along.ok_or_else(|| SceneError::BadParameter {
                scene: "plan".into(),
                parameter: "directions".into(),
                found: format!("{direction:?}"),
                expected: "finite vectors that are not zero".into(),
            })?);
        }
        let bodies = scene.bodies().iter();
        let mut swept: Vec<Sweeping> = bodies.clone().map(|body| Sweeping::of(S::pieces(body))).collect();
        let directions = at_contacts(assembly, &given, |body| swept[body].is_fine());
        swept.extend(clear.obstacles.iter().cloned().map(Sweeping::of));
        let mut tolerances: Vec<f64> = bodies.map(|body| tolerance_of(scene, body)).collect();
        tolerances.resize(swept.len(), f64::INFINITY);
        Ok(Self {
            assembly,
            units: (0..assembly.blocks()).map(|block| vec![block]).collect(),
            swept,
            tolerances,
            moves: clear.moves,
            known: directions.iter().map(|list| vec![OnceCell::new(); list.len()]).collect(),
            known_turns: RefCell::default(),
            directions,
            faces_tried: false,
        })
    }

    /// Adds the directions along the faces of each block and of those near it, behind the others. Returns false if that was
    /// done before.
    pub fn try_faces(&mut self) -> bool {
        if std::mem::replace(&mut self.faces_tried, true) {
            return false;
        }
        self.known_turns.get_mut().clear();
        for unit in 0..self.units.len() {
            for &block in &self.units[unit] {
                let list = &mut self.directions[unit];
                along_faces(list, &self.swept, self.assembly.body_index(block), self.assembly.in_plane());
            }
            self.known[unit].resize(self.directions[unit].len(), OnceCell::new());
        }
        true
    }

    /// Lets the blocks of each of these units leave together, in the directions of all of them.
    pub fn join(&mut self, units: &[Vec<usize>]) {
        let of = |unit: &Vec<usize>| merged(unit.iter().flat_map(|&block| &self.directions[block]));
        self.directions = units.iter().map(of).collect();
        self.known = self.directions.iter().map(|list| vec![OnceCell::new(); list.len()]).collect();
        self.known_turns.get_mut().clear();
        self.units = units.to_vec();
    }

    /// Number of units.
    pub fn units(&self) -> usize {
        self.units.len()
    }

    /// The bodies of a unit.
    fn bodies(&self, unit: usize) -> impl Iterator<Item = usize> + '_ {
        self.units[unit].iter().map(|&block| self.assembly.body_index(block))
    }

    /// Fixed bodies and obstacles.
    fn fixed(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.swept.len()).filter(|&other| self.assembly.bodies().get(other).is_none_or(|body| body.fixed))
    }

    fn in_the_way(&self, unit: usize, way: usize) -> &InTheWay {
        self.known[unit][way].get_or_init(|| self.found_in_the_way(unit, self.directions[unit][way]))
    }

    fn found_in_the_way(&self, unit: usize, direction: [f64; 3]) -> InTheWay {
        let stops = |other: usize| self.bodies(unit).any(|body| self.stops(body, other, direction));
        let mut units = BlockSet::empty(self.units.len());
        for other in (0..self.units.len()).filter(|&other| other != unit) {
            if self.bodies(other).any(stops) {
                units.insert(other);
            }
        }
        InTheWay { units, fixed: self.fixed().filter(|&other| stops(other)).collect() }
    }

    /// Whether a body is stopped by another.
    fn stops(&self, body: usize, other: usize, direction: [f64; 3]) -> bool {
        let (own, others) = (&self.swept[body], &self.swept[other]);
        let fine = own.is_fine() || others.is_fine();
        fine && self.presses_against([body, other], direction)
            || own.is_stopped_by(others, direction, self.tolerance([body, other]))
    }

    /// By how much two bodies may be in each other, metres.
    fn tolerance(&self, [body, other]: [usize; 2]) -> f64 {
        self.tolerances[body].min(self.tolerances[other])
    }

    /// Whether a contact of a body with another already shows that the other stops it: to sweep fine surfaces takes longer.
    fn presses_against(&self, [body, other]: [usize; 2], direction: [f64; 3]) -> bool {
        let against = |contact: &Contact| {
            let towards = dot(contact.normal, direction);
            (if contact.bodies[0] == body { towards } else { -towards }) > AGAINST
        };
        let pair = [body.min(other), body.max(other)];
        let first = self.assembly.contacts().partition_point(|contact| contact.bodies < pair);
        self.assembly.contacts()[first..].iter().take_while(|contact| contact.bodies == pair).any(against)
    }

    /// Whether a unit can leave the other units of a set.
    pub fn can_leave(&self, unit: usize, set: &BlockSet) -> bool {
        self.straight(unit, set).is_some() || self.turning(unit, set).is_some()
    }

    /// How a unit can leave the other units of a set: in the first direction that is free, else by the first two moves.
    pub fn way_out(&self, unit: usize, set: &BlockSet) -> Option<Moves> {
        match self.straight(unit, set) {
            Some(direction) => Some(vec![(direction, self.passes(unit, set, [0.0; 3], direction))]),
            None => self.turning(unit, set),
        }
    }

    /// The first direction in which a unit can leave the other units of a set.
    fn straight(&self, unit: usize, set: &BlockSet) -> Option<[f64; 3]> {
        let free = (0..self.directions[unit].len()).find(|&way| self.in_the_way(unit, way).is_free(set));
        free.map(|way| self.directions[unit][way])
    }

    /// Bodies that remain when a unit leaves a set.
    fn remaining(&self, unit: usize, set: &BlockSet) -> Vec<usize> {
        let units = set.iter().filter(|&other| other != unit);
        self.fixed().chain(units.flat_map(|other| self.bodies(other))).collect()
    }

    /// When the boxes around a unit's bodies are out of those around what remains, metres.
    fn passes(&self, unit: usize, set: &BlockSet, by: [f64; 3], direction: [f64; 3]) -> f64 {
        let remaining = self.remaining(unit, set);
        let last = |body: usize| {
            let others = remaining.iter().map(move |&other| (other, self.tolerance([body, other])));
            others
                .map(|(other, tolerance)| self.swept[body].passes(by, &self.swept[other], direction, tolerance))
                .fold(0.0, f64::max)
        };
        self.bodies(unit).map(last).fold(0.0, f64::max)
    }

    /// Two moves by which a unit can leave the other units of a set: as far as it goes in one direction, or less, then in another.
    fn turning(&self, unit: usize, set: &BlockSet) -> Option<Moves> {
        if self.moves < 2 {
            return None;
        }
        let key = (unit, set.clone());
        if let Some(known) = self.known_turns.borrow().get(&key) {
            return known.clone();
        }
        let found = self.find_turning(unit, set);
        self.known_turns.borrow_mut().insert(key, found.clone());
        found
    }

    fn find_turning(&self, unit: usize, set: &BlockSet) -> Option<Moves> {
        let remaining = self.remaining(unit, set);
        let pairs: Vec<[usize; 2]> =
            self.bodies(unit).flat_map(|body| remaining.iter().map(move |&other| [body, other])).collect();
        let tolerance = self.bodies(unit).map(|body| self.tolerances[body]).fold(f64::INFINITY, f64::min);
        for &first in &self.directions[unit] {
            let reach = |&[body, other]: &[usize; 2]| {
                self.swept[body].reach(&self.swept[other], first, self.tolerance([body, other]))
            };
            let reach = pairs.iter().map(reach).fold(f64::INFINITY, f64::min) - tolerance;
            // To go on for ever is one move; what is within the tolerance is none.
            if !(reach.is_finite() && reach > TURNS * tolerance) {
                continue;
            }
            for &second in self.directions[unit].iter().filter(|&&second| dot(first, second) < SAME_WAY) {
                for length in self.stops_before(&pairs, [first, second], reach) {
                    let by = first.map(|x| length * x);
                    let free = |&[body, other]: &[usize; 2]| {
                        let tolerance = self.tolerance([body, other]);
                        !self.swept[body].is_stopped_from(by, &self.swept[other], second, tolerance)
                    };
                    if pairs.iter().all(free) {
                        return Some(vec![(first, length), (second, self.passes(unit, set, by, second))]);
                    }
                }
            }
        }
        None
    }

    /// Lengths of a first move after which the second may be free: as far as it goes, and where faces along the second move
    /// come past one another; the longest first.
    fn stops_before(&self, pairs: &[[usize; 2]], [first, second]: [[f64; 3]; 2], reach: f64) -> Vec<f64> {
        let mut lengths = vec![reach, reach / 2.0];
        for &[body, other] in pairs {
            let guides = |of: usize| {
                let planes = self.swept[of].pieces().iter().flat_map(|piece| piece.planes());
                let guiding = planes.filter(|(n, _)| dot(*n, second).abs() < GUIDES && dot(*n, first).abs() > AGAINST);
                guiding.fold(Vec::new(), |mut list: Vec<([f64; 3], f64)>, (n, far)| {
                    let same = |(m, there): &([f64; 3], f64)| {
                        dot(*m, n) > 1.0 - GUIDES && (there - far).abs() < GUIDES * reach
                    };
                    if list.len() < MOST_STOPS && !list.iter().any(same) {
                        list.push((n, far));
                    }
                    list
                })
            };
            let others = guides(other);
            for (n, far) in guides(body) {
                let facing = others.iter().filter(|(m, _)| dot(*m, n) < GUIDES - 1.0);
                lengths.extend(facing.map(|(_, there)| (-there - far) / dot(n, first)));
            }
        }
        lengths.retain(|&length| length > 0.0 && length <= reach);
        lengths.sort_by(|a, b| b.total_cmp(a));
        lengths.dedup_by(|a, b| *b - *a < GUIDES * reach);
        lengths.truncate(MOST_STOPS);
        lengths
    }

    /// Units of a set that together leave a unit no way out, those put up early if there is a choice; None if it has one.
    pub fn blame(&self, unit: usize, set: &BlockSet, position: &[usize]) -> Option<Vec<usize>> {
        if self.can_leave(unit, set) {
            return None;
        }
        if self.moves > 1 {
            return Some(set.iter().filter(|&other| other != unit).collect());
        }
        let mut blame = Vec::new();
        for way in 0..self.directions[unit].len() {
            let in_the_way = self.in_the_way(unit, way);
            if !in_the_way.fixed.is_empty() || in_the_way.units.iter().any(|other| blame.contains(&other)) {
                continue;
            }
            let there = in_the_way.units.iter().filter(|&other| set.contains(other));
            blame.extend(there.min_by_key(|&other| position[other]));
        }
        Some(blame)
    }

    /// What is in the way of those of some units that cannot leave a set.
    pub fn blocked(&self, units: impl Iterator<Item = usize>, set: &BlockSet) -> Vec<Blocked> {
        let stuck: Vec<usize> = units.filter(|&unit| !self.can_leave(unit, set)).collect();
        stuck.into_iter().flat_map(|unit| self.why(unit, set)).collect()
    }

    fn why(&self, unit: usize, set: &BlockSet) -> Vec<Blocked> {
        let directions = self.directions[unit].clone();
        let ways = directions.into_iter().enumerate().map(|(way, direction)| {
            let in_the_way = self.in_the_way(unit, way);
            let there = in_the_way.units.iter().filter(|&other| set.contains(other));
            let mut bodies: Vec<usize> = there.flat_map(|other| self.bodies(other)).collect();
            bodies.extend(&in_the_way.fixed);
            bodies.sort_unstable();
            (direction, bodies)
        });
        let ways: Vec<_> = ways.collect();
        self.bodies(unit).map(|body| Blocked { body, ways: ways.clone() }).collect()
    }

    /// The units that lock one another in.
    pub fn locked(&self) -> BlockSet {
        self.locked_in(BlockSet::full(self.units.len()))
    }

    /// Those of a set.
    fn locked_in(&self, mut left: BlockSet) -> BlockSet {
        let mut place = vec![0; self.assembly.blocks()];
        self.assembly.upward().into_iter().enumerate().for_each(|(k, block)| place[block] = k);
        let mut downward: Vec<usize> = (0..self.units.len()).collect();
        downward.sort_by_key(|&unit| std::cmp::Reverse(self.units[unit].iter().map(|&block| place[block]).max()));
        loop {
            let before = left.len();
            for &unit in &downward {
                if left.contains(unit) && self.can_leave(unit, &left) {
                    left.remove(unit);
                }
            }
            if left.len() == before {
                return left;
            }
        }
    }

    /// Groups of at most so many blocks that can leave together where none can leave alone, so that all can be taken away,
    /// whatever falls. None if something stays locked. Units are blocks.
    pub fn groups(&self, most: usize) -> Option<Vec<Vec<usize>>> {
        let mut groups = Vec::new();
        let mut left = self.locked();
        while !left.is_empty() {
            let leaving = left.iter().flat_map(|block| self.directions[block].iter().map(move |&way| (block, way)));
            let group = leaving
                .filter_map(|(block, way)| self.carried_along(block, way, &left, most))
                .min_by_key(|group| group.len())?;
            group.iter().for_each(|&block| left.remove(block));
            groups.push(group);
            left = self.locked_in(left);
        }
        Some(groups)
    }

    /// A block and all blocks of a set that have to leave with it in a direction; None if these are more than so many, or
    /// something fixed is in the way of one.
    fn carried_along(&self, block: usize, direction: [f64; 3], set: &BlockSet, most: usize) -> Option<Vec<usize>> {
        let mut group = vec![block];
        let mut next = 0;
        while let Some(&block) = group.get(next) {
            let in_the_way = self.found_in_the_way(block, direction);
            if !in_the_way.fixed.is_empty() {
                return None;
            }
            for other in in_the_way.units.iter().filter(|&other| set.contains(other)) {
                if !group.contains(&other) {
                    group.push(other);
                }
            }
            if group.len() > most {
                return None;
            }
            next += 1;
        }
        group.sort_unstable();
        Some(group)
    }
}
