//! Points of one plane: those at the corners of their hull bear all that the others can.

use super::{
    in_parts::in_parts,
    point::{Found, Mixed, SurfacePoint},
};
use crate::{
    contact::Feature,
    geometry::{Vector3, convex_outline},
    interrupt::poll,
};
use std::{collections::HashMap, hash::BuildHasherDefault, ops::Range};

/// Radians. Planes that differ by more are never one, however small what lies on them.
const SAME: f64 = 1e-2;

/// Planes that are compared with one another. A scan on a scan has more: there nothing is gained.
const COMPARED: usize = 2000;

/// Operations to compare the planes of two points, about, and to find whether a point is a corner of a hull.
const COMPARISON: usize = 20;
const POINT: usize = 200;

/// A point, with the numbers of the two sheets that it was found on.
type OnSheets = ([usize; 2], Found);

/// The sheets and triangles that a point is named by.
type Corner = ([usize; 2], [u32; 2]);

/// Points on one plane, with its normal.
struct Group {
    normal: Vector3,
    points: Vec<OnSheets>,
    /// The greatest side of the box around the points, metres.
    extent: f64,
}

impl Group {
    fn of(points: Vec<OnSheets>) -> Self {
        let normal = points.iter().map(|(_, found)| found.normal).sum::<Vector3>().normalize_or_zero();
        let mut group = Self { normal, points, extent: 0.0 };
        group.measure();
        group
    }

    fn measure(&mut self) {
        let places = || self.points.iter().map(|(_, found)| found.point);
        let low = places().fold(Vector3::INFINITY, Vector3::min);
        let high = places().fold(Vector3::NEG_INFINITY, Vector3::max);
        self.extent = (high - low).max_element();
    }

    /// Whether all points of another group are on this one's plane, within the tolerance.
    fn holds(&self, other: &Self, tolerance: f64) -> bool {
        let first = self.points[0].1.point;
        let angle = self.normal.cross(other.normal).length().atan2(self.normal.dot(other.normal));
        let near = |(_, found): &OnSheets| self.normal.dot(found.point - first).abs() <= tolerance;
        angle <= SAME && angle * other.extent <= tolerance && other.points.iter().all(near)
    }

    /// With the corners of the hull only.
    fn outlined(&self, tolerance: f64) -> Self {
        poll(POINT * self.points.len());
        let u = self.normal.any_orthonormal_vector();
        let v = self.normal.cross(u);
        let flat = |found: &Found| [u.dot(found.point), v.dot(found.point)];
        let outline = |points: &[OnSheets], tolerance: f64| -> Vec<OnSheets> {
            let numbered = points.iter().enumerate().map(|(k, (_, found))| (k, flat(found))).collect();
            convex_outline(numbered, tolerance).into_iter().map(|k| points[k]).collect()
        };
        let mut apart: Vec<OnSheets> = Vec::new();
        for point in outline(&self.points, 0.0) {
            if apart.iter().all(|known| known.1.point.distance(point.1.point) > tolerance) {
                apart.push(point);
            }
        }
        Self { points: outline(&apart, tolerance), ..*self }
    }
}

/// The contact points that are left, plane by plane, each with its name.
pub(super) fn corners(found: Vec<OnSheets>, tolerance: f64) -> Vec<SurfacePoint> {
    let mut order: Vec<u32> = (0..found.len() as u32).collect();
    let plane = |&k: &u32| (found[k as usize].0, found[k as usize].1.plane);
    order.sort_by(|a, b| {
        poll(COMPARISON);
        plane(a).cmp(&plane(b))
    });
    let mut planes: Vec<Range<usize>> = Vec::new();
    for group in order.chunk_by(|a, b| plane(a) == plane(b)) {
        let start = planes.last().map_or(0, |before| before.end);
        planes.push(start..start + group.len());
    }
    let groups = in_parts(&planes, |part| {
        let points = |plane: &Range<usize>| order[plane.clone()].iter().map(|&k| found[k as usize]).collect();
        part.iter().map(|plane| Group::of(points(plane)).outlined(tolerance)).collect()
    });
    drop((found, order, planes));
    let groups = joined(groups, tolerance);
    let groups = in_parts(&groups, |part| part.iter().map(|group| group.outlined(tolerance)).collect());
    let mut known: HashMap<Corner, usize, BuildHasherDefault<Mixed>> = HashMap::default();
    let name = |([i, j], found): &OnSheets, normal: Vector3| {
        let corner = known.entry(([*i, *j], found.triangles)).or_default();
        *corner += 1;
        let [a, b] = found.triangles.map(|k| k as usize);
        let feature = Feature::Surfaces { pieces: [*i, *j], triangles: [a, b], corner: *corner - 1 };
        SurfacePoint { feature, point: found.point, normal, gap: found.gap }
    };
    let mut name = name;
    let mut points = Vec::new();
    for group in &groups {
        poll(POINT * group.points.len());
        points.extend(group.points.iter().map(|point| name(point, group.normal)));
    }
    points
}

/// Groups on one plane become one, the largest first.
fn joined(mut groups: Vec<Group>, tolerance: f64) -> Vec<Group> {
    if groups.len() > COMPARED {
        return groups;
    }
    groups.iter_mut().for_each(Group::measure);
    groups.sort_by(|a, b| b.extent.total_cmp(&a.extent));
    let mut kept: Vec<Group> = Vec::new();
    for group in groups {
        match kept.iter_mut().find(|known| known.holds(&group, tolerance)) {
            Some(known) => known.points.extend(group.points),
            None => kept.push(group),
        }
    }
    kept
}
