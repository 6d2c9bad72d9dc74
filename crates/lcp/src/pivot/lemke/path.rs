//! The almost complementary path: from `z = 0` with a large `z0`, pivot by pivot, to `z0 = 0` or to a ray.

use super::inverse::BasisInverse;
use crate::{matrix::SparseColumns, settings::Settings};
use faer::Mat;

/// A column of `w - M z - c z0 = q`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Variable {
    W(usize),
    Z(usize),
    /// The artificial `z0` with the covering vector c.
    Cover,
}

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
    m: &'a SparseColumns,
    q: &'a [f64],
    settings: &'a Settings,
    /// The covering vector c, positive (n).
    cover: Vec<f64>,
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
    pub fn new(m: &'a SparseColumns, q: &'a [f64], settings: &'a Settings, cover: Vec<f64>) -> Self {
        let n = q.len();
        Self {
            m,
            q,
            settings,
            cover,
            basic: (0..n).map(Variable::W).collect(),
            inverse: BasisInverse::identity(n),
            x: q.to_vec(),
            pivots: 0,
            refactorisations: 0,
        }
    }

    /// Follows the path to its end.
    pub fn follow(&mut self, limit: usize) -> End {
        if self.q.iter().all(|&q| q >= 0.0) {
            return End::Complementary;
        }
        let mut direction: Vec<f64> = self.cover.iter().map(|c| -c).collect();
        let mut entering = Variable::Cover;
        let mut row = self.most_uncovered();
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
        let mut z = vec![0.0; self.q.len()];
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

    /// The rows `[x_B, B^-1]` that the rule compares.
    #[cfg(test)]
    pub fn lexicographic_rows(&self) -> impl Iterator<Item = Vec<f64>> {
        self.x.iter().enumerate().map(|(r, &x)| [&[x], self.inverse.row(r)].concat())
    }

    /// The row in which `z0` enters: the least `q_i / c_i`. Among equals the last, because `[q_i e_i] / c_i` is
    /// lexicographically least there, which leaves every other row lexicographically positive.
    fn most_uncovered(&self) -> usize {
        let ratio = |i: usize| self.q[i] / self.cover[i];
        (0..self.q.len()).fold(0, |least, i| if ratio(i) <= ratio(least) { i } else { least })
    }

    /// How fast every basic variable falls as the entering one rises. `None` if the basis is singular.
    fn direction(&mut self, entering: Variable) -> Option<Vec<f64>> {
        if self.inverse.age >= RENEW {
            self.renew()?;
        }
        let direction = self.inverse.apply(self.column(entering).parts());
        if self.inverse.age == 0 || self.drift(entering, &direction) <= DRIFT * largest(&direction).max(1.0) {
            return Some(direction);
        }
        self.renew()?;
        Some(self.inverse.apply(self.column(entering).parts()))
    }

    /// Largest entry of `a - B d`.
    fn drift(&self, entering: Variable, direction: &[f64]) -> f64 {
        let mut difference = vec![0.0; self.q.len()];
        self.column(entering).add_to(&mut difference, 1.0);
        for (&variable, &d) in self.basic.iter().zip(direction) {
            self.column(variable).add_to(&mut difference, -d);
        }
        largest(&difference)
    }

    fn renew(&mut self) -> Option<()> {
        self.refactorisations += 1;
        let mut b = Mat::zeros(self.q.len(), self.q.len());
        for (place, &variable) in self.basic.iter().enumerate() {
            let column = self.column(variable);
            let (indices, values) = column.parts();
            for (&i, &value) in indices.iter().zip(values) {
                b[(i, place)] = value;
            }
        }
        self.x = self.inverse.rebuild(&b, self.q)?;
        Some(())
    }

    /// The row whose variable reaches zero first; among ties `z0`, which ends the path, and else the lexicographically
    /// least row of `[x B^-1] / d` (Eaves 1971). `None` if no variable falls.
    fn leaving(&self, direction: &[f64]) -> Option<usize> {
        let floor = self.settings.pivot * largest(direction).max(1.0);
        let falling: Vec<usize> = (0..direction.len()).filter(|&r| direction[r] > floor).collect();
        let step = falling.iter().map(|&r| self.x[r].max(0.0) / direction[r]).reduce(f64::min)?;
        let zero = self.settings.feasibility * largest(&self.x).max(1.0);
        let mut tied = falling;
        tied.retain(|&r| self.x[r] - step * direction[r] <= zero);
        let cover = tied.iter().find(|&&r| self.basic[r] == Variable::Cover);
        cover.copied().or_else(|| self.lexicographic_least(tied, direction))
    }

    fn lexicographic_least(&self, mut tied: Vec<usize>, direction: &[f64]) -> Option<usize> {
        let entry = |r: usize, column: usize| self.inverse.row(r)[column] / direction[r];
        let size = tied.iter().map(|&r| largest(self.inverse.row(r)) / direction[r]).fold(0.0, f64::max);
        for column in 0..self.q.len() {
            if tied.len() <= 1 {
                break;
            }
            let least = tied.iter().map(|&r| entry(r, column)).fold(f64::INFINITY, f64::min);
            tied.retain(|&r| entry(r, column) <= least + LEXICOGRAPHIC_TIE * size);
        }
        tied.first().copied()
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
        let mut ray = vec![0.0; self.q.len()];
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

    /// The column of a variable in `w - M z - c z0`.
    fn column(&self, variable: Variable) -> Column {
        match variable {
            Variable::W(i) => Column { indices: vec![i], values: vec![1.0] },
            Variable::Z(j) => {
                let (indices, values) = self.m.column(j);
                Column { indices: indices.to_vec(), values: values.iter().map(|value| -value).collect() }
            }
            Variable::Cover => {
                Column { indices: (0..self.cover.len()).collect(), values: self.cover.iter().map(|c| -c).collect() }
            }
        }
    }
}

struct Column {
    indices: Vec<usize>,
    values: Vec<f64>,
}

impl Column {
    fn parts(&self) -> (&[usize], &[f64]) {
        (&self.indices, &self.values)
    }

    fn add_to(&self, y: &mut [f64], factor: f64) {
        for (&i, value) in self.indices.iter().zip(&self.values) {
            y[i] += factor * value;
        }
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |size, value| size.max(value.abs()))
}
