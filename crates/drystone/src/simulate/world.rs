//! Bodies in motion, and what may be done to them between two steps.

use super::{
    error::SimulationError,
    formulation::Formulation,
    reuse::{Reuse, Route},
    sliding::Carried,
    velocity_level::{Velocity, VelocityLevel},
};
use crate::{
    contact::{ContactId, approach::ApproachFinder, find_contacts},
    error::SceneError,
    scene::{BodyOptions, Scene},
};

/// How a world makes its steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Length of a step, seconds.
    pub dt: f64,
    /// What a step takes over from the one before.
    pub reuse: Reuse,
    /// Share of the normal velocity with which colliding blocks part: 0 for none, 1 for all.
    pub restitution: f64,
    /// What the unknowns of a step are.
    pub formulation: Formulation,
}

impl Default for Options {
    fn default() -> Self {
        Self { dt: 1.0 / 240.0, reuse: Reuse::Full, restitution: 0.0, formulation: Formulation::Velocity }
    }
}

/// A scene in motion.
///
/// ```
/// use drystone::{scenes, simulate::{Options, World}};
///
/// let mut world = World::new(scenes::column(5, 0.5)?, Options::default())?;
/// let record = world.step()?;
/// assert!(record.motionless.iter().all(|&still| still));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct World {
    pub(super) scene: Scene,
    pub(super) options: Options,
    pub(super) velocities: Vec<Velocity>,
    /// Wrenches for the next step: N, N, N m.
    pub(super) forces: Vec<[f64; 3]>,
    /// Diagonal of M^-1, three entries a body; zero for fixed ones.
    pub(super) inverse_mass: Vec<[f64; 3]>,
    /// Bodies that did not move in the last step; before the first one, the fixed ones.
    pub(super) motionless: Vec<bool>,
    pub(super) steps: u64,
    pub(super) finder: ApproachFinder,
    pub(super) route: Box<dyn Route>,
    /// The problem of the last step, if it was solved.
    pub(super) before: Option<VelocityLevel>,
    /// Sliding speed at each of its approaches, m/s.
    pub(super) sliding: Vec<f64>,
    /// Impulse at each of its approaches, along the normal and the tangent, N s.
    pub(super) impulses: Vec<[f64; 2]>,
    /// On the acceleration level with full reuse: where solves of islands with sliding contacts start.
    pub(super) carried: Carried,
}

/// What one block gave another in the last step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactImpulse {
    /// Which corner and which face.
    pub id: ContactId,
    /// The corner, world coordinates, metres, at the beginning of the step.
    pub point: [f64; 2],
    /// Unit vector from the first body into the second.
    pub normal: [f64; 2],
    /// Impulse on the second body along the normal, N s: never negative. Divided by dt it is the mean force.
    pub along_normal: f64,
    /// Along the normal turned a quarter counter-clockwise.
    pub along_tangent: f64,
}

impl ContactImpulse {
    /// Impulse on the second body in world axes, N s.
    pub fn impulse(&self) -> [f64; 2] {
        let ([nx, ny], n, t) = (self.normal, self.along_normal, self.along_tangent);
        [n * nx - t * ny, n * ny + t * nx]
    }
}

impl World {
    /// A world at rest.
    ///
    /// # Errors
    /// [`SimulationError::TimeStep`], [`SimulationError::Restitution`]; [`SceneError::Overlap`] if blocks overlap.
    pub fn new(scene: Scene, options: Options) -> Result<Self, SimulationError> {
        find_contacts(&scene)?;
        Self::resting(scene, options)
    }

    /// The same without a look at overlaps: a step may end with one, and a snapshot may be taken there.
    pub(super) fn resting(scene: Scene, options: Options) -> Result<Self, SimulationError> {
        let Options { dt, restitution, .. } = options;
        if !(dt.is_finite() && dt > 0.0) {
            return Err(SimulationError::TimeStep { value: dt });
        }
        if !(0.0..=1.0).contains(&restitution) {
            return Err(SimulationError::Restitution { value: restitution });
        }
        let n = scene.bodies().len();
        let mut world = Self {
            inverse_mass: Vec::new(),
            velocities: vec![[0.0; 3]; n],
            forces: vec![[0.0; 3]; n],
            motionless: scene.bodies().iter().map(|body| body.fixed).collect(),
            steps: 0,
            finder: ApproachFinder::default(),
            route: options.reuse.route(),
            before: None,
            sliding: Vec::new(),
            impulses: Vec::new(),
            carried: Carried::default(),
            options,
            scene,
        };
        world.weigh();
        Ok(world)
    }

