//! Depth-first search of the disassembly graph.

use super::dead_end::dead_end;
use super::learned::{Bounds, Learned};
use super::memory::{Back, Memory, Place};
use super::outcome::{Limits, Monitor, Outcome, Plan, Progress, Stage, TestRecord};
use super::stability::{FromScratch, PlanError, Reuse, ReuseDantzig, StabilityTest, Test};
use super::touching::Touching;
use super::visited::Visited;
use crate::{
    check::{Verdict, check_blocks_while},
    formulate::{Assembly, BlockSet},
    scene::Scene,
};
use std::time::{Duration, Instant};

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
    let mut clock = Clock { limits, start: Instant::now(), monitor };
    let whole = check_whole(assembly, &mut clock);
    let whole_time = clock.start.elapsed();
    let touching = Touching::new(assembly);
    let mut memory: Box<dyn Memory + '_> = match limits.shortcuts && test.explains() {
        true => Box::new(Learned::new(&touching, Bounds::default())),
        false => Box::new(Visited::default()),
    };
    let mut search = Search::new(&touching, memory.as_mut());
    let outcome = match &whole {
        Err(stopped) => *stopped,
        Ok(whole) if !whole.stable => Outcome::WholeFalls,
        Ok(_) => match search.run(test, &mut clock) {
            Err(PlanError::Interrupted) => Outcome::Interrupted,
            ended => ended?,
        },
    };
    let Search { best: mut reached, records, .. } = search;
    let falls_next = match outcome {
        Outcome::NoOrder => dead_end(assembly, &touching, &mut reached)?,
        _ => Vec::new(),
    };
    let bodies = |blocks: &[usize]| -> Vec<usize> { blocks.iter().map(|&b| assembly.body_index(b)).collect() };
    Ok(Plan {
        outcome,
        order: if outcome == Outcome::Found { bodies(&reached).into_iter().rev().collect() } else { Vec::new() },
        reached: bodies(&reached),
        falls_next: bodies(&falls_next),
        records,
        shortcuts: memory.shortcuts(),
        setup: Duration::ZERO,
        total: clock.start.elapsed(),
        whole: whole.ok(),
        whole_time,
    })
}

/// The verdict on the complete assembly, or why it was not waited for.
fn check_whole(assembly: &Assembly, clock: &mut Clock<'_>) -> Result<Verdict, Outcome> {
    let blocks = assembly.blocks();
    let mut stopped = Outcome::Interrupted;
    let mut go_on = |placed| match clock.stops(Progress { stage: Stage::Whole, tests: 0, placed, blocks }) {
        None => true,
        Some(outcome) => {
            stopped = outcome;
            false
        }
    };
    check_blocks_while(assembly, &BlockSet::full(blocks), &mut go_on).ok_or(stopped)
}

/// Says when a search has to end.
pub(super) struct Clock<'a> {
    pub limits: Limits,
    pub start: Instant,
    pub monitor: &'a mut dyn Monitor,
}

impl Clock<'_> {
    fn stops(&mut self, progress: Progress) -> Option<Outcome> {
        if progress.stage == Stage::Search && self.limits.tests.is_some_and(|limit| progress.tests >= limit) {
            Some(Outcome::TestLimit)
        } else if self.limits.time.is_some_and(|limit| self.start.elapsed() >= limit) {
            Some(Outcome::TimeLimit)
        } else {
            (!self.monitor.go_on(progress)).then_some(Outcome::Interrupted)
        }
    }
}

/// A search under way.
pub(super) struct Search<'a> {
    touching: &'a Touching,
    memory: &'a mut dyn Memory,
    current: BlockSet,
    placed: Vec<usize>,
    /// Of each placed block, in `placed`.
    position: Vec<usize>,
    /// How far each sub-assembly on the way has got with its candidates: a place in the upward order.
    tried: Vec<usize>,
    best: Vec<usize>,
    records: Vec<TestRecord>,
}

