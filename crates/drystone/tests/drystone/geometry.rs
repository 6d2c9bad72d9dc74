//! Polygons: measures known in closed form, and what is refused.

use drystone::geometry::{Polygon, Pose, Shape, ShapeFault, Vector};
use std::f64::consts::{FRAC_PI_2, TAU};

fn polygon(corners: &[[f64; 2]]) -> (Polygon, [f64; 2]) {
    Polygon::from_vertices(corners).unwrap()
}

fn fault(corners: &[[f64; 2]]) -> ShapeFault {
    Polygon::from_vertices(corners).unwrap_err()
}

fn assert_close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{found} instead of {expected}");
}

/// Corners of a regular polygon on the unit circle.
fn regular(corners: u32) -> Vec<[f64; 2]> {
    let at = |k: u32| TAU * f64::from(k) / f64::from(corners);
    (0..corners).map(|k| [at(k).cos(), at(k).sin()]).collect()
}

#[test]
fn a_rectangle_has_its_textbook_measures() {
    let (width, height) = (3.0, 0.5);
    let rectangle = Polygon::rectangle([width, height]);
    assert_eq!(rectangle.area(), 1.5);
    assert_close(rectangle.second_moment(), width * height * (width * width + height * height) / 12.0);
    assert_eq!(rectangle.width(), 0.5);
    assert_eq!(rectangle.vertices()[0], Vector::new(-1.5, -0.25));
}

#[test]
fn a_triangle_has_its_textbook_measures() {
    let (triangle, centroid) = polygon(&[[1.0, 1.0], [4.0, 1.0], [1.0, 5.0]]);
    assert_close(centroid[0], 2.0);
    assert_close(centroid[1], 7.0 / 3.0);
    assert_close(triangle.area(), 6.0);
    // Area / 36 times the sum of the squared sides 3, 4 and 5.
    assert_close(triangle.second_moment(), 6.0 / 36.0 * 50.0);
    // The least width is the height over the longest side: 2 * 6 / 5.
    assert_close(triangle.width(), 2.4);
}

#[test]
fn a_regular_polygon_has_its_textbook_measures() {
    for n in [3, 4, 5, 17, 360] {
        let (shape, _) = polygon(&regular(n));
        let step = TAU / f64::from(n);
        let area = 0.5 * f64::from(n) * step.sin();
        assert!((shape.area() - area).abs() < 1e-13);
        // On the unit circle the polar moment is area / 6 * (2 + cos step).
        assert!((shape.second_moment() - area / 6.0 * (2.0 + step.cos())).abs() < 1e-13);
    }
}

#[test]
fn measures_do_not_suffer_far_from_the_origin() {
    let corners = [[0.0, 0.0], [1.0, 0.25], [1.5, 1.0], [0.25, 1.5]];
    let (near, near_centroid) = polygon(&corners);
    // Sums with 2^20 are exact for these corners.
    let far = 1_048_576.0;
    let (away, centroid) = polygon(&corners.map(|[x, y]| [x + far, y - far]));
    assert_close(away.area(), near.area());
    assert_close(away.second_moment(), near.second_moment());
    assert_close(centroid[0], near_centroid[0] + far);
    for (a, b) in near.vertices().iter().zip(away.vertices()) {
        assert!(a.distance(*b) < 1e-15 * 4.0);
    }
}

#[test]
fn a_polygon_about_its_centroid_is_kept_bit_for_bit() {
    let (first, _) = polygon(&[[0.1, 0.2], [1.7, 0.3], [0.9, 2.1]]);
    let corners: Vec<[f64; 2]> = first.vertices().iter().map(|v| v.to_array()).collect();
    assert_eq!(polygon(&corners), (first, [0.0, 0.0]));
}

#[test]
fn corners_on_a_straight_line_are_merged() {
    let (square, _) =
        polygon(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 0.3], [1.0, 1.0], [0.5, 1.0], [0.0, 1.0], [0.0, 0.2]]);
    assert_eq!(square.vertices().len(), 4);
    assert_eq!(square.area(), 1.0);
    // Also when rounding puts the middle a little inside or outside.
    for bulge in [1e-12, -1e-12] {
        let (square, _) = polygon(&[[0.0, 0.0], [0.5, bulge], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(square.vertices().len(), 4);
    }
    // A block with many sides is not taken for one with few.
    assert_eq!(polygon(&regular(1000)).0.vertices().len(), 1000);
}

#[test]
fn a_ring_may_be_closed_and_run_either_way() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.5], [0.0, 1.0]];
    let clockwise = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.5], [2.0, 0.0]];
    let closed = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.5], [0.0, 1.0], [0.0, 0.0]];
    assert_eq!(polygon(&clockwise), polygon(&corners));
    assert_eq!(polygon(&closed), polygon(&corners));
    let about = |corners: &[[f64; 2]]| Polygon::about(corners, [0.5, 0.5]).unwrap();
    assert_eq!(about(&clockwise), about(&corners));
    assert_eq!(about(&closed), about(&corners));
}

#[test]
fn what_is_no_convex_polygon_is_refused() {
    let nan = f64::NAN;
    assert_eq!(fault(&[]), ShapeFault::TooFewVertices { count: 0 });
    assert_eq!(fault(&[[0.0, 0.0], [1.0, 0.0]]), ShapeFault::TooFewVertices { count: 2 });
    assert_eq!(fault(&[[0.0, 0.0], [1.0, 0.0], [0.0, nan]]), ShapeFault::NotFinite { vertex: 2 });
    let infinite = [[f64::INFINITY, 0.0], [1.0, 0.0], [0.0, 1.0]];
    assert_eq!(fault(&infinite), ShapeFault::NotFinite { vertex: 0 });
    let twice = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    assert_eq!(fault(&twice), ShapeFault::RepeatedVertex { first: 1, second: 2 });
    assert_eq!(fault(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]), ShapeFault::ZeroArea);
    let dent = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]];
    assert_eq!(fault(&dent), ShapeFault::NotConvex { vertex: 3 });
    let clockwise = [[0.0, 0.0], [0.0, 2.0], [1.0, 0.5], [2.0, 2.0], [2.0, 0.0]];
    assert_eq!(fault(&clockwise), ShapeFault::NotConvex { vertex: 2 });
    let star = [0, 2, 4, 1, 3].map(|k| regular(5)[k]);
    assert_eq!(fault(&star), ShapeFault::SelfCrossing);
    let needle = [[0.0, 0.0], [1.0, 0.0], [1.0, 1e-10]];
    assert_eq!(fault(&needle), ShapeFault::RepeatedVertex { first: 1, second: 2 });
    let blade = [[0.0, 0.0], [0.5, -1e-10], [1.0, 0.0], [0.5, 1e-10]];
    assert_eq!(fault(&blade), ShapeFault::RepeatedVertex { first: 1, second: 3 });
    // A spike that turns back on itself.
    let spike = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0], [0.75, 1.0], [0.0, 1.0]];
    assert!(matches!(fault(&spike), ShapeFault::NotConvex { .. }));
}

#[test]
fn a_pose_turns_counter_clockwise_and_shifts() {
    let pose = Pose { position: [10.0, 20.0], angle: FRAC_PI_2 };
    let moved = pose.transform(Vector::new(1.0, 2.0));
    assert!(moved.distance(Vector::new(8.0, 21.0)) < 1e-14);
}
