//! How a structure fell when the solver was last asked, and whether it still falls so.
//!
//! The solver's certificate is a virtual motion (`plan/collapse.rs`). By Lemma 1 there it carries over to every structure that
//! differs from the one that fell by blocks that came and touch none that moves, and by blocks that went and leave work to be
//! done. The motion stays in the solver: only the blocks that came and went are looked at.

use super::putting_up::neighbours;
use crate::formulate::{Assembly, BlockRows};
use drystone_lcp::cone::ConeSolver;

/// A collapse is carried over while at least this share of its work is left: far above the rounding in it.
const WORK_LEFT: f64 = 1e-3;

/// What is needed to read the certificate in the solver.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fall<'a> {
    pub solver: &'a ConeSolver,
    pub rows: &'a BlockRows,
    pub assembly: &'a Assembly,
}

impl Fall<'_> {
    /// Whether the structure falls in the same way when these blocks have come and gone.
    pub fn carries_over(&self, new: &[usize], gone: &[usize]) -> bool {
        if new.iter().any(|&block| self.touches_what_moves(block)) {
            return false;
        }
        let lost: f64 = gone.iter().map(|&block| self.work(block)).sum();
        let all = self.solver.certificate_power();
        all - lost > WORK_LEFT * all
    }

    fn touches_what_moves(&self, block: usize) -> bool {
        let moves = |other: usize| self.rows.of(other).iter().any(|&row| self.solver.multiplier(row) != 0.0);
        neighbours(self.assembly, block).flatten().any(moves)
    }

    /// The work that a block's load does: `y' h` of its rows, with `h = -F`.
    fn work(&self, block: usize) -> f64 {
        let loads = self.rows.of(block).iter().zip(self.assembly.applied(block));
        loads.map(|(&row, load)| -self.solver.multiplier(row) * load).sum()
    }
}
