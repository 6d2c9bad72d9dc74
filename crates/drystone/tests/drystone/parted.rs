//! Scenes whose blocks overlap, with the overlaps taken back.

use crate::motion::{close, named};
use drystone::{
    BodyOptions, Scene, SceneError,
    contact::find_solid_contacts,
    find_contacts, scenes,
    simulate::{Options, SimulationError, World, parted},
};

/// In solver2d's gravity.
fn on_ground(friction: f64, [x, y]: [f64; 2]) -> Scene {
    let mut scene = Scene::new([0.0, -10.0], friction).unwrap();
    scene.add_box([x, y - 1.0], [200.0, 2.0], 0.0, BodyOptions { fixed: true, ..named("ground") }).unwrap();
    scene
}

/// The momentum of the way apart is zero, and each goes no further than it must.
#[test]
fn two_blocks_part_by_the_least_motion() {
    let mut scene = Scene::new([0.0, 0.0], 0.5).unwrap();
    scene.add_box([0.0, 0.0], [1.0, 1.0], 0.0, BodyOptions { density: 3.0, ..named("heavy") }).unwrap();
    scene.add_box([0.8, 0.0], [1.0, 1.0], 0.0, named("light")).unwrap();
    let parted = parted(scene).unwrap();
    let x: Vec<f64> = parted.bodies().iter().map(|body| body.pose.position[0]).collect();
    close(x[0], -0.05, 1e-12);
    close(x[1], 0.95, 1e-12);
}

#[test]
fn what_does_not_overlap_keeps_its_bits() {
    let scene = scenes::wall(4, 3, 0, 0.5).unwrap();
    assert_eq!(parted(scene.clone()).unwrap(), scene);
}

/// As in solver2d's "overlap recovery", near the origin and far from it: rows of boxes, each a quarter in the next.
#[test]
fn a_pyramid_that_overlaps_parts_and_stands() {
    for [x, y] in [[0.0, 0.0], [80_000.0, -70_000.0]] {
        let mut scene = on_ground(0.6, [x, y]);
        for row in 0..4_u8 {
            for k in row..4 {
                let across = 0.375 * (f64::from(row) - 4.0) + 0.75 * f64::from(k - row);
                let at = [x + across, y + 0.5 + 0.75 * f64::from(row)];
                scene.add_box(at, [1.0, 1.0], 0.0, BodyOptions::default()).unwrap();
            }
        }
        assert!(matches!(
            World::new(scene.clone(), Options::default()),
            Err(SimulationError::Scene(SceneError::Overlap { .. }))
        ));
        let parted = parted(scene).unwrap();
        assert!(find_contacts(&parted).is_ok());
        let mut world = World::new(parted.clone(), Options::default()).unwrap();
        let record = world.step().unwrap();
        assert!(record.motionless.iter().all(|&still| still), "{record:?}");
    }
}

#[test]
fn solids_part_in_space() {
    let mut scene = Scene::new([0.0, -10.0], 0.6).unwrap();
    scene.add_box([0.0, 0.0], [2.0, 1.0], 0.0, BodyOptions { fixed: true, ..named("fixed") }).unwrap();
    scene.add_box([1.75, 0.25], [2.0, 1.0], 0.0, named("beside")).unwrap();
    let parted = parted(scenes::extruded(&scene, 1.0).unwrap()).unwrap();
    assert!(find_solid_contacts(&parted).is_ok());
    close(parted.bodies()[1].pose.position[0], 2.0, 1e-5);
}

#[test]
fn what_is_jammed_is_an_overlap() {
    let mut scene = Scene::new([0.0, -10.0], 0.6).unwrap();
    for (x, name) in [(-1.0, "left"), (1.0, "right")] {
        scene.add_box([x, 0.0], [1.0, 20.0], 0.0, BodyOptions { fixed: true, ..named(name) }).unwrap();
    }
    scene.add_box([0.0, 0.0], [1.2, 1.0], 0.0, named("jammed")).unwrap();
    assert!(matches!(parted(scene), Err(SimulationError::Scene(SceneError::Overlap { .. }))));
}
