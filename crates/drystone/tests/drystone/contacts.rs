//! Contact sets of small scenes, each derived by hand.

use drystone::{BodyOptions, Contact, ContactSet, Feature, Scene, SceneError, find_contacts};
use std::f64::consts::FRAC_PI_4;

/// Rounding of coordinates of order one, with room to spare: far below the tolerance of 1e-6.
const ROUNDING: f64 = 1e-13;

fn empty() -> Scene {
    Scene::new([0.0, -9.81], 0.5).unwrap()
}

fn fixed() -> BodyOptions {
    BodyOptions { fixed: true, ..BodyOptions::default() }
}

fn movable() -> BodyOptions {
    BodyOptions::default()
}

/// The unit square with centre (x, y).
fn square(scene: &mut Scene, x: f64, y: f64) -> usize {
    scene.add_box([x, y], [1.0, 1.0], 0.0, movable()).unwrap()
}

fn assert_near(found: [f64; 3], expected: [f64; 3]) {
    let distance = (0..3).map(|k| (found[k] - expected[k]).powi(2)).sum::<f64>().sqrt();
    assert!(distance <= ROUNDING, "{found:?} instead of {expected:?}");
}

fn points(set: &ContactSet) -> Vec<[f64; 2]> {
    set.contacts.iter().map(|c| [c.point[0], c.point[1]]).collect()
}

#[test]
fn a_square_on_a_square_touches_at_both_ends_of_the_shared_face() {
    let mut scene = empty();
    square(&mut scene, 0.0, 0.0);
    square(&mut scene, 0.25, 1.0);
    let set = find_contacts(&scene).unwrap();
    // b's bottom face (0) runs from left to right, and is shared from x = -0.25 to x = 0.5.
    assert_eq!(points(&set), [[-0.25, 0.5], [0.5, 0.5]]);
    for (end, contact) in set.contacts.iter().enumerate() {
        assert_eq!(contact.id.feature, Feature::Faces { a: 2, b: 0, end });
        assert_eq!(contact.normal, [0.0, 1.0, 0.0]);
        assert_eq!(contact.gap, 0.0);
        assert_eq!(contact.friction, 0.5);
    }
    assert_eq!(set.contacts[0].id.feature.to_string(), "a:face 2 / b:face 0 / end 0");
}

#[test]
fn a_face_contact_keeps_both_ends_at_any_angle_and_far_from_the_origin() {
    for step in 0..360 {
        let angle = 0.017_f64 * f64::from(step) + 0.003;
        let far = 1e4 * f64::from(step);
        let (sin, cos) = angle.sin_cos();
        let place = |x: f64, y: f64| [far + cos * x - sin * y, sin * x + cos * y];
        let mut scene = empty();
        scene.add_box(place(0.0, 0.0), [1.0, 1.0], angle, movable()).unwrap();
        scene.add_box(place(0.3, 0.75), [2.0, 0.5], angle, movable()).unwrap();
        let set = find_contacts(&scene).unwrap();
        assert_eq!(set.contacts.len(), 2, "at {angle} rad");
        for (contact, x) in set.contacts.iter().zip([-0.5, 0.5]) {
            let expected = place(x, 0.5);
            let distance = (contact.point[0] - expected[0]).hypot(contact.point[1] - expected[1]);
            // Coordinates of size `far` are rounded to far * 2^-53 in each of a few operations.
            assert!(distance <= ROUNDING + 1e-15 * far, "{distance} at {angle} rad");
            assert!((contact.normal[0] + sin).hypot(contact.normal[1] - cos) <= ROUNDING);
        }
    }
}

#[test]
fn side_by_side_faces_count() {
    let mut scene = empty();
    square(&mut scene, 0.0, 0.0);
    square(&mut scene, 1.0, 0.0);
    let set = find_contacts(&scene).unwrap();
    assert_eq!(points(&set), [[0.5, 0.5], [0.5, -0.5]]);
    assert!(set.contacts.iter().all(|c| c.normal == [1.0, 0.0, 0.0]));
}

