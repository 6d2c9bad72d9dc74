//! Depth-first search of the disassembly graph.

use super::candidates::Candidates;
use super::clear_path::Paths;
use super::memory::{Back, Memory, Place};
use super::outcome::{Limits, Monitor, Outcome, Progress, Stage, TestRecord};
use super::stability::{PlanError, StabilityTest};
use super::touching::Touching;
use crate::{formulate::BlockSet, interrupt::Interrupt};
use std::{
    iter::successors,
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

/// Sub-assemblies known to be lost between two looks at the clock: each may take as long as the memory is large.
const OFTEN: usize = 16;

/// Says when a search has to end.
pub(super) struct Clock<'a> {
    pub limits: Limits,
    pub start: Instant,
    pub monitor: &'a mut dyn Monitor,
    /// Stops a test, or other long work, when the time is over.
    pub interrupt: Interrupt,
    /// Set when a check beside the search has found that the complete assembly falls.
    pub whole_falls: &'a AtomicBool,
}

impl<'a> Clock<'a> {
    /// Begins now.
    pub fn new(limits: Limits, monitor: &'a mut dyn Monitor, whole_falls: &'a AtomicBool) -> Self {
        let start = Instant::now();
        Self { limits, start, monitor, interrupt: limits.interrupt(start), whole_falls }
    }

    /// Does some long work unless the time is over, or somebody stops it.
    pub fn run<T>(&self, work: impl FnOnce() -> Result<T, PlanError>) -> Result<T, PlanError> {
        self.interrupt.run(work).unwrap_or(Err(PlanError::Interrupted))
    }

    /// How a search ended in which some work was stopped.
    pub fn stopped(&self) -> Outcome {
        self.limits.stopped(self.start)
    }

