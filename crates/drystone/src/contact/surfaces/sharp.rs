//! Where an edge or a vertex of one surface touches another: on a face, or across an edge.

use super::{
    nearest::closest,
    pair::Pair,
    point::{Found, Lying, Plane},
};
use crate::{
    geometry::{Surface, SurfaceEdge, Vector3},
    interrupt::poll,
};

/// Radians. An edge that turns by more is sharp: what touches it only there has no normal but that of slightly rounded ones. With
/// less it is a seam of a curved surface.
const SHARP: f64 = super::facing::CONFORM;

/// Radians. Edges that turn by less are no edges.
const BENT: f64 = 1e-7;

/// The bisector of what touches a face looks against the face by at least this cosine.
const AGAINST: f64 = 0.02;

/// An edge lies on a face if all of it over the face is within tolerance, over more than so many tolerances. One that leaves the
/// tolerance there touches the face with its vertex, unless it does so by less than the angle [`LEVEL`].
const LYING: f64 = 2.0;

/// Radians.
const LEVEL: f64 = super::facing::LEVEL;

/// Radians: edges that cross at less have no normal of their own.
const PARALLEL: f64 = 1e-6;

/// Operations to look at a pair of triangles, about.
const LOOK: usize = 200;

/// Points at edges and vertices, for pairs of triangles that do not lie on each other.
pub(super) fn sharp(pair: &Pair, candidates: &[[u32; 2]], lying: &Lying) -> Vec<Found> {
    let mut found = Vec::new();
    for &[ta, tb] in candidates {
        poll(LOOK);
        if lying.contains(&[ta, tb]) {
            continue; // so do their edges and vertices
        }
        for side in [0, 1] {
            let (own, against) = if side == 0 { (ta, tb) } else { (tb, ta) };
            let on = Over::of(pair, side, own, against);
            if on.is_clear() {
                continue;
            }
            on.edges(lying, &mut found);
            on.vertices(lying, &mut found);
        }
        crossings(pair, [ta, tb], lying, &mut found);
    }
    found
}

/// A triangle of one surface over a triangle of the other.
struct Over<'a> {
    pair: &'a Pair<'a>,
    side: usize,
    own: u32,
    against: u32,
    one: &'a Surface,
    other: &'a Surface,
    /// Of the other's triangle, seen from the first surface of the pair.
    corners: [Vector3; 3],
    normal: Vector3,
    /// Of the first surface of the two, if it is the second of the pair.
    shift: Vector3,
}

impl<'a> Over<'a> {
    fn of(pair: &'a Pair, side: usize, own: u32, against: u32) -> Self {
        let [one, other] = [pair.surfaces[side], pair.surfaces[1 - side]];
        let (shift, at) = if side == 0 { (Vector3::ZERO, pair.offset) } else { (pair.offset, Vector3::ZERO) };
        let corners = other.corners(against).map(|p| p + at);
        Self { pair, side, own, against, one, other, corners, normal: other.normal(against), shift }
    }

    fn vertex(&self, number: u32) -> Vector3 {
        self.one.vertices()[number as usize] + self.shift
    }

    fn height(&self, point: Vector3) -> f64 {
        self.normal.dot(point - self.corners[0])
    }

    /// Whether all of the triangle is on one side of the other's plane, beyond the tolerance.
    fn is_clear(&self) -> bool {
        let heights = self.one.triangles()[self.own as usize].map(|vertex| self.height(self.vertex(vertex)));
        let beyond = |sign: f64| heights.iter().all(|height| sign * height > self.pair.tolerance);
        beyond(1.0) || beyond(-1.0)
    }

    /// How far a point is within each side of the triangle, metres.
    fn inwards(&self, point: Vector3) -> [f64; 3] {
        [0, 1, 2].map(|k| {
            let along = self.corners[(k + 1) % 3] - self.corners[k];
            self.normal.cross(along).normalize_or_zero().dot(point - self.corners[k])
        })
    }

    /// Whether a point of the triangle is at a sharp border, beyond which the surface falls away.
    fn is_at_border(&self, point: Vector3) -> bool {
        let tolerance = self.pair.tolerance;
        let sides = self.other.sides(self.against).into_iter().zip(self.inwards(point));
        let at_side =
            |(side, distance): (u32, f64)| distance <= tolerance && self.other.edges()[side as usize].turn > SHARP;
        let corners = self.other.triangles()[self.against as usize].into_iter().zip(self.corners);
        let at_tip =
            |(vertex, corner): (u32, Vector3)| corner.distance(point) <= tolerance && is_tip(self.other, vertex);
        sides.into_iter().any(at_side) || corners.into_iter().any(at_tip)
    }

    fn is_lying(&self, own: u32, lying: &Lying) -> bool {
        lying.contains(&if self.side == 0 { [own, self.against] } else { [self.against, own] })
    }