#[test]
fn a_square_on_its_corner_touches_once() {
    let mut scene = empty();
    scene.add_box([0.0, -0.5], [4.0, 1.0], 0.0, fixed()).unwrap();
    let half_diagonal = 0.5_f64.sqrt();
    scene.add_box([0.3, half_diagonal], [1.0, 1.0], FRAC_PI_4, movable()).unwrap();
    let set = find_contacts(&scene).unwrap();
    assert_eq!(set.contacts.len(), 1);
    let Contact { id, point, normal, .. } = &set.contacts[0];
    assert_near(*point, [0.3, 0.0, 0.0]);
    assert_near(*normal, [0.0, 1.0, 0.0]);
    // Turned by 45 degrees, the lower left corner (0) points straight down.
    assert_eq!(id.feature, Feature::CornerOfB { a: 2, b: 0 });
}

#[test]
fn a_face_on_a_corner_touches_once_with_the_faces_normal() {
    let mut scene = empty();
    scene.add_polygon(&[[-2.0, -1.0], [2.0, -1.0], [0.5, 0.0]], fixed()).unwrap();
    square(&mut scene, 0.6, 0.5);
    let set = find_contacts(&scene).unwrap();
    assert_eq!(set.contacts.len(), 1);
    assert_near(set.contacts[0].point, [0.5, 0.0, 0.0]);
    assert_near(set.contacts[0].normal, [0.0, 1.0, 0.0]);
    assert_eq!(set.contacts[0].id.feature, Feature::CornerOfA { a: 2, b: 0 });
}

#[test]
fn a_corner_on_a_corner_touches_once_with_the_normal_of_rounded_ones() {
    let mut scene = empty();
    square(&mut scene, 0.0, 0.0);
    square(&mut scene, 1.0, 1.0);
    let diamond = [[-1.5, 0.0], [-1.0, -0.5], [-0.5, 0.0], [-1.0, 0.5]];
    // The diamond's right corner touches the middle of the first square's left side.
    scene.add_polygon(&diamond, movable()).unwrap();
    // Its left corner meets the right corner of another one.
    scene.add_polygon(&diamond.map(|[x, y]| [x - 1.0, y]), movable()).unwrap();
    let set = find_contacts(&scene).unwrap();
    assert!(set.corner_touches.is_empty());
    let [squares, side, diamonds] = &set.contacts[..] else { panic!("{set:?}") };
    assert_eq!((squares.bodies, side.bodies, diamonds.bodies), ([0, 1], [0, 2], [2, 3]));
    assert!(squares.id.feature.at_borders() && diamonds.id.feature.at_borders() && !side.id.feature.at_borders());
    assert_eq!(squares.id.feature, Feature::Corners { a: 2, b: 0 });
    assert_near(squares.normal, [0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0]);
    assert_near(squares.point, [0.5, 0.5, 0.0]);
    assert_near(side.normal, [-1.0, 0.0, 0.0]);
    assert_near(diamonds.normal, [-1.0, 0.0, 0.0]);
    assert_near(diamonds.point, [-1.5, 0.0, 0.0]);
}

/// Unit normals of corners of 90 degrees have cores that end in (1, 1); those of `q` in the page on touches at borders.
#[test]
fn the_normal_follows_both_corners() {
    // A square's corner at the origin, looking up and right, and a tip above it that looks down and to the left.
    let normal_of = |tip: &[[f64; 2]]| {
        let mut scene = empty();
        square(&mut scene, -0.5, -0.5);
        scene.add_polygon(tip, movable()).unwrap();
        let set = find_contacts(&scene).unwrap();
        assert_eq!(set.contacts.len(), 1, "{set:?}");
        assert!(set.contacts[0].id.feature.at_borders());
        set.contacts[0].normal
    };
    // Faces of the tip look to (-1, 0) and to (1, -1) / sqrt(2): -m = (1, 1 + sqrt(2)), q = (2, 2 + sqrt(2)).
    let q = [2.0, 2.0 + 2.0_f64.sqrt()];
    let length = q[0].hypot(q[1]);
    assert_near(normal_of(&[[0.0, 0.0], [1.0, 1.0], [0.0, 2.0]]), [q[0] / length, q[1] / length, 0.0]);
    // A needle from the upper left ends far from its core, so that q looks to the upper left too. No plane square to it parts the
    // two; of those that do the square's top is the nearest.
    let at = |degrees: f64| [degrees.to_radians().cos(), degrees.to_radians().sin()];
    assert_near(normal_of(&[[0.0, 0.0], at(115.0), at(125.0)]), [0.0, 1.0, 0.0]);
}

