//! Adding blocks to a scene: names, and what is refused with which words.

use drystone::geometry::Pose;
use drystone::{BodyOptions, Scene, SceneError};

fn empty() -> Scene {
    Scene::new([0.0, -9.81], 0.5).unwrap()
}

fn named(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.to_owned()), ..BodyOptions::default() }
}

fn square(scene: &mut Scene, options: BodyOptions) -> Result<usize, SceneError> {
    scene.add_box([0.0, 0.0], [1.0, 1.0], 0.0, options)
}

fn names(scene: &Scene) -> Vec<&str> {
    scene.bodies().iter().map(|body| body.name.as_str()).collect()
}

#[test]
fn default_names_never_collide_with_given_ones() {
    let mut scene = empty();
    for options in [named("b1"), BodyOptions::default(), named("b3-2"), BodyOptions::default()] {
        square(&mut scene, options).unwrap();
    }
    assert_eq!(names(&scene), ["b1", "b1-2", "b3-2", "b3"]);
    let error = square(&mut scene, named("b3")).unwrap_err();
    assert_eq!(error, SceneError::DuplicateName { name: "b3".into(), index: 3 });
    assert!(error.to_string().contains("\"b3\""), "{error}");
    assert_eq!(square(&mut scene, named("")).unwrap_err(), SceneError::EmptyName);
}

#[test]
fn an_unknown_name_suggests_the_nearest() {
    let mut scene = empty();
    square(&mut scene, named("lintel")).unwrap();
    square(&mut scene, named("left pier")).unwrap();
    assert_eq!(scene.index_of("left pier"), Ok(1));
    let error = scene.index_of("lintle").unwrap_err().to_string();
    assert_eq!(error, "no block is named \"lintle\": did you mean \"lintel\"?");
    let error = scene.index_of("keystone").unwrap_err().to_string();
    assert_eq!(error, "no block is named \"keystone\"");
}

#[test]
fn numbers_that_cannot_be_are_refused_with_block_and_quantity() {
    let (nan, infinity) = (f64::NAN, f64::INFINITY);
    let add = |center, size, angle, density, friction| {
        let options = BodyOptions { density, friction, ..named("brick") };
        empty().add_box(center, size, angle, options).unwrap_err().to_string()
    };
    let (here, size) = ([0.0, 0.0], [1.0, 1.0]);
    let cases = [
        (add([0.0, nan], size, 0.0, 1.0, None), "block \"brick\": center[1] is NaN: give a finite"),
        (add(here, size, infinity, 1.0, None), "block \"brick\": angle is inf: give a finite"),
        (add(here, [0.0, 1.0], 0.0, 1.0, None), "block \"brick\": size[0] is 0: it must be greater"),
        (add(here, [1.0, -2.0], 0.0, 1.0, None), "block \"brick\": size[1] is -2: it must be"),
        (add(here, size, 0.0, 0.0, None), "block \"brick\": density is 0: it must be greater"),
        (add(here, size, 0.0, nan, None), "block \"brick\": density is NaN: give a finite"),
        (add(here, size, 0.0, 1.0, Some(-0.1)), "block \"brick\": friction is -0.1: a coefficient"),
        (add(here, size, 0.0, 1.0, Some(nan)), "block \"brick\": friction is NaN: give a finite"),
        (
            add(here, [1e-200, 1.0], 0.0, 1.0, None),
            "block \"brick\": size[0] is 1e-200 m: it must be from 1e-12 to 1e12 m",
        ),
        (add([0.0, -1e13], size, 0.0, 1.0, None), "block \"brick\": center[1] is -1e13 m: it must be from -1e12 to"),
        (add(here, size, 1e300, 1.0, None), "block \"brick\": angle is 1e300 rad: it must be from -1e12"),
        (
            add(here, size, 0.0, 1.0, Some(1e7)),
            "block \"brick\": friction is 1e7: it must be at most 1e6: with 1e6 nothing",
        ),
        (add(here, [1e12, 1e-2], 0.0, 1e-9, None), "block \"brick\": the distance of its corners from its centre is 5"),
        // Each is fine, their product is not.
        (add(here, [1.0, 1.0], 0.0, 1e-320, None), "block \"brick\": mass is 1e-320 kg: it must be"),
        (add(here, [1e-10, 1e-10], 0.0, 1e-320, None), "block \"brick\": mass is 0: it must be"),
        (add(here, [1e10, 1e10], 0.0, 1e300, None), "block \"brick\": mass is inf: give a finite"),
        (add(here, [1.0, 1.0], 0.0, 1e25, None), "block \"brick\": mass is 1e25 kg: it must be from 1e-24 to"),
    ];
    for (text, expected) in cases {
        assert!(text.starts_with(expected), "{text}");
    }
    assert!(matches!(Scene::new([nan, 0.0], 0.0), Err(SceneError::NotFinite { .. })));
    assert!(matches!(Scene::new([0.0, 0.0], -1.0), Err(SceneError::NegativeFriction { .. })));
    for gravity in [1e-300, 1e13] {
        assert!(matches!(Scene::new([0.0, gravity], 0.0), Err(SceneError::OutOfBounds { .. })));
    }
    let far = empty().add_polygon(&[[0.0, 0.0], [1e200, 0.0], [0.0, 1e200]], named("far")).unwrap_err();
    assert!(far.to_string().starts_with("block \"far\": vertex 1[0] is 1e200 m"), "{far}");
    for tolerance in [0.0, -1.0, nan, 1e-30, 1e30] {
        assert!(empty().with_contact_tolerance(tolerance).is_err());
    }
}

