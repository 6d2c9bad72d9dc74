//! Blocks with a mass, a centre of mass and an inertia of their own.

use drystone::geometry::{Pose, PoseInSpace, Shape, SolidFault};
use drystone::simulate::{Options, World};
use drystone::{
    AnyScene, BodyOptions, FileError, InertiaFault, MassProperties, Scene, SceneError, SceneInSpace, check, io, scenes,
};

fn fixed() -> BodyOptions {
    BodyOptions { name: Some("ground".into()), fixed: true, ..BodyOptions::default() }
}

fn weighing(own: MassProperties) -> BodyOptions {
    BodyOptions { name: Some("block".into()), own, ..BodyOptions::default() }
}

fn in_space() -> SceneInSpace {
    let mut scene = SceneInSpace::new([0.0, 0.0, -9.81], 0.5).unwrap();
    let pose = PoseInSpace { position: [0.0, 0.0, -0.5], ..PoseInSpace::WORLD };
    scene.add_cuboid(pose, [20.0, 20.0, 1.0], fixed()).unwrap();
    scene
}

fn corners(low: [f64; 3], high: [f64; 3]) -> Vec<[f64; 3]> {
    (0..8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { high[axis] } else { low[axis] })).collect()
}

#[test]
fn a_box_stands_while_its_centre_of_mass_is_over_its_foot() {
    for (offset, stands) in [(0.0, true), (0.049, true), (0.051, false), (5.0, false), (-0.051, false)] {
        let own = MassProperties { mass: Some(7.0), center_of_mass: Some([offset, 0.0, 0.0]), inertia: None };
        let mut scene = in_space();
        let pose = PoseInSpace { position: [1.0, 2.0, 0.5], ..PoseInSpace::WORLD };
        scene.add_cuboid(pose, [0.1, 0.1, 1.0], weighing(own)).unwrap();
        assert_eq!(check(&scene, None).unwrap().stable, stands, "in space, {offset}");
        let body = &scene.bodies()[1];
        assert_eq!((body.mass(), body.pose.position[0]), (7.0, 1.0 + offset));

        let mut plane = Scene::new([0.0, -9.81], 0.5).unwrap();
        plane.add_box([0.0, -0.5], [20.0, 1.0], 0.0, fixed()).unwrap();
        plane.add_box([1.0, 0.5], [0.1, 1.0], 0.0, weighing(own)).unwrap();
        assert_eq!(check(&plane, None).unwrap().stable, stands, "in the plane, {offset}");
    }
}

#[test]
fn a_centre_of_mass_and_an_inertia_turn_with_the_frame() {
    // A quarter about z takes the body's x axis to y.
    let half = 0.5_f64.sqrt();
    let pose = PoseInSpace { position: [0.0, 0.0, 0.5], orientation: [half, 0.0, 0.0, half] };
    let inertia = Some([[1.0, 0.1, 0.0], [0.1, 2.0, 0.0], [0.0, 0.0, 2.5]]);
    let mut scene = in_space();
    let own = MassProperties { mass: Some(3.0), center_of_mass: Some([0.2, 0.0, 0.1]), inertia };
    scene.add_cuboid(pose, [1.0, 1.0, 1.0], weighing(own)).unwrap();
    let body = &scene.bodies()[1];
    let at = |found: [f64; 3], expected: [f64; 3]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15);
    assert!(at(body.pose.position, [0.0, 0.2, 0.6]));
    assert!(at(body.shape.centroid(), [-0.2, 0.0, -0.1]));
    assert!(body.corners().iter().all(|p| p[0].abs() < 0.5 + 1e-12 && p[1].abs() < 0.5 + 1e-12 && p[2] > -1e-12));
    // The middle 2 x 2 block has the eigenvalues 1.5 -+ sqrt(.25 + .01).
    let away = 0.26_f64.sqrt();
    let mut moments = body.moments().to_vec();
    moments.sort_by(f64::total_cmp);
    assert!(at([moments[0], moments[1], moments[2]], [1.5 - away, 1.5 + away, 2.5]));
}

/// A rod hinged by nothing, struck beside its centre of mass: with J an impulse along y at the lever r along x, v = J / m and
/// w = r J / I.
#[test]
fn a_struck_body_turns_about_its_own_centre_of_mass() {
    let mut scene = SceneInSpace::new([0.0; 3], 0.0).unwrap();
    let inertia = Some([[0.4, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.8]]);
    let own = MassProperties { mass: Some(2.0), center_of_mass: Some([0.25, 0.0, 0.0]), inertia };
    scene.add_cuboid(PoseInSpace::WORLD, [1.0, 0.2, 0.2], weighing(own)).unwrap();
    let mut world = World::new(scene, Options::default()).unwrap();
    world.apply_impulse("block", [0.0, 6.0, 0.0, 0.0, 0.0, 0.0], Some([0.5, 0.0, 0.0])).unwrap();
    let velocity = world.velocities()[0];
    assert!((velocity[1] - 3.0).abs() < 1e-12 && (velocity[5] - 0.25 * 6.0 / 0.8).abs() < 1e-12, "{velocity:?}");
}

