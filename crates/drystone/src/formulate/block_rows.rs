//! Which rows of the equilibrium problem are a block's.

/// Rows of [`Assembly::equilibrium`](super::Assembly::equilibrium) by block.
#[derive(Debug, Clone)]
pub struct BlockRows {
    components: usize,
    all: Vec<usize>,
}

impl BlockRows {
    /// Rows of so many blocks with these [`Components`](super::Components).
    pub fn of_components(components: &[usize], blocks: usize) -> Self {
        Self { components: components.len(), all: (0..components.len() * blocks).collect() }
    }

    /// Number of movable blocks.
    pub fn blocks(&self) -> usize {
        self.all.len() / self.components
    }

    /// Rows of a movable block: the components of its wrench.
    pub fn of(&self, block: usize) -> &[usize] {
        &self.all[self.components * block..self.components * (block + 1)]
    }

    /// The movable block that a row belongs to.
    pub fn block(&self, row: usize) -> usize {
        row / self.components
    }
}
