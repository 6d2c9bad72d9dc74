//! Loops over small blocks, compiled for what the machine has.

/// Does work on registers as wide as the machine's: found when it runs, so that one wheel fits all. No product and sum is joined to one
/// operation, so that every number is the same on all machines.
///
/// `work` has to be inlined, with all that it calls: a closure marked `#[inline(always)]`.
#[inline(always)]
pub(crate) fn wide<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}
