//! Depth-first search of the disassembly graph.

use super::collapse::KnownCollapse;
use super::stability::{FromScratch, PlanError, Reuse, ReuseDantzig, StabilityTest, Test, TestOutcome};
use crate::{
    check::{Verdict, check_blocks},
    formulate::{Assembly, BlockSet},
    scene::Scene,
};
use std::{
    collections::HashMap,
    time::{Duration, Instant},
};

/// Budgets of a search, without which it goes on to the end, and how it goes about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most stability tests.
    pub tests: Option<usize>,
    /// Most wall time.
    pub time: Option<Duration>,
    /// Answer without a test what the collapse found by an earlier test already answers (Lemmas 1 and 2 of
    /// [`Collapse`]). The order found is the same; the paper's planner does without.
    pub shortcuts: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Self { tests: None, time: None, shortcuts: true }
    }
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
    /// Sub-assemblies known to fall without a test, by a collapse found before.
    pub shortcuts: usize,
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
    let outcome = match whole.stable.then(|| search.run(test, monitor)) {
        None => Outcome::WholeFalls,
        Some(Err(PlanError::Interrupted)) => Outcome::Interrupted,
        Some(ended) => ended?,
    };
    let bodies = |blocks: &[usize]| -> Vec<usize> { blocks.iter().map(|&b| assembly.body_index(b)).collect() };
    let exhausted = matches!(outcome, Outcome::NoOrder);
    Ok(Plan {
        outcome,
        order: if outcome == Outcome::Found { bodies(&search.best).into_iter().rev().collect() } else { Vec::new() },
        reached: bodies(&search.best),
        falls_next: if exhausted { bodies(&search.blocked(&search.best)) } else { Vec::new() },
        records: search.records,
        shortcuts: search.shortcuts,
        setup: Duration::ZERO,
        total: start.elapsed(),
        whole,
        whole_time,
    })
}

/// A sub-assembly on the current path.
struct Level {
    /// Where its list of candidates has got to.
    next_candidate: usize,
    /// Its blocks to blame for the candidates that failed so far: the set of Lemma 2.
    conflict: BlockSet,
}

/// What is known of a sub-assembly visited before.
enum Visited {
    /// It falls, or its search is under way.
    Falls,
    /// It stands, and cannot be grown to the whole because of these blocks.
    Trapped(BlockSet),
}

struct Search<'a> {
    assembly: &'a Assembly,
    limits: Limits,
    start: Instant,
    /// Blocks from the supports upward: the order in which they are tried.
    upward: Vec<usize>,
    neighbours: Vec<Vec<usize>>,
    on_support: Vec<bool>,
    visited: HashMap<BlockSet, Visited>,
    /// The last collapse found with a block on top.
    collapses: Vec<Option<KnownCollapse>>,
    current: BlockSet,
    placed: Vec<usize>,
    best: Vec<usize>,
    records: Vec<TestRecord>,
    shortcuts: usize,
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
            visited: HashMap::new(),
            collapses: vec![None; blocks],
            shortcuts: 0,
            current: BlockSet::empty(blocks),
            placed: Vec::new(),
            best: Vec::new(),
            records: Vec::new(),
        }
    }

    /// Grows the current sub-assembly by the first candidate that stands, and steps back where none does.
    fn run(&mut self, test: &mut dyn StabilityTest, monitor: &mut dyn Monitor) -> Result<Outcome, PlanError> {
        let blocks = self.assembly.blocks();
        let mut path = vec![self.new_level()];
        while let Some(level) = path.last_mut() {
            if self.placed.len() == blocks {
                return Ok(Outcome::Found);
            }
            let Some(added) = self.next_candidate(level) else {
                self.step_back(&mut path, test);
                continue;
            };
            self.current.insert(added);
            let last = self.placed.len() + 1 == blocks; // the complete assembly, checked first
            let stands = last
                || !self.known_to_fail(added, &mut level.conflict) && {
                    let progress = Progress { tests: self.records.len(), placed: self.placed.len(), blocks };
                    if let Some(outcome) = self.spent(monitor, progress) {
                        return Ok(outcome);
                    }
                    self.stands(test, added, &mut level.conflict)?
                };
            if stands {
                self.placed.push(added);
                if self.placed.len() > self.best.len() {
                    self.best.clone_from(&self.placed);
                }
                path.push(self.new_level());
            } else {
                self.current.remove(added);
            }
        }
        Ok(Outcome::NoOrder)
    }

    fn new_level(&self) -> Level {
        Level { next_candidate: 0, conflict: BlockSet::empty(self.assembly.blocks()) }
    }

    /// Whether the current sub-assembly, which holds `added`, was found to fail before: tested, trapped, or falling by
    /// a known collapse. Who is to blame goes into the conflict of the sub-assembly without it.
    fn known_to_fail(&mut self, added: usize, conflict: &mut BlockSet) -> bool {
        if let Some(known) = self.collapses[added].as_ref().filter(|known| known.holds_for(&self.current)) {
            known.blame(&self.current, conflict);
            self.shortcuts += 1;
            return true;
        }
        match self.visited.get(&self.current) {
            None => return false,
            Some(Visited::Trapped(trap)) => conflict.union_with(trap),
            Some(Visited::Falls) => conflict.union_with(&self.current),
        }
        true
    }

    /// Tests the current sub-assembly, which holds `added`.
    fn stands(
        &mut self,
        test: &mut dyn StabilityTest,
        added: usize,
        conflict: &mut BlockSet,
    ) -> Result<bool, PlanError> {
        self.visited.insert(self.current.clone(), Visited::Falls);
        if self.record(test, added)? {
            test.descend();
            return Ok(true);
        }
        match self.limits.shortcuts.then(|| test.collapse()).flatten() {
            Some(collapse) => {
                let known = KnownCollapse::new(collapse, &self.current, &self.neighbours);
                known.blame(&self.current, conflict);
                self.collapses[added] = Some(known);
            }
            None => conflict.union_with(&self.current),
        }
        Ok(false)
    }

    /// No candidate is left: takes blocks off until one that is to blame is gone (Lemma 2).
    fn step_back(&mut self, path: &mut Vec<Level>, test: &mut dyn StabilityTest) {
        while let Some(Level { conflict, .. }) = path.pop()
            && let Some(last) = self.placed.pop()
        {
            self.visited.insert(self.current.clone(), Visited::Trapped(conflict.clone()));
            self.current.remove(last);
            test.backtrack();
            let Some(parent) = path.last_mut() else { return };
            if conflict.contains(last) {
                parent.conflict.union_with(&conflict);
                return;
            }
            parent.conflict = conflict; // without `last` it is trapped just the same
        }
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
