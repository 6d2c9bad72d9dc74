//! How far one gets where there is no order.

use super::stability::{PlanError, Reuse, StabilityTest};
use super::touching::Touching;
use crate::formulate::{Assembly, BlockSet};

/// Grows a sub-assembly as long as it stands, and says which blocks make it fall then. A search that knows that there is
/// no order need not have tried them all.
///
/// # Errors
/// [`PlanError::NoAnswer`] in numerical trouble.
pub(super) fn dead_end(
    assembly: &Assembly,
    touching: &Touching,
    reached: &mut Vec<usize>,
) -> Result<Vec<usize>, PlanError> {
    let mut test = Reuse::new(assembly);
    let mut current = BlockSet::empty(assembly.blocks());
    for &block in reached.iter() {
        current.insert(block);
        test.test(&current, block)?;
        test.descend();
    }
    let (mut falls, mut from) = (Vec::new(), 0);
    while let Some((place, block)) = touching.candidate(&current, from) {
        current.insert(block);
        if test.test(&current, block)?.stands {
            test.descend();
            reached.push(block);
            (falls, from) = (Vec::new(), 0);
        } else {
            current.remove(block);
            falls.push(block);
            from = place + 1;
        }
    }
    Ok(falls)
}
