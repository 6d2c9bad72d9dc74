//! Bodies in motion at one moment, and what pushes them.

use super::{
    kinematics::{Kinematics, inverse_mass, is_zero},
    options::Options,
};
use crate::scene::SceneOf;

/// What a step begins with.
#[derive(Debug, Clone)]
pub struct State<S: Kinematics> {
    /// The bodies where they are now, seen from the world's origin.
    pub scene: SceneOf<S>,
    pub options: Options,
    /// Of every body, its turning about its own axes.
    pub velocities: Vec<S::Velocity>,
    /// Wrenches for the next step: N, and N m about the own axes.
    pub forces: Vec<S::Velocity>,
    /// Diagonal of M^-1; zero for fixed bodies.
    pub inverse_mass: Vec<S::Velocity>,
    /// Bodies that did not move in the last step; before the first one, the fixed ones.
    pub motionless: Vec<bool>,
}

impl<S: Kinematics> State<S> {
    /// Bodies at rest.
    pub fn at_rest(scene: SceneOf<S>, options: Options) -> Self {
        let n = scene.bodies().len();
        let mut state = Self {
            velocities: vec![S::Velocity::default(); n],
            forces: vec![S::Velocity::default(); n],
            inverse_mass: Vec::new(),
            motionless: scene.bodies().iter().map(|body| body.fixed).collect(),
            options,
            scene,
        };
        state.weigh();
        state
    }

    /// Whether no body moves.
    pub fn is_at_rest(&self) -> bool {
        self.velocities.iter().all(is_zero)
    }

    /// Takes a scene that has further bodies behind the same ones; those are at rest.
    pub fn extend(&mut self, scene: SceneOf<S>) {
        for body in &scene.bodies()[self.velocities.len()..] {
            self.velocities.push(S::Velocity::default());
            self.forces.push(S::Velocity::default());
            self.motionless.push(body.fixed);
        }
        self.scene = scene;
        self.weigh();
    }

    /// Takes body i out.
    pub fn remove(&mut self, i: usize) {
        self.scene.remove(i);
        self.velocities.remove(i);
        self.forces.remove(i);
        self.motionless.remove(i);
        self.weigh();
    }

    fn weigh(&mut self) {
        self.inverse_mass = self.scene.bodies().iter().map(inverse_mass).collect();
    }
}
