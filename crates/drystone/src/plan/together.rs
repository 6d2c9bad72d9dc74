//! Blocks that leave together where they lock one another in: a nut in the pocket of a block, or a drawer and what lies in it.
//!
//! The search goes by *units*, groups of blocks that are put up at once, and blocks alone. It asks no more of a group than that it
//! stands when all of it is there. The lemmas of the search hold for units as they do for blocks: a unit moves if a block of it
//! does, with the work of all its loads, and touches what a block of it touches.
//!
//! Which groups there are is found as locked blocks are ([`Paths::groups`]): a block takes along in a direction what
//! is in its way, and what is in the way of that (R. H. Wilson and J.-C. Latombe, "Geometric reasoning about mechanical
//! assembly", Artificial Intelligence 71, 1994).

use super::candidates::Upward;
use super::clear_path::Paths;
use super::collapse::Collapse;
use super::dead_end::{dead_end, until_stopped};
use super::found::{Found, check_alone};
use super::grips::fewest_grips;
use super::holding::Holding;
use super::in_turn::memory_for;
use super::outcome::Outcome;
use super::search::{Clock, Search};
use super::stability::{PlanError, StabilityTest, TestOutcome};
use super::touching::Touching;
use crate::formulate::{Assembly, BlockSet};

/// Groups and blocks alone, so that every block is in one.
pub(super) fn units_of(groups: &[Vec<usize>], blocks: usize) -> Vec<Vec<usize>> {
    let alone = (0..blocks).filter(|block| !groups.iter().any(|group| group.contains(block)));
    groups.iter().cloned().chain(alone.map(|block| vec![block])).collect()
}

/// Searches an order of units whose paths these are. What it finds is told in blocks.
///
/// # Errors
/// [`PlanError`] for a test without an answer.
pub(super) fn search_units(
    assembly: &Assembly,
    units: &[Vec<usize>],
    paths: &Paths<'_>,
    test: &mut dyn StabilityTest,
    hands: usize,
    clock: &mut Clock<'_>,
) -> Result<Found, PlanError> {
    let mut found = check_alone(assembly, clock, Outcome::Found);
    if found.outcome != Outcome::Found {
        return Ok(found);
    }
    let touching = Touching::of_units(assembly, units);
    let mut by_units = UnitTest::new(test, units);
    search(&touching, paths, &mut by_units, clock, &mut found)?;
    by_units.take_down();
    found.held = vec![Vec::new(); found.reached.iter().map(|&unit| units[unit].len()).sum()];
    if found.outcome == Outcome::NoOrder {
        if hands > 0 {
            let mut test = Holding::new(assembly, hands, usize::MAX);
            let mut by_units = UnitTest::new(&mut test, units);
            search(&touching, paths, &mut by_units, clock, &mut found)?;
            by_units.take_down();
            let undecided = test.undecided() > 0;
            tell(assembly, units, &touching, paths, hands, clock, &mut found)?;
            if found.outcome == Outcome::NoOrder && undecided {
                found.outcome = Outcome::Undecided;
            }
        } else {
            let ended = clock.run(|| dead_end(&mut by_units, &touching, Some(paths), &mut found.reached));
            found.falls_next = until_stopped(ended)?;
        }
    }
    Ok(found)
}

/// Searches on with a test, and adds what it finds.
fn search(
    touching: &Touching,
    paths: &Paths<'_>,
    test: &mut UnitTest<'_>,
    clock: &mut Clock<'_>,
    found: &mut Found,
) -> Result<(), PlanError> {
    let mut memory = memory_for(touching, clock.limits, test);
    let mut upward = Upward::new(touching);
    let mut search = Search::new(touching, Some(paths), memory.as_mut(), &mut upward);
    search.records = std::mem::take(&mut found.records);
    let ended = search.run(test, clock);
    let Search { best, records, .. } = search;
    (found.reached, found.records) = (best, records);
    found.shortcuts += memory.shortcuts();
    found.outcome = match ended {
        Err(PlanError::Interrupted) => clock.stopped(),
        ended => ended?,
    };
    Ok(())
}

