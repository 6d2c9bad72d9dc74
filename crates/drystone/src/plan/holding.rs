//! A stability test that may hold blocks.
//!
//! A sub-assembly passes if it stands with at most `hands` of its blocks held, and if that hold can follow the one before.
//! Which holds are worth a look follows from the collapses (`hitting.rs`): the *minimal* ones that can be had from where the
//! hands are, for whatever holds more stands as well. If none does, the others are tried: the collapses found on the way
//! prove that none stops all of them, and carry over as a nogood, for by Lemma 1 each holds for other sub-assemblies.
//!
//! A first search keeps only the first few holds of a sub-assembly, which is quicker by far; what it passes over for
//! that is left to a second one that keeps them all ([`Holding::left_out`]).
//!
//! *How hands move.* One more hand carries the block that is put up or taken away, and may go on holding it. Apart from it
//! at most `hands` blocks are held at any moment, and a new block is held before an old one is let go. So H' can follow H
//! when X is put up if `|H + (H' - X)| <= hands`; from any hold on, so can a part of it.

use super::by_interior::{Forces, by_interior_point, falls_among};
use super::collapse::Collapse;
use super::hitting::next_hitting_set;
use super::reuse::certified_collapse;
use super::stability::{PlanError, StabilityTest, TestOutcome, Tested, by_accelerations};
use super::touching::Touching;
use crate::{
    formulate::{Assembly, BlockRows, BlockSet},
    ladder::Ladder,
    nearby::Put,
};
use drystone_lcp::cone::{ConeSolver, Mark, Membership};

/// Most holds tried on one sub-assembly. One hand never comes near; with more the number of sets could explode.
const MOST_TRIED: usize = 2000;

/// Holds of one sub-assembly that a first search keeps: with two hands there may be hundreds, each a test of its own, and
/// those that hold what came last are the first and serve longest.
pub(super) const FEW: usize = 4;

/// A sub-assembly on the way.
#[derive(Debug)]
struct Level {
    /// The solver, with nothing held, even if that falls.
    unheld: Mark,
    /// The block put up last.
    added: usize,
    /// The minimal holds that can be had on this way; one that holds nothing is alone.
    holds: Vec<Vec<usize>>,
    /// It stands under each of these.
    proved: bool,
    /// How it falls with nothing held, as far as that is known.
    falls: Vec<Fall>,
    /// Forces that hold it under some of its holds, or held the one before.
    forces: Vec<(Vec<usize>, Forces)>,
    /// See [`Holding::hard`].
    hard: bool,
}

/// A collapse of a sub-assembly that is held or not.
#[derive(Debug, Clone)]
struct Fall {
    collapse: Collapse,
    /// The blocks that move in it; those that are held do not, but for rounding.
    moving: BlockSet,
}

/// Equilibrium as in [`Reuse`](super::Reuse), with hands.
#[derive(Debug)]
pub(super) struct Holding<'a> {
    assembly: &'a Assembly,
    touching: Touching,
    solver: ConeSolver,
    rows: BlockRows,
    loads: Vec<f64>,
    hands: usize,
    /// Most holds of a sub-assembly that are kept.
    most: usize,
    /// Sub-assemblies of which more holds may have been had than were kept.
    left_out: usize,
    /// The bare supports, the current sub-assembly's ancestors, and itself.
    path: Vec<Level>,
    at_current: bool,
    /// Of the sub-assembly tested last.
    added: usize,
    holds: Vec<Vec<usize>>,
    falls: Vec<Fall>,
    forces: Vec<(Vec<usize>, Forces)>,
    collapses: Vec<Collapse>,
    /// How the one tested last falls, where that is not told by the solver.
    fell: Option<Collapse>,
    /// On the way to the one tested last pivots took longer than the interior-point method, which is asked from there on.
    hard: bool,
    undecided: usize,
}

