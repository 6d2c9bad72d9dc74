//! Contacts of closed surfaces of triangles (docs/theory/contacts-of-surfaces.md).
//!
//! Pairs of triangles that come within the tolerance are found in trees of boxes. What two of them share that lie on one another
//! is a polygon; elsewhere edges and vertices touch faces, and edges cross edges. Of the points on one plane those at the corners
//! of their hull are kept.

mod depth;
mod facing;
mod in_parts;
mod nearest;
mod planes;
mod sharp;
mod thinned;

use super::{Feature, touch::Touch};
use crate::{
    geometry::{Solid, Surface, Vector3},
    interrupt::poll,
    scene::Body,
};
use in_parts::in_parts;
use nearest::distance;
use parry3d_f64::partitioning::BvhNode;
use std::{
    collections::HashSet,
    hash::{BuildHasherDefault, Hasher},
    sync::Arc,
};

/// A body's surface, or those of its convex pieces, in world axes about its centre of mass.
#[derive(Debug, Clone)]
pub(super) struct Sheets(Vec<Arc<Surface>>);

impl Sheets {
    pub fn of(body: &Body<Solid>) -> Self {
        let [x, y, z] = body.pose.axes();
        let rotate = |v: Vector3| v.x * x + v.y * y + v.z * z;
        let upright = [x, y, z] == [Vector3::X, Vector3::Y, Vector3::Z];
        Self(match body.shape.surface() {
            Some(surface) if upright => vec![Arc::clone(surface)],
            Some(surface) => vec![Arc::new(surface.turned(rotate))],
            None => {
                let pieces = body.shape.pieces().iter().map(|piece| piece.turned(rotate));
                // Convex polyhedra are closed.
                pieces.filter_map(|piece| Surface::of_polyhedron(&piece).ok().map(Arc::new)).collect()
            }
        })
    }
}

/// Two surfaces.
pub(super) struct Pair<'a> {
    surfaces: [&'a Surface; 2],
    /// Where the second stands from the first.
    offset: Vector3,
    tolerance: f64,
}

impl<'a> Pair<'a> {
    /// One of the two, and the other with where it stands from it.
    fn seen_from(&self, side: usize) -> (&'a Surface, depth::Seen<'a>) {
        let at = if side == 0 { self.offset } else { -self.offset };
        (self.surfaces[side], depth::Seen { surface: self.surfaces[1 - side], at })
    }

    /// Triangles whose boxes come within the tolerance, in the order of their numbers.
    fn candidates(&self) -> Vec<[u32; 2]> {
        let [a, b] = self.surfaces;
        let near = |m: &BvhNode, n: &BvhNode| {
            let between = (n.mins() + self.offset - m.maxs()).max(m.mins() - n.maxs() - self.offset);
            between.max_element() <= self.tolerance
        };
        let pairs = a.tree().leaf_pairs(b.tree(), near);
        let mut found: Vec<[u32; 2]> = pairs.map(|(ta, tb)| [ta, tb]).inspect(|_| poll(LEAF)).collect();
        found.sort_unstable();
        found
    }
}

/// Distance of two bodies that do not overlap, metres; zero where they meet.
pub(crate) fn solid_distance(a: &Body<Solid>, b: &Body<Solid>) -> f64 {
    let offset = Vector3::from_array(b.pose.position) - Vector3::from_array(a.pose.position);
    let (of_a, of_b) = (Sheets::of(a), Sheets::of(b));
    let pairs = of_a.0.iter().flat_map(|a| of_b.0.iter().map(move |b| [a, b]));
    let nearer = |least: f64, [a, b]: [&Arc<Surface>; 2]| distance(a, b, offset, least).unwrap_or(least);
    pairs.fold(f64::MAX, nearer)
}

/// Operations on the way to a pair of leaves, about.
const LEAF: usize = 100;

/// The plane on which a point was found, before planes are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Plane {
    /// Between a flat face of each.
    Between(u32, u32),
    /// On a flat face of the first.
    OfA(u32),
    /// On a flat face of the second.
    OfB(u32),
    /// On a seam between facets of a curved surface, by the bits of the normal there.
    Seam([u64; 3]),
    /// Along an edge of each, by their ends.
    Across([u32; 2], [u32; 2]),
}

/// A point where two surfaces touch, seen from the first.
#[derive(Debug, Clone, Copy)]
struct Found {
    plane: Plane,
    point: Vector3,
    /// From the first into the second.
    normal: Vector3,
    gap: f64,
    triangles: [u32; 2],
}

/// A contact point of two bodies, seen from the first.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfacePoint {
    pub feature: Feature,
    pub point: Vector3,
    pub normal: Vector3,
    pub gap: f64,
}

/// How two bodies touch of which one at least has a surface; the second stands at `offset` from the first.
pub(super) fn touch(a: &Sheets, b: &Sheets, offset: Vector3, tolerance: f64) -> Touch<SurfacePoint> {
    let (mut found, mut deepest, mut near) = (Vec::new(), 0.0_f64, false);
    for (i, of_a) in a.0.iter().enumerate() {
        for (j, of_b) in b.0.iter().enumerate() {
            let pair = Pair { surfaces: [of_a, of_b], offset, tolerance };
            let candidates = pair.candidates();
            if let Some(depth) = depth::depth(&pair, &candidates) {
                deepest = deepest.max(depth);
                continue;
            }
            let points = points_of(&pair, &candidates);
            near = near || points.is_empty() && distance(of_a, of_b, offset, tolerance).is_some();
            found.extend(points.into_iter().map(|found| ([i, j], found)));
        }
    }
    match () {
        () if deepest > 0.0 => Touch::Overlap { depth: deepest },
        () if !found.is_empty() => Touch::At(thinned::thinned(planes::corners(found, tolerance))),
        () if near => Touch::AtBorders(Vec::new()),
        () => Touch::Apart,
    }
}

/// Pairs of triangles that lie on one another.
type Lying = HashSet<[u32; 2], BuildHasherDefault<Mixed>>;

/// A hash of some numbers, of triangles mostly: there are millions of them, and nobody chooses them to collide.
#[derive(Default)]
struct Mixed(u64);

impl Hasher for Mixed {
    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 32
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_ne_bytes(word));
        }
    }

    fn write_u32(&mut self, number: u32) {
        self.write_u64(number.into());
    }

    fn write_u64(&mut self, number: u64) {
        // Multiplication by an odd number near the golden section of 2^64 (D. Knuth, 6.4).
        self.0 = (self.0.rotate_left(26) ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}

/// Every point where two surfaces touch that do not overlap.
fn points_of(pair: &Pair, candidates: &[[u32; 2]]) -> Vec<Found> {
    let [a, b] = pair.surfaces;
    let shared = in_parts(candidates, |part| {
        let lying = part.iter().inspect(|_| poll(LEAF)).filter_map(|&triangles| {
            let shared = facing::shared(pair.surfaces, triangles, pair.offset, pair.tolerance)?;
            Some((triangles, shared))
        });
        lying.collect()
    });
    let lying: Lying = shared.iter().map(|(triangles, _)| *triangles).collect();
    let mut found = Vec::with_capacity(shared.iter().map(|(_, shared)| shared.corners.len()).sum());
    for (triangles @ [ta, tb], shared) in shared {
        poll(LEAF);
        let plane = Plane::Between(a.face(ta), b.face(tb));
        let at = |(point, gap)| Found { plane, point, normal: shared.normal, gap, triangles };
        found.extend(shared.corners.into_iter().map(at));
    }
    found.extend(in_parts(candidates, |part| sharp::sharp(pair, part, &lying)));
    found
}