/// Puts up again what was reached with hands, and tells what they hold, and what falls next where there is no order.
fn tell(
    assembly: &Assembly,
    units: &[Vec<usize>],
    touching: &Touching,
    paths: &Paths<'_>,
    hands: usize,
    clock: &Clock<'_>,
    found: &mut Found,
) -> Result<(), PlanError> {
    if !matches!(found.outcome, Outcome::Found | Outcome::NoOrder) {
        found.reached.clear(); // who stopped the search would stop this too
        found.held.clear();
        return Ok(());
    }
    let mut test = Holding::new(assembly, hands, usize::MAX);
    let mut by_units = UnitTest::new(&mut test, units);
    // The complete assembly stands with nothing held, and is not put up.
    let mut way = found.reached.clone();
    way.truncate(units.len() - 1);
    let ended = clock.run(|| dead_end(&mut by_units, touching, Some(paths), &mut way));
    match ended {
        Err(PlanError::Interrupted) => {
            found.outcome = clock.stopped();
            found.reached.clear();
            found.held.clear();
            return Ok(());
        }
        ended if found.outcome != Outcome::Found => {
            found.falls_next = ended?;
            found.reached = way;
        }
        ended => drop(ended?),
    }
    found.held = fewest_grips(test.way(), hands);
    found.held.resize(found.reached.iter().map(|&unit| units[unit].len()).sum(), Vec::new());
    Ok(())
}

/// A test of blocks that is asked about units.
struct UnitTest<'a> {
    test: &'a mut dyn StabilityTest,
    units: &'a [Vec<usize>],
    /// Of each block.
    unit: Vec<usize>,
    /// Blocks of each unit on the way.
    path: Vec<usize>,
    /// Blocks of the unit tested last that the test has put up already: all but one.
    ahead: usize,
    collapses: Vec<Collapse>,
}

impl<'a> UnitTest<'a> {
    fn new(test: &'a mut dyn StabilityTest, units: &'a [Vec<usize>]) -> Self {
        let mut unit = vec![0; units.iter().map(Vec::len).sum()];
        units.iter().enumerate().for_each(|(k, blocks)| blocks.iter().for_each(|&block| unit[block] = k));
        Self { test, units, unit, path: Vec::new(), ahead: 0, collapses: Vec::new() }
    }

    /// Takes off what was put up of a unit that did not come to stay.
    fn withdraw(&mut self) {
        (0..std::mem::take(&mut self.ahead)).for_each(|_| self.test.backtrack());
    }

    /// Back to the bare supports.
    fn take_down(&mut self) {
        self.withdraw();
        (0..self.path.drain(..).sum()).for_each(|_| self.test.backtrack());
    }

    /// A collapse of blocks as one of units: each does the work of all its blocks.
    fn of_units(&self, collapse: &Collapse) -> Collapse {
        let mut moving: Vec<(usize, f64)> = Vec::new();
        for &(block, work) in collapse.moving() {
            let unit = self.unit[block];
            match moving.iter_mut().find(|(known, _)| *known == unit) {
                Some((_, sum)) => *sum += work,
                None => moving.push((unit, work)),
            }
        }
        Collapse::new(moving)
    }
}

impl StabilityTest for UnitTest<'_> {
    fn test(&mut self, set: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        self.withdraw();
        let mut blocks = BlockSet::empty(self.unit.len());
        let others = set.iter().filter(|&unit| unit != added);
        others.flat_map(|unit| &self.units[unit]).for_each(|&block| blocks.insert(block));
        let Some((&last, first)) = self.units[added].split_last() else {
            return Ok(TestOutcome { stands: true, borderline: false, pivots: 0 });
        };
        let mut pivots = 0;
        for &block in first {
            blocks.insert(block);
            pivots += self.test.carry(&blocks, block)?;
            self.ahead += 1;
        }
        blocks.insert(last);
        let outcome = self.test.test(&blocks, last)?;
        self.collapses = self.test.collapses_however_held().iter().map(|collapse| self.of_units(collapse)).collect();
        Ok(TestOutcome { pivots: outcome.pivots + pivots, ..outcome })
    }

    fn explains(&self) -> bool {
        self.test.explains()
    }

    fn collapse(&self) -> Option<Collapse> {
        self.test.collapse().map(|collapse| self.of_units(&collapse))
    }

    fn collapses_however_held(&self) -> &[Collapse] {
        &self.collapses
    }

    fn descend(&mut self) {
        self.test.descend();
        self.path.push(std::mem::take(&mut self.ahead) + 1);
    }

    fn backtrack(&mut self) {
        self.withdraw();
        (0..self.path.pop().unwrap_or(0)).for_each(|_| self.test.backtrack());
    }
}
