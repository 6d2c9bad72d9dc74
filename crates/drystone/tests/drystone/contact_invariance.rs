//! Contacts do not depend on the order of the blocks, nor on where the scene stands.

use drystone::geometry::{Pose, Vector};
use drystone::{BodyOptions, Contact, ContactSet, Feature, Scene, SceneError, find_contacts};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// A polygon in the world, counter-clockwise.
type Outline = Vec<Vector>;

fn scene_of<'a>(outlines: impl Iterator<Item = &'a Outline>) -> Scene {
    let mut scene = Scene::new([0.0, -9.81], 0.5).unwrap();
    for outline in outlines {
        let corners: Vec<[f64; 2]> = outline.iter().map(|v| v.to_array()).collect();
        scene.add_polygon(&corners, BodyOptions::default()).unwrap();
    }
    scene
}

/// A convex polygon with corners on an ellipse, turned.
fn outline() -> impl Strategy<Value = Outline> {
    let corners = prop::collection::vec(0.3..1.0_f64, 3..8);
    (corners, 0.3..2.0_f64, 0.0..TAU).prop_map(|(steps, flatness, angle)| {
        let total: f64 = steps.iter().sum();
        let mut at = 0.0;
        let turn = Pose { position: [0.0, 0.0], angle };
        let corner = |step: &f64| {
            at += TAU * step / total;
            turn.transform(Vector::new(at.cos(), flatness * at.sin()))
        };
        steps.iter().map(corner).collect()
    })
}

fn face(outline: &Outline, k: usize) -> (Vector, Vector) {
    let k = k % outline.len();
    (outline[k], outline[(k + 1) % outline.len()])
}

/// Moves `outline` so that its face `k` lies on the face `on`, from a share of it on and beyond its start.
fn laid_on(outline: &Outline, k: usize, on: (Vector, Vector), share: f64) -> Outline {
    let (a, b) = face(outline, k);
    let angle = (b - a).angle_to(on.0 - on.1);
    placed(outline, a, angle, on.1 + share * (on.0 - on.1))
}

/// Moves `outline` so that its corner `k` stands square on the face `on`, at a share of it.
fn stood_on(outline: &Outline, k: usize, on: (Vector, Vector), share: f64) -> Outline {
    let n = outline.len();
    let corner = outline[k % n];
    let [before, after] = [outline[(k + n - 1) % n], outline[(k + 1) % n]];
    let inwards = (before - corner).normalize() + (after - corner).normalize();
    let angle = inwards.angle_to(-(on.1 - on.0).perp());
    placed(outline, corner, angle, on.0 + share * (on.1 - on.0))
}

/// Turns by `angle` about `pivot`, which goes to `target`.
fn placed(outline: &Outline, pivot: Vector, angle: f64, target: Vector) -> Outline {
    let pose = Pose { position: target.to_array(), angle };
    outline.iter().map(|v| pose.transform(*v - pivot)).collect()
}

prop_compose! {
    /// A block, another one lying on one of its faces and a third standing on the next face.
    fn group()(
        base in outline(), lying in outline(), standing in outline(),
        face_of_base in 0..8_usize, face_of_lying in 0..8_usize, corner in 0..8_usize,
        slide in 0.0..0.9_f64, stand in 0.1..0.9_f64,
    ) -> Vec<Outline> {
        let first = laid_on(&lying, face_of_lying, face(&base, face_of_base), slide);
        let second = stood_on(&standing, corner, face(&base, face_of_base + 1), stand);
        vec![base, first, second]
    }
}

/// The contacts, unless the second and third block happen to overlap.
fn contacts(scene: &Scene) -> Option<ContactSet> {
    match find_contacts(scene) {
        Ok(set) => Some(set),
        Err(SceneError::Overlap { .. }) => None,
        Err(error) => panic!("{error}"),
    }
}

/// The same contact seen from the other block: its face runs the other way.
fn swapped(feature: Feature) -> Feature {
    match feature {
        Feature::Faces { a, b, end } => Feature::Faces { a: b, b: a, end: 1 - end },
        Feature::CornerOfA { a, b } => Feature::CornerOfB { a: b, b: a },
        Feature::CornerOfB { a, b } => Feature::CornerOfA { a: b, b: a },
        Feature::Solids { a, b } => Feature::Solids { a: b, b: a },
        Feature::Corners { a, b } => Feature::Corners { a: b, b: a },
        Feature::Borders { a, b } => Feature::Borders { a: b, b: a },
        Feature::Surfaces { pieces: [i, j], triangles: [a, b], corner } => {
            Feature::Surfaces { pieces: [j, i], triangles: [b, a], corner }
        }
    }
}

/// The contact as it would be with the blocks in reverse order.
fn reversed(contact: &Contact, blocks: usize) -> Contact {
    let [a, b] = contact.bodies;
    let mut other = contact.clone();
    other.bodies = [blocks - 1 - b, blocks - 1 - a];
    other.id.bodies = other.bodies;
    other.id.feature = swapped(contact.id.feature);
    other.normal = contact.normal.map(|x| -x);
    other
}

