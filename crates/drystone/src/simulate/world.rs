//! Bodies in motion, and what may be done to them between two steps.

use super::{
    error::SimulationError,
    formulation::{Formulation, Law},
    moving::{Moving, inverse_mass, is_zero, masses},
    origin::{in_scene, moved, origin_of, place_in_scene},
    reuse::{Reuse, Route},
    settled::Settled,
    sliding::Carried,
    standing::Stood,
    velocity_level::VelocityLevel,
};
use crate::{
    bounds::TIME_STEP,
    contact::{ContactId, approach::ApproachFinder},
    error::SceneError,
    formulate::Cones,
    geometry::{Numbers, Polygon, norm, plus_times, product},
    scene::SceneOf,
};
use std::{borrow::Cow, fmt};

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
    /// What stands for friction cones in space.
    pub cones: Cones,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            dt: 1.0 / 240.0,
            reuse: Reuse::Full,
            restitution: 0.0,
            formulation: Formulation::Velocity,
            cones: Cones::default(),
        }
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
pub struct World<S: Moving = Polygon> {
    /// The bodies where they are now, seen from [`Self::origin`].
    pub(super) scene: SceneOf<S>,
    /// See `origin.rs`.
    pub(super) origin: S::Vector,
    pub(super) options: Options,
    pub(super) law: &'static dyn Law<S>,
    /// Of every body, its turning about its own axes.
    pub(super) velocities: Vec<S::Velocity>,
    /// Wrenches for the next step: N, and N m about the own axes.
    pub(super) forces: Vec<S::Velocity>,
    /// Diagonal of M^-1; zero for fixed bodies.
    pub(super) inverse_mass: Vec<S::Velocity>,
    /// Bodies that did not move in the last step; before the first one, the fixed ones.
    pub(super) motionless: Vec<bool>,
    pub(super) steps: u64,
    pub(super) finder: ApproachFinder<S>,
    pub(super) route: Box<dyn Route<S>>,
    /// The problem of the last step, if it was solved.
    pub(super) before: Option<VelocityLevel<S>>,
    /// Sliding speed at each of its approaches, m/s.
    pub(super) sliding: Vec<f64>,
    /// Impulse at each of its approaches, in world axes, N s.
    pub(super) impulses: Vec<S::Vector>,
    /// On the acceleration level with full reuse: where solves of islands with sliding contacts start.
    pub(super) carried: Carried,
    /// The solution of the last step, where no solver was made for it.
    pub(super) stood: Option<Stood>,
    /// The last step, if nothing moved in it and everything is taken over.
    pub(super) settled: Option<Settled<S>>,
}

impl<S: Moving> fmt::Debug for World<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bodies = self.scene.bodies().len();
        f.debug_struct("World").field("bodies", &bodies).field("steps", &self.steps).finish_non_exhaustive()
    }
}

/// What one block gave another in the last step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactImpulse<V = [f64; 2]> {
    /// Which features meet.
    pub id: ContactId,
    /// Where, world coordinates, metres, at the beginning of the step.
    pub point: V,
    /// Unit vector from the first body into the second.
    pub normal: V,
    /// Impulse on the second body, world axes, N s. Divided by dt it is the mean force.
    pub impulse: V,
    /// Its part along the normal, N s: never negative.
    pub along_normal: f64,
}

impl<V: Numbers> ContactImpulse<V> {
    /// The rest of it, N s: in the plane along the normal turned a quarter counter-clockwise, in space its length.
    pub fn tangential(&self) -> f64 {
        match (self.normal.as_ref(), self.impulse.as_ref()) {
            (&[nx, ny], &[x, y]) => y * nx - x * ny,
            _ => norm(plus_times(self.impulse, -self.along_normal, &self.normal).as_ref()),
        }
    }
}

impl<S: Moving> World<S> {
    /// A world at rest.
    ///
    /// # Errors
    /// [`SimulationError::TimeStep`], [`SimulationError::Restitution`], [`SimulationError::NoSuchLaw`];
    /// [`SceneError::Overlap`] if blocks overlap, [`SceneError::BadFacets`].
    pub fn new(scene: SceneOf<S>, options: Options) -> Result<Self, SimulationError> {
        let origin = origin_of(&scene);
        let scene = moved(scene, -1.0, &origin);
        S::contacts(&scene)?;
        Self::resting(scene, origin, options)
    }