impl<'a> Holding<'a> {
    /// Takes the generators of the complete assembly; the current sub-assembly is empty. Of each sub-assembly at most `most` holds
    /// are kept.
    pub fn new(assembly: &'a Assembly, hands: usize, most: usize) -> Self {
        let mut solver = assembly.equilibrium_with_hands();
        let (unheld, holds) = (solver.mark(), vec![Vec::new()]);
        let bare = Level { unheld, added: 0, holds, proved: true, falls: Vec::new(), forces: Vec::new(), hard: false };
        Self {
            assembly,
            touching: Touching::new(assembly),
            solver,
            rows: assembly.equilibrium_rows(),
            loads: (0..assembly.blocks()).flat_map(|block| assembly.applied(block)).copied().collect(),
            hands,
            most,
            left_out: 0,
            path: vec![bare],
            at_current: true,
            added: 0,
            holds: Vec::new(),
            falls: Vec::new(),
            forces: Vec::new(),
            collapses: Vec::new(),
            fell: None,
            hard: false,
            undecided: 0,
        }
    }

    /// Sub-assemblies given up without a proof that they fall however they are held: they stand under holds that could not
    /// be had on the way, or there were too many to try.
    pub fn undecided(&self) -> usize {
        self.undecided
    }

    /// Sub-assemblies of which there may have been more holds than were kept: what was given up on them is no proof.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// Of every sub-assembly on the way the block put up last and the minimal holds.
    pub fn way(&self) -> impl Iterator<Item = (usize, &[Vec<usize>])> {
        self.path.iter().skip(1).map(|level| (level.added, level.holds.as_slice()))
    }

    /// Whether a sub-assembly stands with these blocks held; None if that is borderline, or not known. If not, `fell` is how it
    /// falls. Where a solver has no answer the accelerations may have one with nothing held; with hands there is none then.
    fn stands(&mut self, held: &[usize], blocks: &BlockSet) -> Result<Option<bool>, PlanError> {
        let found = if self.hard { Membership::PivotLimit } else { self.by_pivots(held, blocks) };
        let by_solver = match self.hard {
            true => self.by_interior_point(held, blocks).or_else(|| self.by_new_solver(held, blocks)),
            false => self.tested(found, &self.solver),
        };
        let tested = match by_solver {
            Some(tested) => tested,
            None if held.is_empty() => by_accelerations(self.assembly, blocks)?,
            None => return Ok(None),
        };
        self.fell = tested.collapse;
        Ok((!tested.outcome.borderline).then_some(tested.outcome.stands))
    }

    /// What the interior-point method says.
    fn by_interior_point(&mut self, held: &[usize], blocks: &BlockSet) -> Option<Tested> {
        let put = Put { blocks, held, added: self.added };
        let known = self.path.last().into_iter().flat_map(|level| &level.forces).chain(&self.forces);
        let let_go = |before: &[usize]| before.iter().filter(|block| !held.contains(block)).count();
        let before = known.min_by_key(|(before, _)| let_go(before)).map(|(_, forces)| forces);
        let answer = by_interior_point(self.assembly, &self.touching, put, before)?;
        self.forces.extend(answer.forces.map(|forces| (held.to_vec(), forces)));
        Some(answer.tested)
    }

    /// What the pivots of a new solver say.
    fn by_new_solver(&self, held: &[usize], blocks: &BlockSet) -> Option<Tested> {
        let mut solver = self.assembly.equilibrium_with_hands();
        blocks.iter().for_each(|block| solver.add_rows(self.rows.of(block)));
        solver.add_rows(&held.iter().map(|&block| self.assembly.hand_row(block)).collect::<Vec<_>>());
        self.tested(solver.solve(), &solver)
    }

    fn tested(&self, found: Membership, solver: &ConeSolver) -> Option<Tested> {
        let falls = found == Membership::Outside;
        let collapse = falls.then(|| certified_collapse(solver, &self.rows, &self.loads));
        TestOutcome::of(found, 0).map(|outcome| Tested { outcome, collapse })
    }

