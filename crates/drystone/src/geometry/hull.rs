//! The convex hull of points as flat faces, each in one piece.
//!
//! The triangles of the hull come from parry; here they grow together to faces.

use super::{
    Vector3,
    solid_fault::{MOST_POINTS, SolidFault},
};
use faer::{Mat, Side};
use parry3d_f64::transformation::try_convex_hull;
use std::collections::BTreeMap;

/// A vertex this close to a face's plane, as a share of the largest extent, is on it. As in the plane
/// (`polygon.rs`): far below the contact tolerance of a compact block, far above the rounding of coordinates.
pub(super) const STRAIGHT: f64 = 1e-9;

/// A polyhedron narrower than this share of its largest extent has no volume to speak of.
pub(super) const FLAT: f64 = 1e-8;

/// A closed surface of flat faces.
pub(super) struct Outlined {
    /// The points without those that coincide with an earlier one.
    pub corners: Vec<Vector3>,
    /// Corners of each face, counter-clockwise from outside, the least first; in the order of these lists.
    pub faces: Vec<Vec<usize>>,
    /// The largest side of the bounding box, metres.
    pub extent: f64,
}

/// The hull's faces.
pub(super) fn outlined(points: &[Vector3]) -> Result<Outlined, SolidFault> {
    let extent = check_points(points)?;
    let corners = distinct(points, extent);
    let mut faces = flat_faces(&corners, &hull_triangles(&corners)?, extent)?;
    drop_inner_corners(&mut faces);
    faces.iter_mut().for_each(|face| start_at_least(face));
    faces.sort();
    Ok(Outlined { corners, faces, extent })
}

/// Refuses what is no polyhedron at all; returns the largest side of the bounding box.
fn check_points(points: &[Vector3]) -> Result<f64, SolidFault> {
    if points.len() < 4 {
        return Err(SolidFault::TooFewVertices { count: points.len() });
    }
    if points.len() > MOST_POINTS {
        return Err(SolidFault::TooManyVertices { count: points.len() });
    }
    if let Some(vertex) = points.iter().position(|v| !v.is_finite()) {
        return Err(SolidFault::NotFinite { vertex });
    }
    let low = points.iter().fold(points[0], |low, v| low.min(*v));
    let high = points.iter().fold(points[0], |high, v| high.max(*v));
    Ok((high - low).max_element())
}

/// The points without those that coincide with an earlier one.
fn distinct(points: &[Vector3], extent: f64) -> Vec<Vector3> {
    let mut kept: Vec<Vector3> = Vec::with_capacity(points.len());
    for point in points {
        if kept.iter().all(|k| k.distance(*point) > STRAIGHT * extent) {
            kept.push(*point);
        }
    }
    kept
}

/// The triangles of the hull of points, by their numbers.
fn hull_triangles(points: &[Vector3]) -> Result<Vec<[usize; 3]>, SolidFault> {
    let round = rounded(points)?;
    let hull = std::panic::catch_unwind(|| try_convex_hull(&round));
    let (vertices, triangles) = match hull {
        Ok(Ok(hull)) => hull,
        Ok(Err(error)) => return Err(SolidFault::NoHull { reason: error.to_string() }),
        Err(_) => return Err(SolidFault::NoHull { reason: "the search for it failed".into() }),
    };
    // The hull's vertices are copies of the points.
    let bits = |v: &Vector3| v.to_array().map(f64::to_bits);
    let number: BTreeMap<[u64; 3], usize> = round.iter().enumerate().map(|(k, v)| (bits(v), k)).collect();
    Ok(triangles.into_iter().map(|triangle| triangle.map(|k| number[&bits(&vertices[k as usize])])).collect())
}

