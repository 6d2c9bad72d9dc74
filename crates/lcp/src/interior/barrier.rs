//! What forces inside the cones tell of other loads, for bodies in the plane or in space (`metric.rs`).

use super::{metric::Metric, problem::Gauss, walk::Walked};

/// The metric of a problem, analysed once.
#[derive(Debug)]
pub struct Barrier {
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    Plane(Box<Metric<3, 2>>),
    Space(Box<Metric<6, 3>>),
}

impl Barrier {
    /// None if there is no memory for it.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn new(problem: &Gauss) -> Option<Self> {
        let kind = match problem.size {
            3 => Kind::Plane(Box::new(Metric::new(problem)?)),
            6 => Kind::Space(Box::new(Metric::new(problem)?)),
            size => panic!("a body has 3 or 6 unknowns, not {size}"),
        };
        Some(Self { kind })
    }

    /// The least changes of forces inside the cones, point after point, for some loads, each body after body. None if some body could
    /// not be held by such forces whatever they were.
    pub fn changes(&mut self, forces: &[f64], loads: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        match &mut self.kind {
            Kind::Plane(metric) => metric.changes(forces, loads),
            Kind::Space(metric) => metric.changes(forces, loads),
        }
    }

    /// From forces inside the cones that hold the bodies under a load, body after body, as far as they can follow `more`, or to all
    /// of it. None where that leads nowhere, which proves nothing.
    pub fn walk(&mut self, forces: &[f64], load: &[f64], more: &[f64]) -> Option<Walked> {
        match &mut self.kind {
            Kind::Plane(metric) => metric.walk(forces, load, more),
            Kind::Space(metric) => metric.walk(forces, load, more),
        }
    }
}
