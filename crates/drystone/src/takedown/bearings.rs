//! Normal forces of the points that bear a block, for one load after another: a nonnegative least squares problem each.
//!
//! ```text
//! min |B x + b|,   x >= 0,   B = U^-1 G_b,   b = U^-1 load            U units of the balance
//! ```
//!
//! Lawson, C. L., & Hanson, R. J. (1974). Solving least squares problems, chapter 23: an active set. The points that push are
//! independent columns, no more than a wrench has numbers: mostly two in the plane, three in space. Normals of blocks that moved a
//! little differ by little, so that columns are made orthogonal, twice (Gram and Schmidt), rather than multiplied with one another.
//! What they do not balance to [`LEFT`] is not borne.

use crate::formulate::Components;

/// Most that rounding may leave of a load, as a share: a hundredth of what counts as rest, so that a load may pass many blocks.
const LEFT: f64 = 1e-11;

/// A column of which no more than this share is independent of those that push already bears nothing that these do not: rounding.
const DEPENDENT: f64 = 1e-12;

/// Points that push at a time: as many as a wrench has numbers.
const MOST: usize = 6;

/// The points under a block whose normal forces are taken up there.
pub(super) struct Bearings<'a> {
    units: &'a [f64],
    /// B, by columns.
    columns: Vec<Components>,
}

impl<'a> Bearings<'a> {
    /// Of the wrenches of unit forces, of which as many numbers count as there are units.
    pub fn new(wrenches: impl Iterator<Item = &'a Components>, units: &'a [f64]) -> Self {
        Self { units, columns: wrenches.map(|wrench| over(wrench, units)).collect() }
    }

    /// Forces that balance a load, one for each point; None if there are none.
    pub fn balance(&self, load: &Components) -> Option<Vec<f64>> {
        let load = over(load, self.units);
        let most = LEFT * load.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()));
        let (mut forces, mut pushing) = (vec![0.0; self.columns.len()], Vec::with_capacity(MOST + 1));
        let mut left = load;
        for _ in 0..=3 * forces.len() {
            if self.balances(&load, &forces, &pushing, most) {
                return Some(forces);
            }
            pushing.push(self.steepest(&left, &pushing)?);
            left = self.share(&load, &mut forces, &mut pushing)?;
        }
        None
    }

    fn balances(&self, load: &Components, forces: &[f64], pushing: &[usize], most: f64) -> bool {
        let mut left = *load;
        pushing.iter().for_each(|&j| add(&mut left, forces[j], &self.columns[j]));
        left.iter().all(|entry| entry.abs() <= most)
    }

    /// The point without a force of which a unit would take up most of what is left of the load.
    fn steepest(&self, left: &Components, pushing: &[usize]) -> Option<usize> {
        let idle = (0..self.columns.len()).filter(|j| !pushing.contains(j)).map(|j| (-dot(&self.columns[j], left), j));
        idle.reduce(|best, next| if next.0 > best.0 { next } else { best })
            .filter(|best| best.0 > 0.0)
            .map(|best| best.1)
    }

    /// Least squares on the points that push; those that would pull are let go on the way. Answers what is left of the load.
    fn share(&self, load: &Components, forces: &mut [f64], pushing: &mut Vec<usize>) -> Option<Components> {
        loop {
            let (aim, left) = self.least_squares(load, pushing)?;
            let way = |k: usize| (aim[k] <= 0.0).then(|| (forces[pushing[k]] / (forces[pushing[k]] - aim[k]), k));
            let end = (0..pushing.len()).filter_map(way).reduce(|best, next| if next.0 < best.0 { next } else { best });
            let step = end.map_or(1.0, |(step, _)| step);
            for (&j, aim) in pushing.iter().zip(aim) {
                forces[j] += step * (aim - forces[j]);
            }
            let Some((_, k)) = end else { return Some(left) };
            forces[pushing.remove(k)] = 0.0;
        }
    }

    /// Forces of either sign on some points, and what they leave of a load; None if their columns are dependent.
    fn least_squares(&self, load: &Components, points: &[usize]) -> Option<([f64; MOST], Components)> {
        let (mut q, mut r) = ([[0.0; 6]; MOST], [[0.0; MOST]; MOST]);
        if points.len() > MOST {
            return None;
        }
        for (i, &point) in points.iter().enumerate() {
            let length = dot(&self.columns[point], &self.columns[point]).sqrt();
            let (along, across) = split(&self.columns[point], &q[..i]);
            let rest = dot(&across, &across).sqrt();
            if rest <= DEPENDENT * length {
                return None;
            }
            r[i] = along;
            r[i][i] = rest;
            q[i] = across.map(|entry| entry / rest);
        }
        let (along, left) = split(load, &q[..points.len()]);
        let mut x = [0.0; MOST];
        for i in (0..points.len()).rev() {
            x[i] = (-along[i] - (i + 1..points.len()).map(|k| r[k][i] * x[k]).sum::<f64>()) / r[i][i];
        }
        Some((x, left))
    }
}

/// The parts of a wrench along orthogonal unit wrenches, and what is across them: twice, as the first time leaves rounding.
fn split(wrench: &Components, units: &[Components]) -> ([f64; MOST], Components) {
    let (mut along, mut across) = ([0.0; MOST], *wrench);
    for _ in 0..2 {
        for (along, unit) in along.iter_mut().zip(units) {
            let part = dot(unit, &across);
            *along += part;
            add(&mut across, -part, unit);
        }
    }
    (along, across)
}

fn over(wrench: &Components, units: &[f64]) -> Components {
    let mut scaled = [0.0; 6];
    scaled.iter_mut().zip(wrench).zip(units).for_each(|((scaled, entry), unit)| *scaled = entry / unit);
    scaled
}

fn dot(a: &Components, b: &Components) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(to: &mut Components, factor: f64, other: &Components) {
    to.iter_mut().zip(other).for_each(|(to, other)| *to += factor * other);
}

#[cfg(test)]
#[path = "bearings_tests.rs"]
mod tests;
