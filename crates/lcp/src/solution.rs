//! What comes back from a solve.

use crate::{counts::Counts, problem::Problem, scaling::Scaling};

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Status {
    /// `z` and `w` solve the problem; the residual was computed and is within the tolerance.
    Solved,
    /// No `z >= 0` with `M z + q >= 0` exists. `Solution::ray` proves it: `y >= 0`, `M' y <= 0` but for rounding of M's last
    /// digits, and `q' y < 0` by 1e-7 of q and y at least.
    NoSolution,
    /// Lemke's method ended on a ray that proves nothing for this class of matrix.
    RayTermination,
    /// The pivot limit was reached; `z` and `w` are the last complementary pair, not a solution.
    PivotLimit,
    /// Accuracy was lost, and neither refactoring nor further attempts brought it back; the residual says by how much.
    NumericalTrouble,
    /// Of a verdict on forces: neither standing nor falling is proved, see [`Membership`](crate::cone::Membership).
    Borderline,
}

impl Status {
    /// The status as users of other languages see it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solved => "solved",
            Self::NoSolution => "no_solution",
            Self::RayTermination => "ray_termination",
            Self::PivotLimit => "pivot_limit",
            Self::NumericalTrouble => "numerical_trouble",
            Self::Borderline => "borderline",
        }
    }
}

/// A complementary pair with its own check.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// (n), not negative.
    pub z: Vec<f64>,
    /// (n), `M z + q` as computed from `z`.
    pub w: Vec<f64>,
    /// How the solve ended.
    pub status: Status,
    /// Largest violation of `min(z, w) = 0` in the problem's own scale, see [`residual`].
    pub residual: f64,
    /// For [`Status::NoSolution`] the certificate `y` (n), for [`Status::RayTermination`] the ray.
    pub ray: Option<Vec<f64>>,
    /// Work done.
    pub counts: Counts,
}

/// The natural residual `max_i |min(z_i, w_i)|` with `w = M z + q`, in the problem's own scale.
///
/// Scale: with `d_i = 1 / sqrt(M_ii)` (1 where the diagonal is not positive) the pair is `z_i / d_i` and `d_i w_i`, so
/// that both are in the unit of the scaled `q`; the result is divided by the largest entry of both.
pub fn residual(problem: &Problem, z: &[f64]) -> f64 {
    let scaling = Scaling::new(problem);
    scaling.residual(&problem.w(z), z)
}
