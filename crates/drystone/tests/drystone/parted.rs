//! Scenes whose blocks overlap, with the overlaps taken back; and what stands after that comes to rest.

use crate::motion::{close, named};
use drystone::{
    BodyOptions, Scene, SceneError,
    contact::find_solid_contacts,
    find_contacts, scenes,
    simulate::{Options, SimulationError, World, parted},
};
use std::f64::consts::FRAC_PI_2;

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

/// Cards of 2 mm by 40 cm that lean on one another, as in solver2d and PEEL; drawn with overlaps and gaps of millimetres.
fn house_of_cards(storeys: u8, friction: f64) -> Scene {
    let mut scene = on_ground(friction, [0.0, 0.0]);
    let lean = 25.0_f64.to_radians();
    for storey in 0..storeys {
        let (mut x, y) = (0.175 * f64::from(storey), 0.18 + 0.37 * f64::from(storey));
        for pair in storey..storeys {
            let mut card = |x: f64, y: f64, angle: f64| {
                scene.add_box([x, y], [0.002, 0.4], angle, BodyOptions::default()).unwrap();
            };
            if pair + 1 < storeys {
                card(x + 0.25, y + 0.185, FRAC_PI_2);
            }
            card(x, y, -lean);
            card(x + 0.175, y, lean);
            x += 0.35;
        }
    }
    scene
}

/// Rounding of places and of sliding speeds is no motion, though in a house of cards it comes to 5e-11 m/s and more. A body that moves elsewhere does
/// not change that.
#[test]
fn houses_of_cards_come_to_rest() {
    for storeys in 3..6 {
        for friction in [0.6, 0.7, 0.8] {
            let mut scene = house_of_cards(storeys, friction);
            scene.add_box([-20.0, 200.0], [1.0, 1.0], 0.0, named("falls")).unwrap();
            let mut world = World::new(parted(scene).unwrap(), Options::default()).unwrap();
            let cards = world.scene().bodies().len() - 2;
            let mut still = false;
            for _ in 0..60 {
                still = world.step().unwrap().motionless[..=cards].iter().all(|&still| still);
            }
            assert!(still, "{storeys} storeys, {friction}: {:?}", world.velocities());
            let highest = world.poses().take(cards + 1).map(|[_, y, _]| y).fold(0.0, f64::max);
            assert!(highest > 0.36 * f64::from(storeys) - 0.2, "{storeys} storeys, {friction}: {highest} m");
        }
    }
}
