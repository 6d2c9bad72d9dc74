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
    let arcs_of_b: Vec<Arc> = b.edges().iter().map(|edge| Arc::of(b, edge, -1.0)).collect();
    let mut work = 0;
    for edge_a in a.edges() {
        work += CROSSING * b.edges().len();
        if work > LONG {
            poll(std::mem::take(&mut work));
        }
        let arc_a = Arc::of(a, edge_a, 1.0);
        for (edge_b, arc_b) in b.edges().iter().zip(&arcs_of_b) {
            if !arc_a.crosses(arc_b) {
                continue;
            }
            let across = arc_a.along.cross(arc_b.along);
            let sine = across.length();
            if sine > PARALLEL {
                // Out of a: on the side of the faces beside its edge.
                let [a0, a1] = arc_a.ends;
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

/// The arc between the normals of the faces beside an edge, on the unit sphere.
struct Arc {
    ends: [Vector3; 2],
    /// Unit vector along the edge, square to both ends: it tells the sides of the arc's plane.
    along: Vector3,
    /// The cross product of the ends, along the edge.
    turn: f64,
}

impl Arc {
    /// With the normals times `sign`.
    fn of(piece: &Polyhedron, edge: &Edge, sign: f64) -> Self {
        let ends = edge.faces.map(|face| sign * piece.normals()[face]);
        let along = direction(piece, edge);
        Self { ends, along, turn: ends[0].cross(ends[1]).dot(along) }
    }

    /// Whether each has its ends on both sides of the other's plane, and on the same half of the sphere. An end that lies on the other's plane to
    /// within [`PARALLEL`] does not count: there a face's normal parts the polyhedra as well.
    fn crosses(&self, other: &Self) -> bool {
        let both_sides = |x: f64, y: f64| x * y < 0.0 && x.abs().min(y.abs()) > PARALLEL;
        let [b0, b1] = other.ends.map(|end| end.dot(self.along));
        if !both_sides(b0, b1) {
            return false;
        }
        let [a0, a1] = self.ends.map(|end| end.dot(other.along));
        // The triple products (a0 x a1) b1 and (b1 x b0) a1 have one sign.
        both_sides(a0, a1) && self.turn * b1 * other.turn * a1 < 0.0
    }
}
