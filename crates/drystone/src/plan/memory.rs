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

impl Back {
    /// To before the last of these blocks.
    pub fn before_last_of(blame: &[usize], place: &Place<'_>) -> Self {
        place.placed.iter().rposition(|block| blame.contains(block)).map_or(Self::NoOrder, Self::To)
    }
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

    /// The same, and it falls whichever blocks are held: no hold stops all of these collapses.
    fn fell_however_held(&mut self, place: &Place<'_>, added: usize, collapses: &[Collapse]);

    /// `place.current` stands, and is where the search goes on.
    fn stood(&mut self, place: &Place<'_>);

    /// How far to step back where `added` cannot be put on `place.current`, nor ever, as long as all blocks of `blame` are
    /// there.
    fn blocked(&mut self, place: &Place<'_>, added: usize, blame: Vec<usize>) -> Back;

    /// Whether to step back from a sub-assembly on which `failed` cannot come next, or no candidate is left (None).
    fn back(&mut self, place: &Place<'_>, failed: Option<usize>) -> Option<Back>;

    /// The search begins anew from the bare supports, with all that is known.
    fn begin_anew(&mut self) {}

    /// Sub-assemblies called lost that were never tested.
    fn shortcuts(&self) -> usize {
        0
    }
}