    fn weigh(&mut self) {
        let inverse = |body: &crate::scene::Body| {
            let (mass, inertia) = (body.mass().recip(), body.inertia().recip());
            if body.fixed { [0.0; 3] } else { [mass, mass, inertia] }
        };
        self.inverse_mass = self.scene.bodies().iter().map(inverse).collect();
    }

    /// The bodies where they are now.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How steps are made.
    pub fn options(&self) -> Options {
        self.options
    }

    /// Velocity of every body: m/s, m/s, rad/s.
    pub fn velocities(&self) -> &[Velocity] {
        &self.velocities
    }

    /// Place of every body: centroid, metres, and angle, radians.
    pub fn poses(&self) -> impl Iterator<Item = [f64; 3]> {
        self.scene.bodies().iter().map(|body| [body.pose.position[0], body.pose.position[1], body.pose.angle])
    }

    /// Whether each body kept its place in the last step; fixed ones always do.
    pub fn motionless(&self) -> &[bool] {
        &self.motionless
    }

    /// Steps made.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Kinetic energy and the potential energy of gravity (zero at the origin), joules. Fixed bodies have none.
    pub fn energy(&self) -> f64 {
        let [gx, gy] = self.scene.gravity();
        let of = |(body, [vx, vy, turning]): (&crate::scene::Body, &Velocity)| {
            let [x, y] = body.pose.position;
            let moving = 0.5 * (vx * vx + vy * vy) - (gx * x + gy * y);
            body.mass() * moving + 0.5 * body.inertia() * turning * turning
        };
        let bodies = self.scene.bodies().iter().zip(&self.velocities);
        bodies.filter(|(body, _)| !body.fixed).map(of).sum()
    }

    /// What the bodies gave one another in the last step, in the order of identities.
    pub fn contact_impulses(&self) -> Vec<ContactImpulse> {
        let approaches = self.before.iter().flat_map(VelocityLevel::approaches);
        let impulse = |(approach, &[along_normal, along_tangent]): (&crate::contact::approach::Approach, &[f64; 2])| {
            ContactImpulse {
                id: approach.id,
                point: approach.corner,
                normal: approach.normal,
                along_normal,
                along_tangent,
            }
        };
        approaches.zip(&self.impulses).map(impulse).collect()
    }

    /// Sets a block's velocity: m/s, m/s, rad/s.
    ///
    /// # Errors
    /// [`SimulationError::Fixed`], [`SimulationError::NotFinite`], [`SceneError::UnknownName`].
    pub fn set_velocity(&mut self, name: &str, velocity: Velocity) -> Result<(), SimulationError> {
        let i = self.movable(name, "velocity", &velocity)?;
        self.velocities[i] = velocity;
        Ok(())
    }

    /// Pushes a block during the next step with a force (N) at a point (world coordinates, metres; the centroid
    /// without one) and a moment (N m). Pushes add up, and end with the step.
    ///
    /// # Errors
    /// As [`Self::set_velocity`].
    pub fn apply_force(
        &mut self,
        name: &str,
        force: [f64; 2],
        at: Option<[f64; 2]>,
        moment: f64,
    ) -> Result<(), SimulationError> {
        let wrench = self.wrench(name, "force", force, at, moment)?;
        let i = self.scene.index_of(name)?;
        (0..3).for_each(|axis| self.forces[i][axis] += wrench[axis]);
        Ok(())
    }