fn assert_same(found: &ContactSet, expected: &[Contact]) -> Result<(), TestCaseError> {
    let mut expected = expected.to_vec();
    expected.sort_by_key(|contact| contact.id);
    prop_assert_eq!(found.contacts.len(), expected.len());
    for (a, b) in found.contacts.iter().zip(&expected) {
        prop_assert_eq!(a.id, b.id);
        // Coordinates up to some hundred metres: rounding of a few 1e-14.
        let near = |x: [f64; 3], y: [f64; 3]| (0..3).all(|k| (x[k] - y[k]).abs() < 1e-11);
        prop_assert!(near(a.point, b.point), "{:?} instead of {:?}", a.point, b.point);
        prop_assert!(near(a.normal, b.normal), "{:?} instead of {:?}", a.normal, b.normal);
        prop_assert!((a.gap - b.gap).abs() < 1e-11);
    }
    Ok(())
}

fn in_plane([x, y, _]: [f64; 3]) -> Vector {
    Vector::new(x, y)
}

fn in_space(v: Vector) -> [f64; 3] {
    [v.x, v.y, 0.0]
}

/// The contacts of blocks listed the other way round.
fn assert_order_does_not_matter(outlines: &[Outline], set: &ContactSet) -> Result<(), TestCaseError> {
    let backwards = contacts(&scene_of(outlines.iter().rev())).unwrap();
    let expected: Vec<Contact> = set.contacts.iter().map(|c| reversed(c, outlines.len())).collect();
    assert_same(&backwards, &expected)?;
    prop_assert_eq!(backwards.corner_touches.len(), set.corner_touches.len());
    Ok(())
}

/// The contacts of blocks `scale` times as large, then moved.
fn assert_moved_along(outlines: &[Outline], set: &ContactSet, scale: f64, motion: &Pose) -> Result<(), TestCaseError> {
    let moved: Vec<Outline> =
        outlines.iter().map(|o| o.iter().map(|v| motion.transform(scale * *v)).collect()).collect();
    let after = contacts(&scene_of(moved.iter())).unwrap();
    let along = |contact: &Contact| Contact {
        point: in_space(motion.transform(scale * in_plane(contact.point))),
        normal: in_space(motion.rotate(in_plane(contact.normal))),
        gap: scale * contact.gap,
        ..contact.clone()
    };
    let expected: Vec<Contact> = set.contacts.iter().map(along).collect();
    assert_same(&after, &expected)?;
    prop_assert_eq!(&after.corner_touches, &set.corner_touches);
    Ok(())
}

/// Moves `outline` so that its corner `k` meets the corner `j` of `other` and a line parts them: straight against one another
/// where `lean` is 0, as far from that as a line allows where it is 1.
fn cornered(outline: &Outline, k: usize, other: &Outline, j: usize, lean: f64) -> Outline {
    let inwards = |outline: &Outline, k: usize| {
        let n = outline.len();
        let sides = [k + n - 1, k + 1].map(|at| (outline[at % n] - outline[k % n]).normalize());
        (sides[0] + sides[1], sides[0].dot(sides[1]).clamp(-1.0, 1.0).acos())
    };
    let (j, k) = (j % other.len(), k % outline.len());
    let ((own, own_angle), (into, angle)) = (inwards(outline, k), inwards(other, j));
    let most = 0.5 * (TAU - own_angle - angle);
    placed(outline, outline[k], own.angle_to(-into) + lean * most, other[j])
}

prop_compose! {
    /// A block, and another one whose corner meets a corner of it.
    fn at_a_corner()(
        base in outline(), other in outline(), corner in 0..8_usize, own in 0..8_usize, lean in -0.9..0.9_f64,
    ) -> Vec<Outline> {
        let second = cornered(&other, own, &base, corner, lean);
        vec![base, second]
    }
}

proptest! {
    #[test]
    fn the_order_of_the_blocks_does_not_matter(outlines in group()) {
        let Some(set) = contacts(&scene_of(outlines.iter())) else { return Err(TestCaseError::reject("overlap")) };
        // Two ends of the shared face and one corner; the second and third block may touch as well.
        prop_assert!(set.contacts.len() >= 3, "{:?}", set);
        assert_order_does_not_matter(&outlines, &set)?;
    }

    #[test]
    fn a_rigid_motion_moves_the_contacts_along(
        outlines in group(), x in -100.0..100.0_f64, y in -100.0..100.0_f64, angle in -TAU..TAU,
    ) {
        let Some(set) = contacts(&scene_of(outlines.iter())) else { return Err(TestCaseError::reject("overlap")) };
        assert_moved_along(&outlines, &set, 1.0, &Pose { position: [x, y], angle })?;
    }

    #[test]
    fn a_corner_on_a_corner_has_one_normal(
        outlines in at_a_corner(), x in -10.0..10.0_f64, y in -10.0..10.0_f64, angle in -TAU..TAU, scale in 0.1..10.0_f64,
    ) {
        let set = contacts(&scene_of(outlines.iter())).unwrap();
        prop_assert_eq!(set.contacts.len(), 1);
        let contact = &set.contacts[0];
        prop_assert!(contact.id.feature.at_borders(), "{}", contact.id);
        // The line square to it parts the two.
        let side = |outline: &Outline, sign: f64| {
            let over = |v: &Vector| sign * in_plane(contact.normal).dot(*v - in_plane(contact.point));
            outline.iter().map(over).fold(f64::INFINITY, f64::min)
        };
        prop_assert!(side(&outlines[0], -1.0) > -1e-9 && side(&outlines[1], 1.0) > -1e-9, "{:?}", contact);
        assert_order_does_not_matter(&outlines, &set)?;
        assert_moved_along(&outlines, &set, scale, &Pose { position: [x, y], angle })?;
    }
}