    /// The outward normal of the other surface at a point of the triangle: along a seam of a curved surface that of neither facet.
    fn smooth_normal(&self, point: Vector3) -> Option<Vector3> {
        let tolerance = self.pair.tolerance;
        let corners = self.other.triangles()[self.against as usize].into_iter().zip(self.corners);
        let at_corner = corners.into_iter().find(|(_, corner)| corner.distance(point) <= tolerance);
        if let Some((vertex, _)) = at_corner {
            let hollow = self.other.edges_at(vertex).any(|edge| edge.turn < -SHARP);
            return (!hollow).then(|| self.other.corner_normal(vertex).normalize_or_zero());
        }
        let sides = self.other.sides(self.against).into_iter().zip(self.inwards(point));
        let near = sides.into_iter().find(|&(_, distance)| distance <= tolerance);
        let edge = self.other.edges()[near?.0 as usize];
        let bent = edge.turn.abs() > BENT && edge.turn.abs() <= SHARP;
        bent.then(|| edge.triangles.into_iter().map(|t| self.other.normal(t)).sum::<Vector3>().normalize_or_zero())
    }

    /// A point of the one on the other, which has the normal of the triangle unless `at` a seam.
    fn found(&self, point: Vector3, at: Vector3) -> Found {
        let gap = self.height(point);
        let face = self.other.face(self.against);
        let seam = self.smooth_normal(at);
        let normal = seam.unwrap_or(self.normal);
        let plane = if self.side == 0 { Plane::OfB(face) } else { Plane::OfA(face) };
        let bits = |v: Vector3| v.to_array().map(|x| (x + 0.0).to_bits());
        Found {
            plane: seam.map_or(plane, |normal| Plane::Seam(bits(normal))),
            point: point - 0.5 * gap * self.normal,
            normal: if self.side == 0 { -normal } else { normal },
            gap,
            triangles: if self.side == 0 { [self.own, self.against] } else { [self.against, self.own] },
        }
    }

    /// Edges that lie on the triangle: the ends of the part that does.
    fn edges(&self, lying: &Lying, found: &mut Vec<Found>) {
        let tolerance = self.pair.tolerance;
        for side in self.one.sides(self.own) {
            let edge = self.one.edges()[side as usize];
            if edge.triangles[0] != self.own
                || edge.turn < BENT
                || edge.triangles.iter().any(|&t| self.is_lying(t, lying))
            {
                continue;
            }
            let out: Vector3 = edge.triangles.into_iter().map(|t| self.one.normal(t)).sum();
            if out.normalize_or_zero().dot(self.normal) > -AGAINST {
                continue;
            }
            let [from, to] = edge.ends.map(|k| self.vertex(k));
            let Some([start, end]) = self.part_on([from, to]) else { continue };
            let at = |share: f64| from + share * (to - from);
            let middle = at(0.5 * (start + end));
            if (end - start) * from.distance(to) <= LYING * tolerance || self.is_at_border(middle) {
                continue;
            }
            found.extend([self.found(at(start), middle), self.found(at(end), middle)]);
        }
    }

    /// The part of a segment over the triangle and within tolerance of its plane, as shares of the segment.
    fn part_on(&self, [from, to]: [Vector3; 2]) -> Option<[f64; 2]> {
        let tolerance = self.pair.tolerance;
        let (first, last) = (self.inwards(from), self.inwards(to));
        let (low, high) = (self.height(from), self.height(to));
        let over = limited([0.0, 1.0], (0..3).map(|k| [first[k], last[k]]))?;
        let heights = [[tolerance - low, tolerance - high], [tolerance + low, tolerance + high]];
        let part = limited(over, heights)?;
        let level = (high - low).abs() <= LEVEL * from.distance(to);
        (part == over || level).then_some(part)
    }

    /// Vertices on the triangle, but for its sharp borders.
    fn vertices(&self, lying: &Lying, found: &mut Vec<Found>) {
        let tolerance = self.pair.tolerance;
        for vertex in self.one.triangles()[self.own as usize] {
            // Whatever a vertex is near to, all triangles at it are: the first of them looks.
            let point = self.vertex(vertex);
            if self.one.owner(vertex) != self.own || self.height(point).abs() > tolerance {
                continue;
            }
            let mut bent = self.one.edges_at(vertex).filter(|edge| edge.turn > BENT).peekable();
            let over = self.inwards(point).into_iter().all(|distance| distance >= -1e-3 * tolerance);
            if bent.peek().is_none() || !over || self.is_at_border(point) {
                continue;
            }
            let out = self.one.corner_normal(vertex).normalize_or_zero();
            if out.dot(self.normal) > -AGAINST || self.lies_about(vertex, lying) {
                continue;
            }
            found.push(self.found(point, point));
        }
    }

    /// Whether a triangle at a vertex lies on the other's.
    fn lies_about(&self, vertex: u32, lying: &Lying) -> bool {
        self.one.edges_at(vertex).flat_map(|edge| edge.triangles).any(|t| self.is_lying(t, lying))
    }
}

