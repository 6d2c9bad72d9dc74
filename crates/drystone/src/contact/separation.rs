//! How far two convex polyhedra are apart: separating axes.
//!
//! Two convex polyhedra are disjoint exactly when a plane parts them that is parallel to a face of one, or to an edge of
//! each. Of the pairs of edges only those count whose normals' arcs cross on the unit sphere: the others are no edge of the
//! Minkowski difference (D. Gregorius, "The separating axis test between convex polyhedra", 2013).

use crate::{
    geometry::{Edge, Polyhedron, Vector3},
    interrupt::poll,
};

/// A plane that parts two polyhedra best, or along which their overlap is least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Separation {
    /// Metres; negative by the depth of an overlap.
    pub distance: f64,
    /// Unit vector from the first into the second.
    pub normal: Vector3,
    pub between: Between,
}

/// What the plane is parallel to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Between {
    FaceOfA(usize),
    FaceOfB(usize),
    Edges(Edge, Edge),
}

/// The greatest separation along a face's normal. `b` stands at `offset` from `a`. Of equal faces the first, a's before b's,
/// and a's too where b's is greater by no more than `bias`, metres.
pub(super) fn along_faces(a: &Polyhedron, b: &Polyhedron, offset: Vector3, bias: f64) -> Separation {
    let (face_a, distance_a) = greatest(a, b, offset);
    let (face_b, distance_b) = greatest(b, a, -offset);
    if distance_a + bias >= distance_b {
        Separation { distance: distance_a, normal: a.normals()[face_a], between: Between::FaceOfA(face_a) }
    } else {
        Separation { distance: distance_b, normal: -b.normals()[face_b], between: Between::FaceOfB(face_b) }
    }
}

/// Every plane that may part the two: their Minkowski difference's faces.
pub(super) fn planes(a: &Polyhedron, b: &Polyhedron, offset: Vector3) -> Vec<Separation> {
    let of = |normal: Vector3, between| Separation { distance: gap_along(normal, a, b, offset), normal, between };
    let of_a = a.normals().iter().enumerate().map(|(face, normal)| of(*normal, Between::FaceOfA(face)));
    let of_b = b.normals().iter().enumerate().map(|(face, normal)| of(-*normal, Between::FaceOfB(face)));
    let mut planes: Vec<Separation> = of_a.chain(of_b).collect();
    for_each_crossing(a, b, |edge_a, edge_b, normal| planes.push(of(normal, Between::Edges(*edge_a, *edge_b))));
    planes
}

fn greatest(reference: &Polyhedron, other: &Polyhedron, offset: Vector3) -> (usize, f64) {
    let mut best = (0, f64::NEG_INFINITY);
    poll(reference.faces().len() * other.vertices().len());
    for (face, (normal, corners)) in reference.normals().iter().zip(reference.faces()).enumerate() {
        let own = normal.dot(reference.vertices()[corners[0]] - offset);
        let nearest = other.vertices().iter().map(|v| normal.dot(*v)).fold(f64::INFINITY, f64::min);
        if nearest - own > best.1 {
            best = (face, nearest - own);
        }
    }
    best
}

/// Edges whose directions differ by less than this angle, in radians, span no plane of their own: the faces beside them
/// part the polyhedra as well, to within rounding.
const PARALLEL: f64 = 1e-9;

/// The greatest separation along a direction square to an edge of each, if there is such a pair.
pub(super) fn along_edges(a: &Polyhedron, b: &Polyhedron, offset: Vector3) -> Option<Separation> {
    let mut best: Option<Separation> = None;
    for_each_crossing(a, b, |edge_a, edge_b, normal| {
        let (on_a, on_b) = (a.vertices()[edge_a.ends[0]], b.vertices()[edge_b.ends[0]] + offset);
        let better = |distance: f64| best.is_none_or(|best| distance > best.distance);
        // Where rounding takes arcs to cross that do not, the edges are not the outermost: all corners decide.
        let distance = normal.dot(on_b - on_a);
        if better(distance) && better(gap_along(normal, a, b, offset)) {
            let distance = gap_along(normal, a, b, offset);
            best = Some(Separation { distance, normal, between: Between::Edges(*edge_a, *edge_b) });
        }
    });
    best
}

/// Operations to look at a pair of edges, about, and after how many there is a question whether to go on.
const CROSSING: usize = 16;
const LONG: usize = 1 << 16;

/// The pairs of edges that span a face of the Minkowski difference, with its unit normal out of `a`.
fn for_each_crossing<'a>(a: &'a Polyhedron, b: &'a Polyhedron, mut found: impl FnMut(&'a Edge, &'a Edge, Vector3)) {
    let mut work = 0;
    for edge_a in a.edges() {
        work += CROSSING * b.edges().len();
        if work > LONG {
            poll(std::mem::take(&mut work));
        }
        let along_a = direction(a, edge_a);
        let [a0, a1] = edge_a.faces.map(|face| a.normals()[face]);
        for edge_b in b.edges() {
            let [b0, b1] = edge_b.faces.map(|face| -b.normals()[face]);
            let along_b = direction(b, edge_b);
            if !arcs_cross([a0, a1], along_a, [b0, b1], along_b) {
                continue;
            }
            let across = along_a.cross(along_b);
            let sine = across.length();
            if sine > PARALLEL {
                // Out of a: on the side of the faces beside its edge.
                found(edge_a, edge_b, if across.dot(a0 + a1) < 0.0 { -across / sine } else { across / sine });
            }
        }
    }
    poll(work);
}

/// How far b lies beyond a along a direction, metres.
fn gap_along(normal: Vector3, a: &Polyhedron, b: &Polyhedron, offset: Vector3) -> f64 {
    normal.dot(offset) + b.span(normal)[0] - a.span(normal)[1]
}

/// Unit vector along an edge.
pub(super) fn direction(of: &Polyhedron, edge: &Edge) -> Vector3 {
    let [from, to] = edge.ends.map(|k| of.vertices()[k]);
    (to - from).normalize_or_zero()
}

/// Whether the arc between the normals beside one edge crosses that between those beside another. An edge's direction is
/// square to both of its normals, so that it tells the side of its arc's plane. An end that lies on the other's plane to
/// within [`PARALLEL`] does not count: there a face's normal parts the polyhedra as well.
fn arcs_cross([a0, a1]: [Vector3; 2], along_a: Vector3, [b0, b1]: [Vector3; 2], along_b: Vector3) -> bool {
    let (b0_side, b1_side) = (b0.dot(along_a), b1.dot(along_a));
    let (a0_side, a1_side) = (a0.dot(along_b), a1.dot(along_b));
    // Each arc has its ends on both sides of the other's plane, and they lie on the same half of the sphere.
    let triple = |u: Vector3, v: Vector3, w: Vector3| u.cross(v).dot(w);
    let same_half = triple(a0, a1, b1) * triple(b1, b0, a1) > 0.0;
    let both_sides = |x: f64, y: f64| x * y < 0.0 && x.abs().min(y.abs()) > PARALLEL;
    both_sides(a0_side, a1_side) && both_sides(b0_side, b1_side) && same_half
}