#[test]
fn a_bad_polygon_is_refused_with_the_blocks_name_and_the_fix() {
    let add = |vertices: &[[f64; 2]]| empty().add_polygon(vertices, named("wedge")).unwrap_err().to_string();
    assert_eq!(
        add(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]),
        "block \"wedge\": the polygon has zero area: give corners that are not all on one line, in order round the block"
    );
    assert!(add(&[[0.0, 0.0], [1.0, 0.0]]).contains("at least three"));
    let dent = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]];
    assert!(add(&dent).contains("not convex at vertex 3: split it"));
}

#[test]
fn a_refused_block_leaves_the_scene_as_it_was() {
    let mut scene = empty();
    square(&mut scene, named("a")).unwrap();
    let before = scene.clone();
    let heavy = BodyOptions { density: -1.0, ..named("b") };
    assert!(square(&mut scene, heavy).is_err());
    assert_eq!(scene, before);
    square(&mut scene, named("b")).unwrap();
}

#[test]
fn a_polygon_stands_where_its_corners_were_given() {
    let corners = [[3.0, 1.0], [5.0, 1.0], [4.0, 4.0]];
    let mut scene = empty();
    scene.add_polygon(&corners, BodyOptions { density: 2.0, ..BodyOptions::default() }).unwrap();
    let body = &scene.bodies()[0];
    assert_eq!(body.pose, Pose { position: [4.0, 2.0], angle: 0.0 });
    assert_eq!(body.vertices(), corners);
    assert_eq!(body.mass(), 6.0);
    // An isosceles triangle of base b and height h: mass (b^2 / 24 + h^2 / 18).
    assert!((body.inertia() - 6.0 * (4.0 / 24.0 + 9.0 / 18.0)).abs() < 1e-14);
}

#[test]
fn pair_friction_never_exceeds_either_surface() {
    let mut scene = empty();
    for friction in [None, Some(0.2), Some(0.9)] {
        square(&mut scene, BodyOptions { friction, ..BodyOptions::default() }).unwrap();
    }
    assert_eq!(scene.pair_friction(0, 1), 0.2);
    assert_eq!(scene.pair_friction(0, 2), 0.5);
    assert_eq!(scene.pair_friction(2, 1), 0.2);
}
