//! Area and second moments of the polygon in which two bodies touch.

use crate::geometry::convex_outline;

/// The polygon as a layer has it: its centroid, its principal axes, and how its area is spread along them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Section {
    /// In the plane of the contact, metres.
    pub centroid: [f64; 2],
    /// Direction of the first principal axis, along which it is widest; the second is that turned a quarter.
    pub axis: [f64; 2],
    /// m^2.
    pub area: f64,
    /// Squares of the radii of gyration along the two axes, m^2.
    pub spread: [f64; 2],
}

/// Area over the product of the radii of gyration, of every rectangle.
const OF_RECTANGLES: f64 = 12.0;

impl Section {
    /// Of the hull of points. It is at least `least` (m) wide: an edge counts as a strip of that width, a corner as a square.
    pub fn of(points: &[[f64; 2]], outline: &[usize], least: f64) -> Self {
        let corners: Vec<[f64; 2]> = outline.iter().map(|&k| points[k]).collect();
        let (centroid, area, [xx, yy, xy]) = match corners[..] {
            [] => ([0.0; 2], 0.0, [0.0; 3]),
            [one] => (one, 0.0, [0.0; 3]),
            [a, b] => of_segment(a, b),
            _ => of_polygon(&corners),
        };
        let turn = 0.5 * (2.0 * xy).atan2(xx - yy);
        let axis = [turn.cos(), turn.sin()];
        let (mean, radius) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        let spread = [mean + radius, (mean - radius).max(0.0)];
        let shape = if corners.len() > 2 { area / (spread[0] * spread[1]).sqrt() } else { OF_RECTANGLES };
        let spread = spread.map(|spread| spread.max(least * least / OF_RECTANGLES));
        Self { centroid, axis, area: shape * (spread[0] * spread[1]).sqrt(), spread }
    }
}

/// Corners of the hull; points within a billionth of its extent of a straight line between others are none.
pub(super) fn outline(points: &[[f64; 2]]) -> Vec<usize> {
    const STRAIGHT: f64 = 1e-9;
    let apart = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let extent = points.iter().fold(0.0_f64, |extent, point| extent.max(apart(point, &points[0])));
    let mut single: Vec<(usize, [f64; 2])> = Vec::with_capacity(points.len());
    for (k, point) in points.iter().enumerate() {
        if single.iter().all(|(_, known)| apart(point, known) > STRAIGHT * extent) {
            single.push((k, *point));
        }
    }
    convex_outline(single, STRAIGHT * extent)
}

/// Centroid, no area, and the second moments per area.
fn of_segment(a: [f64; 2], b: [f64; 2]) -> ([f64; 2], f64, [f64; 3]) {
    let [x, y] = [b[0] - a[0], b[1] - a[1]];
    ([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])], 0.0, [x * x, y * y, x * y].map(|square| square / 12.0))
}

/// Centroid, area, and the second moments xx, yy and xy about the centroid per area, by triangles from the first corner.
fn of_polygon(corners: &[[f64; 2]]) -> ([f64; 2], f64, [f64; 3]) {
    let [x0, y0] = corners[0];
    let from = |[x, y]: [f64; 2]| [x - x0, y - y0];
    let (mut area, mut first, mut second) = (0.0, [0.0; 2], [0.0; 3]);
    for pair in corners[1..].windows(2) {
        let ([ax, ay], [bx, by]) = (from(pair[0]), from(pair[1]));
        let triangle = 0.5 * (ax * by - ay * bx);
        area += triangle;
        first[0] += triangle * (ax + bx) / 3.0;
        first[1] += triangle * (ay + by) / 3.0;
        second[0] += triangle * (ax * ax + ax * bx + bx * bx) / 6.0;
        second[1] += triangle * (ay * ay + ay * by + by * by) / 6.0;
        second[2] += triangle * (2.0 * ax * ay + ax * by + bx * ay + 2.0 * bx * by) / 12.0;
    }
    let [x, y] = first.map(|first| first / area);
    let moments = [second[0] / area - x * x, second[1] / area - y * y, second[2] / area - x * y];
    ([x0 + x, y0 + y], area, moments)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(points: &[[f64; 2]]) -> Section {
        Section::of(points, &outline(points), 0.01)
    }

    #[test]
    fn a_rectangle_has_its_area_and_moments_by_hand() {
        let found = section(&[[1.0, 2.0], [5.0, 2.0], [5.0, 3.0], [1.0, 3.0]]);
        assert_eq!((found.centroid, found.area), ([3.0, 2.5], 4.0));
        assert!((found.spread[0] - 16.0 / 12.0).abs() < 1e-14 && (found.spread[1] - 1.0 / 12.0).abs() < 1e-14);
        assert!(found.axis[1].abs() < 1e-14);
    }

    #[test]
    fn points_on_a_side_or_inside_change_nothing() {
        let corners = [[0.0, 0.0], [3.0, 0.5], [2.0, 4.0]];
        let mut more = corners.to_vec();
        more.extend([[1.5, 0.25], [2.5, 2.25], [1.5, 1.5]]);
        assert_eq!(section(&corners), section(&more));
    }

    #[test]
    fn an_edge_is_a_strip_and_a_corner_a_square() {
        let edge = section(&[[0.0, 0.0], [0.0, 2.0]]);
        assert!((edge.area - 0.02).abs() < 1e-15 && (edge.spread[0] - 4.0 / 12.0).abs() < 1e-15, "{edge:?}");
        let corner = section(&[[7.0, 7.0]]);
        assert!((corner.area - 1e-4).abs() < 1e-18, "{corner:?}");
    }
}
