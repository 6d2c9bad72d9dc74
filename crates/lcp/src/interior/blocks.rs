//! Where a matrix of small dense blocks has some, and what is done with these.

/// A block by its columns.
pub(super) type Block<const B: usize> = [[f64; B]; B];

/// The blocks of a symmetric matrix below its diagonal: for each column its rows, ascending.
#[derive(Debug, Clone)]
pub(super) struct Pattern {
    starts: Vec<usize>,
    rows: Vec<u32>,
}

impl Default for Pattern {
    fn default() -> Self {
        Self { starts: vec![0], rows: Vec::new() }
    }
}

impl Pattern {
    /// Another column.
    pub fn push(&mut self, rows: &[u32]) {
        self.rows.extend_from_slice(rows);
        self.starts.push(self.rows.len());
    }

    pub fn columns(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Number of pairs of different blocks of a column, over all columns.
    pub fn products(&self) -> usize {
        (0..self.columns()).map(|column| self.rows(column).len()).map(|rows| rows * rows.saturating_sub(1) / 2).sum()
    }

    /// The first block of a column.
    pub fn start(&self, column: usize) -> usize {
        self.starts[column]
    }

    /// The blocks of a column.
    pub fn range(&self, column: usize) -> std::ops::Range<usize> {
        self.starts[column]..self.starts[column + 1]
    }

    pub fn rows(&self, column: usize) -> &[u32] {
        &self.rows[self.range(column)]
    }
}

/// Takes a product `a b'` from a block.
#[inline]
pub(super) fn minus_product<const B: usize>(from: &mut Block<B>, a: &Block<B>, b: &Block<B>) {
    for column in 0..B {
        let mut sum = from[column];
        for k in 0..B {
            let factor = b[k][column];
            (0..B).for_each(|row| sum[row] -= a[k][row] * factor);
        }
        from[column] = sum;
    }
}

/// Takes `a a'` from the lower triangle of a block.
#[inline]
pub(super) fn minus_square<const B: usize>(from: &mut Block<B>, a: &Block<B>) {
    for a in a {
        for column in 0..B {
            let factor = a[column];
            (column..B).for_each(|row| from[column][row] -= a[row] * factor);
        }
    }
}
