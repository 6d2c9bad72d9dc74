//! Depth-first search of the disassembly graph.

use super::stability::{FromScratch, PlanError, Reuse, ReuseDantzig, StabilityTest, Test, TestOutcome};
use crate::{
    check::{Verdict, check_blocks},
    formulate::{Assembly, BlockSet},
    scene::Scene,
};
use std::{
    collections::HashSet,
    time::{Duration, Instant},
};

/// Budgets of a search; without them it goes on to the end.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Limits {
    /// Most stability tests.
    pub tests: Option<usize>,
    /// Most wall time.
    pub time: Option<Duration>,
}

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Outcome {
    /// `order` takes the whole assembly apart.
    Found,
    /// Every sub-assembly that can be reached was tested: no stable order exists.
    NoOrder,
    /// The complete assembly does not stand, so there is nothing to take apart.
    WholeFalls,
    /// The test budget was spent.
    TestLimit,
    /// The time budget was spent.
    TimeLimit,
    /// The monitor asked to stop.
    Interrupted,
}

impl Outcome {
    /// The outcome as users of other languages see it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::NoOrder => "no_order",
            Self::WholeFalls => "whole_falls",
            Self::TestLimit => "test_limit",
            Self::TimeLimit => "time_limit",
            Self::Interrupted => "interrupted",
        }
    }
}

/// How far a search has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Stability tests done.
    pub tests: usize,
    /// Blocks of the current sub-assembly.
    pub placed: usize,
    /// Movable blocks in all.
    pub blocks: usize,
}

/// Watches a search, and may stop it.
pub trait Monitor {
    /// Called before every test. False stops the search.
    fn go_on(&mut self, progress: Progress) -> bool;
}

/// A monitor that says nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Quiet;

impl Monitor for Quiet {
    fn go_on(&mut self, _progress: Progress) -> bool {
        true
    }
}

/// One stability test of a search, in the order in which they were made (Fig. 6 plots them).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TestRecord {
    /// Movable blocks in the sub-assembly.
    pub size: usize,
    /// What the test said and cost.
    pub outcome: TestOutcome,
    /// Wall time of the test.
    pub time: Duration,
}

/// The answer of the planner. Bodies are scene indices.
#[derive(Debug, Clone)]
pub struct Plan {
    /// How the search ended.
    pub outcome: Outcome,
    /// The disassembly order, first removed first; empty unless found.
    pub order: Vec<usize>,
    /// The largest standing sub-assembly reached, in the order in which it was put up.
    pub reached: Vec<usize>,
    /// Blocks that could be put on it next, none of which leaves it standing (empty if found or cut short).
    pub falls_next: Vec<usize>,
    /// Every stability test.
    pub records: Vec<TestRecord>,
    /// Time to analyse the complete assembly for the tests (counted as test time).
    pub setup: Duration,
    /// Time of everything, contacts included.
    pub total: Duration,
    /// Verdict on the complete assembly, reported apart from the tests.
    pub whole: Verdict,
    /// Time of that check.
    pub whole_time: Duration,
}

impl Plan {
    /// Pivots of all tests.
    pub fn pivots(&self) -> usize {
        self.records.iter().map(|record| record.outcome.pivots).sum()
    }

    /// Time spent in tests, their set-up included.
    pub fn test_time(&self) -> Duration {
        self.setup + self.records.iter().map(|record| record.time).sum::<Duration>()
    }
}

/// Plans with one of this crate's tests.
///
/// # Errors
/// [`PlanError`] for an invalid scene or a test without an answer.
pub fn plan(scene: &Scene, test: Test, limits: Limits, monitor: &mut dyn Monitor) -> Result<Plan, PlanError> {
    let start = Instant::now();
    let assembly = Assembly::new(scene)?;
    let setup = Instant::now();
    let mut test: Box<dyn StabilityTest + '_> = match test {
        Test::Lcp => Box::new(FromScratch::new(&assembly)),
        Test::Reuse => Box::new(Reuse::new(&assembly)),
        Test::ReuseDantzig => Box::new(ReuseDantzig::new(&assembly)),
    };
    let setup = setup.elapsed();
    let mut plan = plan_with(&assembly, test.as_mut(), limits, monitor)?;
    plan.setup = setup;
    plan.total = start.elapsed();
    Ok(plan)
}

/// Plans with any stability test.
///
/// # Errors
/// [`PlanError`] if the test gives no answer.
pub fn plan_with(
    assembly: &Assembly,
    test: &mut dyn StabilityTest,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    let start = Instant::now();
    let whole = check_blocks(assembly, &BlockSet::full(assembly.blocks()));
    let whole_time = start.elapsed();
    let mut search = Search::new(assembly, limits, start);
    let outcome = if whole.stable { search.run(test, monitor)? } else { Outcome::WholeFalls };
    let bodies = |blocks: &[usize]| -> Vec<usize> { blocks.iter().map(|&b| assembly.body_index(b)).collect() };
    let exhausted = matches!(outcome, Outcome::NoOrder);
    Ok(Plan {
        outcome,
        order: if outcome == Outcome::Found { bodies(&search.best).into_iter().rev().collect() } else { Vec::new() },
        reached: bodies(&search.best),
        falls_next: if exhausted { bodies(&search.blocked(&search.best)) } else { Vec::new() },
        records: search.records,
        setup: Duration::ZERO,
        total: start.elapsed(),
        whole,
        whole_time,
    })
}

