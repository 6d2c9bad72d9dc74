//! Sub-assemblies as sets of movable blocks.

use serde::{Deserialize, Serialize};

/// A set of movable blocks, by their index among the movable ones.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub struct BlockSet {
    words: Vec<u64>,
}

impl BlockSet {
    /// The empty set within `blocks` blocks.
    pub fn empty(blocks: usize) -> Self {
        Self { words: vec![0; blocks.div_ceil(64)] }
    }

    /// All of `blocks` blocks.
    pub fn full(blocks: usize) -> Self {
        let mut set = Self::empty(blocks);
        (0..blocks).for_each(|block| set.insert(block));
        set
    }

    /// Whether the set holds a block.
    pub fn contains(&self, block: usize) -> bool {
        self.words[block / 64] >> (block % 64) & 1 == 1
    }

    /// Adds a block.
    pub fn insert(&mut self, block: usize) {
        self.words[block / 64] |= 1 << (block % 64);
    }

    /// Removes a block.
    pub fn remove(&mut self, block: usize) {
        self.words[block / 64] &= !(1 << (block % 64));
    }

    /// Whether it can be a set within so many blocks.
    pub fn fits(&self, blocks: usize) -> bool {
        self.words.len() == blocks.div_ceil(64) && self.iter().all(|block| block < blocks)
    }

    /// Adds every block of another set.
    pub fn union_with(&mut self, other: &Self) {
        self.words.iter_mut().zip(&other.words).for_each(|(word, other)| *word |= other);
    }

    /// Number of blocks in the set.
    pub fn len(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Whether the set has no block.
    pub fn is_empty(&self) -> bool {
        self.words.iter().all(|&word| word == 0)
    }

    /// The blocks, ascending.
    pub fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.words.iter().enumerate().flat_map(|(k, &word)| {
            let mut rest = word;
            std::iter::from_fn(move || {
                let bit = (rest != 0).then(|| rest.trailing_zeros() as usize)?;
                rest &= rest - 1;
                Some(64 * k + bit)
            })
        })
    }
}
