//! What a search remembers of the sub-assemblies that led nowhere.

use super::collapse::Collapse;
use crate::formulate::BlockSet;

/// Where a search stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place<'a> {
    /// The blocks of the current sub-assembly in the order in which they were put up.
    pub placed: &'a [usize],
    /// The place of each of them in `placed`.
    pub position: &'a [usize],
    /// The same as a set, together with the block being tried, if any.
    pub current: &'a BlockSet,
}

/// How far to step back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Back {
    /// So many blocks stay; the first that goes counts as failed on them.
    To(usize),
    /// The bare supports cannot be grown to the whole.
    NoOrder,
}

/// Knowledge of sub-assemblies that are *lost*: they fall, or cannot be grown to the whole. It must never call one lost
/// that is not, so that every memory leads a search to the same order.
pub(super) trait Memory {
    /// Whether a sub-assembly with `added` on top is known to be lost.
    fn is_lost(&self, set: &BlockSet, added: usize) -> bool;

    /// The same of `place.current`, where the search now is.
    fn knows(&mut self, place: &Place<'_>, added: usize) -> bool;

    /// `place.current`, which holds `added` on top, was tested and falls.
    fn fell(&mut self, place: &Place<'_>, added: usize, collapse: Option<Collapse>);

    /// `place.current` stands, and is where the search goes on.
    fn stood(&mut self, place: &Place<'_>);

    /// Whether to step back from a sub-assembly on which `failed` cannot come next, or no candidate is left (None).
    fn back(&mut self, place: &Place<'_>, failed: Option<usize>) -> Option<Back>;

    /// Sub-assemblies called lost that were never tested.
    fn shortcuts(&self) -> usize {
        0
    }
}
