//! Friction cones as the hulls of finitely many edges.
//!
//! In the plane Coulomb's cone has two edges and is itself such a hull. In space it is round; k edges, evenly turned about the
//! normal, make a pyramid within it (*inscribed*: the edges lie on the cone) or around it (*circumscribed*: the faces touch
//! it). What stands within the inscribed pyramids stands; what falls within the circumscribed ones falls. The two
//! come together as 1 - cos(pi / k).

use crate::{
    bounds::MOST_FACETS,
    error::SceneError,
    geometry::{cross, dot, length},
};
use serde::{Deserialize, Serialize};

/// Which friction cones a question is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FrictionCone {
    /// Hulls of finitely many edges: the generators. In the plane these are Coulomb's own.
    #[default]
    Pyramid,
    /// Coulomb's round cones.
    Round,
}

/// Whether the pyramids lie within Coulomb's cones or around them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Bound {
    /// Within: a verdict "stands" is never due to the pyramid.
    #[default]
    Inscribed,
    /// Around: a verdict "falls" is never due to the pyramid.
    Circumscribed,
}

/// How round cones are replaced. In the plane there is nothing to replace.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cones {
    /// Edges of a cone, at least 3.
    pub facets: usize,
    /// Which side of the cone the pyramid is on.
    pub bound: Bound,
}

/// Edges of a cone without a choice: 7.6 % of the coefficient are left out in the worst direction.
pub const FACETS: usize = 8;

/// With a greater coefficient than this the normal joins the edges of a cone as one more generator in statics. It adds no force that they do not have; but a
/// load of 1 N straight down is mu N along each of two edges that all but cancel, so that with 1e6 there are no digits left of it.
/// With the normal, edges only bear what leans. (Without it, problems of pyramids end wrong from 1e3 on.)
pub const STEEP: f64 = 10.0;

impl Default for Cones {
    fn default() -> Self {
        Self { facets: FACETS, bound: Bound::Inscribed }
    }
}

impl Cones {
    /// # Errors
    /// [`SceneError::BadFacets`].
    pub(crate) fn check(self) -> Result<(), SceneError> {
        let known = (3..=MOST_FACETS).contains(&self.facets);
        if known { Ok(()) } else { Err(SceneError::BadFacets { facets: self.facets }) }
    }

    /// The coefficient at the edges of a cone in space.
    pub(crate) fn at_edges(self, friction: f64) -> f64 {
        match self.bound {
            Bound::Inscribed => friction,
            Bound::Circumscribed => friction / (std::f64::consts::PI / self.facets as f64).cos(),
        }
    }

    /// Unit vectors along the edges of a cone in space: the normal alone without friction. The first edge leans where
    /// gravity pulls along the contact's plane, so that a block about to slide straight down meets the cone itself.
    pub fn edges(self, normal: [f64; 3], friction: f64, gravity: [f64; 3]) -> Vec<[f64; 3]> {
        if friction == 0.0 {
            return vec![normal];
        }
        let mu = self.at_edges(friction);
        let scale = mu.hypot(1.0).recip();
        let [u, v] = tangents(normal, gravity);
        let edge = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / self.facets as f64).sin_cos();
            [0, 1, 2].map(|axis| (normal[axis] + mu * (cos * u[axis] + sin * v[axis])) * scale)
        };
        (0..self.facets).map(edge).collect()
    }

    /// What a force of one newton along a cone's axis is in each of its edges, newtons.
    pub fn axis_share(self, friction: f64) -> f64 {
        self.at_edges(friction).hypot(1.0) / self.facets as f64
    }
}

/// A share of gravity along the contact's plane below this one is rounding, and says nothing of a direction.
const LEVEL: f64 = 1e-6;

/// Two unit vectors square to the normal and to one another.
pub(crate) fn tangents(normal: [f64; 3], gravity: [f64; 3]) -> [[f64; 3]; 2] {
    let along = |v: [f64; 3]| {
        let across = dot(v, normal);
        [0, 1, 2].map(|k| v[k] - across * normal[k])
    };
    let mut first = along(gravity);
    if length(first) <= LEVEL * length(gravity) {
        // The axis of the world furthest from the normal; of equal ones the first.
        let furthest = (1..3).fold(0, |best, k| if normal[k].abs() < normal[best].abs() { k } else { best });
        let mut axis = [0.0; 3];
        axis[furthest] = 1.0;
        first = along(axis);
    }
    let scale = length(first).recip();
    let first = first.map(|x| x * scale);
    [first, cross(normal, first)]
}

/// The edges of a friction cone in the plane: the normal alone without friction, else the two directions at the angle of
/// friction on either side of it.
pub(crate) fn cone_edges([nx, ny]: [f64; 2], mu: f64) -> Vec<[f64; 2]> {
    if mu == 0.0 {
        return vec![[nx, ny]];
    }
    let length = mu.hypot(1.0);
    [mu, -mu].map(|side| [(nx - side * ny) / length, (ny + side * nx) / length]).to_vec()
}