/// The part of a segment where affine functions, given by their values at its ends, are not negative.
fn limited(mut part: [f64; 2], values: impl IntoIterator<Item = [f64; 2]>) -> Option<[f64; 2]> {
    for [here, there] in values {
        match (here >= 0.0, there >= 0.0) {
            (true, true) => {}
            (false, false) => return None,
            (false, true) => part[0] = part[0].max(here / (here - there)),
            (true, false) => part[1] = part[1].min(here / (here - there)),
        }
    }
    (part[0] < part[1]).then_some(part)
}

/// Whether a vertex is the end of a sharp edge, or the tip of a cone.
fn is_tip(surface: &Surface, vertex: u32) -> bool {
    let turns = || surface.edges_at(vertex).map(|edge| edge.turn);
    if turns().any(|turn| turn > SHARP) {
        return true;
    }
    let out = surface.corner_normal(vertex).normalize_or_zero();
    let spread = surface.edges_at(vertex).flat_map(|edge| edge.triangles).map(|t| surface.normal(t).dot(out));
    !turns().any(|turn| turn < -SHARP) && spread.fold(1.0, f64::min) < SHARP.cos()
}

/// The point where two edges cross, if a plane along both parts the surfaces there.
fn crossings(pair: &Pair, [ta, tb]: [u32; 2], lying: &Lying, found: &mut Vec<Found>) {
    let [a, b] = pair.surfaces;
    let bent = |of: &'_ Surface, triangle: u32| {
        let edges = of.sides(triangle).map(|side| of.edges()[side as usize]);
        edges.into_iter().filter(move |edge| edge.triangles[0] == triangle && edge.turn > BENT)
    };
    for of_a in bent(a, ta) {
        for of_b in bent(b, tb) {
            found.extend(crossing(pair, [of_a, of_b], [ta, tb], lying));
        }
    }
}

fn crossing(pair: &Pair, [of_a, of_b]: [SurfaceEdge; 2], triangles: [u32; 2], lying: &Lying) -> Option<Found> {
    let [a, b] = pair.surfaces;
    let ends_a = of_a.ends.map(|k| a.vertices()[k as usize]);
    let ends_b = of_b.ends.map(|k| b.vertices()[k as usize] + pair.offset);
    let shares = closest(ends_a, ends_b);
    let at = |[from, to]: [Vector3; 2], share: f64| from + share * (to - from);
    let (on_a, on_b) = (at(ends_a, shares[0]), at(ends_b, shares[1]));
    if on_a.distance(on_b) > pair.tolerance {
        return None;
    }
    if of_a.triangles.iter().any(|&t| of_b.triangles.iter().any(|&s| lying.contains(&[t, s]))) {
        return None;
    }
    let [along_a, along_b] = [ends_a, ends_b].map(|[from, to]| (to - from).normalize_or_zero());
    let across = along_a.cross(along_b);
    if across.length() < PARALLEL {
        return None;
    }
    let out: Vector3 = of_a.triangles.into_iter().map(|t| a.normal(t)).sum();
    let normal = across.normalize() * if across.dot(out) < 0.0 { -1.0 } else { 1.0 };
    let goes_on = is_within(a, &of_a, ends_a, shares[0], pair.tolerance)
        && is_within(b, &of_b, ends_b, shares[1], pair.tolerance);
    if !goes_on || !is_outside(a, &of_a, normal) || !is_outside(b, &of_b, -normal) {
        return None;
    }
    Some(Found {
        plane: Plane::Across(of_a.ends, of_b.ends),
        point: on_a.midpoint(on_b),
        normal,
        gap: normal.dot(on_b - on_a),
        triangles,
    })
}

/// Whether a place on an edge is not an end of it, or one where another edge goes on.
fn is_within(of: &Surface, edge: &SurfaceEdge, ends: [Vector3; 2], share: f64, tolerance: f64) -> bool {
    let length = ends[0].distance(ends[1]);
    let at_end = [share * length <= tolerance, (1.0 - share) * length <= tolerance];
    (0..2).all(|k| {
        let along = (ends[1 - k] - ends[k]).normalize_or_zero();
        let number = edge.ends[k];
        let on = |other: &SurfaceEdge| {
            let far = if other.ends[0] == number { other.ends[1] } else { other.ends[0] };
            let way = of.vertices()[far as usize] - of.vertices()[number as usize];
            other.turn > BENT && way.normalize_or_zero().dot(along) < -SHARP.cos()
        };
        !at_end[k] || of.edges_at(number).any(on)
    })
}

/// Whether a plane along an edge with this normal leaves the surface behind it.
fn is_outside(of: &Surface, edge: &SurfaceEdge, normal: Vector3) -> bool {
    let [from, to] = edge.ends.map(|k| of.vertices()[k as usize]);
    let along = (to - from).normalize_or_zero();
    let [first, second] = edge.triangles.map(|t| of.normal(t));
    first.cross(normal).dot(along) > -PARALLEL && normal.cross(second).dot(along) > -PARALLEL
}
