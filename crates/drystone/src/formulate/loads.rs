//! Blocks without their weight.
//!
//! A block can be there for its contacts alone. In the equilibrium `G f = -F`, `f >= 0` the load of each block has a row of
//! its own then, and a column that passes it on to the block's rows:
//!
//! ```text
//! G f + F / |F| t = 0,    t = |F|    on the rows of the block and on that of its load,    t >= 0
//! ```
//!
//! With the rows of the block alone, t and its column are absent and nothing has to be carried. So a load comes and goes as
//! blocks do, by rows, and the kept basis follows it.

use super::assembly::Assembly;
use drystone_lcp::cone::{Columns, ConeSolver};

impl Assembly {
    /// [`Self::equilibrium`] with the load of each block apart. The columns that pass them on come after the generators, the
    /// row of each load after those of the blocks. It has no axes of cones: they make what stands quick to find, and
    /// what falls slow (13 seconds instead of 2 for the collapses of 1000 random blocks with friction).
    pub fn equilibrium_with_loads(&self) -> ConeSolver {
        let (mut indptr, mut indices, mut data) = self.compressed(self.generators().iter());
        let (mut balance, mut units) = (vec![0.0; self.load_row(0)], self.balance_units());
        let mut own = self.own_loads();
        for block in 0..self.blocks() {
            let (applied, size) = (self.applied(block), self.load_size(block));
            for (row, load) in self.equilibrium_rows().of(block).iter().zip(applied).filter(|(_, load)| **load != 0.0) {
                indices.push(*row);
                data.push(load / size);
            }
            indices.push(self.load_row(block));
            data.push(1.0);
            indptr.push(indices.len());
            balance.push(size);
            let load = units[self.equilibrium_rows().of(block)[0]];
            units.push(load);
            own.push(own[self.equilibrium_rows().of(block)[0]]);
        }
        let columns = Columns::new(balance.len(), &indptr, &indices, &data)
            .expect("a validated scene has finite masses, positions and directions");
        ConeSolver::new(columns, &balance, &units)
            .expect("a validated scene has finite masses, positions and directions")
            .with_own_loads(own)
    }

    /// The row of [`Self::equilibrium_with_loads`] that is present while a block weighs something.
    pub fn load_row(&self, block: usize) -> usize {
        self.components().len() * self.blocks() + block
    }

    /// `|F|` of a block.
    fn load_size(&self, block: usize) -> f64 {
        self.applied(block).iter().map(|load| load * load).sum::<f64>().sqrt()
    }
}
