//! Where solids may meet within a time step: the polygon of a face before a face, and edges that cross.
//!
//! Of two convex pieces the plane that parts them best (`separation.rs`) says how they can meet first. If it is a face of one,
//! the points are the corners of what that face shares, seen along its normal, with the other's most opposed face
//! (`shared_face.rs`), each as far away as it is. If it is square to an edge of each, the point is where the two cross.
//!
//! Where nothing is before that face, the pieces may yet meet on their way. Moved in a straight line, they do so at that face of
//! their Minkowski difference which is entered last; the points are those that are before it halfway between entry and exit.
//! A plane on which they touch already goes first, of several the one that closes most slowly: a block that slides over the seam of
//! two level ones is not stopped by the side of the second.

use super::{
    ContactId, Feature,
    approach::{Approach, ApproachOf, Approaching, FirstMet, Meeting, Near},
    id::{SolidFeature, SolidPart},
    separation::{Between, Separation, along_edges, along_faces, planes},
    shared_face::{SharedCorner, facing_corners},
    solids::{Placed, at_edges},
};
use crate::{
    geometry::{Polyhedron, Solid, Vector3},
    scene::Body,
};

impl Approaching for Solid {
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
        let [a, b] = near.places.map(Vector3::from_array);
        let offset = b - a;
        let (mut approaches, mut separation) = (Vec::new(), f64::INFINITY);
        for (i, piece) in near.outlines[0].pieces.iter().enumerate() {
            for (j, other) in near.outlines[1].pieces.iter().enumerate() {
                let pieces = Pieces { near, pieces: [piece, other], numbers: [i, j], offset };
                let (distance, points) = pieces.meet();
                separation = separation.min(distance);
                approaches.extend(points.iter().map(|point| pieces.approach(a, point)));
            }
        }
        Meeting { approaches, separation }
    }
}

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

impl Pieces<'_> {
    /// How far they are apart, and where they may meet.
    fn meet(&self) -> (f64, Vec<Point>) {
        let ([a, b], bias) = (self.pieces, self.near.tolerance);
        let faces = along_faces(a, b, self.offset, bias);
        if faces.distance > self.near.reach {
            return (faces.distance, Vec::new());
        }
        let edges = along_edges(a, b, self.offset).filter(|edges| edges.distance > faces.distance + bias);
        let plane = edges.unwrap_or(faces);
        if plane.distance > self.near.reach {
            return (plane.distance, Vec::new());
        }
        let mut points = self.points(&plane, Vector3::ZERO);
        if points.is_empty() && plane.distance > -bias {
            points = self.first_met().map(|(plane, shift)| self.points(&plane, shift)).unwrap_or_default();
        }
        points.retain(|point| point.gap <= self.near.reach);
        if points.iter().all(|point| point.gap > 0.5 * plane.distance) && plane.distance < 0.0 {
            points.extend(self.deepest(&plane));
        }
        (plane.distance, points)
    }

    /// Where they meet at a plane once the second has gone by `shift` relative to the first; the points as they are now.
    fn points(&self, plane: &Separation, shift: Vector3) -> Vec<Point> {
        let ([a, b], tolerance) = (self.pieces, self.near.tolerance);
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
                let point = |met: super::solids::TouchPoint| Point {
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

    /// The plane at which the second piece, moved in a straight line, first meets the first, and a shift after which they
    /// overlap. None if they do not meet within the step.
    fn first_met(&self) -> Option<(Separation, Vector3)> {
        let drift = self.drift();
        let mut met = FirstMet::new(self.near.tolerance);
        for plane in planes(self.pieces[0], self.pieces[1], self.offset) {
            met.see(plane, plane.distance, plane.normal.dot(drift))?;
        }
        met.found().map(|(plane, middle)| (plane, middle * drift))
    }

    /// How far the second centroid goes relative to the first.
    fn drift(&self) -> Vector3 {
        let [a, b] = self.near.travel.map(|[x, y, z, ..]| Vector3::new(x, y, z));
        b - a
    }

    fn approach(&self, origin: Vector3, point: &Point) -> ApproachOf<Solid> {
        let [a, b] = self.near.outlines;
        let feature = Feature::Solids { a: point.features[0], b: point.features[1] };
        Approach {
            id: ContactId { bodies: self.near.bodies, feature },
            normal: point.normal.to_array(),
            point: (origin + point.at).to_array(),
            levers: [Solid::levers(a, point.at.to_array()), Solid::levers(b, (point.at - self.offset).to_array())],
            gap: point.gap,
            friction: self.near.friction,
        }
    }
}
