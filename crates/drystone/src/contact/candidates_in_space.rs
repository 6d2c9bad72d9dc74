//! Where solids may meet within a time step: the polygon of a face before a face, and edges that cross.
//!
//! Of two convex pieces the plane that parts them best (`separation.rs`) says how they can meet first. If it is a face of one,
//! the points are the corners of what that face shares, seen along its normal, with the other's most opposed face
//! (`shared_face.rs`), each as far away as it is. If it is square to an edge of each, the point is where the two cross.
//!
//! Where nothing is before that face, the pieces may yet meet on their way. Moved in a straight line, they do so at that face of
//! their Minkowski difference which is entered last; the points are those that are before it halfway between entry and exit.
//! That is looked for on the ways that come out of a solve without such a contact (docs/theory/seams.md). Edges and corners that are on
//! one another by then have the normal of slightly rounded ones, as they have at rest (docs/theory/touching-at-borders.md).

use super::{
    ContactId, Feature,
    borders::at_borders,
    candidates::{CandidateContact, CandidateOf, Colliding, FirstMet, Meeting, Near},
    id::{SolidFeature, SolidPart},
    placed::{Placed, TouchPoint},
    separation::{Between, Separation, along_edges, along_faces, planes},
    shared_face::{SharedCorner, facing_corners},
    solids::at_edges,
};
use crate::{
    geometry::{Polyhedron, Solid, Vector3},
    scene::Body,
};

impl Colliding for Solid {
    type Velocity = [f64; 6];
    type Levers = [[f64; 3]; 3];
    type Outline = Placed;

    fn outline(body: &Body<Self>) -> Placed {
        Placed::of(body)
    }

    fn levers(outline: &Placed, arm: [f64; 3]) -> [[f64; 3]; 3] {
        outline.axes.map(|axis| axis.cross(Vector3::from_array(arm)).to_array())
    }

    fn meet(near: &Near<'_, Self>) -> Meeting<Self> {
        let mut meeting = Meeting { candidates: Vec::new(), open: Vec::new(), separation: f64::INFINITY };
        for i in 0..near.outlines[0].pieces.len() {
            for j in 0..near.outlines[1].pieces.len() {
                let pieces = Pieces::of(near, [i, j]);
                let (distance, points, at_borders) = pieces.meet();
                meeting.separation = meeting.separation.min(distance);
                if (points.is_empty() || at_borders) && distance > -near.tolerance && distance <= near.reach {
                    meeting.open.push([i, j]);
                }
                meeting.candidates.extend(points.iter().map(|point| pieces.candidate(point)));
            }
        }
        meeting
    }

    fn first_met(near: &Near<'_, Self>, pieces: [usize; 2], allowed: f64) -> Vec<CandidateOf<Self>> {
        let pieces = Pieces::of(near, pieces);
        pieces.first_met(allowed)
    }
}

/// Pieces that meet on their way are in one another by the contact tolerance, which is half of what a shared face has to be wide:
/// the share of it that counts for them.
const NARROW: f64 = 0.25;

/// Two convex pieces.
struct Pieces<'a> {
    near: &'a Near<'a, Solid>,
    pieces: [&'a Polyhedron; 2],
    numbers: [usize; 2],
    /// The second centroid, seen from the first.
    offset: Vector3,
}

/// A point where they may press on one another, seen from the first centroid.
struct Point {
    features: [SolidFeature; 2],
    at: Vector3,
    /// Unit vector from the first into the second.
    normal: Vector3,
    gap: f64,
}

impl<'a> Pieces<'a> {
    fn of(near: &'a Near<'a, Solid>, numbers: [usize; 2]) -> Self {
        let [a, b] = near.places.map(Vector3::from_array);
        let pieces = [0, 1].map(|side| &near.outlines[side].pieces[numbers[side]]);
        Self { near, pieces, numbers, offset: b - a }
    }

