//! What a search hands over to be told as a plan.

use super::outcome::{Outcome, TestRecord};
use super::search::Clock;
use crate::{
    check::{Verdict, check_blocks},
    formulate::{Assembly, BlockSet},
};
use drystone_lcp::Status;
use std::time::{Duration, Instant};

/// What a search has found, blocks by their numbers among the movable ones.
pub(super) struct Found {
    pub outcome: Outcome,
    pub reached: Vec<usize>,
    pub held: Vec<Vec<usize>>,
    pub falls_next: Vec<usize>,
    pub records: Vec<TestRecord>,
    pub shortcuts: usize,
    pub whole: Option<Verdict>,
    pub whole_time: Duration,
}

impl Found {
    /// Whether "falls" would be said of what is borderline, or of what the check has no answer for.
    pub fn is_undecided(&self) -> bool {
        match self.outcome {
            Outcome::WholeFalls => self.whole.as_ref().is_some_and(|whole| whole.status != Status::Solved),
            Outcome::NoOrder => self.records.iter().any(|record| record.outcome.borderline),
            _ => false,
        }
    }
}

/// What there is to say before a search, or without one: `outcome` if the complete assembly stands.
pub(super) fn check_alone(assembly: &Assembly, clock: &Clock<'_>, outcome: Outcome) -> Found {
    let begin = Instant::now();
    let whole = clock.interrupt.run(|| check_blocks(assembly, &BlockSet::full(assembly.blocks())));
    Found {
        outcome: match &whole {
            None => clock.stopped(),
            Some(whole) if whole.stable => outcome,
            Some(_) => Outcome::WholeFalls,
        },
        reached: Vec::new(),
        held: Vec::new(),
        falls_next: Vec::new(),
        records: Vec::new(),
        shortcuts: 0,
        whole,
        whole_time: begin.elapsed(),
    }
}
