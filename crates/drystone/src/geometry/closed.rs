//! Whether triangles make a closed surface, and which two of them meet along each edge.

use super::{Vector3, solid_fault::SolidFault};

/// An edge of a closed surface, once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceEdge {
    /// Its vertices, in the order in which the first triangle goes round.
    pub ends: [u32; 2],
    /// The triangles on either side.
    pub triangles: [u32; 2],
    /// How far the outward normal turns across it, radians: positive where it is convex, zero within a flat face.
    pub turn: f64,
}

/// The vertices of a surface, within bounds and finite, and its triangles of three vertices each.
pub(super) fn check_numbers(vertices: &[Vector3], triangles: &[[u32; 3]]) -> Result<(), SolidFault> {
    if triangles.is_empty() {
        return Err(SolidFault::NoTriangles);
    }
    if let Some(vertex) = vertices.iter().position(|v| !v.is_finite()) {
        return Err(SolidFault::NotFinite { vertex });
    }
    let wrong = |&[a, b, c]: &[u32; 3]| {
        let there = |k: u32| (k as usize) < vertices.len();
        a == b || b == c || c == a || ![a, b, c].into_iter().all(there)
    };
    match triangles.iter().position(wrong) {
        Some(triangle) => Err(SolidFault::NotATriangle { triangle }),
        None => Ok(()),
    }
}

/// One side of a triangle.
#[derive(Clone, Copy)]
struct Half {
    key: [u32; 2],
    forward: bool,
    triangle: u32,
}

/// Every edge once. A closed surface goes along each of them as often one way as the other.
///
/// Where more than two triangles meet along an edge, those that have solid between them belong together. `normal` is a
/// triangle's outward unit normal.
pub(super) fn edges_of(
    triangles: &[[u32; 3]],
    vertices: &[Vector3],
    normal: impl Fn(u32) -> Vector3,
) -> Result<Vec<SurfaceEdge>, SolidFault> {
    let half = |triangle: u32, a: u32, b: u32| Half { key: [a.min(b), a.max(b)], forward: a < b, triangle };
    let sides = |(k, &[a, b, c]): (usize, &[u32; 3])| {
        let k = k as u32;
        [half(k, a, b), half(k, b, c), half(k, c, a)]
    };
    let mut halves: Vec<Half> = triangles.iter().enumerate().flat_map(sides).collect();
    halves.sort_unstable_by_key(|half| (half.key, !half.forward, half.triangle));
    let mut edges = Vec::with_capacity(halves.len() / 2);
    for group in halves.chunk_by(|a, b| a.key == b.key) {
        let forwards = group.iter().take_while(|half| half.forward).count();
        if 2 * forwards != group.len() {
            return Err(SolidFault::Open { ends: group[0].key.map(|k| k as usize) });
        }
        let (forward, backward) = group.split_at(forwards);
        let mut left: Vec<u32> = backward.iter().map(|half| half.triangle).collect();
        let ends = group[0].key;
        for half in forward {
            let other = match left.len() {
                1 => 0,
                _ => behind(ends, half.triangle, &left, (triangles, vertices), &normal),
            };
            let pair = [half.triangle, left.swap_remove(other)];
            edges.push(SurfaceEdge { ends, triangles: pair, turn: turn(ends, pair.map(&normal), vertices) });
        }
    }
    Ok(edges)
}

/// How far the normal turns from the first to the second triangle about the edge, radians.
fn turn(ends: [u32; 2], [first, second]: [Vector3; 2], vertices: &[Vector3]) -> f64 {
    let [from, to] = ends.map(|k| vertices[k as usize]);
    let along = (to - from).normalize_or_zero();
    first.cross(second).dot(along).atan2(first.dot(second))
}

/// Of some triangles at an edge the one first met on the way round it from a triangle through the solid.
fn behind(
    ends: [u32; 2],
    triangle: u32,
    others: &[u32],
    (triangles, vertices): (&[[u32; 3]], &[Vector3]),
    normal: &impl Fn(u32) -> Vector3,
) -> usize {
    let [from, to] = ends.map(|k| vertices[k as usize]);
    let along = (to - from).normalize_or_zero();
    let out = |triangle: u32| {
        let tip = triangles[triangle as usize].into_iter().find(|k| !ends.contains(k));
        let arm = tip.map_or(Vector3::ZERO, |tip| vertices[tip as usize] - from);
        (arm - arm.dot(along) * along).normalize_or_zero()
    };
    let (start, inwards) = (out(triangle), -normal(triangle));
    let angle = |other: u32| {
        let there = out(other);
        let angle = there.dot(inwards).atan2(there.dot(start));
        if angle < 0.0 { angle + std::f64::consts::TAU } else { angle }
    };
    let angles = others.iter().map(|&other| angle(other)).enumerate();
    angles.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(k, _)| k)
}