    /// Changes a block's velocity at once by an impulse (N s) at a point and an impulsive moment (N m s).
    ///
    /// # Errors
    /// As [`Self::set_velocity`].
    pub fn apply_impulse(
        &mut self,
        name: &str,
        impulse: [f64; 2],
        at: Option<[f64; 2]>,
        moment: f64,
    ) -> Result<(), SimulationError> {
        let wrench = self.wrench(name, "impulse", impulse, at, moment)?;
        let i = self.scene.index_of(name)?;
        (0..3).for_each(|axis| self.velocities[i][axis] += self.inverse_mass[i][axis] * wrench[axis]);
        Ok(())
    }

    fn wrench(
        &self,
        name: &str,
        quantity: &'static str,
        [fx, fy]: [f64; 2],
        at: Option<[f64; 2]>,
        moment: f64,
    ) -> Result<[f64; 3], SimulationError> {
        let [px, py] = at.unwrap_or_default();
        let i = self.movable(name, quantity, &[fx, fy, px, py, moment])?;
        let [x, y] = self.scene.bodies()[i].pose.position;
        let arm = at.map_or([0.0; 2], |[px, py]| [px - x, py - y]);
        Ok([fx, fy, arm[0] * fy - arm[1] * fx + moment])
    }

    fn movable(&self, name: &str, quantity: &'static str, values: &[f64]) -> Result<usize, SimulationError> {
        let i = self.scene.index_of(name)?;
        let body = || name.to_owned();
        if self.scene.bodies()[i].fixed {
            return Err(SimulationError::Fixed { body: body(), quantity });
        }
        match values.iter().find(|value| !value.is_finite()) {
            Some(&value) => Err(SimulationError::NotFinite { body: body(), quantity, value }),
            None => Ok(i),
        }
    }

    /// Adds a rectangle at rest; see [`Scene::add_box`]. What was taken over from earlier steps stays.
    ///
    /// # Errors
    /// [`SceneError`], for an overlap too; nothing has changed then.
    pub fn add_box(
        &mut self,
        center: [f64; 2],
        size: [f64; 2],
        angle: f64,
        options: BodyOptions,
    ) -> Result<usize, SimulationError> {
        self.add(|scene| scene.add_box(center, size, angle, options))
    }

    /// Adds a convex polygon at rest; see [`Scene::add_polygon`].
    ///
    /// # Errors
    /// As [`Self::add_box`].
    pub fn add_polygon(&mut self, vertices: &[[f64; 2]], options: BodyOptions) -> Result<usize, SimulationError> {
        self.add(|scene| scene.add_polygon(vertices, options))
    }

    fn add(&mut self, place: impl FnOnce(&mut Scene) -> Result<usize, SceneError>) -> Result<usize, SimulationError> {
        let mut scene = self.scene.clone();
        let index = place(&mut scene)?;
        find_contacts(&scene)?;
        let fixed = scene.bodies()[index].fixed;
        self.scene = scene;
        self.velocities.push([0.0; 3]);
        self.forces.push([0.0; 3]);
        self.motionless.push(fixed);
        self.weigh();
        Ok(index)
    }

    /// Takes a block out. The blocks after it move up by one, and the next step starts from scratch.
    ///
    /// # Errors
    /// [`SceneError::UnknownName`].
    pub fn remove(&mut self, name: &str) -> Result<(), SimulationError> {
        let i = self.scene.index_of(name)?;
        self.scene.remove(i);
        self.velocities.remove(i);
        self.forces.remove(i);
        self.motionless.remove(i);
        self.weigh();
        self.forget();
        Ok(())
    }

    /// Drops what was taken over from earlier steps.
    pub(super) fn forget(&mut self) {
        self.route.forget();
        self.finder.clear();
        self.before = None;
        self.sliding.clear();
        self.impulses.clear();
        self.carried = Carried::default();
    }

    /// A number for the state: equal for equal places, velocities, pending forces and step counts, to the bit.
    pub fn hash(&self) -> u64 {
        // Fowler, Noll and Vo's FNV-1a: the same on every machine, which the standard library does not promise.
        const PRIME: u64 = 0x0100_0000_01b3;
        let numbers = self.poses().chain(self.velocities.iter().copied()).chain(self.forces.iter().copied());
        let words = numbers.flatten().map(f64::to_bits).chain([self.steps]);
        let bytes = words.flat_map(u64::to_le_bytes);
        bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME))
    }
}