    /// How far they are apart, where they may meet, and whether they are on one another with their borders only.
    fn meet(&self) -> (f64, Vec<Point>, bool) {
        let ([a, b], bias) = (self.pieces, self.near.tolerance);
        let faces = along_faces(a, b, self.offset, bias);
        if faces.distance > self.near.reach {
            return (faces.distance, Vec::new(), false);
        }
        let edges = along_edges(a, b, self.offset).filter(|edges| edges.distance > faces.distance + bias);
        let plane = edges.unwrap_or(faces);
        if plane.distance > self.near.reach {
            return (plane.distance, Vec::new(), false);
        }
        let mut points = self.points(&plane, Vector3::ZERO, bias);
        points.retain(|point| point.gap <= self.near.reach);
        if plane.distance <= -bias && points.iter().all(|point| point.gap > 0.5 * plane.distance) {
            points.extend(self.deepest(&plane));
        }
        let at_borders = plane.distance > -bias && self.only_borders(&plane, &points);
        points.retain(|point| !at_borders || point.gap > bias);
        (plane.distance, points, at_borders)
    }

    /// Whether what is on a face is at its border: an edge or a corner on one of its edges, for which no face is the right one.
    fn only_borders(&self, plane: &Separation, points: &[Point]) -> bool {
        let (piece, face, place) = match plane.between {
            Between::FaceOfA(face) => (self.pieces[0], face, Vector3::ZERO),
            Between::FaceOfB(face) => (self.pieces[1], face, self.offset),
            Between::Edges(..) => return false,
        };
        let closed = || points.iter().filter(|point| point.gap <= self.near.tolerance);
        let count = closed().count();
        let middle = closed().fold(Vector3::ZERO, |sum, point| sum + point.at) / count.max(1) as f64 - place;
        let (corners, normal) = (&piece.faces()[face], piece.normals()[face]);
        let depth = |k: usize| {
            let [from, to] = [k, (k + 1) % corners.len()].map(|k| piece.vertices()[corners[k]]);
            normal.cross((to - from).normalize_or_zero()).dot(middle - from)
        };
        count > 0 && (0..corners.len()).any(|k| depth(k) <= self.near.tolerance)
    }

    /// Where they meet at a plane once the second has gone by `shift` relative to the first; the points as they are now.
    fn points(&self, plane: &Separation, shift: Vector3, tolerance: f64) -> Vec<Point> {
        let [a, b] = self.pieces;
        let (offset, normal) = (self.offset + shift, plane.normal);
        let closer = normal.dot(shift);
        match plane.between {
            Between::FaceOfA(face) => {
                let point = |c: SharedCorner| Point {
                    features: self.named([c.reference, c.other]),
                    at: c.point + c.gap * normal - shift,
                    normal,
                    gap: c.gap - closer,
                };
                facing_corners(a, face, b, offset, tolerance).into_iter().map(point).collect()
            }
            Between::FaceOfB(face) => {
                let point = |c: SharedCorner| Point {
                    features: self.named([c.other, c.reference]),
                    at: c.point + offset - c.gap * normal,
                    normal,
                    gap: c.gap - closer,
                };
                facing_corners(b, face, a, -offset, tolerance).into_iter().map(point).collect()
            }
            Between::Edges(..) => {
                let met = at_edges(self.pieces, self.numbers, offset, *plane, tolerance);
                let point = |met: TouchPoint| Point {
                    features: met.features,
                    at: met.point - shift,
                    normal,
                    gap: plane.distance,
                };
                met.map(point).into_iter().collect()
            }
        }
    }

    /// The point by which they overlap along a plane, wherever it is. Beside a face that overlaps another only at its border,
    /// no point before the face says how deep they are in one another.
    fn deepest(&self, plane: &Separation) -> Option<Point> {
        let [a, b] = self.pieces;
        let point = |parts: [SolidPart; 2], at: Vector3| Point {
            features: self.named(parts),
            at,
            normal: plane.normal,
            gap: plane.distance,
        };
        match plane.between {
            Between::FaceOfA(face) => {
                let corner = b.lowest(plane.normal);
                Some(point([SolidPart::Face(face), SolidPart::Corner(corner)], b.vertices()[corner] + self.offset))
            }
            Between::FaceOfB(face) => {
                let corner = a.lowest(-plane.normal);
                Some(point([SolidPart::Corner(corner), SolidPart::Face(face)], a.vertices()[corner]))
            }
            Between::Edges(..) => {
                let met = at_edges(self.pieces, self.numbers, self.offset, *plane, f64::NEG_INFINITY)?;
                Some(Point { features: met.features, at: met.point, normal: plane.normal, gap: plane.distance })
            }
        }
    }

