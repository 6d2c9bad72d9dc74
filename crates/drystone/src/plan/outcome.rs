//! What a search is told, and what it answers.

use super::{
    clear_path::{Blocked, ClearPath, Moves},
    stability::TestOutcome,
};
use crate::{check::Verdict, interrupt::Interrupt, threads::available};
use std::time::{Duration, Instant};

/// Budgets of a search, without which it goes on to the end, and how it goes about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most stability tests.
    pub tests: Option<usize>,
    /// Most wall time.
    pub time: Option<Duration>,
    /// Answer without a test what the collapses found by earlier tests already answer (Lemmas 1 and 2 in `plan/collapse.rs`
    /// and `plan/learned.rs`). The order found is the same, unless it takes more than 20,000 tests, or 20 a block: then a
    /// balanced search takes turns with the paper's (`plan/in_turn.rs`). The paper's planner does without.
    pub shortcuts: bool,
    /// Threads to use; None for those of the machine. The plan is the same on any number.
    pub threads: Option<usize>,
}

impl Default for Limits {
    fn default() -> Self {
        Self { tests: None, time: None, shortcuts: true, threads: None }
    }
}

impl Limits {
    /// Stops what began at `start` when its time is over.
    pub fn interrupt(&self, start: Instant) -> Interrupt {
        self.time.and_then(|time| start.checked_add(time)).map_or_else(Interrupt::default, Interrupt::at)
    }

    /// How something that began at `start` and was stopped has ended.
    pub(super) fn stopped(&self, start: Instant) -> Outcome {
        let over = self.time.is_some_and(|time| start.elapsed() >= time);
        if over { Outcome::TimeLimit } else { Outcome::Interrupted }
    }

    /// For what comes after something that began at `start`.
    pub fn after(self, start: Instant) -> Self {
        Self { time: self.time.map(|time| time.saturating_sub(start.elapsed())), ..self }
    }

    /// Threads to use.
    pub fn threads(&self) -> usize {
        self.threads.unwrap_or_else(available)
    }
}

/// Most blocks that may be held at a time.
pub const MOST_HANDS: usize = 8;

/// What an order has to fulfil beside standing, and what helps it to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Conditions {
    /// Most blocks that may be held at a time, up to [`MOST_HANDS`], beside the one that is put up or taken away. They are
    /// only held if there is no order without.
    pub hold: usize,
    /// Every block has to leave along a straight line, without passing through those that remain.
    pub clear_path: Option<ClearPath>,
    /// Every structure on the way, and the complete one, stands under any horizontal acceleration up to this one, over gravity; permanent
    /// loads stay as they are. In space it is up to 2 % more for some directions. Not with blocks held.
    pub margin: f64,
    /// Every structure on the way, and the complete one, must stand, not only can. Not with blocks held, nor with a margin.
    pub strong: bool,
}

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Outcome {
    /// `order` takes the whole assembly apart.
    Found,
    /// Every sub-assembly that can be reached was tested: no stable order exists.
    NoOrder,
    /// None was found, but a structure was given up without a proof that it falls. It is borderline; or, with blocks held, it
    /// stands under a hold that could not be had on the way to it, or there were too many to try.
    Undecided,
    /// Some blocks lock one another in, so that none of them can be the first to leave along a straight line.
    Locked,
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
            Self::Undecided => "undecided",
            Self::Locked => "locked",
            Self::WholeFalls => "whole_falls",
            Self::TestLimit => "test_limit",
            Self::TimeLimit => "time_limit",
            Self::Interrupted => "interrupted",
        }
    }
}

/// What is being done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stage {
    /// The complete assembly is checked, put up block by block.
    Whole,
    /// Sub-assemblies are tested.
    Search,
}

/// How far a search has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// Stability tests done.
    pub tests: usize,
    /// Blocks of the current sub-assembly.
    pub placed: usize,
    /// Movable blocks in all.
    pub blocks: usize,
}

/// Watches a search, and may stop it.
pub trait Monitor {
    /// Called before every test, and for every block, major cycle and iteration of the check of the whole. False stops the
    /// search.
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
    /// Movable blocks in the sub-assembly; those that leave together count as one.
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
    /// The largest standing sub-assembly reached, in the order in which it was put up. If there is no order, nothing can be
    /// added to it, and unless a search with shortcuts was long (more than 30 dead ends) none is larger.
    pub reached: Vec<usize>,
    /// For each structure on the way to `reached`, of one block, of two and so on: the blocks held.
    pub held: Vec<Vec<usize>>,
    /// For each block of `reached`, if it has to leave along straight lines: by which moves it does.
    pub moves: Vec<Moves>,
    /// Blocks that leave together, where some do: each group's come one after the other in `reached`.
    pub groups: Vec<Vec<usize>>,
    /// With straight lines asked for and no order: blocks that cannot be put on `reached`, and what is in the way; if the
    /// outcome is [`Outcome::Locked`], the blocks that lock one another in.
    pub blocked: Vec<Blocked>,
    /// Blocks that could be put on it next, none of which leaves it standing (empty if found or cut short).
    pub falls_next: Vec<usize>,
    /// Every stability test.
    pub records: Vec<TestRecord>,
    /// Sub-assemblies known to fall or to lead nowhere without a test, by collapses found before.
    pub shortcuts: usize,
    /// Time to analyse the complete assembly for the tests (counted as test time).
    pub setup: Duration,
    /// Time of everything, contacts included.
    pub total: Duration,
    /// Verdict on the complete assembly, reported apart from the tests. None if the search was stopped before there was one.
    pub whole: Option<Verdict>,
    /// Time of that check.
    pub whole_time: Duration,
}

impl Plan {
    /// What there is to say if the search was stopped before it began.
    pub fn stopped(outcome: Outcome, total: Duration) -> Self {
        Self {
            outcome,
            order: Vec::new(),
            reached: Vec::new(),
            held: Vec::new(),
            moves: Vec::new(),
            groups: Vec::new(),
            blocked: Vec::new(),
            falls_next: Vec::new(),
            records: Vec::new(),
            shortcuts: 0,
            setup: total,
            total,
            whole: None,
            whole_time: Duration::ZERO,
        }
    }

    /// Tests that were borderline: their structures were not taken for standing.
    pub fn borderline(&self) -> usize {
        self.records.iter().filter(|record| record.outcome.borderline).count()
    }

    /// Pivots of all tests.
    pub fn pivots(&self) -> usize {
        self.records.iter().map(|record| record.outcome.pivots).sum()
    }

    /// Time spent in tests, their set-up included.
    pub fn test_time(&self) -> Duration {
        self.setup + self.records.iter().map(|record| record.time).sum::<Duration>()
    }
}
