//! The last iterations of a structure that stands, in one.
//!
//! Near rest the forces f are inside their cones and leave a small part of each body's load. Two or three more iterations
//! would take that up; so does the least change of the forces in the metric of the cones' barrier (`metric.rs`),
//!
//! ```text
//! df = -D J v,   (J' D J) v = F + J' f
//! ```
//!
//! at once, to rounding, and if f + df is inside the cones it holds the bodies. Else it says nothing, and the method goes on.

use super::{
    matrix::BodyMatrix,
    metric::{give_way, weight},
    scaled::Scaled,
    scaling::way_to_border,
};

/// What the forces may leave of a body's own load: a hundredth of what counts as rest.
pub(super) const REST: f64 = 1e-11;
/// Share of the loads that forces may leave for a look. With a tenth standing structures save one iteration more, but falling domes
/// pay for a look that is in vain.
const NEAR: f64 = 1e-2;
/// Share of what they left at the last look, for another.
const NEARER: f64 = 0.1;
/// Weight of the motion itself in the matrix, where forces that are nearly zero leave none.
const PROXIMAL: f64 = 1e-13;
/// Solves: the first takes up all but rounding, the others that.
const SOLVES: usize = 3;
/// Share of the way to the border of the cones that the change may go.
const SHARE: f64 = 0.95;

/// Looks at forces near rest.
pub(super) struct Restoring<const B: usize> {
    /// What the forces left at the last look.
    last: f64,
    /// Looks: a matrix is factored for each.
    pub looks: usize,
    df: Vec<f64>,
    /// `f + df`.
    forces: Vec<f64>,
    /// `J v`.
    moved: Vec<f64>,
    left: Vec<[f64; B]>,
}

impl<const B: usize> Restoring<B> {
    pub fn new(bodies: usize, forces: usize) -> Self {
        let [df, moved, sums] = [(); 3].map(|()| vec![0.0; forces]);
        Self { last: NEAR / NEARER, looks: 0, df, forces: sums, moved, left: vec![[0.0; B]; bodies] }
    }

    /// Forces that hold the bodies, near some that leave such a share of the loads. None if that is not worth a look, or if they would leave
    /// their cones.
    pub fn look<const D: usize, const N: usize>(
        &mut self,
        problem: &Scaled<B, D, N>,
        matrix: &mut BodyMatrix<B>,
        f: &[f64],
        share: f64,
    ) -> Option<&[f64]> {
        if share > NEARER * self.last {
            return None;
        }
        (self.last, self.looks) = (share, self.looks + 1);
        matrix.assemble(&problem.points, |_| PROXIMAL, |point| weight(problem, point, f));
        matrix.factor()?;
        self.df.fill(0.0);
        self.add(problem, f);
        for _ in 0..SOLVES {
            matrix.solve(&mut self.left);
            problem.motion(&self.left, &mut self.moved);
            for point in &problem.points {
                let own = point.own();
                give_way(point.round, &f[own.clone()], &self.moved[own.clone()], &mut self.df[own]);
            }
            let is_inside = SHARE * way_to_border(problem, f, &self.df) >= 1.0;
            if !is_inside {
                return None;
            }
            self.add(problem, f);
            if share_of_loads(&problem.load, self.left.iter().copied()) <= REST {
                return Some(&self.forces);
            }
        }
        None
    }

    /// Adds the change to the forces; what they leave of the loads.
    fn add<const D: usize, const N: usize>(&mut self, problem: &Scaled<B, D, N>, f: &[f64]) {
        self.forces.iter_mut().zip(f.iter().zip(&self.df)).for_each(|(sum, (f, df))| *sum = f + df);
        self.left.copy_from_slice(&problem.load);
        problem.add_wrenches(&self.forces, 1.0, &mut self.left);
    }
}

/// The largest share that is left of a body's own load.
pub(super) fn share_of_loads<const B: usize>(loads: &[[f64; B]], left: impl Iterator<Item = [f64; B]>) -> f64 {
    let share = |(left, load): ([f64; B], &[f64; B])| {
        let [left, own] = [&left, load].map(|of| of.iter().fold(0.0_f64, |largest, x| largest.max(x.abs())));
        if left == 0.0 { 0.0 } else { left / own }
    };
    left.zip(loads).map(share).fold(0.0, f64::max)
}
