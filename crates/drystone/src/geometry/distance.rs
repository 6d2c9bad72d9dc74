//! How far two convex pieces are apart.

use super::{Piece, minus};
use parry3d_f64::{
    math::{Pose, Vector},
    query::details::distance_support_map_support_map,
    shape::SupportMap,
};

/// Corners in units of a length near theirs: the search knows absolute tolerances of about one.
struct Corners(Vec<Vector>);

impl SupportMap for Corners {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let further = |best: Vector, v: &Vector| if v.dot(direction) > best.dot(direction) { *v } else { best };
        self.0.iter().skip(1).fold(self.0[0], further)
    }
}

/// Distance of the hulls of two pieces, metres; zero where they meet. `origin` is a point near the first, `unit` a length near its
/// size, metres.
pub(crate) fn distance(a: &Piece, b: &Piece, origin: [f64; 3], unit: f64) -> f64 {
    let corners = |piece: &Piece| {
        let scaled = |v: &[f64; 3]| Vector::from_array(minus(*v, origin).map(|x| x / unit));
        Corners(piece.vertices().iter().map(scaled).collect())
    };
    unit * distance_support_map_support_map(&Pose::IDENTITY, &corners(a), &corners(b))
}
