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

use super::directions::{along_faces, at_contacts};
use crate::contact::{Contact, tolerance_of};
use crate::error::SceneError;
use crate::formulate::{Assemble, Assembly, BlockSet};
use crate::geometry::{Sweeping, dot, unit};
use crate::scene::SceneOf;
use std::cell::OnceCell;

/// The cosine with which a direction looks against a contact that stops it, far above what facets' normals are off by where a
/// direction lies in them.
const AGAINST: f64 = 0.1;

/// Why a block cannot leave.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocked {
    /// The body that cannot leave, an index of the scene.
    pub body: usize,
    /// For each direction looked at, which bodies are in the way.
    pub ways: Vec<([f64; 3], Vec<usize>)>,
}

/// What is in the way of a block in one direction, when everything is there.
#[derive(Debug, Clone)]
struct InTheWay {
    blocks: BlockSet,
    /// Fixed bodies, by their index in the scene.
    fixed: Vec<usize>,
}

/// For each block the directions in which it may leave, and what is in the way.
#[derive(Debug)]
pub(super) struct Paths<'a> {
    assembly: &'a Assembly,
    /// Of every body, with the contact tolerance that it allows, metres.
    swept: Vec<Sweeping>,
    tolerances: Vec<f64>,
    directions: Vec<Vec<[f64; 3]>>,
    /// For each block and direction, once it is asked for.
    known: Vec<Vec<OnceCell<InTheWay>>>,
    faces_tried: bool,
}

impl<'a> Paths<'a> {
    /// Takes a scene's assembly, and directions to try beside those along the axes and the block's contacts. Those along
    /// faces come with [`Paths::try_faces`].
    ///
    /// # Errors
    /// [`SceneError::BadParameter`] for a direction that is zero or not finite.
    pub fn new<S: Assemble>(
        scene: &SceneOf<S>,
        assembly: &'a Assembly,
        directions: &[[f64; 3]],
    ) -> Result<Self, SceneError> {
        let mut given = Vec::new();
        for direction in directions {
            let size = direction.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
            let along = unit(direction.map(|x| x / size)).filter(|_| size.is_finite());
            given.push(along.ok_or_else(|| SceneError::BadParameter {
                scene: "plan".into(),
                parameter: "directions".into(),
                found: format!("{direction:?}"),
                expected: "finite vectors that are not zero".into(),
            })?);
        }
        let swept: Vec<Sweeping> = scene.bodies().iter().map(|body| Sweeping::of(S::pieces(body))).collect();
        let directions = at_contacts(assembly, &given, |body| swept[body].is_fine());
        Ok(Self {
            assembly,
            swept,
            tolerances: scene.bodies().iter().map(|body| tolerance_of(scene, body)).collect(),
            known: directions.iter().map(|list| vec![OnceCell::new(); list.len()]).collect(),
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
        for block in 0..self.blocks() {
            let list = &mut self.directions[block];
            along_faces(list, &self.swept, self.assembly.body_index(block), self.assembly.in_plane());
            self.known[block].resize(list.len(), OnceCell::new());
        }
        true
    }

    /// Number of movable blocks.
    pub fn blocks(&self) -> usize {
        self.assembly.blocks()
    }

    fn in_the_way(&self, block: usize, way: usize) -> &InTheWay {
        let assembly = self.assembly;
        self.known[block][way].get_or_init(|| {
            let (body, direction) = (assembly.body_index(block), self.directions[block][way]);
            let stops = |&other: &usize| {
                let tolerance = self.tolerances[body].min(self.tolerances[other]);
                let (own, others) = (&self.swept[body], &self.swept[other]);
                let fine = own.is_fine() || others.is_fine();
                other != body
                    && (fine && self.presses_against([body, other], direction)
                        || own.is_stopped_by(others, direction, tolerance))
            };
            let mut blocks = BlockSet::empty(assembly.blocks());
            (0..assembly.blocks()).filter(|&b| stops(&assembly.body_index(b))).for_each(|b| blocks.insert(b));
            let fixed = (0..self.swept.len()).filter(|&other| assembly.bodies()[other].fixed).filter(stops).collect();
            InTheWay { blocks, fixed }
        })
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

    /// The first direction in which a block can leave the other blocks of a set.
    pub fn way_out(&self, block: usize, set: &BlockSet) -> Option<[f64; 3]> {
        let free = (0..self.directions[block].len()).find(|&way| {
            let in_the_way = self.in_the_way(block, way);
            in_the_way.fixed.is_empty() && !in_the_way.blocks.iter().any(|other| set.contains(other))
        });
        free.map(|way| self.directions[block][way])
    }

    /// Blocks of a set that together leave a block no way out, those put up early if there is a choice; None if it has one.
    pub fn blame(&self, block: usize, set: &BlockSet, position: &[usize]) -> Option<Vec<usize>> {
        if self.way_out(block, set).is_some() {
            return None;
        }
        let mut blame = Vec::new();
        for way in 0..self.directions[block].len() {
            let in_the_way = self.in_the_way(block, way);
            if !in_the_way.fixed.is_empty() || in_the_way.blocks.iter().any(|other| blame.contains(&other)) {
                continue;
            }
            let there = in_the_way.blocks.iter().filter(|&other| set.contains(other));
            blame.extend(there.min_by_key(|&other| position[other]));
        }
        Some(blame)
    }

    /// What is in the way of those of some blocks that cannot leave a set.
    pub fn blocked(&self, blocks: impl Iterator<Item = usize>, set: &BlockSet) -> Vec<Blocked> {
        let stuck: Vec<usize> = blocks.filter(|&block| self.way_out(block, set).is_none()).collect();
        stuck.into_iter().map(|block| self.why(block, set)).collect()
    }

    fn why(&self, block: usize, set: &BlockSet) -> Blocked {
        let (assembly, directions) = (self.assembly, self.directions[block].clone());
        let ways = directions.into_iter().enumerate().map(|(way, direction)| {
            let in_the_way = self.in_the_way(block, way);
            let there = in_the_way.blocks.iter().filter(|&other| set.contains(other));
            let mut bodies: Vec<usize> = there.map(|other| assembly.body_index(other)).collect();
            bodies.extend(&in_the_way.fixed);
            bodies.sort_unstable();
            (direction, bodies)
        });
        Blocked { body: assembly.body_index(block), ways: ways.collect() }
    }

    /// The blocks that lock one another in.
    pub fn locked(&self) -> BlockSet {
        let mut left = BlockSet::full(self.assembly.blocks());
        let downward: Vec<usize> = self.assembly.upward().into_iter().rev().collect();
        loop {
            let before = left.len();
            for &block in &downward {
                if left.contains(block) && self.way_out(block, &left).is_some() {
                    left.remove(block);
                }
            }
            if left.len() == before {
                return left;
            }
        }
    }
}
