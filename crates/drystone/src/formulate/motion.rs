//! Accelerations of a solution of the complementarity problem.
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

impl Assembly {
    /// Accelerations of the blocks of a sub-assembly, in the order of the set, under a solution of its complementarity problem;
    /// `f(j)` is the magnitude of generator j, N.
    pub(crate) fn motion(&self, blocks: &BlockSet, f: impl Fn(usize) -> f64) -> Vec<(usize, Components)> {
        let exact = if self.is_wide() { self.refined_motion(blocks, &f) } else { None };
        exact.unwrap_or_else(|| blocks.iter().map(|block| (block, self.acceleration(block, &f))).collect())
    }

    fn is_wide(&self) -> bool {
        let masses = || (0..self.blocks()).map(|block| self.inverse_mass(block)[0].recip());
        masses().fold(0.0, f64::max) > WIDE * masses().fold(f64::INFINITY, f64::min)
    }

    /// None if the system is too near to a singular one.
    fn refined_motion(&self, blocks: &BlockSet, f: impl Fn(usize) -> f64) -> Option<Vec<(usize, Components)>> {
        let size = self.components().len();
        let present: Vec<usize> = blocks.iter().collect();
        let row = |block: usize| present.binary_search(&block).ok().map(|place| size * place);
        let active: Vec<&Generator> =
            self.rows(blocks).into_iter().filter(|&j| f(j) > 0.0).map(|j| &self.generators()[j]).collect();
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
        for (place, generator) in active.iter().enumerate() {
            for wrench in &generator.wrenches {
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
        Some(present.iter().enumerate().map(of).collect())
    }
}
