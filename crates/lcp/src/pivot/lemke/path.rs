//! The almost complementary path: from a basis with a large `z0`, pivot by pivot, to `z0 = 0` or to a ray.

use super::{
    inverse::BasisInverse,
    system::{System, Variable},
};
use crate::{interrupt::poll, matrix::SparseColumns, settings::Settings};
use std::borrow::Cow;

/// How the path ended.
#[derive(Debug, PartialEq)]
pub(super) enum End {
    /// `z0` left the basis: the basic variables are complementary.
    Complementary,
    /// Nothing blocks the entering variable: the `z` part of the ray (n).
    Ray(Vec<f64>),
    /// The pivot limit was reached.
    Limit,
    /// The basis is numerically singular.
    LostAccuracy,
}

/// Basic variables, their values, and the inverse of their columns.
#[derive(Debug)]
pub(super) struct Path<'a> {
    system: System<'a>,
    settings: &'a Settings,
    /// The basis B0 that the path starts from, which the lexicographic rule compares rows in; `None` for `w`.
    start: Option<Vec<Variable>>,
    /// The order in which the rule compares the entries of two rows (n).
    order: Vec<usize>,
    /// `B0^-1 c`: how fast each basic variable of the start grows with `z0` (n), not negative.
    lift: Vec<f64>,
    /// The variable that every row of the inverse belongs to (n).
    basic: Vec<Variable>,
    inverse: BasisInverse,
    /// Values of the basic variables (n).
    x: Vec<f64>,
    /// Exchanges made.
    pub pivots: usize,
    /// Times the inverse was computed anew.
    pub refactorisations: usize,
}

/// Exchanges after which the inverse is computed from the basis again.
const RENEW: usize = 50;
/// Largest entry of `a - B d`, relative to the direction d, above which the inverse is renewed at once.
const DRIFT: f64 = 1e-11;
/// Entries of two rows of the inverse that differ by less than this, relative to the rows, tie: it is above what `RENEW`
/// exchanges leave in rounding.
const LEXICOGRAPHIC_TIE: f64 = 1e-10;

impl<'a> Path<'a> {
    /// The path from `z = 0` with a positive covering vector.
    pub fn new(m: &'a SparseColumns, q: &'a [f64], settings: &'a Settings, cover: Vec<f64>) -> Self {
        let n = q.len();
        Self {
            settings,
            start: None,
            order: (0..n).collect(),
            lift: cover.clone(),
            system: System { m, q, cover },
            basic: (0..n).map(Variable::W).collect(),
            inverse: BasisInverse::identity(n),
            x: q.to_vec(),
            pivots: 0,
            refactorisations: 0,
        }
    }

    /// The path from the complementary basis with `z` basic on `active`. The covering vector is the one that lifts the
    /// infeasible basic variables, all alike, and no other: `c = B0 lift`. `order` is that of the lexicographic rule.
    /// `None` if the basis is numerically singular.
    pub fn from_basis(
        m: &'a SparseColumns,
        q: &'a [f64],
        settings: &'a Settings,
        active: &[usize],
        order: Vec<usize>,
    ) -> Option<Self> {
        let n = q.len();
        let mut path = Self { order, ..Self::new(m, q, settings, vec![0.0; n]) };
        active.iter().for_each(|&j| path.basic[j] = Variable::Z(j));
        path.x = path.inverse.rebuild(&path.system, &path.basic)?;
        if path.inverse.largest() * settings.singular > 1.0 {
            return None;
        }
        let zero = path.zero();
        let mut cover = vec![0.0; n];
        for place in 0..n {
            if path.x[place] < -zero {
                path.lift[place] = 1.0;
                path.system.for_each(path.basic[place], |i, value| cover[i] += value);
            }
        }
        path.system.cover = cover;
        path.start = Some(path.basic.clone());
        Some(path)
    }

    /// Follows the path to its end.
    pub fn follow(&mut self, limit: usize) -> End {
        let Some(mut row) = self.most_infeasible() else { return End::Complementary };
        let mut direction: Vec<f64> = self.lift.iter().map(|lift| -lift).collect();
        let mut entering = Variable::Cover;
        loop {
            if self.pivots >= limit {
                return End::Limit;
            }
            let left = self.exchange(row, entering, &direction);
            entering = match left {
                Variable::Cover => return End::Complementary,
                Variable::W(i) => Variable::Z(i),
                Variable::Z(i) => Variable::W(i),
            };
            let Some(found) = self.direction(entering) else { return End::LostAccuracy };
            direction = found;
            match self.leaving(&direction) {
                Some(found) => row = found,
                None => return End::Ray(self.ray(entering, &direction)),
            }
        }
    }

    /// `z` at the point reached (n): basic values, not negative.
    pub fn z(&self) -> Vec<f64> {
        let mut z = vec![0.0; self.system.len()];
        for (variable, &x) in self.basic.iter().zip(&self.x) {
            if let Variable::Z(j) = *variable {
                z[j] = x.max(0.0);
            }
        }
        z
    }

    /// The indices with a basic `z`, ascending.
    pub fn active(&self) -> Vec<usize> {
        let mut active: Vec<usize> =
            self.basic.iter().filter_map(|v| if let Variable::Z(j) = *v { Some(j) } else { None }).collect();
        active.sort_unstable();
        active
    }

