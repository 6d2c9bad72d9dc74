//! Forces that hold bodies, from some that nearly do.
//!
//! Where a body comes to others that are held by forces f > 0, all of them positive as the method leaves them, few of these have to
//! change much. The step that restores the balance by the least change, each in units of its own size,
//!
//! ```text
//! min sum (df_j / f_j)^2   over   J' df = -(F + J' f)
//! ```
//!
//! is `df = f^2 J y` with `J' f^2 J y = -(F + J' f)`, one factor: the metric of the cones' barrier (`metric.rs`). If it leaves all forces positive they
//! hold the bodies; if not, it is cut short and made again from there (the affine scaling of I. I. Dikin, 1967).

use super::{
    method::{End, Found},
    metric::Metric,
    problem::{Cone, Gauss},
    restoring::{REST, share_of_loads},
};

/// In the problem's own scale, where the largest load is one: a force of which nothing is known.
const UNKNOWN: f64 = 0.1;
/// Steps: where they lead somewhere two or three do, where not the method itself takes ten times as many.
const MOST: usize = 6;
/// Share of the way to the first force that would pull.
const SHARE: f64 = 0.9;
/// A step that goes less far than this share leads nowhere.
const LEAST: f64 = 0.05;
/// Weight of the motion itself in the matrix, where forces that are nearly zero leave none; what it takes from the balance the
/// next step gives back.
const PROXIMAL: f64 = 1e-13;

impl Gauss {
    /// Forces that hold the bodies, near some that are positive; zeros where nothing is known. None if a few steps do not lead
    /// there, which proves nothing, or where there are round cones.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn rest_near(&self, forces: &[f64]) -> Option<Found> {
        if self.points.iter().any(|point| matches!(point.cone, Cone::Round { .. })) {
            return None;
        }
        match self.size {
            3 => Resting::<3, 2>::new(self, forces)?.found(),
            6 => Resting::<6, 3>::new(self, forces)?.found(),
            size => panic!("a body has 3 or 6 unknowns, not {size}"),
        }
    }
}

struct Resting<const B: usize, const D: usize> {
    metric: Metric<B, D>,
    f: Vec<f64>,
    /// `F + J' f`, and then -y.
    left: Vec<[f64; B]>,
    /// `df`.
    change: Vec<f64>,
}

impl<const B: usize, const D: usize> Resting<B, D> {
    fn new(problem: &Gauss, forces: &[f64]) -> Option<Self> {
        let metric = Metric::new(problem)?;
        let known = |f: f64| if f > 0.0 { f } else { UNKNOWN };
        let f: Vec<f64> = metric.problem.in_own_units(forces).into_iter().map(known).collect();
        let (left, change) = (vec![[0.0; B]; metric.problem.load.len()], vec![0.0; f.len()]);
        Some(Self { metric, f, left, change })
    }

    fn found(mut self) -> Option<Found> {
        for iterations in 0..=MOST {
            if self.is_at_rest() {
                let accelerations = vec![0.0; B * self.left.len()];
                let (forces, bearing) = (self.metric.problem.in_newtons(&self.f), vec![true; self.f.len()]);
                return Some(Found {
                    end: End::AtRest,
                    accelerations,
                    forces,
                    factor: f64::NAN,
                    bearing,
                    iterations,
                    gap: 0.0,
                });
            }
            if iterations < MOST {
                self.step()?;
            }
        }
        None
    }

    /// Whether what the forces leave of each body's load is none.
    fn is_at_rest(&mut self) -> bool {
        let problem = &self.metric.problem;
        self.left.copy_from_slice(&problem.load);
        problem.add_wrenches(&self.f, 1.0, &mut self.left);
        share_of_loads(&problem.load, self.left.iter().copied()) <= REST
    }

    /// None if it leads nowhere.
    fn step(&mut self) -> Option<()> {
        self.metric.factor(&self.f, PROXIMAL)?;
        self.change.fill(0.0);
        self.metric.take_up(&self.f, &mut self.left, &mut self.change);
        let pulls = self.change.iter().zip(&self.f).map(|(change, f)| -change / f).fold(0.0, f64::max);
        let length = if pulls < SHARE { 1.0 } else { SHARE / pulls };
        if !pulls.is_finite() || length < LEAST {
            return None;
        }
        self.f.iter_mut().zip(&self.change).for_each(|(f, change)| *f += length * change);
        Some(())
    }
}
