//! The stability tests of one search, put to other tests: same sub-assemblies, same order, whatever they answer.

use super::stability::{PlanError, StabilityTest, TestOutcome};
use crate::formulate::BlockSet;
use std::time::{Duration, Instant};

/// What a search asked of its test.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// A sub-assembly was tested with a block put on, and this was the verdict.
    Test {
        /// The sub-assembly, with the block.
        blocks: BlockSet,
        /// The block.
        added: usize,
        /// Whether it stands.
        stands: bool,
    },
    /// The sub-assembly just tested became the current one.
    Descend,
    /// The search stepped back to the parent.
    Backtrack,
}

/// A test that writes down what it was asked; its verdicts are the reference of a [`replay`].
#[derive(Debug)]
pub struct Recorder<T> {
    test: T,
    steps: Vec<Step>,
}

impl<T: StabilityTest> Recorder<T> {
    /// Nothing is written down yet.
    pub fn new(test: T) -> Self {
        Self { test, steps: Vec::new() }
    }

    /// What was asked, in order.
    pub fn into_steps(self) -> Vec<Step> {
        self.steps
    }
}

impl<T: StabilityTest> StabilityTest for Recorder<T> {
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        let outcome = self.test.test(blocks, added)?;
        self.steps.push(Step::Test { blocks: blocks.clone(), added, stands: outcome.stands });
        Ok(outcome)
    }

    fn descend(&mut self) {
        self.test.descend();
        self.steps.push(Step::Descend);
    }

    fn backtrack(&mut self) {
        self.test.backtrack();
        self.steps.push(Step::Backtrack);
    }
}

/// What a test answered, and what it cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Replay {
    /// Tests asked.
    pub tests: usize,
    /// Pivots of those that were answered.
    pub pivots: usize,
    /// Verdicts unlike the reference's.
    pub wrong: usize,
    /// Tests without an answer.
    pub unanswered: usize,
    /// Wall time, steps between the tests included.
    pub time: Duration,
}

/// Puts recorded steps to a test that knows none yet. It is led along the reference's path, also where it disagrees or
/// gives no answer.
///
/// # Errors
/// What a test from outside this crate raises, and [`PlanError::Interrupted`].
pub fn replay(steps: &[Step], test: &mut dyn StabilityTest) -> Result<Replay, PlanError> {
    let mut replay = Replay::default();
    let begun = Instant::now();
    for step in steps {
        match step {
            Step::Descend => test.descend(),
            Step::Backtrack => test.backtrack(),
            Step::Test { blocks, added, stands } => {
                replay.tests += 1;
                match test.test(blocks, *added) {
                    Ok(outcome) => {
                        replay.pivots += outcome.pivots;
                        replay.wrong += usize::from(outcome.stands != *stands);
                    }
                    Err(PlanError::NoAnswer { .. }) => replay.unanswered += 1,
                    Err(error) => return Err(error),
                }
            }
        }
    }
    replay.time = begun.elapsed();
    Ok(replay)
}
