//! Bodies in motion, and what may be done to them between two steps.

use super::{
    error::SimulationError,
    formulate::contact_problem::ContactProblem,
    kinematics::{is_zero, masses},
    laws::Law,
    moving::Moving,
    options::Options,
    origin::{in_scene, moved, origin_of, place_in_scene},
    settled::Settled,
    solve::PreviousStep,
    state::State,
};
use crate::{
    bounds::TIME_STEP,
    contact::{ContactId, candidates::CandidateFinder},
    error::SceneError,
    geometry::{Numbers, Polygon, norm, plus_times, product},
    scene::SceneOf,
};
use std::{borrow::Cow, fmt};

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
    pub(super) state: State<S>,
    /// What places are measured from; see `origin.rs`.
    pub(super) origin: S::Vector,
    pub(super) law: &'static dyn Law<S>,
    pub(super) steps: u64,
    pub(super) finder: CandidateFinder<S>,
    pub(super) previous: PreviousStep<S>,
    /// The last step, if nothing moved in it and everything is taken over.
    pub(super) settled: Option<Settled<S>>,
}

impl<S: Moving> fmt::Debug for World<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bodies = self.state.scene.bodies().len();
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
    /// [`SimulationError::TimeStep`], [`SimulationError::Restitution`], [`SimulationError::CoulombTolerance`],
    /// [`SimulationError::NoSuchLaw`], [`SimulationError::Settlement`];
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
        let Options { dt, restitution, formulation, cones, coulomb_tolerance, .. } = options;
        if !TIME_STEP.hold(dt) {
            return Err(SimulationError::TimeStep { value: dt });
        }
        if !(0.0..=1.0).contains(&restitution) {
            return Err(SimulationError::Restitution { value: restitution });
        }
        if !(coulomb_tolerance > 0.0 && coulomb_tolerance <= 1.0) {
            return Err(SimulationError::CoulombTolerance { value: coulomb_tolerance });
        }
        cones.check()?;
        if let Some(body) = S::immovable(&scene) {
            return Err(SimulationError::Surface { body });
        }
        refuse_settlements(&scene)?;
        Ok(Self {
            law: S::law(formulation).ok_or(SimulationError::NoSuchLaw { formulation: formulation.name() })?,
            state: State::at_rest(scene, options),
            origin,
            steps: 0,
            finder: CandidateFinder::default(),
            previous: PreviousStep::none(options.reuse),
            settled: None,
        })
    }

    /// The bodies where they are now.
    pub fn scene(&self) -> Cow<'_, SceneOf<S>> {
        if is_zero(&self.origin) {
            return Cow::Borrowed(&self.state.scene);
        }
        Cow::Owned(moved(self.state.scene.clone(), 1.0, &self.origin))
    }

    /// Names of the bodies, in their order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.state.scene.bodies().iter().map(|body| body.name.as_str())
    }

    /// How steps are made.
    pub fn options(&self) -> Options {
        self.state.options
    }

    /// Velocity of every body, in world axes: m/s along each, then rad/s about each (in the plane about its normal).
    pub fn velocities(&self) -> Vec<S::Velocity> {
        let bodies = self.state.scene.bodies().iter().zip(&self.state.velocities);
        bodies.map(|(body, velocity)| S::to_world_axes(body, velocity)).collect()
    }

    /// Place of every body: the centre of mass, metres, and the angle, radians; in space a unit quaternion (w, x, y, z).
    pub fn poses(&self) -> impl Iterator<Item = S::Place> {
        self.state.scene.bodies().iter().map(|body| place_in_scene::<S>(S::place_of(&body.pose), &self.origin))
    }

    /// Whether each body kept its place in the last step; fixed ones always do.
    pub fn motionless(&self) -> &[bool] {
        &self.state.motionless
    }

    /// Steps made.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Kinetic energy and the potential energy of gravity (zero at the origin), joules. Fixed bodies have none.
    pub fn energy(&self) -> f64 {
        let gravity = self.state.scene.gravity();
        let bodies = self.state.scene.bodies().iter().zip(&self.state.velocities).filter(|(body, _)| !body.fixed);
        let of = |(body, velocity): (&crate::scene::Body<S>, &S::Velocity)| {
            let masses = masses(body);
            let kinetic = velocity.as_ref().iter().zip(masses.as_ref()).map(|(v, m)| 0.5 * m * v * v).sum::<f64>();
            kinetic - body.mass() * product(&gravity, &in_scene(S::place(&body.pose), &self.origin))
        };
        bodies.map(of).sum()
    }

    /// What the bodies gave one another in the last step, in the order of identities. Of a step made in several
    /// ([`StepRecord::substeps`](super::StepRecord::substeps)) what they would have given if all had been as the last one.
    pub fn contact_impulses(&self) -> Vec<ContactImpulse<S::Vector>> {
        let candidates = self.previous.problem.iter().flat_map(ContactProblem::candidates);
        let substeps = self.previous.substeps as f64;
        let given = candidates.zip(&self.previous.impulses).map(|(candidate, impulse)| {
            let impulse = plus_times(S::Vector::default(), substeps, impulse);
            ContactImpulse {
                id: candidate.id,
                point: in_scene(candidate.point, &self.origin),
                normal: candidate.normal,
                impulse,
                along_normal: product(&candidate.normal, &impulse),
            }
        });
        given.collect()
    }

    /// Takes up the bodies that a scene has beyond the world's own, at rest. What was taken over from earlier steps stays.
    ///
    /// # Errors
    /// [`SimulationError::OtherBodies`] unless the scene begins with the world's bodies as they are now; [`SceneError`], for
    /// an overlap too. Nothing has changed then.
    pub fn extend(&mut self, scene: SceneOf<S>) -> Result<(), SimulationError> {
        let known = self.state.scene.bodies().len();
        if scene.bodies().get(..known) != Some(self.scene().bodies()) {
            return Err(SimulationError::OtherBodies);
        }
        refuse_settlements(&scene)?;
        let mut scene = moved(scene, -1.0, &self.origin);
        // What the world has of its bodies' places is finer than what it says.
        self.state.scene.bodies().iter().enumerate().for_each(|(i, body)| scene.set_pose(i, body.pose));
        S::contacts(&scene)?;
        self.state.extend(scene);
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
        let i = self.state.scene.index_of(name)?;
        self.state.remove(i);
        self.forget();
        Ok(())
    }

    /// Drops what was taken over from earlier steps.
    pub(super) fn forget(&mut self) {
        self.previous.forget();
        self.finder.clear();
        self.settled = None;
    }
}

/// A world has no place for displacements that are prescribed but take no time.
fn refuse_settlements<S: Moving>(scene: &SceneOf<S>) -> Result<(), SimulationError> {
    let refused = |body: &str| Err(SimulationError::Settlement { body: body.to_owned() });
    scene.settling().map_or(Ok(()), refused)
}