    /// Why to stop, if there is a reason.
    pub fn stops(&mut self, progress: Progress) -> Option<Outcome> {
        if self.whole_falls.load(Ordering::Relaxed) {
            Some(Outcome::WholeFalls)
        } else if progress.stage == Stage::Search && self.limits.tests.is_some_and(|limit| progress.tests >= limit) {
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
    candidates: &'a mut dyn Candidates,
    /// How blocks leave, if that has to be along a straight line.
    paths: Option<&'a Paths<'a>>,
    current: BlockSet,
    placed: Vec<usize>,
    /// Of each placed block, in `placed`.
    position: Vec<usize>,
    pub best: Vec<usize>,
    pub records: Vec<TestRecord>,
}

impl<'a> Search<'a> {
    pub fn new(
        touching: &'a Touching,
        paths: Option<&'a Paths<'a>>,
        memory: &'a mut dyn Memory,
        candidates: &'a mut dyn Candidates,
    ) -> Self {
        Self {
            touching,
            memory,
            candidates,
            paths,
            current: BlockSet::empty(touching.blocks()),
            placed: Vec::new(),
            position: vec![0; touching.blocks()],
            best: Vec::new(),
            records: Vec::new(),
        }
    }

    /// Grows the current sub-assembly by the first candidate that stands, and steps back where none does. After
    /// [`Outcome::TestLimit`] it can go on.
    pub fn run(&mut self, test: &mut dyn StabilityTest, clock: &mut Clock<'_>) -> Result<Outcome, PlanError> {
        let ended = self.go_on(test, clock);
        self.keep_best();
        ended
    }

    fn go_on(&mut self, test: &mut dyn StabilityTest, clock: &mut Clock<'_>) -> Result<Outcome, PlanError> {
        let (blocks, mut shortcuts) = (self.touching.blocks(), 0);
        while self.placed.len() < blocks {
            let Some(added) = self.candidates.next(&self.current) else {
                if self.step_back(None, test) {
                    continue;
                }
                return Ok(Outcome::NoOrder);
            };
            let blame = |paths: &Paths<'_>| clock.run(|| Ok(paths.blame(added, &self.current, &self.position)));
            if let Some(blame) = self.paths.map(blame).transpose()?.flatten() {
                if !self.step_back_from_blocked(added, blame, test) {
                    return Ok(Outcome::NoOrder);
                }
                continue;
            }
            self.current.insert(added);
            let last = self.placed.len() + 1 == blocks; // the complete assembly, checked first
            let known = !last && self.knows(added);
            shortcuts += usize::from(known);
            if !last && (!known || shortcuts.is_multiple_of(OFTEN)) {
                let (tests, placed) = (self.records.len(), self.placed.len());
                match clock.stops(Progress { stage: Stage::Search, tests, placed, blocks }) {
                    // What is known needs no test.
                    None => {}
                    Some(Outcome::TestLimit) if known => {}
                    Some(outcome) => {
                        self.current.remove(added);
                        self.candidates.put_back();
                        return Ok(outcome);
                    }
                }
            }
            if last || !known && self.stands(test, clock, added)? {
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

    /// Whether the current sub-assembly, which holds `added`, need not be tested.
    fn knows(&mut self, added: usize) -> bool {
        let place = Place { placed: &self.placed, position: &self.position, current: &self.current };
        self.memory.knows(&place, added)
    }

    /// Tests the current sub-assembly, which holds `added`.
    fn stands(&mut self, test: &mut dyn StabilityTest, clock: &Clock<'_>, added: usize) -> Result<bool, PlanError> {
        let begin = Instant::now();
        let outcome = clock.run(|| {
            test.foresee(&mut self.likely());
            test.test(&self.current, added)
        })?;
        let time = begin.elapsed();
        self.records.push(TestRecord { size: self.placed.len() + 1, outcome, time });
        let place = Place { placed: &self.placed, position: &self.position, current: &self.current };
        if outcome.stands {
            test.descend();
            self.memory.stood(&place);
        } else if test.collapses_however_held().is_empty() {
            let collapse = if outcome.borderline { None } else { test.collapse() };
            collapse.iter().for_each(|collapse| self.candidates.fell(&self.current, added, collapse));
            self.memory.fell(&place, added, collapse);
        } else {
            self.memory.fell_however_held(&place, added, test.collapses_however_held());
        }
        Ok(outcome.stands)
    }

    /// The current sub-assembly, which holds the block being tried, and those asked about after it as long as each stands.
    fn likely(&self) -> impl Iterator<Item = BlockSet> {
        let next = |set: &BlockSet| {
            let mut from = 0;
            while let Some((place, block)) = self.touching.candidate(set, from) {
                let mut with = set.clone();
                with.insert(block);
                if !self.memory.is_lost(&with, block) {
                    return (with.len() < self.touching.blocks()).then_some(with);
                }
                from = place + 1;
            }
            None
        };
        successors(Some(self.current.clone()), next)
    }

    fn descend(&mut self, added: usize) {
        self.position[added] = self.placed.len();
        self.placed.push(added);
        self.candidates.came(added);
    }

    /// Before anything is taken off: a copy for each block that comes would take time with the square of the blocks.
    fn keep_best(&mut self) {
        if self.placed.len() > self.best.len() {
            self.best.clone_from(&self.placed);
        }
    }

    /// Steps back as far as the memory says, after `failed` did or after all candidates did. False if nothing is left.
    fn step_back(&mut self, mut failed: Option<usize>, test: &mut dyn StabilityTest) -> bool {
        let mut anew = false;
        loop {
            let place = Place { placed: &self.placed, position: &self.position, current: &self.current };
            let keep = match self.memory.back(&place, failed) {
                None => break,
                Some(Back::NoOrder) => return false,
                Some(Back::To(keep)) => keep,
            };
            failed = Some(self.retreat(keep, test));
            anew |= self.candidates.begins_anew();
        }
        if anew && !self.placed.is_empty() {
            self.retreat(0, test);
            self.memory.begin_anew();
        }
        true
    }

    /// Steps back to where some of the blocks that are in the way of `added` are gone.
    fn step_back_from_blocked(&mut self, added: usize, blame: Vec<usize>, test: &mut dyn StabilityTest) -> bool {
        let place = Place { placed: &self.placed, position: &self.position, current: &self.current };
        let Back::To(keep) = self.memory.blocked(&place, added, blame) else { return false };
        let failed = self.retreat(keep, test);
        self.step_back(Some(failed), test)
    }

    /// Takes off what is still there, so that the test is as it was before the search.
    pub fn take_down(&mut self, test: &mut dyn StabilityTest) {
        if !self.placed.is_empty() {
            self.retreat(0, test);
        }
    }

    /// Takes all but the first blocks off again, and says which of them was the first to come.
    fn retreat(&mut self, keep: usize, test: &mut dyn StabilityTest) -> usize {
        self.keep_best();
        let gone = self.placed.split_off(keep);
        for &block in &gone {
            self.current.remove(block);
            test.backtrack();
        }
        self.candidates.went(keep, &gone);
        gone[0]
    }
}