    /// The same, of a scene seen from its origin, without a look at overlaps: a step may end with one, and a snapshot may be taken
    /// there.
    pub(super) fn resting(scene: SceneOf<S>, origin: S::Vector, options: Options) -> Result<Self, SimulationError> {
        let Options { dt, restitution, formulation, cones, .. } = options;
        if !TIME_STEP.hold(dt) {
            return Err(SimulationError::TimeStep { value: dt });
        }
        if !(0.0..=1.0).contains(&restitution) {
            return Err(SimulationError::Restitution { value: restitution });
        }
        cones.check()?;
        if let Some(body) = S::immovable(&scene) {
            return Err(SimulationError::Surface { body });
        }
        let n = scene.bodies().len();
        let mut world = Self {
            law: S::law(formulation).ok_or(SimulationError::NoSuchLaw { formulation: formulation.name() })?,
            inverse_mass: Vec::new(),
            velocities: vec![S::Velocity::default(); n],
            forces: vec![S::Velocity::default(); n],
            motionless: scene.bodies().iter().map(|body| body.fixed).collect(),
            steps: 0,
            finder: ApproachFinder::default(),
            route: options.reuse.route(),
            before: None,
            sliding: Vec::new(),
            impulses: Vec::new(),
            carried: Carried::default(),
            stood: None,
            settled: None,
            options,
            origin,
            scene,
        };
        world.weigh();
        Ok(world)
    }

    fn weigh(&mut self) {
        self.inverse_mass = self.scene.bodies().iter().map(inverse_mass).collect();
    }

    /// The bodies where they are now.
    pub fn scene(&self) -> Cow<'_, SceneOf<S>> {
        if is_zero(&self.origin) {
            return Cow::Borrowed(&self.scene);
        }
        Cow::Owned(moved(self.scene.clone(), 1.0, &self.origin))
    }

    /// Names of the bodies, in their order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.scene.bodies().iter().map(|body| body.name.as_str())
    }

    /// How steps are made.
    pub fn options(&self) -> Options {
        self.options
    }

    /// Velocity of every body, in world axes: m/s along each, then rad/s about each (in the plane about its normal).
    pub fn velocities(&self) -> Vec<S::Velocity> {
        let bodies = self.scene.bodies().iter().zip(&self.velocities);
        bodies.map(|(body, velocity)| S::to_world_axes(body, velocity)).collect()
    }

    /// Place of every body: the centre of mass, metres, and the angle, radians; in space a unit quaternion (w, x, y, z).
    pub fn poses(&self) -> impl Iterator<Item = S::Place> {
        self.scene.bodies().iter().map(|body| place_in_scene::<S>(S::place_of(&body.pose), &self.origin))
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
        let gravity = self.scene.gravity();
        let bodies = self.scene.bodies().iter().zip(&self.velocities).filter(|(body, _)| !body.fixed);
        let of = |(body, velocity): (&crate::scene::Body<S>, &S::Velocity)| {
            let masses = masses(body);
            let kinetic = velocity.as_ref().iter().zip(masses.as_ref()).map(|(v, m)| 0.5 * m * v * v).sum::<f64>();
            kinetic - body.mass() * product(&gravity, &in_scene(S::place(&body.pose), &self.origin))
        };
        bodies.map(of).sum()
    }

    /// What the bodies gave one another in the last step, in the order of identities.
    pub fn contact_impulses(&self) -> Vec<ContactImpulse<S::Vector>> {
        let approaches = self.before.iter().flat_map(VelocityLevel::approaches);
        let given = approaches.zip(&self.impulses).map(|(approach, impulse)| ContactImpulse {
            id: approach.id,
            point: in_scene(approach.point, &self.origin),
            normal: approach.normal,
            impulse: *impulse,
            along_normal: product(&approach.normal, impulse),
        });
        given.collect()
    }

    /// Takes up the bodies that a scene has beyond the world's own, at rest. What was taken over from earlier steps stays.
    ///
    /// # Errors
    /// [`SimulationError::OtherBodies`] unless the scene begins with the world's bodies as they are now; [`SceneError`], for
    /// an overlap too. Nothing has changed then.
    pub fn extend(&mut self, scene: SceneOf<S>) -> Result<(), SimulationError> {
        let known = self.scene.bodies().len();
        if scene.bodies().get(..known) != Some(self.scene().bodies()) {
            return Err(SimulationError::OtherBodies);
        }
        let mut scene = moved(scene, -1.0, &self.origin);
        // What the world has of its bodies' places is finer than what it says.
        self.scene.bodies().iter().enumerate().for_each(|(i, body)| scene.set_pose(i, body.pose));
        S::contacts(&scene)?;
        for body in &scene.bodies()[known..] {
            self.velocities.push(S::Velocity::default());
            self.forces.push(S::Velocity::default());
            self.motionless.push(body.fixed);
        }
        self.scene = scene;
        self.weigh();
        Ok(())
    }

    /// Adds a block at rest, by what adds it to a scene, such as [`Scene::add_box`](crate::Scene::add_box). What was taken over
    /// from earlier steps stays.
    ///
    /// # Errors
    /// [`SceneError`], for an overlap too; nothing has changed then.
    pub fn add(
        &mut self,
        place: impl FnOnce(&mut SceneOf<S>) -> Result<usize, SceneError>,
    ) -> Result<usize, SimulationError> {
        let mut scene = self.scene().into_owned();
        let index = place(&mut scene)?;
        self.extend(scene)?;
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
        self.stood = None;
        self.settled = None;
    }
}
