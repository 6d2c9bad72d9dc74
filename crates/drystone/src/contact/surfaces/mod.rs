//! Contacts of closed surfaces of triangles (docs/theory/contacts-of-surfaces.md).
//!
//! Pairs of triangles that come within the tolerance are found in trees of boxes. What two of them share that lie on one another
//! is a polygon; elsewhere edges and vertices touch faces, and edges cross edges. Of the points on one plane those at the corners
//! of their hull are kept.

mod depth;
mod facing;
mod in_parts;
mod nearest;
mod pair;
mod planes;
mod point;
mod sharp;
mod thinned;

use super::touch::Touch;
use crate::{
    geometry::{Solid, Surface, Vector3},
    interrupt::poll,
    scene::Body,
};
use in_parts::in_parts;
use nearest::distance;
use pair::{LEAF, Pair};
pub(super) use point::SurfacePoint;
use point::{Found, Lying, Plane};
use std::sync::Arc;

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

/// Distance of two bodies that do not overlap, metres; zero where they meet.
pub(crate) fn solid_distance(a: &Body<Solid>, b: &Body<Solid>) -> f64 {
    let offset = Vector3::from_array(b.pose.position) - Vector3::from_array(a.pose.position);
    let (of_a, of_b) = (Sheets::of(a), Sheets::of(b));
    let pairs = of_a.0.iter().flat_map(|a| of_b.0.iter().map(move |b| [a, b]));
    let nearer = |least: f64, [a, b]: [&Arc<Surface>; 2]| distance(a, b, offset, least).unwrap_or(least);
    pairs.fold(f64::MAX, nearer)
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
