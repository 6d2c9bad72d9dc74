//! How a structure fell when it was last asked about, and whether it still falls so.
//!
//! A certificate is a virtual motion (`plan/collapse.rs`). By Lemma 1 there it carries over to every structure that
//! differs from the one that fell by blocks that came and touch none that moves, and by blocks that went and leave work to be
//! done. Only the blocks that came and went are looked at.

use super::putting_up::neighbours;
use crate::formulate::{Assembly, BlockRows};
use drystone_lcp::cone::ConeSolver;

/// A collapse is carried over while at least this share of its work is left: far above the rounding in it.
const WORK_LEFT: f64 = 1e-3;

/// A motion in which the loads do work.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fall<'a> {
    pub assembly: &'a Assembly,
    pub motion: Motion<'a>,
}

/// Where it is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Motion<'a> {
    /// In the solver, whose multipliers it is.
    Certified(&'a ConeSolver, &'a BlockRows),
    /// The blocks that move, ascending, each with the work of its load.
    Found(&'a [(usize, f64)]),
}

impl Fall<'_> {
    /// Whether the structure falls in the same way when these blocks have come and gone.
    pub fn carries_over(&self, new: &[usize], gone: &[usize]) -> bool {
        if new.iter().any(|&block| self.touches_what_moves(block)) {
            return false;
        }
        let lost: f64 = gone.iter().map(|&block| self.work(block)).sum();
        let all = self.power();
        all - lost > WORK_LEFT * all
    }

    fn touches_what_moves(&self, block: usize) -> bool {
        neighbours(self.assembly, block).flatten().any(|other| self.moves(other))
    }

    fn moves(&self, block: usize) -> bool {
        match self.motion {
            Motion::Certified(solver, rows) => rows.of(block).iter().any(|&row| solver.multiplier(row) != 0.0),
            Motion::Found(moving) => moving.binary_search_by_key(&block, |moving| moving.0).is_ok(),
        }
    }

    /// The work that a block's load does.
    fn work(&self, block: usize) -> f64 {
        match self.motion {
            // `y' h` of its rows, with h = -F
            Motion::Certified(solver, rows) => {
                let loads = rows.of(block).iter().zip(self.assembly.applied(block));
                loads.map(|(&row, load)| -solver.multiplier(row) * load).sum()
            }
            Motion::Found(moving) => {
                moving.binary_search_by_key(&block, |moving| moving.0).map_or(0.0, |place| moving[place].1)
            }
        }
    }

    /// The work that all loads did.
    fn power(&self) -> f64 {
        match self.motion {
            Motion::Certified(solver, _) => solver.certificate_power(),
            Motion::Found(moving) => moving.iter().map(|(_, work)| work).sum(),
        }
    }
}
