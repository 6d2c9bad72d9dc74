//! Tests made ahead of the search, on several threads.
//!
//! A test from scratch depends on nothing but its sub-assembly. So while the search waits for one answer, other threads
//! test the sub-assemblies that come next if each stands, which most do. Answers are handed out in the order in which the
//! search asks, and those it never asks for are forgotten: the plan is the same on any number of threads.

use super::collapse::Collapse;
use super::stability::{FromScratch, PlanError, StabilityTest, TestOutcome};
use crate::formulate::{Assembly, BlockSet};
use rayon::{ThreadPool, ThreadPoolBuilder, prelude::*};
use std::collections::HashMap;

/// Fewest blocks in a sub-assembly whose test is worth a thread: smaller ones take microseconds.
const WORTH_A_THREAD: usize = 16;

type Answer = Result<(TestOutcome, Option<Collapse>), PlanError>;

/// [`FromScratch`] on several threads.
#[derive(Debug)]
pub struct Ahead<'a> {
    pool: ThreadPool,
    /// One a thread.
    tests: Vec<FromScratch<'a>>,
    answers: HashMap<BlockSet, Answer>,
    collapse: Option<Collapse>,
}

impl<'a> Ahead<'a> {
    /// Analyses the complete assembly. None if so many threads cannot be had.
    pub fn new(assembly: &'a Assembly, threads: usize) -> Option<Self> {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().ok()?;
        let tests = pool.install(|| (0..threads).into_par_iter().map(|_| FromScratch::new(assembly)).collect());
        Some(Self { pool, tests, answers: HashMap::new(), collapse: None })
    }
}

/// The test whose answer only depends on `blocks`, and the collapse if they fall.
fn answer(test: &mut FromScratch<'_>, blocks: &BlockSet) -> Answer {
    let outcome = test.test(blocks, 0)?;
    Ok((outcome, if outcome.stands { None } else { test.collapse() }))
}

impl StabilityTest for Ahead<'_> {
    fn foresee(&mut self, likely: &mut dyn Iterator<Item = BlockSet>) {
        let Some(next) = likely.next().filter(|next| !self.answers.contains_key(next)) else { return };
        // An answer that was not asked for: something fell, and more may fall here.
        let wasted = !self.answers.is_empty();
        self.answers.clear();
        if wasted || next.len() < WORTH_A_THREAD {
            return;
        }
        let sets: Vec<BlockSet> = [next].into_iter().chain(likely).take(self.tests.len()).collect();
        let tests = &mut self.tests;
        self.answers.extend(self.pool.install(|| {
            let each = tests.par_iter_mut().zip(sets).with_max_len(1);
            each.map(|(test, set)| (set.clone(), answer(test, &set))).collect::<Vec<_>>()
        }));
    }

    fn test(&mut self, blocks: &BlockSet, _added: usize) -> Result<TestOutcome, PlanError> {
        let (outcome, collapse) = match self.answers.remove(blocks) {
            Some(known) => known?,
            None => answer(&mut self.tests[0], blocks)?,
        };
        self.collapse = collapse;
        Ok(outcome)
    }

    fn explains(&self) -> bool {
        true
    }

    fn collapse(&self) -> Option<Collapse> {
        self.collapse.clone()
    }
}
