//! The paper's memory: no sub-assembly is tested twice.

use super::collapse::Collapse;
use super::memory::{Back, Memory, Place};
use crate::formulate::BlockSet;
use std::collections::HashSet;

/// Most sub-assemblies kept; later ones are tested again if the search comes back to them. A million sets of 1000 blocks
/// take 150 MB.
const MOST: usize = 1 << 20;

/// Every sub-assembly tested so far. One that the search comes back to fell, or led nowhere.
#[derive(Debug)]
pub(super) struct Visited {
    tested: HashSet<BlockSet>,
    most: usize,
}

impl Default for Visited {
    fn default() -> Self {
        Self::new(MOST)
    }
}

impl Visited {
    /// Keeps at most so many sub-assemblies.
    pub fn new(most: usize) -> Self {
        Self { tested: HashSet::new(), most }
    }

    /// Number of sub-assemblies kept.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.tested.len()
    }

    fn keep(&mut self, set: &BlockSet) {
        if self.tested.len() < self.most {
            self.tested.insert(set.clone());
        }
    }
}

impl Memory for Visited {
    fn is_lost(&self, set: &BlockSet, _added: usize) -> bool {
        self.tested.contains(set)
    }

    fn knows(&mut self, place: &Place<'_>, added: usize) -> bool {
        self.is_lost(place.current, added)
    }

    fn fell(&mut self, place: &Place<'_>, _added: usize, _collapse: Option<Collapse>) {
        self.keep(place.current);
    }

    fn fell_however_held(&mut self, place: &Place<'_>, _added: usize, _collapses: &[Collapse]) {
        self.keep(place.current);
    }

    fn stood(&mut self, place: &Place<'_>) {
        self.keep(place.current);
    }

    fn blocked(&mut self, place: &Place<'_>, _added: usize, blame: Vec<usize>) -> Back {
        Back::before_last_of(&blame, place)
    }

    /// One block at a time, once every candidate was tried.
    fn back(&mut self, place: &Place<'_>, failed: Option<usize>) -> Option<Back> {
        match (failed, place.placed.len().checked_sub(1)) {
            (Some(_), _) => None,
            (None, Some(keep)) => Some(Back::To(keep)),
            (None, None) => Some(Back::NoOrder),
        }
    }
}
