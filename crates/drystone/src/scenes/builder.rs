//! Adds numbered blocks and named fixed ones to a scene.

use crate::error::SceneError;
use crate::scene::{BodyOptions, Scene};

/// Gravity of every built-in scene, m/s^2.
const GRAVITY: [f64; 2] = [0.0, -9.81];

/// A scene under construction.
pub(super) struct Builder {
    scene: Scene,
    placed: usize,
}

impl Builder {
    pub fn new(friction: f64) -> Result<Self, SceneError> {
        Ok(Self { scene: Scene::new(GRAVITY, friction)?, placed: 0 })
    }

    /// A fixed rectangle whose upper side runs from `left` to `right` at height zero.
    pub fn ground(&mut self, name: &str, left: f64, right: f64, depth: f64) -> Result<(), SceneError> {
        let center = [0.5 * (left + right), -0.5 * depth];
        self.scene.add_box(center, [right - left, depth], 0.0, fixed(name))?;
        Ok(())
    }

    /// A fixed rectangle anywhere.
    pub fn fixed_box(&mut self, name: &str, center: [f64; 2], size: [f64; 2], angle: f64) -> Result<(), SceneError> {
        self.scene.add_box(center, size, angle, fixed(name))?;
        Ok(())
    }

    /// A movable rectangle.
    pub fn block(&mut self, center: [f64; 2], size: [f64; 2]) -> Result<(), SceneError> {
        self.turned_block(center, size, 0.0)
    }

    /// A movable rectangle, turned.
    pub fn turned_block(&mut self, center: [f64; 2], size: [f64; 2], angle: f64) -> Result<(), SceneError> {
        let options = self.next_number();
        self.scene.add_box(center, size, angle, options)?;
        Ok(())
    }

    /// A movable rectangle, turned, with a name of its own.
    pub fn leaning_block(
        &mut self,
        name: &str,
        center: [f64; 2],
        size: [f64; 2],
        angle: f64,
    ) -> Result<(), SceneError> {
        let options = BodyOptions { name: Some(name.to_owned()), ..BodyOptions::default() };
        self.scene.add_box(center, size, angle, options)?;
        Ok(())
    }

    /// A movable polygon by its corners in the world.
    pub fn polygon(&mut self, vertices: &[[f64; 2]]) -> Result<(), SceneError> {
        let options = self.next_number();
        self.scene.add_polygon(vertices, options)?;
        Ok(())
    }

    pub fn finish(self) -> Scene {
        self.scene
    }

    fn next_number(&mut self) -> BodyOptions {
        self.placed += 1;
        BodyOptions { name: Some(self.placed.to_string()), ..BodyOptions::default() }
    }
}

fn fixed(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.to_owned()), fixed: true, ..BodyOptions::default() }
}
