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
//! pivoting method keeps a basis. Where 64 bits chose that set wrongly, a force in it pulls or another contact closes: the
//! first leaves it or the second joins it, which keeps its columns independent (one that closes is no sum of those that do not).

use super::{Assembly, BlockSet, Components, generator::Generator};
use crate::geometry::length;
use drystone_lcp::refined::Square;

/// A force below zero by no more than this share of the weight of the lighter block it acts on is none.
const NONE: f64 = 1e-10;

/// A contact that closes by less than this share of the fastest, and of the terms of its own speed, does not: rounding.
const CLOSING: f64 = 1e-12;
const CLOSING_OF_TERMS: f64 = 1e-12;

/// Changes of the active set at most: it is right but for some contacts that 64 bits do not tell.
const CHANGES: usize = 50;

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

    /// Where no active set fits, the motion of the first in which nothing pulls, whose contacts may close a little. None if the
    /// system is too near to a singular one.
    fn refined(&self, blocks: &BlockSet, f: impl Fn(usize) -> f64) -> Option<Moving> {
        let rows = self.rows(blocks);
        let mut active: Vec<usize> = rows.iter().copied().filter(|&j| f(j) > 0.0).collect();
        let mut nearly = None;
        for _ in 0..=CHANGES {
            let Some(under) = self.on(blocks, &active) else { break };
            let pull = |j: usize| -under.forces[j] / self.lightest(&self.generators()[j]);
            let strongest = active.iter().copied().max_by(|&i, &j| pull(i).total_cmp(&pull(j)));
            if let Some(pulling) = strongest.filter(|&j| pull(j) > NONE) {
                active.retain(|&j| j != pulling);
            } else if let Some(closing) = self.closing(&rows, &under.motion) {
                nearly.get_or_insert(under);
                match active.binary_search(&closing) {
                    Ok(_) => break,
                    Err(place) => active.insert(place, closing),
                }
            } else {
                nearly = Some(under);
                break;
            }
        }
        let Moving { forces, motion } = nearly?;
        Some(Moving { forces: forces.into_iter().map(|force| force.max(0.0)).collect(), motion })
    }

    /// The generator whose contact closes most, if it does by more than rounding of 64-bit numbers.
    fn closing(&self, rows: &[usize], motion: &[(usize, Components)]) -> Option<usize> {
        let speeds: Vec<(f64, f64)> = rows.iter().map(|&j| self.opening(&self.generators()[j], motion)).collect();
        let fastest = self.fastest(motion);
        let closes = |(_, (opening, size)): &(&usize, &(f64, f64))| {
            -opening > CLOSING * fastest && -opening > CLOSING_OF_TERMS * size
        };
        let all = rows.iter().zip(&speeds).filter(closes);
        all.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0)).map(|(&j, _)| j)
    }

    /// Of the fastest point of a block, or a little less.
    pub(crate) fn speed(&self, block: usize, &[x, y, z, ref turning @ ..]: &Components) -> f64 {
        length([x, y, z]).max(length(*turning) * self.body(block).radius)
    }

    /// Of the fastest point of all blocks that move, or a little less.
    pub(crate) fn fastest(&self, motion: &[(usize, Components)]) -> f64 {
        motion.iter().fold(0.0, |fastest, (block, velocity)| fastest.max(self.speed(*block, velocity)))
    }

    /// How fast a generator's contact opens in a motion (blocks ascending), and the size of the terms of that.
    pub(crate) fn opening(&self, generator: &Generator, motion: &[(usize, Components)]) -> (f64, f64) {
        let (mut opening, mut size) = (0.0, 0.0);
        for wrench in self.wrenches(generator) {
            let Ok(place) = motion.binary_search_by_key(&wrench.block, |moving| moving.0) else { continue };
            for &k in self.components() {
                let term = wrench.value[k] * motion[place].1[k];
                opening += term;
                size += term.abs();
            }
        }
        (opening, size)
    }

    /// Forces and accelerations where just these contacts stay closed. None if the system is too near to a singular one.
    fn on(&self, blocks: &BlockSet, active: &[usize]) -> Option<Moving> {
        let size = self.components().len();
        let present: Vec<usize> = blocks.iter().collect();
        let row = |block: usize| present.binary_search(&block).ok().map(|place| size * place);
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
        active.iter().zip(&solution[first..]).for_each(|(&j, &force)| forces[j] = force);
        Some(Moving { forces, motion })
    }

    /// Load of the lighter one of the blocks that a generator acts on, N.
    fn lightest(&self, generator: &Generator) -> f64 {
        let directions = if self.in_plane() { 2 } else { 3 };
        let load = |block: usize| self.applied(block)[..directions].iter().map(|load| load * load).sum::<f64>().sqrt();
        generator.blocks().map(load).fold(f64::INFINITY, f64::min)
    }
}
