//! Points of one plane: those at the corners of their hull bear all that the others can.

use super::{Feature, Found, Plane, SurfacePoint};
use crate::geometry::{Vector3, convex_outline};
use std::collections::BTreeMap;

/// Radians. Planes that differ by more are never one, however small what lies on them.
const SAME: f64 = 1e-2;

/// Planes that are compared with one another. A scan on a scan has more: there nothing is gained.
const COMPARED: usize = 2000;

/// A point, with the numbers of the two sheets that it was found on.
type OnSheets = ([usize; 2], Found);

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

    /// Leaves the corners of the hull.
    fn outline(&mut self, tolerance: f64) {
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
        self.points = outline(&apart, tolerance);
    }
}

/// The contact points that are left, plane by plane, each with its name.
pub(super) fn corners(found: Vec<OnSheets>, tolerance: f64) -> Vec<SurfacePoint> {
    let mut planes: BTreeMap<([usize; 2], Plane), Vec<OnSheets>> = BTreeMap::new();
    for point in found {
        planes.entry((point.0, point.1.plane)).or_default().push(point);
    }
    let mut groups: Vec<Group> = planes.into_values().map(Group::of).collect();
    groups.iter_mut().for_each(|group| group.outline(tolerance));
    let mut groups = joined(groups, tolerance);
    groups.iter_mut().for_each(|group| group.outline(tolerance));
    let mut known: BTreeMap<([usize; 2], [u32; 2]), usize> = BTreeMap::new();
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