#[test]
fn what_another_body_parts_bears_nothing_at_a_corner() {
    // Four squares in a point, all movable: the two pairs across it bear nothing.
    let mut scene = empty();
    for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        square(&mut scene, x, y);
    }
    let set = find_contacts(&scene).unwrap();
    assert_eq!(set.corner_touches, [[0, 3], [1, 2]]);
    assert!(set.contacts.iter().all(|c| !c.id.feature.at_borders()));
    assert_eq!(set.contacts.len(), 8);
    // A block at the seam of two level slabs, and one on the second of two with a gap, at the first's corner.
    for second in [0.0, 0.25] {
        let mut scene = empty();
        scene.add_box([-1.0, -0.5], [2.0, 1.0], 0.0, fixed()).unwrap();
        scene.add_box([second + 1.0, -0.5], [2.0, 1.0], 0.0, fixed()).unwrap();
        square(&mut scene, 0.5, 0.5);
        let set = find_contacts(&scene).unwrap();
        assert_eq!(set.corner_touches, [[0, 2]], "{second}");
        assert!(set.contacts.iter().all(|c| c.bodies == [1, 2]) && set.contacts.len() == 2, "{set:?}");
    }
}

#[test]
fn sharp_tips_apart_by_more_than_the_tolerance_do_not_touch() {
    // The faces of two tips with a half-angle of 1e-4 separate them by no more than 1e-4 of the
    // gap, which the separating axes alone would take for a touch.
    let mut scene = empty();
    scene.add_polygon(&[[-1e-2, -100.0], [1e-2, -100.0], [0.0, 0.0]], movable()).unwrap();
    scene.add_polygon(&[[-1e-2, 100.0], [0.0, 1e-5], [1e-2, 100.0]], movable()).unwrap();
    let set = find_contacts(&scene).unwrap();
    assert!(set.contacts.is_empty() && set.corner_touches.is_empty());
}

#[test]
fn a_gap_or_overlap_within_the_tolerance_is_a_contact_halfway() {
    for gap in [9e-7, -9e-7] {
        let mut scene = empty();
        square(&mut scene, 0.0, 0.0);
        square(&mut scene, 0.0, 1.0 + gap);
        let set = find_contacts(&scene).unwrap();
        assert_eq!(set.contacts.len(), 2);
        for contact in &set.contacts {
            assert!((contact.gap - gap).abs() <= ROUNDING);
            assert!((contact.point[1] - 0.5 - 0.5 * gap).abs() <= ROUNDING);
        }
    }
    let mut scene = empty();
    square(&mut scene, 0.0, 0.0);
    square(&mut scene, 0.0, 1.0 + 1.1e-6);
    assert!(find_contacts(&scene).unwrap().contacts.is_empty());
}

#[test]
fn a_given_tolerance_replaces_the_default() {
    let mut scene = empty().with_contact_tolerance(1e-3).unwrap();
    square(&mut scene, 0.0, 0.0);
    square(&mut scene, 0.0, 1.0009);
    square(&mut scene, 0.0, 2.0);
    assert_eq!(find_contacts(&scene).unwrap().contacts.len(), 4);
}

#[test]
fn an_overlap_names_both_blocks_and_the_depth() {
    let mut scene = empty();
    square(&mut scene, 0.0, 0.0);
    let named = BodyOptions { name: Some("lintel".into()), ..movable() };
    scene.add_box([0.0, 0.75], [1.0, 1.0], 0.0, named).unwrap();
    let error = find_contacts(&scene).unwrap_err();
    let SceneError::Overlap { a, b, depth, tolerance } = &error else { panic!("{error}") };
    assert_eq!((a.as_str(), b.as_str()), ("b0", "lintel"));
    assert_eq!((*depth, *tolerance), (0.25, 1e-6));
    let text = error.to_string();
    assert!(text.contains("\"b0\" and \"lintel\" overlap by 2.500e-1 m"), "{text}");
}