impl<'a> Search<'a> {
    pub fn new(touching: &'a Touching, memory: &'a mut dyn Memory) -> Self {
        Self {
            touching,
            memory,
            current: BlockSet::empty(touching.blocks()),
            placed: Vec::new(),
            position: vec![0; touching.blocks()],
            tried: vec![0],
            best: Vec::new(),
            records: Vec::new(),
        }
    }

    /// Grows the current sub-assembly by the first candidate that stands, and steps back where none does.
    pub fn run(&mut self, test: &mut dyn StabilityTest, clock: &mut Clock<'_>) -> Result<Outcome, PlanError> {
        let blocks = self.touching.blocks();
        while self.placed.len() < blocks {
            let Some(added) = self.next_candidate() else {
                if self.step_back(None, test) {
                    continue;
                }
                return Ok(Outcome::NoOrder);
            };
            self.current.insert(added);
            let last = self.placed.len() + 1 == blocks; // the complete assembly, checked first
            let known = !last && self.knows(added);
            if !last && !known {
                let (tests, placed) = (self.records.len(), self.placed.len());
                if let Some(outcome) = clock.stops(Progress { stage: Stage::Search, tests, placed, blocks }) {
                    return Ok(outcome);
                }
            }
            if last || !known && self.stands(test, added)? {
                self.descend(added);
                continue;
            }
            self.current.remove(added);
            if !self.step_back(Some(added), test) {
                return Ok(Outcome::NoOrder);
            }
        }
        Ok(Outcome::Found)
    }

    /// The current sub-assembly's blocks, as they were put up.
    #[cfg(test)]
    pub fn placed(&self) -> &[usize] {
        &self.placed
    }

    /// Tests made.
    #[cfg(test)]
    pub fn tests(&self) -> usize {
        self.records.len()
    }

    /// The next block from the supports upward that can be put on the current sub-assembly.
    fn next_candidate(&mut self) -> Option<usize> {
        let tried = self.tried.last_mut()?;
        let (place, block) = self.touching.candidate(&self.current, *tried)?;
        *tried = place + 1;
        Some(block)
    }

    /// Whether the current sub-assembly, which holds `added`, need not be tested.
    fn knows(&mut self, added: usize) -> bool {
        let place = Place { placed: &self.placed, position: &self.position, current: &self.current };
        self.memory.knows(&place, added)
    }

    /// Tests the current sub-assembly, which holds `added`.
    fn stands(&mut self, test: &mut dyn StabilityTest, added: usize) -> Result<bool, PlanError> {
        let begin = Instant::now();
        let outcome = test.test(&self.current, added)?;
        let time = begin.elapsed();
        self.records.push(TestRecord { size: self.placed.len() + 1, outcome, time });
        let place = Place { placed: &self.placed, position: &self.position, current: &self.current };
        if outcome.stands {
            test.descend();
            self.memory.stood(&place);
        } else {
            self.memory.fell(&place, added, test.collapse());
        }
        Ok(outcome.stands)
    }

    fn descend(&mut self, added: usize) {
        self.position[added] = self.placed.len();
        self.placed.push(added);
        self.tried.push(0);
        if self.placed.len() > self.best.len() {
            self.best.clone_from(&self.placed);
        }
    }

    /// Steps back as far as the memory says, after `failed` did or after all candidates did. False if nothing is left.
    fn step_back(&mut self, mut failed: Option<usize>, test: &mut dyn StabilityTest) -> bool {
        loop {
            let place = Place { placed: &self.placed, position: &self.position, current: &self.current };
            let keep = match self.memory.back(&place, failed) {
                None => return true,
                Some(Back::NoOrder) => return false,
                Some(Back::To(keep)) => keep,
            };
            failed = Some(self.placed[keep]);
            for block in self.placed.drain(keep..) {
                self.current.remove(block);
                test.backtrack();
            }
            self.tried.truncate(keep + 1);
        }
    }
}
