//! Blocks that are held: by a robot's hand, or by a scaffold.
//!
//! A hand can push, pull and turn its block in any way, so that whatever acts on the block is balanced: for the others it
//! is a fixed body. In the equilibrium `G f = -F`, `f >= 0` a hand is two columns for each row of its block, one a unit
//! and one minus a unit. They take part while the hand's own row is present, in which they have zeros: nothing has to
//! balance there. So a hold comes and goes as blocks do, by rows, and the kept basis follows it.

use super::assembly::Assembly;
use drystone_lcp::cone::{Columns, ConeSolver};

impl Assembly {
    /// [`Self::equilibrium`] with a hand for every block, none of which holds yet. Its columns come after the others, the
    /// row of each hand after those of the blocks.
    pub fn equilibrium_with_hands(&self) -> ConeSolver {
        let edges = self.generators().len();
        let (mut indptr, mut indices, mut data) = self.compressed(self.generators().iter().chain(&self.axes));
        let axes = edges..indptr.len() - 1;
        let rows = self.equilibrium_rows();
        for block in 0..self.blocks() {
            for &row in rows.of(block) {
                for sign in [1.0, -1.0] {
                    indices.extend([row, self.hand_row(block)]);
                    data.extend([sign, 0.0]);
                    indptr.push(indices.len());
                }
            }
        }
        let rows = self.hand_row(self.blocks());
        let columns = Columns::new(rows, &indptr, &indices, &data)
            .expect("a validated scene has finite masses, positions and directions");
        let (mut balance, mut units) = (self.balance(), self.balance_units());
        balance.resize(rows, 0.0);
        units.resize(rows, 1.0);
        let mut own = self.own_loads();
        own.resize(rows, 1.0);
        let mut solver = ConeSolver::new(columns, &balance, &units)
            .expect("a validated scene has finite masses, positions and directions")
            .with_own_loads(own);
        solver.prefer(axes);
        solver
    }

    /// The row of [`Self::equilibrium_with_hands`] that is present while a block is held.
    pub fn hand_row(&self, block: usize) -> usize {
        self.components().len() * self.blocks() + block
    }
}
