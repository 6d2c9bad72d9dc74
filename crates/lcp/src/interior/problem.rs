//! What is solved: bodies with masses and loads, and contact points between them.

use super::{
    method::{Found, Interior},
    scaled::Scaled,
};

/// Gauss's principle for bodies of 3 (in the plane) or 6 unknowns.
#[derive(Debug, Clone, Default)]
pub struct Gauss {
    /// Unknowns of one body.
    pub size: usize,
    /// Diagonal of `M^-1`, body after body: 1/kg, 1/(kg m^2).
    pub inverse_mass: Vec<f64>,
    /// `F`, body after body: N, N m.
    pub load: Vec<f64>,
    /// Where bodies touch.
    pub points: Vec<Point>,
    /// By how much each unknown of the cones may be negative, point after point, in the unit of J a; nowhere if empty: (1) is
    /// over `J a + offset` then.
    pub offset: Vec<f64>,
}

/// A contact point: how two bodies move relative to one another there, and which forces it can bear.
#[derive(Debug, Clone)]
pub struct Point {
    /// The bodies that move of the two.
    pub bodies: [Option<usize>; 2],
    /// For each of the two, three rows of as many entries as a body has unknowns: the relative motion along three
    /// directions is the sum of the rows times the bodies' accelerations, and a force with such components acts on the
    /// bodies by the columns. 1 and m.
    pub jacobian: [[[f64; 6]; 3]; 2],
    /// The forces that it can bear, in components along the three directions.
    pub cone: Cone,
}

/// The forces that a contact point can bear.
#[derive(Debug, Clone)]
pub enum Cone {
    /// Sums of these with factors that are not negative.
    Edges(Vec<[f64; 3]>),
    /// Coulomb's: `hypot(f_1, f_2) <= friction f_0`; friction is positive.
    Round {
        /// mu.
        friction: f64,
    },
}

impl Cone {
    /// Number of unknown forces: a magnitude for each edge, or three components.
    pub fn unknowns(&self) -> usize {
        match self {
            Self::Edges(edges) => edges.len(),
            Self::Round { .. } => 3,
        }
    }
}

impl Gauss {
    /// Solves it from nothing.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn solve(&self) -> Found {
        match self.size {
            3 => Interior::<3, 2>::new(Scaled::new(self)).solve(),
            6 => Interior::<6, 3>::new(Scaled::new(self)).solve(),
            size => panic!("a body has 3 or 6 unknowns, not {size}"),
        }
    }

    /// A basis of the forces that hold the bodies, from such forces, all of them positive: those that are positive where a
    /// cost is least that is close to one for each edge, but less for the last edge of the points that `straight` names. At
    /// most as many as there are rows; none where round cones are. None if the method does not come to an end.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn basis(&self, forces: &[f64], straight: impl Fn(usize) -> bool) -> Option<Vec<usize>> {
        let mut cost = Vec::with_capacity(forces.len());
        for (index, point) in self.points.iter().enumerate() {
            let Cone::Edges(edges) = &point.cone else { return None };
            for edge in 0..edges.len() {
                let factor = if edge + 1 == edges.len() && straight(index) { STRAIGHT } else { 1.0 };
                cost.push(factor * (1.0 + (cost.len() as f64 * GOLDEN).fract()));
            }
        }
        match self.size {
            3 => Interior::<3, 2>::of_least_cost(Scaled::new(self), forces, cost).basis(),
            6 => Interior::<6, 3>::of_least_cost(Scaled::new(self), forces, cost).basis(),
            size => panic!("a body has 3 or 6 unknowns, not {size}"),
        }
    }
}

/// Effort of an equilibrium solver ([`ConeSolver::effort`](crate::cone::ConeSolver::effort)) on so many bodies of so many unknowns
/// beyond which this method takes less time than the pivots that follow. A number of operations, so that no clock decides.
/// Measured: docs/theory/interior-point.md.
pub fn worth_of_pivots(size: usize, bodies: usize) -> usize {
    let of_a_body = if size == 3 { 2_000 } else { 50_000 };
    of_a_body * (bodies + 16)
}

/// Multiples of the golden ratio's fraction are spread evenly and never repeat: no two sums of such costs are the same.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Cost of a force straight across a joint, so that what stands by straight pressure is held by it.
const STRAIGHT: f64 = 0.25;
