//! Forces and accelerations of a solution of the complementarity problem.
//!
//! From the forces they are `M^-1 (F + G f)`. Where a load passes through a block 1e5 and more times lighter, rounding of the
//! forces alone would move it. There they are computed together with the forces of the contacts that stay closed, to 32
//! digits:
//!
//! ```text
//! M a - G f = F,    G' a = 0    on the generators with f > 0
//! ```
//!
//! This is the Karush-Kuhn-Tucker system of Gauss's principle on the active set; the columns of G in it are independent, for a
//! pivoting method keeps a basis.

use super::{Assembly, BlockSet, Components, generator::Generator};
use drystone_lcp::refined::Square;

/// The heaviest block over the lightest from which on forces alone do not tell the accelerations: 64-bit numbers leave 1e-11
/// of a block's own load then, a hundredth of what counts.
const WIDE: f64 = 1e5;

/// A force below zero by no more than this share of the weight of the lighter block it acts on is none.
const NONE: f64 = 1e-10;

/// Forces and the accelerations under them.
pub(crate) struct Moving {
    /// Of every generator, N.
    pub forces: Vec<f64>,
    /// Of the blocks of a sub-assembly, ascending.
    pub motion: Vec<(usize, Components)>,
}

impl Assembly {
    /// What a solution of the complementarity problem of a sub-assembly says; `f(j)` is the magnitude of generator j in it, N. Where
    /// 64-bit forces do not tell, both are refined on its active set.
    pub(crate) fn moving(&self, blocks: &BlockSet, f: impl Fn(usize) -> f64) -> Moving {
        let refined = if self.is_wide() { self.refined(blocks, &f) } else { None };
        refined.unwrap_or_else(|| self.moving_under(blocks, f))
    }

    /// The accelerations of the blocks of a sub-assembly under these forces, in 64 bits.
    pub(crate) fn moving_under(&self, blocks: &BlockSet, f: impl Fn(usize) -> f64) -> Moving {
        let forces: Vec<f64> = (0..self.generators().len()).map(f).collect();
        let motion = blocks.iter().map(|block| (block, self.acceleration(block, |j| forces[j]))).collect();
        Moving { forces, motion }
    }

    fn is_wide(&self) -> bool {
        let masses = || (0..self.blocks()).map(|block| self.inverse_mass(block)[0].recip());
        masses().fold(0.0, f64::max) > WIDE * masses().fold(f64::INFINITY, f64::min)
    }

    /// None if the system is too near to a singular one, or an active contact would pull: it is not closed then.
    fn refined(&self, blocks: &BlockSet, f: impl Fn(usize) -> f64) -> Option<Moving> {
        let size = self.components().len();
        let present: Vec<usize> = blocks.iter().collect();
        let row = |block: usize| present.binary_search(&block).ok().map(|place| size * place);
        let active: Vec<usize> = self.rows(blocks).into_iter().filter(|&j| f(j) > 0.0).collect();
        let first = size * present.len();
        let mut columns = vec![Vec::new(); first + active.len()];
        let mut right = vec![0.0; columns.len()];
        for &block in &present {
            let at = row(block)?;
            for (k, (inverse, load)) in self.inverse_mass(block).iter().zip(self.applied(block)).enumerate() {
                columns[at + k].push((at + k, inverse.recip()));
                right[at + k] = *load;
            }
        }
        for (place, &j) in active.iter().enumerate() {
            for wrench in self.wrenches(&self.generators()[j]) {
                let at = row(wrench.block)?;
                for (k, &component) in self.components().iter().enumerate() {
                    let value = wrench.value[component];
                    if value != 0.0 {
                        columns[first + place].push((at + k, -value));
                        columns[at + k].push((first + place, value));
                    }
                }
            }
        }
        let solution = Square::new(columns)?.solve(&right)?;
        let of = |(place, &block): (usize, &usize)| {
            let mut acceleration = [0.0; 6];
            self.components().iter().enumerate().for_each(|(k, &c)| acceleration[c] = solution[size * place + k]);
            (block, acceleration)
        };
        let motion = present.iter().enumerate().map(of).collect();
        let mut forces = vec![0.0; self.generators().len()];
        for (&j, &force) in active.iter().zip(&solution[first..]) {
            if force < -NONE * self.lightest(&self.generators()[j]) {
                return None;
            }
            forces[j] = force.max(0.0);
        }
        Some(Moving { forces, motion })
    }

    /// Load of the lighter one of the blocks that a generator acts on, N.
    fn lightest(&self, generator: &Generator) -> f64 {
        let directions = if self.in_plane() { 2 } else { 3 };
        let load = |block: usize| self.applied(block)[..directions].iter().map(|load| load * load).sum::<f64>().sqrt();
        generator.blocks().map(load).fold(f64::INFINITY, f64::min)
    }
}
