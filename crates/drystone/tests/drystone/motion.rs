//! What the tests of motion share.

use drystone::{BodyOptions, Scene};

/// Acceleration of free fall, m/s^2.
pub const G: f64 = 9.81;

/// A scene with a long fixed ground, its upper side at height zero.
pub fn on_ground(friction: f64) -> Scene {
    let mut scene = Scene::new([0.0, -G], friction).unwrap();
    let ground = BodyOptions { name: Some("ground".into()), fixed: true, ..BodyOptions::default() };
    scene.add_box([0.0, -0.5], [100.0, 1.0], 0.0, ground).unwrap();
    scene
}

pub fn named(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.into()), ..BodyOptions::default() }
}

pub fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected} within {tolerance:e}");
}