    /// What the solver says, which has the blocks. Where its pivots take longer than the interior-point method all that follows is
    /// [`Self::hard`].
    fn by_pivots(&mut self, held: &[usize], blocks: &BlockSet) -> Membership {
        let rows: Vec<usize> = held.iter().map(|&block| self.assembly.hand_row(block)).collect();
        self.solver.add_rows(&rows);
        let worth = Ladder::of(self.assembly, blocks.len()).effort_of_a_change();
        self.solver.limit_effort(self.solver.effort().saturating_add(worth));
        let found = self.solver.decide();
        self.hard = found == Membership::PivotLimit && self.solver.is_exhausted();
        self.solver.limit_effort(usize::MAX);
        found
    }

    /// Finds the minimal holds of a sub-assembly that falls with nothing held, as far as they can be had here. If there are none,
    /// the collapses are a proof that none stands, or empty.
    fn find_holds(&mut self, blocks: &BlockSet) -> Result<(), PlanError> {
        let mut tried = 0;
        let mut decided = self.try_holds(blocks, &mut tried, true)?;
        if decided && self.holds.is_empty() {
            decided = self.try_holds(blocks, &mut tried, false)?;
            if !decided {
                self.holds.clear();
            }
        }
        if decided && self.holds.is_empty() {
            self.collapses = self.falls.iter().map(|fall| fall.collapse.clone()).collect();
        }
        Ok(())
    }

    /// Tries one hold after the other that stops the collapses of the family, those that can be had here or any. False if
    /// the collapses do not tell which holds there are: one is borderline, there are too many to try, or there is one that cannot
    /// be had here.
    fn try_holds(&mut self, blocks: &BlockSet, tried: &mut usize, here: bool) -> Result<bool, PlanError> {
        let unheld = self.solver.mark();
        let preference: Vec<usize> = self.newest_first().collect();
        loop {
            let may = |held: &[usize]| !here || self.can_follow(held);
            let family: Vec<&BlockSet> = self.falls.iter().map(|fall| &fall.moving).collect();
            let Some(held) = next_hitting_set(&family, self.hands, &preference, &self.holds, &may) else {
                return Ok(true);
            };
            let stands = match *tried {
                MOST_TRIED => None,
                _ if self.stood(&held) => Some(true),
                _ => self.stands(&held, blocks)?,
            };
            *tried += 1;
            match stands {
                Some(true) => self.holds.push(held),
                Some(false) => self.learn(&held),
                None => {}
            }
            self.solver.roll_back(unheld);
            if stands.is_none() || stands == Some(true) && !here {
                return Ok(false);
            }
            if self.holds.len() == self.most {
                self.left_out += 1;
                return Ok(true);
            }
        }
    }

    /// The blocks put up, the one being tried first.
    fn newest_first(&self) -> impl Iterator<Item = usize> {
        [self.added].into_iter().chain(self.path.iter().skip(1).rev().map(|level| level.added))
    }

    /// Keeps how it has just been found to fall with these blocks held, in place of collapses that move more blocks.
    fn learn(&mut self, held: &[usize]) {
        let Some(collapse) = self.fell.take() else { return };
        let mut moving = BlockSet::empty(self.assembly.blocks());
        let free = collapse.moving().iter().filter(|(block, _)| !held.contains(block));
        free.for_each(|&(block, _)| moving.insert(block));
        self.falls.retain(|known| !moving.iter().all(|block| known.moving.contains(block)));
        self.falls.push(Fall { collapse, moving });
    }

    /// The collapses of the current sub-assembly that go on with `added` there: it touches nothing that moves (Lemma 1).
    fn falls_still(&self, added: usize) -> Vec<Fall> {
        let touched = self.touching.neighbours(added);
        let goes_on = |fall: &&Fall| !touched.iter().any(|&block| fall.moving.contains(block));
        self.path.last().into_iter().flat_map(|level| &level.falls).filter(goes_on).cloned().collect()
    }