/// A sub-assembly on the current path: the block that made it, and where its list of candidates has got to.
struct Level {
    next_candidate: usize,
}

struct Search<'a> {
    assembly: &'a Assembly,
    limits: Limits,
    start: Instant,
    /// Blocks from the supports upward: the order in which they are tried.
    upward: Vec<usize>,
    neighbours: Vec<Vec<usize>>,
    on_support: Vec<bool>,
    /// Sub-assemblies tested before, standing or not.
    visited: HashSet<BlockSet>,
    current: BlockSet,
    placed: Vec<usize>,
    best: Vec<usize>,
    records: Vec<TestRecord>,
}

impl<'a> Search<'a> {
    fn new(assembly: &'a Assembly, limits: Limits, start: Instant) -> Self {
        let blocks = assembly.blocks();
        let mut neighbours = vec![Vec::new(); blocks];
        let mut on_support = vec![false; blocks];
        for generator in assembly.generators() {
            match generator.wrenches[..] {
                [one] => on_support[one.block] = true,
                [a, b] => {
                    neighbours[a.block].push(b.block);
                    neighbours[b.block].push(a.block);
                }
                _ => {}
            }
        }
        for list in &mut neighbours {
            list.sort_unstable();
            list.dedup();
        }
        Self {
            assembly,
            limits,
            start,
            upward: assembly.upward(),
            neighbours,
            on_support,
            visited: HashSet::new(),
            current: BlockSet::empty(blocks),
            placed: Vec::new(),
            best: Vec::new(),
            records: Vec::new(),
        }
    }

    /// Grows the current sub-assembly by the first candidate that stands, and steps back where none does.
    fn run(&mut self, test: &mut dyn StabilityTest, monitor: &mut dyn Monitor) -> Result<Outcome, PlanError> {
        let blocks = self.assembly.blocks();
        let mut path = vec![Level { next_candidate: 0 }];
        while let Some(level) = path.last_mut() {
            if self.placed.len() == blocks {
                return Ok(Outcome::Found);
            }
            let Some(added) = self.next_candidate(level) else {
                path.pop();
                if let Some(last) = self.placed.pop() {
                    self.current.remove(last);
                    test.backtrack();
                }
                continue;
            };
            self.current.insert(added);
            let stands = if self.placed.len() + 1 == blocks {
                true // the complete assembly, checked first
            } else if !self.visited.insert(self.current.clone()) {
                false // tested before: its answer, and all that follows from it, is known
            } else {
                let progress = Progress { tests: self.records.len(), placed: self.placed.len(), blocks };
                if let Some(outcome) = self.spent(monitor, progress) {
                    return Ok(outcome);
                }
                let stands = self.record(test, added)?;
                if stands {
                    test.descend();
                }
                stands
            };
            if stands {
                self.placed.push(added);
                if self.placed.len() > self.best.len() {
                    self.best.clone_from(&self.placed);
                }
                path.push(Level { next_candidate: 0 });
            } else {
                self.current.remove(added);
            }
        }
        Ok(Outcome::NoOrder)
    }

    fn record(&mut self, test: &mut dyn StabilityTest, added: usize) -> Result<bool, PlanError> {
        let begin = Instant::now();
        let outcome = test.test(&self.current, added)?;
        let time = begin.elapsed();
        self.records.push(TestRecord { size: self.placed.len() + 1, outcome, time });
        Ok(outcome.stands)
    }

    fn spent(&self, monitor: &mut dyn Monitor, progress: Progress) -> Option<Outcome> {
        if self.limits.tests.is_some_and(|limit| progress.tests >= limit) {
            Some(Outcome::TestLimit)
        } else if self.limits.time.is_some_and(|limit| self.start.elapsed() >= limit) {
            Some(Outcome::TimeLimit)
        } else {
            (!monitor.go_on(progress)).then_some(Outcome::Interrupted)
        }
    }

    /// The next block, from the supports upward, that touches the current sub-assembly or a fixed body. A block
    /// that touches neither falls freely, so its test would be a waste.
    fn next_candidate(&self, level: &mut Level) -> Option<usize> {
        while let Some(&block) = self.upward.get(level.next_candidate) {
            level.next_candidate += 1;
            if !self.current.contains(block) && self.touches(block, &self.current) {
                return Some(block);
            }
        }
        None
    }

    fn touches(&self, block: usize, set: &BlockSet) -> bool {
        self.on_support[block] || self.neighbours[block].iter().any(|&other| set.contains(other))
    }

    /// Blocks that touch a sub-assembly without being in it.
    fn blocked(&self, placed: &[usize]) -> Vec<usize> {
        let mut set = BlockSet::empty(self.assembly.blocks());
        placed.iter().for_each(|&block| set.insert(block));
        self.upward.iter().copied().filter(|&block| !set.contains(block) && self.touches(block, &set)).collect()
    }
}
