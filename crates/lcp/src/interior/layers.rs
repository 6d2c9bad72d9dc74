//! Elastic layers between bodies: what makes contact forces unique.
//!
//! Of all forces that balance some loads those of least norm are wanted,
//!
//! ```text
//! min 1/2 sum_k W_k' Q_k W_k   over   J' f = -F,  W_k = B_k f,  f in K                     (4)
//! ```
//!
//! with the wrench W of each layer, the sum of the forces at its points, and its compliance Q. With the layer's motion
//! `u = Q W` for a multiplier, the optimality conditions of (4) are those of Gauss's principle,
//!
//! ```text
//! -J' f = F,   Q^-1 u - B' f = 0,   s = J y + B u,   f in K,  s in K*,  f' s = 0
//! ```
//!
//! for bodies without mass and one more body for each layer, of mass `Q^-1`, that every one of its points moves with. So the same
//! method solves it. Since Q is positive definite, W is unique, but f need not be.

use super::problem::Gauss;

/// The layers between the bodies of a [`Gauss`] problem.
#[derive(Debug, Clone, Default)]
pub struct Layers {
    /// Diagonal of `Q^-1`, layer after layer, as many numbers as a body has unknowns. All in any one unit of stiffness.
    pub stiffness: Vec<f64>,
    /// The layer of each point.
    pub of: Vec<usize>,
    /// For each point three rows: a force with components along the point's three directions is the wrench on its layer
    /// by the columns. 1 and m.
    pub jacobian: Vec<[[f64; 6]; 3]>,
}

impl Layers {
    /// Q in the unit in which layers give way about as easily as bodies do: no answer depends on it, and numbers stay near one.
    pub(super) fn compliance(&self, problem: &Gauss) -> Vec<f64> {
        let size = problem.size;
        let ease = |rows: &[[f64; 6]; 3], inverse: &[f64]| -> f64 {
            rows.iter().flat_map(|row| row.iter().zip(inverse)).map(|(x, inverse)| x * x * inverse).sum()
        };
        let compliance: Vec<f64> = self.stiffness.iter().map(|stiffness| stiffness.recip()).collect();
        let (mut of_bodies, mut of_layers) = (0.0, 0.0);
        for (index, point) in problem.points.iter().enumerate() {
            for (body, rows) in point.bodies.iter().zip(&point.jacobian) {
                of_bodies += body.map_or(0.0, |body| ease(rows, &problem.inverse_mass[body * size..][..size]));
            }
            of_layers += ease(&self.jacobian[index], &compliance[self.of[index] * size..][..size]);
        }
        let factor = if of_layers > 0.0 { of_bodies / of_layers } else { 1.0 };
        compliance.into_iter().map(|compliance| compliance * factor).collect()
    }
}