    /// The rows `[x_B, B^-1 B0]` as the rule compares them.
    #[cfg(test)]
    pub fn lexicographic_rows(&self) -> impl Iterator<Item = Vec<f64>> {
        self.x.iter().enumerate().map(|(r, &x)| {
            let row = self.lexicographic_row(r);
            std::iter::once(x).chain(self.order.iter().map(|&column| row[column])).collect()
        })
    }

    /// Row r of `B^-1 B0`. In terms of B0 the path is that of the problem in which its variables are the `w`.
    fn lexicographic_row(&self, r: usize) -> Cow<'_, [f64]> {
        let row = self.inverse.row(r);
        match &self.start {
            None => Cow::Borrowed(row),
            Some(start) => {
                poll(self.system.m.stored());
                start.iter().map(|&variable| self.system.dot(variable, row)).collect()
            }
        }
    }

    /// The row in which `z0` enters: the least `x_i / lift_i`; `None` if it is not negative. Among equals the last in the
    /// order of the rule, because `[x_i e_i] / lift_i` is lexicographically least there, which leaves every other row
    /// lexicographically positive.
    fn most_infeasible(&self) -> Option<usize> {
        let infeasible = || self.order.iter().copied().filter(|&i| self.lift[i] > 0.0 && self.x[i] < 0.0);
        let ratio = |i: usize| self.x[i] / self.lift[i];
        let least = infeasible().map(ratio).reduce(f64::min)?;
        infeasible().rfind(|&i| ratio(i) <= least + self.zero())
    }

    /// How fast every basic variable falls as the entering one rises. `None` if the basis is singular.
    fn direction(&mut self, entering: Variable) -> Option<Vec<f64>> {
        if self.inverse.age >= RENEW {
            self.renew()?;
        }
        let direction = self.inverse.apply(&self.system, entering);
        if self.inverse.age == 0 || self.drift(entering, &direction) <= DRIFT * largest(&direction).max(1.0) {
            return Some(direction);
        }
        self.renew()?;
        Some(self.inverse.apply(&self.system, entering))
    }

    /// Largest entry of `a - B d`.
    fn drift(&self, entering: Variable, direction: &[f64]) -> f64 {
        let mut column = vec![0.0; self.system.len()];
        self.system.add_to(&mut column, entering, 1.0);
        largest(&self.system.difference(&self.basic, direction, &column))
    }

    fn renew(&mut self) -> Option<()> {
        self.refactorisations += 1;
        self.x = self.inverse.rebuild(&self.system, &self.basic)?;
        Some(())
    }

    /// How far below zero a basic variable is still zero.
    fn zero(&self) -> f64 {
        self.settings.feasibility * largest(&self.x).max(1.0)
    }

    /// The row whose variable reaches zero first; among ties `z0`, which ends the path, and else the lexicographically
    /// least row of `[x B^-1 B0] / d` (Eaves 1971). `None` if no variable falls.
    fn leaving(&self, direction: &[f64]) -> Option<usize> {
        let floor = self.settings.pivot * largest(direction).max(1.0);
        let falling: Vec<usize> = (0..direction.len()).filter(|&r| direction[r] > floor).collect();
        let step = falling.iter().map(|&r| self.x[r].max(0.0) / direction[r]).reduce(f64::min)?;
        let zero = self.zero();
        let mut tied = falling;
        tied.retain(|&r| self.x[r] - step * direction[r] <= zero);
        let cover = tied.iter().find(|&&r| self.basic[r] == Variable::Cover);
        cover.copied().or_else(|| self.lexicographic_least(tied, direction))
    }

    fn lexicographic_least(&self, tied: Vec<usize>, direction: &[f64]) -> Option<usize> {
        if tied.len() <= 1 {
            return tied.first().copied();
        }
        let mut rows: Vec<(usize, Cow<'_, [f64]>)> = tied.into_iter().map(|r| (r, self.lexicographic_row(r))).collect();
        let size = rows.iter().map(|(r, row)| largest(row) / direction[*r]).fold(0.0, f64::max);
        for &column in &self.order {
            let entry = |(r, row): &(usize, Cow<'_, [f64]>)| row[column] / direction[*r];
            let least = rows.iter().map(entry).fold(f64::INFINITY, f64::min);
            poll(rows.len());
            rows.retain(|row| entry(row) <= least + LEXICOGRAPHIC_TIE * size);
            if rows.len() == 1 {
                break;
            }
        }
        rows.first().map(|(r, _)| *r)
    }

    /// One pivot: the entering variable takes the place of the one in `row`, which is returned.
    fn exchange(&mut self, row: usize, entering: Variable, direction: &[f64]) -> Variable {
        let step = self.x[row] / direction[row];
        for (x, d) in self.x.iter_mut().zip(direction) {
            *x -= step * d;
        }
        self.x[row] = step;
        self.inverse.exchange(row, direction);
        self.pivots += 1;
        std::mem::replace(&mut self.basic[row], entering)
    }

    fn ray(&self, entering: Variable, direction: &[f64]) -> Vec<f64> {
        let mut ray = vec![0.0; self.system.len()];
        if let Variable::Z(j) = entering {
            ray[j] = 1.0;
        }
        for (variable, &d) in self.basic.iter().zip(direction) {
            if let Variable::Z(j) = *variable {
                ray[j] = (-d).max(0.0);
            }
        }
        ray
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |size, value| size.max(value.abs()))
}