    fn named(&self, parts: [SolidPart; 2]) -> [SolidFeature; 2] {
        [0, 1].map(|side| SolidFeature { piece: self.numbers[side], part: parts[side] })
    }

    /// Where the second piece, moved in a straight line, first meets the first.
    fn first_met(&self, allowed: f64) -> Vec<CandidateOf<Solid>> {
        let [a, b] = self.near.travel.map(|[x, y, z, ..]| Vector3::new(x, y, z));
        let Some((plane, middle)) = self.plane_first_met(allowed) else { return Vec::new() };
        if let Some(border) = at_borders(self.near.outlines, self.numbers, self.offset, self.near.tolerance) {
            return border.points.iter().map(|met| self.at_border(met)).collect();
        }
        let points = self.points(&plane, middle * (b - a), NARROW * self.near.tolerance);
        let points = if points.is_empty() { self.deepest(&plane).into_iter().collect() } else { points };
        points.iter().map(|point| self.candidate(point)).collect()
    }

    /// Borders that are on one another already.
    fn at_border(&self, met: &TouchPoint) -> CandidateOf<Solid> {
        let [a, b] = met.features;
        let id = ContactId { bodies: self.near.bodies, feature: Feature::Borders { a, b } };
        let point = Point { features: met.features, at: met.point, normal: met.normal, gap: met.gap };
        CandidateContact { id, ..self.candidate(&point) }
    }

    /// The plane at which they do, and when, in steps. None if they do not meet within the step.
    fn plane_first_met(&self, allowed: f64) -> Option<(Separation, f64)> {
        let mut met = FirstMet::new(self.near.tolerance, allowed);
        for plane in planes(self.pieces[0], self.pieces[1], self.offset) {
            met.see(plane, plane.distance, self.opening(&plane))?;
        }
        met.found()
    }

    /// By how much a plane's gap grows in the step, to first order, turning included.
    fn opening(&self, plane: &Separation) -> f64 {
        let [a, b] = self.pieces;
        let (normal, offset) = (plane.normal, self.offset);
        let least = |gaps: &mut dyn Iterator<Item = f64>| gaps.fold(f64::INFINITY, f64::min);
        match plane.between {
            Between::FaceOfA(face) => {
                let on = a.vertices()[a.faces()[face][0]];
                let then = |v: &Vector3| normal.dot(*v + offset - on + self.shift(*v + offset));
                least(&mut b.vertices().iter().map(then)) - plane.distance
            }
            Between::FaceOfB(face) => {
                let on = b.vertices()[b.faces()[face][0]] + offset;
                let then = |v: &Vector3| normal.dot(on - *v + self.shift(*v));
                least(&mut a.vertices().iter().map(then)) - plane.distance
            }
            Between::Edges(edge, other) => {
                let ends = edge.ends.map(|k| a.vertices()[k]).into_iter();
                let ends = ends.chain(other.ends.map(|k| b.vertices()[k] + offset));
                least(&mut ends.map(|at| normal.dot(self.shift(at))))
            }
        }
    }

    /// How far the second body's point goes relative to the first's, to first order.
    fn shift(&self, at: Vector3) -> Vector3 {
        let of = |side: usize, arm: Vector3| {
            let [x, y, z, turning @ ..] = self.near.travel[side];
            let levers = self.near.outlines[side].axes.map(|axis| axis.cross(arm));
            Vector3::new(x, y, z) + turning[0] * levers[0] + turning[1] * levers[1] + turning[2] * levers[2]
        };
        of(1, at - self.offset) - of(0, at)
    }

    fn candidate(&self, point: &Point) -> CandidateOf<Solid> {
        let ([a, b], origin) = (self.near.outlines, Vector3::from_array(self.near.places[0]));
        let feature = Feature::Solids { a: point.features[0], b: point.features[1] };
        CandidateContact {
            id: ContactId { bodies: self.near.bodies, feature },
            normal: point.normal.to_array(),
            point: (origin + point.at).to_array(),
            levers: [Solid::levers(a, point.at.to_array()), Solid::levers(b, (point.at - self.offset).to_array())],
            gap: point.gap,
            friction: self.near.friction,
        }
    }
}