    /// Whether it stands with these blocks held because the one before did, and the new one is held: that is a fixed body more.
    fn stood(&self, held: &[usize]) -> bool {
        let stands = |before: &Vec<usize>| before.iter().all(|block| held.contains(block));
        let before = self.path.last().filter(|level| level.proved && held.contains(&self.added));
        before.is_some_and(|level| level.holds.iter().any(stands))
    }

    /// Brings the solver to the current sub-assembly.
    fn go_to_current(&mut self) {
        if !self.at_current
            && let Some(current) = self.path.last()
        {
            self.solver.roll_back(current.unheld);
        }
    }

    /// Whether a hold can follow one of the current sub-assembly's.
    fn can_follow(&self, held: &[usize]) -> bool {
        let before = self.path.last().map_or(&[][..], |level| &level.holds);
        before.iter().any(|before| hands_needed(before, held, self.added) <= self.hands)
    }
}

/// Hands, beside the one that carries `added`, while the hold changes as it is put up.
pub(super) fn hands_needed(before: &[usize], after: &[usize], added: usize) -> usize {
    before.len() + after.iter().filter(|&block| *block != added && !before.contains(block)).count()
}

#[cfg(test)]
impl Holding<'_> {
    /// The same where the interior-point method is asked from the first test on.
    pub fn always_hard(mut self) -> Self {
        self.path.iter_mut().for_each(|level| level.hard = true);
        self
    }
}

impl StabilityTest for Holding<'_> {
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        self.go_to_current();
        self.hard = self.path.last().is_some_and(|level| level.hard);
        self.at_current = false;
        self.added = added;
        self.holds.clear();
        self.collapses.clear();
        self.fell = None;
        let before = self.solver.counts().pivots;
        if !self.hard {
            self.solver.add_rows(self.rows.of(added));
        }
        self.falls = self.falls_still(added);
        self.forces.clear();
        if self.hard && !self.falls.is_empty() {
            // Otherwise it is asked first below.
            let put = Put { blocks, held: &[], added };
            self.fell = falls_among(self.assembly, &self.touching, put, &[added]);
            self.learn(&[]);
        }
        let unheld = if self.falls.is_empty() { self.stands(&[], blocks)? } else { Some(false) };
        if unheld == Some(true) {
            self.holds.push(Vec::new());
        } else if unheld == Some(false) {
            self.learn(&[]);
            self.find_holds(blocks)?;
        }
        let stands = !self.holds.is_empty();
        self.undecided += usize::from(!stands && self.collapses.is_empty());
        let borderline = unheld.is_none();
        Ok(TestOutcome { stands, borderline, pivots: self.solver.counts().pivots - before })
    }

    /// The hands hold on to what they hold.
    fn carry(&mut self, _blocks: &BlockSet, added: usize) -> Result<usize, PlanError> {
        self.go_to_current();
        let (holds, hard) = self.path.last().map_or((Vec::new(), false), |before| (before.holds.clone(), before.hard));
        if !hard {
            self.solver.add_rows(self.rows.of(added));
        }
        let falls = self.falls_still(added);
        let forces = self.path.last().map_or_else(Vec::new, |before| before.forces.clone());
        self.path.push(Level { unheld: self.solver.mark(), added, holds, proved: false, falls, forces, hard });
        self.at_current = true;
        Ok(0)
    }

    fn explains(&self) -> bool {
        true
    }

    fn collapses_however_held(&self) -> &[Collapse] {
        &self.collapses
    }

    fn descend(&mut self) {
        let (unheld, holds) = (self.solver.mark(), std::mem::take(&mut self.holds));
        let falls = std::mem::take(&mut self.falls);
        let mut forces = std::mem::take(&mut self.forces);
        if let Some(before) = self.path.last().filter(|_| forces.is_empty()) {
            forces.clone_from(&before.forces);
        }
        self.path.push(Level { unheld, added: self.added, holds, proved: true, falls, forces, hard: self.hard });
        self.at_current = true;
    }

    fn backtrack(&mut self) {
        self.path.pop();
        self.at_current = false;
    }
}
