//! The explicit inverse of a basis, which the lexicographic rule reads row by row.

use super::system::{System, Variable};
use crate::interrupt::{apart, poll};
use faer::{
    Mat,
    linalg::solvers::{DenseSolveCore, Solve},
};

/// `B^-1`, n x n by rows. One exchange costs n^2 operations (Gauss and Jordan); [`Self::rebuild`] factors B anew.
#[derive(Debug)]
pub(super) struct BasisInverse {
    n: usize,
    rows: Vec<f64>,
    /// Exchanges since the inverse was computed from B itself.
    pub age: usize,
}

impl BasisInverse {
    /// The inverse of the identity.
    pub fn identity(n: usize) -> Self {
        let mut rows = vec![0.0; n * n];
        rows.iter_mut().step_by(n + 1).for_each(|diagonal| *diagonal = 1.0);
        Self { n, rows, age: 0 }
    }

    /// Row `r` (n).
    pub fn row(&self, r: usize) -> &[f64] {
        &self.rows[r * self.n..(r + 1) * self.n]
    }

    /// `B^-1 a` for the column of a variable.
    pub fn apply(&self, system: &System, variable: Variable) -> Vec<f64> {
        let dot = |r: usize| {
            poll(self.n);
            system.dot(variable, self.row(r))
        };
        (0..self.n).map(dot).collect()
    }

    /// The column at place `r` of B is replaced by `a`, with `direction = B^-1 a`.
    pub fn exchange(&mut self, r: usize, direction: &[f64]) {
        let n = self.n;
        poll(n * n);
        let mut pivot_row: Vec<f64> = self.row(r).to_vec();
        pivot_row.iter_mut().for_each(|value| *value /= direction[r]);
        for (i, &d) in direction.iter().enumerate() {
            if i != r && d != 0.0 {
                for (value, p) in self.rows[i * n..(i + 1) * n].iter_mut().zip(&pivot_row) {
                    *value -= d * p;
                }
            }
        }
        self.rows[r * n..(r + 1) * n].copy_from_slice(&pivot_row);
        self.age += 1;
    }

    /// Computes the inverse from B itself, and `B^-1 q` with one step of iterative refinement. `None` if B is numerically
    /// singular.
    ///
    /// A basic `w_i` is a unit column, so only the block of the other basic variables on the rows without one is
    /// factored, by LU with partial pivoting: `x_K = B_RK^-1 a_R`, `x_i = a_i - B_iK x_K`.
    pub fn rebuild(&mut self, system: &System, basic: &[Variable]) -> Option<Vec<f64>> {
        let shape = Shape::of(basic);
        let (block, size) = (shape.block(system), shape.rows.len());
        let (lu, inverse) = apart(3 * size * size * size, move || {
            let lu = block.partial_piv_lu();
            let inverse = lu.inverse();
            (lu, inverse)
        });
        let solve = |a: &[f64]| {
            let right = Mat::from_fn(shape.rows.len(), 1, |r, _| a[shape.rows[r]]);
            let found = lu.solve(&right);
            shape.complete(system, a, |k| found[(k, 0)])
        };
        let mut x = solve(system.q);
        let correction = solve(&system.difference(basic, &x, system.q));
        x.iter_mut().zip(correction).for_each(|(x, correction)| *x += correction);

        self.rows.fill(0.0);
        self.age = 0;
        for (k, &(place, _)) in shape.others.iter().enumerate() {
            for (r, &row) in shape.rows.iter().enumerate() {
                self.rows[place * self.n + row] = inverse[(k, r)];
            }
        }
        for &(place, i) in &shape.units {
            self.rows[place * self.n + i] = 1.0;
        }
        self.fill_unit_rows(&shape, system);
        (self.rows.iter().chain(&x).all(|value| value.is_finite())).then_some(x)
    }

    /// Rows of basic `w_i`: `e_i - B_iK` times the rows of the others.
    fn fill_unit_rows(&mut self, shape: &Shape, system: &System) {
        for &(place, variable) in &shape.others {
            poll(self.n);
            let source: Vec<f64> = shape.rows.iter().map(|&r| self.rows[place * self.n + r]).collect();
            system.for_each(variable, |i, value| {
                let Some(target) = shape.unit_at[i] else { return };
                poll(shape.rows.len());
                let row = &mut self.rows[target * self.n..(target + 1) * self.n];
                shape.rows.iter().zip(&source).for_each(|(&r, source)| row[r] -= value * source);
            });
        }
    }

    /// Largest entry.
    pub fn largest(&self) -> f64 {
        self.rows.iter().fold(0.0, |size, value| size.max(value.abs()))
    }
}

/// Which columns of a basis are unit columns.
struct Shape {
    /// (place, i) of every basic `w_i`.
    units: Vec<(usize, usize)>,
    /// The place of `w_i`, where it is basic (n).
    unit_at: Vec<Option<usize>>,
    /// All other basic variables with their places, K.
    others: Vec<(usize, Variable)>,
    /// Rows whose `w` is not basic, R; as many.
    rows: Vec<usize>,
}

impl Shape {
    fn of(basic: &[Variable]) -> Self {
        let mut unit_at = vec![None; basic.len()];
        let (mut units, mut others) = (Vec::new(), Vec::new());
        for (place, &variable) in basic.iter().enumerate() {
            if let Variable::W(i) = variable {
                unit_at[i] = Some(place);
                units.push((place, i));
            } else {
                others.push((place, variable));
            }
        }
        let rows = (0..basic.len()).filter(|&i| unit_at[i].is_none()).collect();
        Self { units, unit_at, others, rows }
    }

    /// `B_RK`.
    fn block(&self, system: &System) -> Mat<f64> {
        let mut at = vec![None; self.unit_at.len()];
        self.rows.iter().enumerate().for_each(|(r, &row)| at[row] = Some(r));
        let mut block = Mat::zeros(self.rows.len(), self.others.len());
        for (k, &(_, variable)) in self.others.iter().enumerate() {
            system.for_each(variable, |i, value| {
                if let Some(r) = at[i] {
                    block[(r, k)] = value;
                }
            });
        }
        block
    }

    /// All of x from `x_K`.
    fn complete(&self, system: &System, a: &[f64], x_k: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut rest = a.to_vec();
        let mut x = vec![0.0; a.len()];
        for (k, &(place, variable)) in self.others.iter().enumerate() {
            x[place] = x_k(k);
            system.add_to(&mut rest, variable, -x[place]);
        }
        self.units.iter().for_each(|&(place, i)| x[place] = rest[i]);
        x
    }
}