/// The points mapped so that they spread alike in all directions: the search for a hull takes what is a thousand times
/// wider than thick for flat, and an affine map changes no hull.
fn rounded(points: &[Vector3]) -> Result<Vec<Vector3>, SolidFault> {
    let count = points.len() as f64;
    let mean = points.iter().map(|p| *p - points[0]).sum::<Vector3>() / count + points[0];
    let near: Vec<Vector3> = points.iter().map(|p| *p - mean).collect();
    let spread = Mat::from_fn(3, 3, |i, j| near.iter().map(|v| v[i] * v[j]).sum::<f64>() / count);
    let no_hull = |_| SolidFault::NoHull { reason: "its axes were not found".into() };
    let eigen = spread.self_adjoint_eigen(Side::Lower).map_err(no_hull)?;
    let axis = |k: usize| Vector3::new(eigen.U()[(0, k)], eigen.U()[(1, k)], eigen.U()[(2, k)]);
    // Right-handed, so that triangles keep their outside.
    let axes = [axis(0), axis(1), axis(0).cross(axis(1))];
    // From the points, not from the spread: its least eigenvalue has lost what is a hundred millionth as thick as wide.
    let reach = axes.map(|axis| near.iter().map(|v| axis.dot(*v).abs()).fold(0.0, f64::max));
    let widest = reach.into_iter().fold(0.0, f64::max);
    if reach.iter().any(|&reach| reach <= FLAT * widest) {
        return Err(SolidFault::ZeroVolume);
    }
    let round = |v: &Vector3| Vector3::from_array([0, 1, 2].map(|k| axes[k].dot(*v) / reach[k]));
    Ok(near.iter().map(round).collect())
}

/// The outlines of the flat faces of a closed surface of triangles: from the largest triangle on, each takes its
/// neighbours in as long as they lie on its plane.
fn flat_faces(points: &[Vector3], triangles: &[[usize; 3]], extent: f64) -> Result<Vec<Vec<usize>>, SolidFault> {
    let square = |k: usize| {
        let [a, b, c] = triangles[k].map(|k| points[k]);
        (b - a).cross(c - a)
    };
    let sides = |k: usize| [0, 1, 2].map(|side| [triangles[k][side], triangles[k][(side + 1) % 3]]);
    let beside: BTreeMap<[usize; 2], usize> =
        (0..triangles.len()).flat_map(|k| sides(k).into_iter().map(move |side| (side, k))).collect();
    let mut largest: Vec<usize> = (0..triangles.len()).collect();
    largest.sort_by(|&i, &j| square(j).length().total_cmp(&square(i).length()).then(i.cmp(&j)));
    let mut face_of: Vec<Option<usize>> = vec![None; triangles.len()];
    let mut faces = Vec::new();
    for &first in &largest {
        if face_of[first].is_some() {
            continue;
        }
        let (normal, corner) = (square(first).normalize_or_zero(), points[triangles[first][0]]);
        let on_plane = |k: usize| normal.dot(points[k] - corner).abs() <= STRAIGHT * extent;
        let mut members = vec![first];
        face_of[first] = Some(faces.len());
        let mut next = 0;
        while let Some(&member) = members.get(next) {
            next += 1;
            for [a, b] in sides(member) {
                let Some(&other) = beside.get(&[b, a]) else {
                    return Err(SolidFault::NoHull { reason: "it is open".into() });
                };
                // Not round a sharp edge, of which both sides may lie on the plane of a piece that is thin there.
                let along = square(other).dot(normal) >= 0.0;
                if face_of[other].is_none() && along && triangles[other].iter().all(|&k| on_plane(k)) {
                    face_of[other] = Some(faces.len());
                    members.push(other);
                }
            }
        }
        faces.push(members);
    }
    let border = |(face, members): (usize, &Vec<usize>)| {
        let inner = |side: &[usize; 2]| face_of[beside[&[side[1], side[0]]]] == Some(face);
        outline(members.iter().flat_map(|&k| sides(k)).filter(|side| !inner(side)))
    };
    faces.iter().enumerate().map(border).collect()
}

/// Sides as one closed loop.
fn outline(sides: impl Iterator<Item = [usize; 2]>) -> Result<Vec<usize>, SolidFault> {
    let next: BTreeMap<usize, usize> = sides.map(|[a, b]| (a, b)).collect();
    let first = next.keys().next().copied().unwrap_or_default();
    let mut corners = vec![first];
    while let Some(&corner) = next.get(&corners[corners.len() - 1])
        && corner != first
        && corners.len() <= next.len()
    {
        corners.push(corner);
    }
    match corners.len() == next.len() {
        true => Ok(corners),
        false => Err(SolidFault::NoHull { reason: "a face has a hole".into() }),
    }
}

/// Drops corners of two faces only: they lie within an edge.
fn drop_inner_corners(faces: &mut [Vec<usize>]) {
    let mut count: BTreeMap<usize, usize> = BTreeMap::new();
    faces.iter().flatten().for_each(|&corner| *count.entry(corner).or_default() += 1);
    faces.iter_mut().for_each(|face| face.retain(|corner| count[corner] > 2));
}

/// Turns a loop so that it begins with its least number.
fn start_at_least(face: &mut [usize]) {
    let least = (0..face.len()).min_by_key(|&k| face[k]).unwrap_or(0);
    face.rotate_left(least);
}