#[test]
fn a_mass_scales_the_shape() {
    let mut scene = in_space();
    let own = MassProperties { mass: Some(12.0), ..MassProperties::default() };
    scene.add_cuboid(PoseInSpace::WORLD, [1.0, 2.0, 3.0], weighing(own)).unwrap();
    let body = &scene.bodies()[1];
    assert_eq!((body.mass(), body.density, body.box_size), (12.0, 2.0, Some([1.0, 2.0, 3.0])));
    assert!(body.moments().iter().zip([13.0, 10.0, 5.0]).all(|(found, expected)| (found - expected).abs() < 1e-12));
}

#[test]
fn pieces_overlap_where_the_mass_is_given() {
    // A table whose leg reaches into the top.
    let table = [corners([-0.5, -0.5, 0.9], [0.5, 0.5, 1.0]), corners([-0.1, -0.1, 0.0], [0.1, 0.1, 0.95])];
    let refused = in_space().add_solid(&table, PoseInSpace::WORLD, weighing(MassProperties::default()));
    let fault = match refused {
        Err(SceneError::BadSolid { fault: fault @ SolidFault::PiecesOverlap { .. }, .. }) => fault.to_string(),
        other => panic!("{other:?}"),
    };
    assert!(fault.contains("give the block's mass"), "{fault}");

    let mut scene = in_space();
    let own = MassProperties { mass: Some(12.0), ..MassProperties::default() };
    scene.add_solid(&table, PoseInSpace::WORLD, weighing(own)).unwrap();
    let pose = PoseInSpace { position: [0.4, 0.0, 1.05], ..PoseInSpace::WORLD };
    let cup = BodyOptions { name: Some("cup".into()), density: 1.0, ..BodyOptions::default() };
    scene.add_cuboid(pose, [0.1, 0.1, 0.1], cup).unwrap();
    let verdict = check(&scene, None).unwrap();
    assert!(verdict.stable);
    // The cup stands on the top alone, the leg on the ground alone: four points each.
    assert_eq!(verdict.forces.len(), 8);
    // Forces on the ground bear both.
    let weight = 9.81 * (12.0 + 0.001);
    let borne: f64 = verdict.forces.iter().filter(|(c, _)| c.bodies[0] == 0).map(|(_, f)| f.force[2]).sum();
    assert!((borne - weight).abs() < 1e-9 * weight, "{borne}");

    // It stays where it is in motion, and a block may be let fall on it.
    let mut world = World::new(scene, Options::default()).unwrap();
    for _ in 0..20 {
        assert!(world.step().unwrap().motionless.iter().all(|&still| still));
    }
    // What is fixed weighs nothing.
    in_space().add_solid(&table, PoseInSpace::WORLD, BodyOptions { fixed: true, ..BodyOptions::default() }).unwrap();
}

#[test]
fn bodies_of_their_own_weight_come_back_bit_for_bit() {
    let mut scene = in_space();
    let pose = PoseInSpace { position: [0.3, 0.1, 7.0], orientation: [0.9, 0.1, -0.3, 0.2] };
    let inertia = Some([[0.3, 0.01, 0.02], [0.01, 0.4, 0.03], [0.02, 0.03, 0.5]]);
    let center_of_mass = Some([0.1, 1.0 / 3.0, -0.7]);
    for own in [
        MassProperties { mass: Some(1.0 / 7.0), center_of_mass, inertia },
        MassProperties { mass: None, center_of_mass, inertia: None },
        MassProperties { mass: Some(0.3), center_of_mass: None, inertia },
    ] {
        let options = BodyOptions { own, ..BodyOptions::default() };
        scene.add_cuboid(pose, [0.3, 0.7, 1.1], options.clone()).unwrap();
        let pieces = [corners([0.0, 0.0, 0.0], [1.0, 0.3, 0.7]), corners([0.0, 0.3, 0.0], [0.31, 1.0, 0.7])];
        scene.add_solid(&pieces, pose, options).unwrap();
    }
    let scene = AnyScene::from(scene);
    let text = scene.to_json();
    let again = io::from_json(&text, "scene").unwrap();
    assert_eq!(again, scene);
    assert_eq!(again.to_json(), text);

    let mut plane = Scene::new([0.0, -9.81], 0.5).unwrap();
    let mut inertia = [[0.0; 3]; 3];
    inertia[2][2] = 0.07;
    let own = MassProperties { mass: Some(0.3), center_of_mass: Some([0.1, 0.7, 0.0]), inertia: Some(inertia) };
    plane.add_box([0.2, 0.3], [0.7, 1.1], 0.3, weighing(own)).unwrap();
    let frame = Pose { position: [5.0, 0.1], angle: 1.0 };
    let options = BodyOptions { own: MassProperties { inertia: None, ..own }, ..BodyOptions::default() };
    plane.add_placed_polygon(&[[0.0, 0.0], [1.0, 0.1], [0.3, 0.9]], frame, options).unwrap();
    let plane = AnyScene::from(plane);
    assert_eq!(io::from_json(&plane.to_json(), "scene").unwrap(), plane);
}

