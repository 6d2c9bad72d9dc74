//! How far one gets where there is no order.

use super::clear_path::Paths;
use super::stability::{PlanError, StabilityTest};
use super::touching::Touching;
use crate::formulate::BlockSet;

/// Puts a sub-assembly up that was found to stand block by block, and returns it as a set.
///
/// # Errors
/// [`PlanError::NoAnswer`] in numerical trouble.
pub(super) fn put_up(
    test: &mut dyn StabilityTest,
    touching: &Touching,
    reached: &[usize],
) -> Result<BlockSet, PlanError> {
    let mut current = BlockSet::empty(touching.blocks());
    for &block in reached {
        current.insert(block);
        test.test(&current, block)?;
        test.descend();
    }
    Ok(current)
}

/// Grows a sub-assembly as long as it stands, and says which blocks make it fall then. A search that knows that there is
/// no order need not have tried them all. `test` is at the bare supports.
///
/// # Errors
/// [`PlanError::NoAnswer`] in numerical trouble.
pub(super) fn dead_end(
    test: &mut dyn StabilityTest,
    touching: &Touching,
    paths: Option<&Paths<'_>>,
    reached: &mut Vec<usize>,
) -> Result<Vec<usize>, PlanError> {
    let mut current = put_up(test, touching, reached)?;
    let (mut falls, mut from) = (Vec::new(), 0);
    while let Some((place, block)) = touching.candidate(&current, from) {
        if paths.is_some_and(|paths| !paths.can_leave(block, &current)) {
            from = place + 1;
            continue;
        }
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

/// Nothing of what was stopped: the answer stays, but what would be said about it.
pub(super) fn until_stopped<T: Default>(done: Result<T, PlanError>) -> Result<T, PlanError> {
    match done {
        Err(PlanError::Interrupted) => Ok(T::default()),
        done => done,
    }
}