/// A numbered point in the plane.
type Numbered = (usize, [f64; 2]);

/// The corners of the convex hull of numbered points in the plane, counter-clockwise; points within `tolerance` of a straight
/// line between others are no corners. Andrew's monotone chain.
pub(crate) fn convex_outline(mut points: Vec<Numbered>, tolerance: f64) -> Vec<usize> {
    sort(&mut points);
    if points.len() > 2 && begins_within_a_side(&points, tolerance) {
        upright(&mut points, tolerance);
    }
    let mut outline = outline_of_sorted(&points, tolerance);
    if loses_a_corner(&outline, &points, tolerance) {
        upright(&mut points, tolerance);
        outline = outline_of_sorted(&points, tolerance);
    }
    outline.into_iter().map(|(k, _)| k).collect()
}

fn sort(points: &mut [Numbered]) {
    points.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
}

fn outline_of_sorted(points: &[Numbered], tolerance: f64) -> Vec<Numbered> {
    let straight = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        let (ux, uy) = (c[0] - a[0], c[1] - a[1]);
        let turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
        turn <= tolerance * ux.hypot(uy)
    };
    let chain = |points: &mut dyn Iterator<Item = Numbered>| {
        let mut kept: Vec<Numbered> = Vec::new();
        for point in points {
            while let [.., a, b] = kept[..]
                && straight(a.1, b.1, point.1)
            {
                kept.pop();
            }
            kept.push(point);
        }
        kept.pop();
        kept
    };
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut lower = chain(&mut points.iter().copied());
    lower.extend(chain(&mut points.iter().rev().copied()));
    lower
}

/// Whether the first or the last of sorted points is neither the lowest nor the highest of those as far left or right as it: by
/// rounding a side that is parallel to the second axis begins in its middle.
fn begins_within_a_side(points: &[Numbered], tolerance: f64) -> bool {
    let within = |&(_, [x, y]): &Numbered| {
        let beside = || points.iter().filter(move |(_, other)| (other[0] - x).abs() <= tolerance);
        beside().any(|(_, other)| other[1] < y) && beside().any(|(_, other)| other[1] > y)
    };
    points.first().is_some_and(within) || points.last().is_some_and(within)
}

/// Whether one of the leftmost or rightmost of sorted points is outside of their outline: a chain that goes back and forth along a side
/// parallel to the second axis takes the corner where it turns for a point within the side.
fn loses_a_corner(outline: &[Numbered], points: &[Numbered], tolerance: f64) -> bool {
    let ([first, .., last], [.., before]) = (points, outline) else { return false };
    let outside = |[x, y]: [f64; 2]| {
        let mut from = before.1;
        outline.iter().any(|&(_, to)| {
            let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
            let left = dx * (y - from[1]) - dy * (x - from[0]);
            from = to;
            left < -2.0 * tolerance * dx.hypot(dy)
        })
    };
    let beside = |x: f64| (x - first.1[0]).min(last.1[0] - x) <= tolerance;
    points.iter().any(|&(_, point)| beside(point[0]) && outside(point))
}

/// Lays points that are as far left as the first or as far right as the last of some sorted ones, within the tolerance, beside it, and
/// sorts again.
fn upright(points: &mut [Numbered], tolerance: f64) {
    let (Some(&(_, [left, _])), Some(&(_, [right, _]))) = (points.first(), points.last()) else { return };
    for (_, [x, _]) in points.iter_mut() {
        if *x - left <= tolerance {
            *x = left;
        } else if right - *x <= tolerance {
            *x = right;
        }
    }
    sort(points);
}

#[cfg(test)]
mod tests {
    use super::convex_outline;

    /// A rectangle whose left and right sides have a point in their middle, all of them off by rounding in any order.
    #[test]
    fn no_corner_of_an_upright_side_is_lost() {
        let places = [(0.0, 0.0), (0.0, 0.3), (0.0, 1.0), (2.0, 0.0), (2.0, 0.6), (2.0, 1.0)];
        for code in 0..729_usize {
            let off = |k: usize| (code / 3_usize.pow(k as u32) % 3) as f64 * 1e-15;
            let points = places.iter().enumerate().map(|(k, &(x, y))| (k, [x + off(k), y])).collect();
            let mut corners = convex_outline(points, 1e-6);
            let least = corners.iter().position(|&k| k == 0).expect("the first is a corner");
            corners.rotate_left(least);
            assert_eq!(corners, [0, 3, 5, 2], "{code}");
        }
    }
}
