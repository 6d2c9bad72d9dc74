//! Forces inside the cones in their own metric: the Hessian of the cones' logarithmic barrier there.
//!
//! With D its inverse at forces f, the least change of f that takes up a load dF, in the norm in which the border of the cones is at least
//! one away (Dikin's ellipsoid), is
//!
//! ```text
//! df = -D J v,    (J' D J) v = dF                                                      (1)
//! ```
//!
//! What is done with it: forces that follow small changes of the loads (`nearby.rs`), that follow a load as far as it can grow (`walk.rs`),
//! that are mended where they nearly hold the bodies (`resting.rs`).

use super::{
    matrix::BodyMatrix,
    problem::Gauss,
    scaled::{Scaled, ScaledPoint},
};

/// The problem, and the matrix of (1) at the forces last given.
pub(super) struct Metric<const B: usize, const D: usize> {
    pub problem: Scaled<B, D, 2>,
    matrix: BodyMatrix<B>,
    /// `J v`.
    moved: Vec<f64>,
}

impl<const B: usize, const D: usize> std::fmt::Debug for Metric<B, D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Metric").field("forces", &self.problem.forces()).finish_non_exhaustive()
    }
}

impl<const B: usize, const D: usize> Metric<B, D> {
    pub fn new(problem: &Gauss) -> Option<Self> {
        let problem = Scaled::new(problem);
        Some(Self { matrix: BodyMatrix::new(&problem)?, moved: vec![0.0; problem.forces()], problem })
    }

    /// Factors the matrix at some forces, with `more` on its diagonal. None if some body could not be held by these whatever they were.
    pub fn factor(&mut self, f: &[f64], more: f64) -> Option<()> {
        self.matrix.assemble(&self.problem.points, |_| more, |point| weight(&self.problem, point, f));
        self.matrix.factor().map(drop)
    }

    /// `v = (J' D J)^-1 load`, in place of the load, by the factor at the forces f; takes `D J v` from the change.
    pub fn take_up(&mut self, f: &[f64], load: &mut [[f64; B]], change: &mut [f64]) {
        let Self { problem, matrix, moved } = self;
        matrix.solve(load);
        problem.motion(load, moved);
        for point in &problem.points {
            give_way(point.round, &f[point.own()], &moved[point.own()], &mut change[point.own()]);
        }
    }
}

/// D of a point, on its directions.
pub(super) fn weight<const B: usize, const D: usize, const N: usize>(
    problem: &Scaled<B, D, N>,
    point: &ScaledPoint<B, D, N>,
    f: &[f64],
) -> [[f64; D]; D] {
    let (edges, f) = (&problem.edges[point.own()], &f[point.own()]);
    let mut weight = [[0.0; D]; D];
    let mut add = |one: &[f64; D], other: &[f64; D], value: f64| {
        (0..D).for_each(|i| (0..D).for_each(|j| weight[i][j] += one[i] * value * other[j]));
    };
    if !point.round {
        edges.iter().zip(f).for_each(|(edge, f)| add(edge, edge, f * f));
        return weight;
    }
    for (k, edge) in edges.iter().enumerate() {
        let (mut unit, mut column) = ([0.0; 3], [0.0; 3]);
        unit[k] = -1.0;
        give_way(true, f, &unit, &mut column);
        edges.iter().zip(column).for_each(|(other, value)| add(other, edge, value));
    }
    weight
}

/// Takes D times a motion from the forces of a point: the squares of the magnitudes along edges, `2 f f' - det(f) diag(1, -1, -1)`
/// in a round cone.
pub(super) fn give_way(round: bool, f: &[f64], moved: &[f64], df: &mut [f64]) {
    if !round {
        df.iter_mut().zip(f.iter().zip(moved)).for_each(|(df, (f, moved))| *df -= f * f * moved);
        return;
    }
    let radius = f[1].hypot(f[2]);
    let determinant = (f[0] - radius) * (f[0] + radius);
    let along: f64 = f.iter().zip(moved).map(|(f, moved)| f * moved).sum();
    for (k, df) in df.iter_mut().enumerate() {
        let sign = if k == 0 { 1.0 } else { -1.0 };
        *df -= 2.0 * along * f[k] - sign * determinant * moved[k];
    }
}
