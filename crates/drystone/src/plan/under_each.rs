//! The test of structures that have to stand under several loads, such as accelerations to all sides.

use super::{
    Reuse,
    collapse::Collapse,
    stability::{PlanError, StabilityTest, TestOutcome},
};
use crate::formulate::{Assembly, BlockSet};

/// [`Reuse`] under each of some loads: a structure stands if it does under all. A collapse is that under the first of them under
/// which it falls; since the loads of later structures are the same there, it answers for them, too.
#[derive(Debug)]
pub(super) struct UnderEach<'a> {
    assemblies: &'a [Assembly],
    tests: Vec<Reuse<'a>>,
    /// Under which the last structure fell.
    fell: Option<usize>,
}

impl<'a> UnderEach<'a> {
    /// Takes the same assembly under different loads; the current sub-assembly is empty.
    pub fn new(assemblies: &'a [Assembly]) -> Self {
        Self { assemblies, tests: assemblies.iter().map(Reuse::new).collect(), fell: None }
    }
}

impl StabilityTest for UnderEach<'_> {
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        let mut all = TestOutcome { stands: true, borderline: false, pivots: 0 };
        self.fell = None;
        for (k, test) in self.tests.iter_mut().enumerate() {
            let one = test.test(blocks, added)?;
            all = TestOutcome { pivots: all.pivots + one.pivots, ..one };
            if !one.stands {
                self.fell = Some(k);
                break;
            }
        }
        Ok(all)
    }

    fn carry(&mut self, blocks: &BlockSet, added: usize) -> Result<usize, PlanError> {
        self.tests.iter_mut().map(|test| test.carry(blocks, added)).sum()
    }

    fn explains(&self) -> bool {
        true
    }

    fn collapse(&self) -> Option<Collapse> {
        self.tests[self.fell?].collapse()
    }

    fn anew(&self) -> Option<Box<dyn StabilityTest + '_>> {
        Some(Box::new(UnderEach::new(self.assemblies)))
    }

    fn descend(&mut self) {
        self.tests.iter_mut().for_each(Reuse::descend);
    }

    fn backtrack(&mut self) {
        self.tests.iter_mut().for_each(Reuse::backtrack);
    }
}
