//! Tests made ahead of the search, on several threads.
//!
//! A test from scratch depends on nothing but its sub-assembly. So while the search waits for one answer, other threads
//! test the sub-assemblies that come next if each stands, which most do. Answers are handed out in the order in which the
//! search asks, and those it never asks for are forgotten: the plan is the same on any number of threads.

use super::collapse::Collapse;
use super::stability::{FromScratch, PlanError, StabilityTest, TestOutcome};
use super::whole::Stop;
use crate::formulate::{Assembly, BlockSet};
use crate::interrupt::{Interrupt, poll_now};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::{
    collections::HashMap,
    sync::mpsc::{RecvTimeoutError, channel},
    time::Duration,
};

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
        let tests = on_threads(&pool, vec![assembly; threads], FromScratch::new);
        Some(Self { pool, tests, answers: HashMap::new(), collapse: None })
    }
}

/// Time between two looks whether to stop while only other threads work.
const PERIOD: Duration = Duration::from_millis(10);

/// Does each piece of work on a thread of the pool; the answers are in the order of what was given. May be stopped, like any work
/// of the caller's.
fn on_threads<T: Send, A: Send>(pool: &ThreadPool, given: Vec<T>, work: impl Fn(T) -> A + Sync) -> Vec<A> {
    let stop = Stop::default();
    let (interrupt, work, (tell, told)) = (stop.interrupt(), &work, channel());
    let mut answers: Vec<Option<A>> = given.iter().map(|_| None).collect();
    pool.in_place_scope(|scope| {
        for (k, one) in given.into_iter().enumerate() {
            let (interrupt, tell) = (interrupt.clone(), tell.clone());
            scope.spawn(move |_| {
                if let Some(answer) = interrupt.run(|| work(one)) {
                    tell.send((k, answer)).ok(); // it is waited for until all have ended
                }
            });
        }
        drop(tell);
        loop {
            match told.recv_timeout(PERIOD) {
                Ok((k, answer)) => answers[k] = Some(answer),
                Err(RecvTimeoutError::Disconnected) => break,
                Err(RecvTimeoutError::Timeout) if Interrupt::current().stops() => stop.stop(),
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    });
    if answers.iter().any(Option::is_none) {
        poll_now();
    }
    answers.into_iter().map(|answer| answer.expect("nothing else stops them")).collect()
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
        let each: Vec<_> = self.tests.iter_mut().zip(sets).collect();
        self.answers.extend(on_threads(&self.pool, each, |(test, set)| {
            let answer = answer(test, &set);
            (set, answer)
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