#[test]
fn a_block_inside_another_overlaps_by_the_shortest_way_out() {
    let mut scene = empty();
    scene.add_box([0.0, 0.0], [10.0, 10.0], 0.0, movable()).unwrap();
    scene.add_box([4.0, 0.0], [1.0, 1.0], 0.0, movable()).unwrap();
    let error = find_contacts(&scene).unwrap_err();
    // To the right: from x = 4.5 inside to x = 5 takes 0.5, and the block's own width of 1.
    assert!(matches!(error, SceneError::Overlap { depth: 1.5, .. }), "{error}");
}

#[test]
fn fixed_blocks_may_overlap_and_never_touch_each_other() {
    let mut scene = empty();
    scene.add_box([0.0, 0.0], [2.0, 1.0], 0.0, fixed()).unwrap();
    scene.add_box([1.0, 0.0], [2.0, 1.0], 0.0, fixed()).unwrap();
    scene.add_box([3.0, 0.0], [2.0, 1.0], 0.0, fixed()).unwrap();
    let set = find_contacts(&scene).unwrap();
    assert_eq!(set, ContactSet::default());
}

#[test]
fn pair_friction_is_the_smaller_coefficient() {
    let mut scene = empty();
    let with = |friction| BodyOptions { friction: Some(friction), ..BodyOptions::default() };
    scene.add_box([0.0, 0.0], [1.0, 1.0], 0.0, with(0.9)).unwrap();
    scene.add_box([0.0, 1.0], [1.0, 1.0], 0.0, with(0.2)).unwrap();
    square(&mut scene, 1.0, 0.0);
    let set = find_contacts(&scene).unwrap();
    let friction = |a, b| set.contacts.iter().find(|c| c.bodies == [a, b]).map(|c| c.friction);
    assert_eq!(friction(0, 1), Some(0.2));
    assert_eq!(friction(0, 2), Some(0.5));
}

#[test]
fn contacts_do_not_depend_on_other_blocks() {
    let mut scene = empty();
    square(&mut scene, 0.0, 0.0);
    square(&mut scene, 0.4, 1.0);
    let before = find_contacts(&scene).unwrap();
    // A tiny block, which would shrink a tolerance taken over the whole scene, and some others.
    scene.add_box([5.0, 0.0], [1e-6, 1e-6], 0.3, movable()).unwrap();
    square(&mut scene, 0.4, 2.0);
    square(&mut scene, 1.0, 0.0);
    let after = find_contacts(&scene).unwrap();
    let old = |c: &&Contact| c.bodies == [0, 1];
    let kept: Vec<Contact> = after.contacts.iter().filter(old).cloned().collect();
    assert_eq!(kept, before.contacts);
    assert!(after.contacts.len() > kept.len());
}

#[test]
fn contacts_come_sorted_by_pair_and_feature() {
    let mut scene = empty();
    for (x, y) in [(0.5, 1.0), (0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.5, 1.0)] {
        square(&mut scene, x, y);
    }
    let set = find_contacts(&scene).unwrap();
    let ids: Vec<_> = set.contacts.iter().map(|c| c.id).collect();
    let mut sorted = ids.clone();
    sorted.sort();
    assert_eq!(ids, sorted);
    // Two squares on three: 2 side contacts below, 1 above, 4 between the rows.
    assert_eq!(ids.len(), 2 * 7);
}

#[test]
fn empty_and_single_block_scenes_have_no_contacts() {
    let mut scene = empty();
    assert_eq!(find_contacts(&scene).unwrap(), ContactSet::default());
    square(&mut scene, 0.0, 0.0);
    assert_eq!(find_contacts(&scene).unwrap(), ContactSet::default());
}
