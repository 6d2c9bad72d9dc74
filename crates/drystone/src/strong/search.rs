//! Branch and bound on which contacts part, slide and rest.

use super::{
    answer::Strong,
    branch::{Branch, Choice, Way},
    budget::{Budget, Monitor, Searched},
    chains::{disjoint, fastest_first, rows_of_faces},
    escape::Escape,
    hinges::Turned,
    laws::{Laws, Row},
    program::{Answer, Found, Objective, solve},
    turned::virial,
};
use crate::formulate::{Assembly, BlockSet};

/// Power below which nothing moves, of that of free fall: what is left of an optimum of zero by the rounding of its multipliers. An
/// acceleration of that power is 3e-5 of free fall.
const NO_POWER: f64 = 1e-9;

/// By how much a least bearing is taken lower than it was found, of the loads: the rounding of a program's optimum.
const OF_A_BOUND: f64 = 1e-9;

/// A face that is behind another by no more than this is not: rounding of an optimum of zero.
const BEHIND: f64 = 1e-12;

/// A law is broken if both of what must not be there together are above this, of free fall and of the loads.
const BROKEN: f64 = 1e-8;

/// Broken laws that are tried in a node before it is split; more tell little (docs/theory/strong-stability.md).
const TRIED: usize = 12;

/// A bound of the accelerations is followed as long as it falls to this share; a bearing is news if it is larger by that much.
const FALLS_TO: f64 = 0.9;
const GROWS_BY: f64 = 1.02;
const NEWS: f64 = 1e-6;

/// Virials are bounded anew when the bound of the accelerations has fallen to this share since.
const VIRIALS_AGAIN: f64 = 0.7;

/// Turned loads are kept if they leave no more than this share of the power: programs with them take five times as long.
const WORTH: f64 = 0.75;

/// Factors of turned loads that are tried, as shares of the least friction, to either side; and halvings of the step from one to the next
/// around the best.
const FACTORS: i32 = 4;
const HALVINGS: usize = 2;

/// Rounds of tries in a node.
const ROUNDS: usize = 50;

/// What is known of a node.
enum Node {
    /// Nothing moves in it.
    Closed,
    Escapes(Escape),
    /// Two nodes in its place; the second is looked at first.
    Split(Box<[Branch; 2]>),
    /// No program tells more.
    Unknown,
}

/// The most power in a branch.
enum Bound {
    Closed,
    Open(f64, Found),
    Unknown,
}

struct Search<'a> {
    assembly: &'a Assembly,
    blocks: &'a BlockSet,
    laws: Laws<'a>,
    budget: Budget,
    monitor: &'a mut Monitor<'a>,
    done: Searched,
    stopped: bool,
    programs: usize,
    /// Whether turned loads have been looked for, and after them chains: not before the root would be split.
    turned: bool,
    ordered: bool,
}

/// See [`super::strong`].
pub(super) fn search(
    assembly: &Assembly,
    blocks: &BlockSet,
    budget: Budget,
    monitor: &mut Monitor<'_>,
) -> Option<Strong> {
    let Some(laws) = Laws::new(assembly, blocks) else {
        return Some(Strong { must_stand: Some(true), escape: None, nodes: 0, programs: 0 });
    };
    let root = Branch::root(&laws);
    let mut search = Search {
        assembly,
        blocks,
        laws,
        budget,
        monitor,
        done: Searched::default(),
        stopped: false,
        programs: 0,
        turned: false,
        ordered: false,
    };
    let (mut open, mut unknown) = (vec![root], false);
    let mut escape = None;
    while let Some(branch) = open.pop() {
        if !budget.allows_another(search.done) {
            unknown = true;
            break;
        }
        search.done.nodes += 1;
        let node = search.look(branch);
        if search.stopped {
            return None;
        }
        match node {
            Node::Closed => {}
            Node::Escapes(found) => {
                escape = Some(found);
                break;
            }
            Node::Split(two) => open.extend(*two),
            Node::Unknown => unknown = true,
        }
    }
    let must_stand = if escape.is_some() { Some(false) } else { (!unknown).then_some(true) };
    Some(Strong { must_stand, escape, nodes: search.done.nodes, programs: search.programs })
}

