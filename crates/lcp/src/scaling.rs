//! Symmetric scaling to a unit diagonal, which makes every tolerance a relative one.

use crate::{problem::Problem, settings::PROGRESS};

/// `d_i = 1 / sqrt(M_ii)`, and 1 where the diagonal is not positive. With `z = D zs`, `w = D^-1 ws` the problem
/// becomes `ws = (D M D) zs + D q`.
#[derive(Debug, Clone)]
pub(crate) struct Scaling {
    pub d: Vec<f64>,
    /// Largest entry of `D q`.
    q_size: f64,
}

/// A z so many times larger than q may be one along which M is zero but for rounding.
const LARGE: f64 = 1e10;

impl Scaling {
    pub fn new(problem: &Problem) -> Self {
        Self::of(problem, |_| None)
    }

    /// The same for a problem of which only rows in `moved` have another diagonal than the one that this is for.
    pub fn after(&self, problem: &Problem, moved: impl Fn(usize) -> bool) -> Self {
        Self::of(problem, |i| (!moved(i)).then_some(self.d[i]))
    }

    fn of(problem: &Problem, known: impl Fn(usize) -> Option<f64>) -> Self {
        let scale = |i: usize| {
            let diagonal = problem.m().get(i, i);
            if diagonal > 0.0 { diagonal.sqrt().recip() } else { 1.0 }
        };
        let d: Vec<f64> = (0..problem.len()).map(|i| known(i).unwrap_or_else(|| scale(i))).collect();
        let q_size = d.iter().zip(problem.q()).fold(0.0_f64, |size, (d, q)| size.max((d * q).abs()));
        Self { d, q_size }
    }

    /// The problem's own scale at a scaled `z`: rounding in `M z + q` is a small multiple of it.
    pub fn own_scale(&self, scaled_z_size: f64) -> f64 {
        self.q_size.max(scaled_z_size)
    }

    /// Whether a pair with this residual lies so far out that it may be a ray: in its own scale the residual falls along
    /// every ray. It is far if there is room for a certificate, whose progress is at most the largest violation, or if z is more
    /// than 1e10 times larger than q.
    pub fn is_far(&self, z: &[f64], residual: f64) -> bool {
        let z_size = z.iter().zip(&self.d).fold(0.0, |size: f64, (z, d)| size.max((z / d).abs()));
        is_far(z_size, self.q_size, residual)
    }

    /// Residual of an unscaled pair; see [`crate::solution::residual`].
    pub fn residual(&self, w: &[f64], z: &[f64]) -> f64 {
        let (mut worst, mut z_size) = (0.0_f64, 0.0_f64);
        for ((&d, &w), &z) in self.d.iter().zip(w).zip(z) {
            let (zs, ws) = (z / d, w * d);
            worst = worst.max(zs.min(ws).abs());
            z_size = z_size.max(zs.abs());
            if zs.is_nan() || ws.is_nan() {
                return f64::NAN;
            }
        }
        if worst == 0.0 { 0.0 } else { worst / self.own_scale(z_size) }
    }
}

/// The same from the sizes of the scaled z and q.
pub(crate) fn is_far(z_size: f64, q_size: f64, residual: f64) -> bool {
    z_size > LARGE * q_size || residual * z_size.max(q_size) > PROGRESS * q_size
}
