//! In which sequence a search tries the blocks that can come next.

use super::collapse::Collapse;
use super::touching::Touching;
use crate::formulate::BlockSet;

/// Hands out the blocks to try on each sub-assembly on the way of a search, every block once as long as it is on the way.
pub(super) trait Candidates {
    /// The next block to try on the current sub-assembly; None if all were.
    fn next(&mut self, current: &BlockSet) -> Option<usize>;

    /// The block handed out last was not tried after all; it is the next again.
    fn put_back(&mut self);

    /// The block handed out last has come to the current sub-assembly.
    fn came(&mut self, block: usize);

    /// All but the first `keep` blocks have gone; these.
    fn went(&mut self, keep: usize, gone: &[usize]);

    /// `fallen`, with the block handed out last, was tested and falls.
    fn fell(&mut self, _fallen: &BlockSet, _added: usize, _collapse: &Collapse) {}

    /// Told of every step back: whether to begin anew from the bare supports, with what is known by now.
    fn begins_anew(&mut self) -> bool {
        false
    }
}

/// The paper's sequence: from the supports upward.
#[derive(Debug)]
pub(super) struct Upward<'a> {
    touching: &'a Touching,
    /// How far each sub-assembly on the way has got: a place in the upward order.
    tried: Vec<usize>,
    /// For each of them: all blocks before this place are in it.
    full: Vec<usize>,
    /// Where the block handed out last is in that order.
    last: usize,
}

impl<'a> Upward<'a> {
    pub fn new(touching: &'a Touching) -> Self {
        Self { touching, tried: vec![0], full: vec![0], last: 0 }
    }
}

impl Candidates for Upward<'_> {
    fn next(&mut self, current: &BlockSet) -> Option<usize> {
        let (tried, full) = (self.tried.last_mut()?, self.full.last_mut()?);
        *full = self.touching.full(current, *full);
        let (place, block) = self.touching.candidate(current, *full.max(tried))?;
        (*tried, self.last) = (place + 1, place);
        Some(block)
    }

    fn put_back(&mut self) {
        self.tried.iter_mut().last().into_iter().for_each(|tried| *tried = self.last);
    }

    fn came(&mut self, _block: usize) {
        self.tried.push(0);
        self.full.extend(self.full.last().copied()); // what grows holds them too
    }

    fn went(&mut self, keep: usize, _gone: &[usize]) {
        self.tried.truncate(keep + 1);
        self.full.truncate(keep + 1);
    }
}