/// A file says it in the frame of the shape.
#[test]
fn a_file_gives_mass_centre_and_inertia() {
    let file = |body: &str| {
        format!(
            r#"{{"format": "drystone-scene", "version": 1, "dimension": 2, "gravity": [0, -9.81], "friction": 0.5,
                "bodies": [{body}]}}"#
        )
    };
    let body = r#"{"box": {"size": [2, 1]}, "position": [3, 0], "angle": 3.141592653589793,
                   "mass": 5, "center_of_mass": [0.5, 0], "inertia": 4}"#;
    let scene = io::from_json(&file(body), "scene").unwrap().in_plane().unwrap();
    let body = &scene.bodies()[0];
    assert_eq!((body.mass(), body.inertia()), (5.0, 4.0));
    assert!((body.pose.position[0] - 2.5).abs() < 1e-15);
    let both = io::from_json(&file(r#"{"box": {"size": [2, 1]}, "mass": 5, "density": 2}"#), "scene").unwrap_err();
    assert!(matches!(both, SceneError::File(FileError::WrongType { .. })), "{both}");
    assert!(both.to_string().contains("\"density\" beside \"mass\""), "{both}");
}

#[test]
fn what_no_body_weighs_is_refused_by_name() {
    let refused = |own: MassProperties| {
        let mut scene = in_space();
        scene.add_cuboid(PoseInSpace::WORLD, [1.0, 1.0, 1.0], weighing(own)).unwrap_err()
    };
    let with = |inertia: [[f64; 3]; 3]| match refused(MassProperties {
        inertia: Some(inertia),
        ..MassProperties::default()
    }) {
        SceneError::BadInertia { body, fault } => {
            assert_eq!(body, "block");
            fault
        }
        other => panic!("{other}"),
    };
    let diagonal = |a: f64, b: f64, c: f64| [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]];
    assert!(matches!(with(diagonal(1.0, 1.0, -1.0)), InertiaFault::NotPositive { .. }));
    assert!(matches!(with(diagonal(1.0, 0.0, 1.0)), InertiaFault::NotPositive { .. }));
    assert!(matches!(with(diagonal(1.0, 1.0, 2.01)), InertiaFault::Triangle { .. }));
    let mut lopsided = diagonal(1.0, 1.0, 1.0);
    lopsided[0][1] = 0.1;
    assert!(matches!(with(lopsided), InertiaFault::NotSymmetric { i: 0, j: 1, .. }));
    // A plate given with three digits.
    let mut scene = in_space();
    let own = MassProperties { inertia: Some(diagonal(0.333, 0.334, 0.6675)), ..MassProperties::default() };
    scene.add_cuboid(PoseInSpace::WORLD, [1.0, 1.0, 1.0], weighing(own)).unwrap();

    for own in [
        MassProperties { mass: Some(0.0), ..MassProperties::default() },
        MassProperties { mass: Some(f64::NAN), ..MassProperties::default() },
        MassProperties { center_of_mass: Some([0.0, f64::INFINITY, 0.0]), ..MassProperties::default() },
        MassProperties { inertia: Some(diagonal(1.0, f64::NAN, 1.0)), ..MassProperties::default() },
    ] {
        let error = refused(own).to_string();
        assert!(error.starts_with("block \"block\": "), "{error}");
    }
}

/// A planar figure's own moment stays its moment about y, and no moment exceeds the sum of the others.
#[test]
fn an_extruded_block_keeps_its_weight() {
    let mut plane = Scene::new([0.0, -9.81], 0.5).unwrap();
    let mut inertia = [[0.0; 3]; 3];
    inertia[2][2] = 3.0;
    let own = MassProperties { mass: Some(4.0), center_of_mass: Some([0.2, 0.1, 0.0]), inertia: Some(inertia) };
    plane.add_polygon(&[[0.0, 0.0], [1.0, 0.1], [0.3, 0.9]], weighing(own)).unwrap();
    let solid = scenes::extruded(&plane, 0.5).unwrap();
    let body = &solid.bodies()[0];
    assert_eq!(body.mass(), 4.0);
    assert!((body.pose.position[0] - 0.2).abs() + (body.pose.position[2] - 0.1).abs() < 1e-15);
    let own_moment = body.moments().iter().zip(body.principal_axes()).find(|(_, axis)| axis.y.abs() > 1.0 - 1e-12);
    assert!((own_moment.unwrap().0 - 3.0).abs() < 1e-12);
    // Ixx + Izz = Iyy + m d^2 / 6.
    let sum: f64 = body.moments().iter().sum();
    assert!((sum - (2.0 * 3.0 + 4.0 * 0.25 / 6.0)).abs() < 1e-12);
}