impl Search<'_> {
    /// [`Answer::Unknown`] without any work where it was stopped, or the budget is used up.
    fn solve(&mut self, branch: &Branch, objective: Objective<'_>) -> Answer {
        let left = self.budget.effort_left(self.done);
        self.stopped = self.stopped || !(self.monitor)(self.done);
        if self.stopped || left == 0 {
            return Answer::Unknown;
        }
        self.programs += 1;
        let (effort, answer) = solve(&self.laws, branch, objective, left);
        self.done.effort += effort as u64;
        answer
    }

    /// The most power, the bound of the accelerations with it: their length squared is at most that power.
    fn bound(&mut self, branch: &mut Branch) -> Bound {
        loop {
            match self.solve(branch, Objective::Power) {
                Answer::None => return Bound::Closed,
                Answer::Unknown => return Bound::Unknown,
                Answer::Best(power, _) if power <= NO_POWER => return Bound::Closed,
                Answer::Best(power, found) => {
                    branch.basis.clone_from(&found.basis);
                    let (before, radius) = (branch.radius, power.sqrt());
                    branch.radius = before.min(radius);
                    if radius > FALLS_TO * before {
                        return Bound::Open(power, found);
                    }
                }
            }
        }
    }

    /// Bounds a node, tries what the relaxation breaks, and splits it where both sides of a choice stay open.
    fn look(&mut self, mut branch: Branch) -> Node {
        let mut split = None;
        for _ in 0..ROUNDS {
            let (power, found) = match self.bound(&mut branch) {
                Bound::Closed => return Node::Closed,
                Bound::Unknown => return Node::Unknown,
                Bound::Open(power, found) => (power, found),
            };
            if !branch.virials.is_empty() && branch.radius < VIRIALS_AGAIN * branch.virial_radius {
                self.bound_virials(&mut branch);
                continue;
            }
            let broken = self.broken(&found);
            if broken.is_empty() {
                return match Escape::new(self.assembly, self.blocks, &self.laws, &found) {
                    Some(escape) => Node::Escapes(escape),
                    None => Node::Unknown,
                };
            }
            split = None;
            let (mut news, mut best) = (false, 0.0);
            for choice in broken.into_iter().take(TRIED) {
                match self.try_both(&mut branch, choice, power) {
                    Some((worth, two)) if worth > best => (best, split) = (worth, Some(two)),
                    Some(_) => {}
                    None => news = true,
                }
            }
            if news {
                continue;
            }
            if self.ordered {
                break;
            }
            if !self.turn(&mut branch, power) {
                self.order(&mut branch);
            }
        }
        split.map_or(Node::Unknown, Node::Split)
    }

    /// Looks for turned loads that bound the power of the root further, with virials as they are bounded now. False if there are none.
    fn turn(&mut self, root: &mut Branch, power: f64) -> bool {
        let before = self.laws.turned.as_ref().map(|turned| turned.factor);
        if before.is_none() {
            if std::mem::replace(&mut self.turned, true) {
                return false;
            }
            self.laws.turned = Turned::new(&self.laws);
        }
        if self.laws.turned.is_none() || !self.bound_virials(root) {
            return false;
        }
        let most = self.laws.points.iter().map(|point| point.friction).fold(f64::INFINITY, f64::min);
        let mut step = most / f64::from(FACTORS);
        let (mut best, mut least) = (0.0, f64::INFINITY);
        let mut tried: Vec<f64> = (1..=FACTORS).flat_map(|k| [-step, step].map(|step| f64::from(k) * step)).collect();
        for _ in 0..=HALVINGS {
            for factor in tried {
                let power = self.power_turned(root, factor);
                if power < least {
                    (best, least) = (factor, power);
                }
            }
            step *= 0.5;
            tried = [best - step, best + step].into_iter().filter(|factor| factor.abs() <= most).collect();
        }
        let share = if before.is_some() { FALLS_TO } else { WORTH };
        let better = least < share * power;
        match (better, before) {
            (true, _) => self.set_factor(best),
            (false, Some(before)) => self.set_factor(before),
            (false, None) => {
                self.laws.turned = None;
                root.virials.clear();
            }
        }
        better
    }

    fn set_factor(&mut self, factor: f64) {
        if let Some(turned) = &mut self.laws.turned {
            turned.factor = factor;
        }
    }

    /// The most power with loads turned by a factor.
    fn power_turned(&mut self, branch: &Branch, factor: f64) -> f64 {
        self.set_factor(factor);
        match self.solve(branch, Objective::Power) {
            Answer::None => 0.0,
            Answer::Best(power, _) => power,
            Answer::Unknown => f64::INFINITY,
        }
    }

    /// Finds the least and the greatest virials in a branch. False if they have none.
    fn bound_virials(&mut self, branch: &mut Branch) -> bool {
        branch.virial_radius = branch.radius;
        let mut virials = Vec::with_capacity(self.laws.size() / 3);
        for block in 0..self.laws.size() / 3 {
            let levers = (0..self.laws.points.len()).flat_map(|point| virial(&self.laws, point, block));
            let (reach, mut bounds) = (levers.fold(0.0_f64, |reach, lever| reach.max(lever.abs())), [0.0; 2]);
            for (bound, sign) in bounds.iter_mut().zip([1.0, -1.0]) {
                match self.solve(branch, Objective::Virial(block, sign)) {
                    Answer::Best(least, _) => *bound = sign * (least - reach * OF_A_BOUND),
                    Answer::None => return true,
                    Answer::Unknown => return false,
                }
            }
            virials.push(bounds);
        }
        branch.virials = virials;
        true
    }

    /// Finds out which faces of a row slide faster than which, whatever the motion.
    fn order(&mut self, root: &mut Branch) {
        let anything = Branch::root(&self.laws);
        let mut chains: Vec<Vec<usize>> = Vec::new();
        for row in rows_of_faces(&self.laws) {
            for order in [row.clone(), row.iter().rev().copied().collect()] {
                let mut chain: Vec<usize> = Vec::new();
                for face in order {
                    if chain.last().is_some_and(|&last| !self.leads(&anything, last, face)) {
                        chains.push(std::mem::take(&mut chain));
                    }
                    chain.push(face);
                }
                chains.push(chain);
            }
        }
        self.laws.chains = disjoint(chains, self.laws.faces.len());
        let nothing = |chain: &Vec<usize>| [vec![0.0; chain.len()], vec![0.0; chain.len()]];
        root.sums = self.laws.chains.iter().map(nothing).collect();
        self.ordered = true;
    }

    /// Whether a face slides along the tangent at least as fast as another in every solution.
    fn leads(&mut self, anything: &Branch, other: usize, face: usize) -> bool {
        matches!(self.solve(anything, Objective::Lead([other, face])), Answer::Best(lead, _) if lead >= -BEHIND)
    }

    /// A face slides, so that all faster ones of its chain do: where their sum is kept, and what they bear at least together. None
    /// without faster ones; an error if it cannot slide.
    fn sum(&mut self, slides: &mut Branch, face: usize, way: Way) -> Result<Option<([usize; 2], f64)>, ()> {
        let place = |chain: &Vec<usize>| fastest_first(chain, way).iter().position(|&other| other == face);
        let found = self.laws.chains.iter().enumerate().find_map(|(number, chain)| Some((number, place(chain)?)));
        // A branch from before the chains were known has no sums.
        let Some((chain, k)) = found.filter(|&(chain, k)| k > 0 && chain < slides.sums.len()) else { return Ok(None) };
        let faces = fastest_first(&self.laws.chains[chain], way);
        for &faster in &faces[..k] {
            *slides = slides.clone().first(Choice::Sliding(faster, way));
        }
        match self.solve(slides, Objective::Bearing(&faces[..=k])) {
            Answer::None => Err(()),
            Answer::Best(sum, _) => Ok(Some(([chain, k], sum - OF_A_BOUND))),
            Answer::Unknown => Ok(None),
        }
    }

    /// Both sides of a choice, and what splitting by it is worth; None if only one of them is open, or more is known now: the
    /// branch has it then.
    fn try_both(&mut self, branch: &mut Branch, choice: Choice, power: f64) -> Option<(f64, Box<[Branch; 2]>)> {
        let mut first = branch.clone().first(choice);
        let first_power = match self.bound(&mut first) {
            Bound::Closed => {
                *branch = branch.clone().second(choice);
                return None;
            }
            Bound::Open(power, _) => power,
            Bound::Unknown => power,
        };
        let mut news = false;
        if let Choice::Sliding(face, way) = choice {
            match self.solve(&first, Objective::Bearing(&[face])) {
                Answer::None => {
                    *branch = branch.clone().second(choice);
                    return None;
                }
                Answer::Unknown => {}
                Answer::Best(least, _) => {
                    let (least, known) = (least - OF_A_BOUND, branch.least[face][way]);
                    first.least[face][way] = first.least[face][way].max(least);
                    if least > GROWS_BY * known + NEWS {
                        branch.least[face][way] = least;
                        news = true;
                    }
                }
            }
        }
        if let Choice::Sliding(face, way) = choice {
            match self.sum(&mut first, face, way) {
                Ok(None) => {}
                Err(()) => {
                    *branch = branch.clone().second(choice);
                    return None;
                }
                Ok(Some(([chain, k], sum))) => {
                    let known = branch.sums[chain][way][k];
                    first.sums[chain][way][k] = known.max(sum);
                    if sum > GROWS_BY * known + NEWS {
                        branch.sums[chain][way][k] = sum;
                        news = true;
                    }
                }
            }
        }
        let mut second = branch.clone().second(choice);
        let second_power = match self.bound(&mut second) {
            Bound::Closed => {
                *branch = first;
                return None;
            }
            Bound::Open(power, _) => power,
            Bound::Unknown => power,
        };
        if news {
            return None;
        }
        let gain = |other: f64| (power - other).max(1e-3 * power);
        let two = if first_power >= second_power { [second, first] } else { [first, second] };
        Some((gain(first_power) * gain(second_power), Box::new(two)))
    }

    /// The choices of which a point of the relaxation takes neither, those it takes least first.
    fn broken(&self, found: &Found) -> Vec<Choice> {
        let along = |row: &Row| row.iter().map(|&(k, value)| value * found.a[k]).sum::<f64>();
        let mut broken = Vec::new();
        for (index, point) in self.laws.points.iter().enumerate() {
            let (parts, bears) = (along(&point.normal), found.forces[index][0]);
            broken.push((parts, bears, Choice::Parting(index)));
        }
        for (index, face) in self.laws.faces.iter().enumerate() {
            let slides = along(&self.laws.points[face.points[0]].tangent);
            for (way, sign) in [1.0, -1.0].into_iter().enumerate() {
                let on_edge = |&point: &usize| {
                    let [normal, tangential] = found.forces[point];
                    0.5 * (normal + sign * tangential / face.friction)
                };
                let helps: f64 = face.points.iter().map(on_edge).sum();
                broken.push((sign * slides, helps, Choice::Sliding(index, way)));
            }
        }
        broken.retain(|&(one, other, _)| one.min(other) > BROKEN);
        broken.sort_by(|a, b| (b.0 * b.1).total_cmp(&(a.0 * a.1)));
        broken.into_iter().map(|(_, _, choice)| choice).collect()
    }
}
