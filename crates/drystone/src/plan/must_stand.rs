//! The test of structures that must stand, not only can: [`crate::strong`].

use super::{
    Reuse,
    collapse::Collapse,
    stability::{PlanError, StabilityTest, TestOutcome},
};
use crate::{
    formulate::{Assembly, BlockSet},
    strong::{Budget, strong},
};

/// [`Reuse`], and of what can stand whether it must. A structure of which that is not decided within the default [`Budget`] counts
/// as borderline. Only what falls has a collapse: what need not stand may be made to by more blocks.
#[derive(Debug)]
pub(super) struct MustStand<'a> {
    assembly: &'a Assembly,
    can: Reuse<'a>,
    /// Whether the last structure can stand.
    could: bool,
}

impl<'a> MustStand<'a> {
    /// The current sub-assembly is empty.
    pub fn new(assembly: &'a Assembly) -> Self {
        Self { assembly, can: Reuse::new(assembly), could: true }
    }
}

impl StabilityTest for MustStand<'_> {
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        let can = self.can.test(blocks, added)?;
        self.could = can.stands;
        if !can.stands {
            return Ok(can);
        }
        let must = strong(self.assembly, blocks, Budget::default(), &mut |_| true).expect("nobody stops it").must_stand;
        Ok(TestOutcome { stands: must == Some(true), borderline: must.is_none(), ..can })
    }

    fn carry(&mut self, blocks: &BlockSet, added: usize) -> Result<usize, PlanError> {
        self.can.carry(blocks, added)
    }

    fn explains(&self) -> bool {
        true
    }

    fn collapse(&self) -> Option<Collapse> {
        if self.could { None } else { self.can.collapse() }
    }

    fn anew(&self) -> Option<Box<dyn StabilityTest + '_>> {
        Some(Box::new(MustStand::new(self.assembly)))
    }

    fn descend(&mut self) {
        self.can.descend();
    }

    fn backtrack(&mut self) {
        self.can.backtrack();
    }
}
