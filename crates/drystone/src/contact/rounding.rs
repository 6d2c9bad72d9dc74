//! The normal of a touch at borders: the limit of small roundings.
//!
//! Where corners and edges meet corners and edges, many planes part the bodies, and sharp ones have no normal. Real ones are
//! rounded: each is its *core*, the body shrunk by r, grown by r again. Then there is one normal, along the line between the
//! nearest points of the two cores. With r = 1 and where they touch at the origin,
//!
//! ```text
//!     core of a = { x : f . x <= -1 for every face f of a there },    its point nearest to the origin -m(a),
//!     q = m(a) - m(b)  is what parts the two corners of the cores, and  n = the point nearest to q in N,
//!     N = { n : n . t <= 0 for every direction t into a,  n . t >= 0 for every t into b }
//! ```
//!
//! N are the normals of all planes that part the bodies there. If two faces make an edge, or three a corner, n is exactly the
//! direction between the nearest points of the cores (Moreau: what is nearest to the origin in q plus a cone is the part of q in
//! its polar). A corner of more faces is taken for one whose core ends in m.

use crate::geometry::Vector3;

/// A convex body near one point of its border.
#[derive(Debug, Clone, Default)]
pub(super) struct Local {
    /// Outward unit normals of the faces there.
    pub faces: Vec<Vector3>,
    /// Unit vectors that span all directions into the body or along its border.
    pub into: Vec<Vector3>,
}

impl Local {
    /// The same with all that lies along a direction taken away, for a whole edge in it.
    pub fn across(mut self, along: Vector3) -> Self {
        let flat = |v: &Vector3| *v - v.dot(along) * along;
        // What is left of a direction that is the edge's own is rounding.
        let kept = |v: Vector3| (v.length() > LEVEL).then(|| v.normalize());
        self.faces = self.faces.iter().map(flat).filter_map(kept).collect();
        self.into = self.into.iter().map(flat).filter_map(kept).collect();
        self
    }
}

/// Radians. Planes that differ by less are level with one another: to be within the contact tolerance, a millionth of a block,
/// faces may be turned by this over a thousandth of its width.
pub(super) const LEVEL: f64 = 1e-3;

/// Distance by which a unit normal, or a core of radius one, may miss a constraint: far above rounding, far below [`LEVEL`].
const MISS: f64 = 1e-9;

/// The planes that part two bodies where they touch at borders.
#[derive(Debug, Clone)]
pub(super) struct Parting {
    /// That of the limit of small roundings: a unit vector from the first into the second.
    pub normal: Vector3,
    /// A unit normal n parts them if n . c >= 0 for each of these.
    cone: Vec<Vector3>,
}

impl Parting {
    /// None if no plane parts them.
    pub fn of(a: &Local, b: &Local) -> Option<Self> {
        let cone: Vec<Vector3> = a.into.iter().map(|t| -*t).chain(b.into.iter().copied()).collect();
        let corner = |local: &Local| nearest(Vector3::ZERO, &local.faces, 1.0);
        let normal = nearest(corner(a)? - corner(b)?, &cone, 0.0)?;
        // Cores of radius one are apart by two at least along every normal that parts the bodies.
        (normal.length() > 1.0).then(|| Self { normal: normal.normalize(), cone })
    }

    /// Whether a plane with this unit normal parts them, within [`LEVEL`].
    pub fn holds(&self, normal: Vector3) -> bool {
        self.cone.iter().all(|c| c.dot(normal) >= -LEVEL)
    }
}

/// The point x nearest to q with c . x >= bound for all unit vectors c, if there is one.
///
/// At most three of them decide. They are found by taking in, one after the other, the one that x misses most, and keeping of
/// those four the three that decide; the distance grows each time, so that it ends.
fn nearest(q: Vector3, constraints: &[Vector3], bound: f64) -> Option<Vector3> {
    let missed = |x: Vector3, c: &Vector3| bound - c.dot(x);
    let (mut x, mut deciding) = (q, Vec::new());
    loop {
        let worst = constraints.iter().max_by(|c, d| missed(x, c).total_cmp(&missed(x, d)));
        let Some(worst) = worst.filter(|c| missed(x, c) > MISS) else { return Some(x) };
        deciding.push(*worst);
        let (next, kept) = nearest_of_few(q, &deciding, bound)?;
        if next.distance(q) <= x.distance(q) {
            return None;
        }
        (x, deciding) = (next, kept);
    }
}

/// [`nearest`] for up to four constraints, and those that decide.
fn nearest_of_few(q: Vector3, constraints: &[Vector3], bound: f64) -> Option<(Vector3, Vec<Vector3>)> {
    let mut best: Option<(Vector3, Vec<Vector3>)> = None;
    for chosen in 1..1_usize << constraints.len() {
        let some: Vec<Vector3> =
            (0..constraints.len()).filter(|k| chosen >> k & 1 == 1).map(|k| constraints[k]).collect();
        let Some(x) = on_planes(q, &some, bound) else { continue };
        let keeps = constraints.iter().all(|c| bound - c.dot(x) <= MISS);
        if keeps && best.as_ref().is_none_or(|(known, _)| x.distance(q) < known.distance(q)) {
            best = Some((x, some));
        }
    }
    best
}

/// The point nearest to q with c . x = bound for up to three unit vectors c, if these are independent.
fn on_planes(q: Vector3, planes: &[Vector3], bound: f64) -> Option<Vector3> {
    match *planes {
        [c] => Some(q + (bound - c.dot(q)) * c),
        [c, d] => {
            let (cosine, [to_c, to_d]) = (c.dot(d), [c, d].map(|c| bound - c.dot(q)));
            let square = c.cross(d).length_squared();
            let step = (to_c - cosine * to_d) * c + (to_d - cosine * to_c) * d;
            (square > MISS * MISS).then(|| q + step / square)
        }
        [c, d, e] => {
            let volume = c.dot(d.cross(e));
            (volume.abs() > MISS).then(|| bound * (d.cross(e) + e.cross(c) + c.cross(d)) / volume)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner_at(angles: [f64; 2]) -> Local {
        // In the plane, faces that look in these directions (radians); the third axis is free.
        let at = |angle: f64| Vector3::new(angle.cos(), angle.sin(), 0.0);
        let [low, high] = angles;
        let quarter = std::f64::consts::FRAC_PI_2;
        Local { faces: vec![at(low), at(high)], into: vec![at(low - quarter), at(high + quarter)] }
    }

    #[test]
    fn mirrored_corners_have_the_mirror_as_their_plane() {
        for lean in [0.1, 0.5, 0.75, 1.2] {
            let left = corner_at([-lean, std::f64::consts::FRAC_PI_2 - lean]);
            let right = corner_at([std::f64::consts::FRAC_PI_2 + lean, std::f64::consts::PI + lean]);
            let normal = Parting::of(&left, &right).map(|parting| parting.normal);
            assert!(normal.is_some_and(|n| n.distance(Vector3::X) < 1e-12), "{lean}: {normal:?}");
        }
    }

    #[test]
    fn bodies_that_no_plane_parts_have_no_normal() {
        let corner = corner_at([0.0, 1.5]);
        assert!(Parting::of(&corner, &corner).is_none());
    }
}
