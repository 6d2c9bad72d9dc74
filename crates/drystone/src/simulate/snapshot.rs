//! A world as bytes, and back: what goes on from them goes on bit for bit.
//!
//! The bytes are sealed ([`drystone_lcp::sealed`]): kind and version in front, a checksum behind, so that a changed one is
//! noticed. Between them are the scene in its own format, velocities, pending forces, and what the next step takes over, the
//! numbers of the factor included.

use super::{
    error::SimulationError,
    formulate::contact_problem::ContactProblem,
    kinematics::axes,
    moving::Moving,
    options::{Formulation, Options, Reuse},
    settled::Settled,
    solve::{ActiveRows, RestSolution, SavedStart},
    world::World,
};
use crate::{
    contact::candidates::{CandidateContact, CandidateOf},
    formulate::Cones,
    io,
};
use drystone_lcp::sealed::{self, Seal, SealError};
use serde::{Deserialize, Serialize};

/// 1 and 2 were JSON, without a checksum.
const VERSION: u32 = 5;
const IN_PLANE: Seal = Seal { kind: *b"DS-WORL2", version: VERSION };
const IN_SPACE: Seal = Seal { kind: *b"DS-WORL3", version: VERSION };

fn seal<S: Moving>() -> Seal {
    if axes::<S>() == 2 { IN_PLANE } else { IN_SPACE }
}

/// What decides how a world moves on.
#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct SavedState<S: Moving> {
    /// As JSON: the bodies where they are, seen from the world's origin, their shapes, masses and friction, gravity, the tolerance.
    scene: String,
    origin: S::Vector,
    dt: f64,
    reuse: Reuse,
    restitution: f64,
    formulation: Formulation,
    cones: Cones,
    coulomb_tolerance: f64,
    velocities: Vec<S::Velocity>,
    forces: Vec<S::Velocity>,
    motionless: Vec<bool>,
    steps: u64,
}

/// The same, and what was computed for the step before. Without that the motion is the same but for rounding.
#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct Saved<S: Moving> {
    state: SavedState<S>,
    before: Option<Vec<CandidateOf<S>>>,
    at_rest: Option<RestSolution>,
    settled: Option<Settled<S>>,
    sliding: Vec<f64>,
    impulses: Vec<S::Vector>,
    substeps: usize,
    solver: SavedStart<CandidateOf<S>>,
    active_rows: ActiveRows,
}

/// The dimension of the world that a snapshot was taken of.
///
/// # Errors
/// [`SimulationError::Snapshot`] for bytes that do not begin as one.
pub fn snapshot_dimension(bytes: &[u8]) -> Result<usize, SimulationError> {
    let begins = |seal: Seal| bytes.starts_with(&seal.kind);
    match (begins(IN_PLANE), begins(IN_SPACE)) {
        (true, _) => Ok(2),
        (_, true) => Ok(3),
        _ => Err(fault(SealError::OtherKind)),
    }
}

fn fault(reason: impl ToString) -> SimulationError {
    SimulationError::Snapshot { reason: reason.to_string() }
}

impl<S: Moving> World<S> {
    fn saved_state(&self) -> SavedState<S> {
        SavedState {
            scene: S::to_json(&self.state.scene),
            origin: self.origin,
            dt: self.state.options.dt,
            reuse: self.state.options.reuse,
            restitution: self.state.options.restitution,
            formulation: self.state.options.formulation,
            cones: self.state.options.cones,
            coulomb_tolerance: self.state.options.coulomb_tolerance,
            velocities: self.state.velocities.clone(),
            forces: self.state.forces.clone(),
            motionless: self.state.motionless.clone(),
            steps: self.steps,
        }
    }

    /// A number for the state, the same on every machine: equal for equal bodies (shapes, masses, friction, names), places,
    /// velocities, pending forces, gravity, options and step counts, to the bit. What was computed for the step before is not in
    /// it: a failed step forgets that.
    pub fn hash(&self) -> u64 {
        sealed::digest(&seal::<S>().close(&self.saved_state()))
    }

    /// The whole state, to go on from with [`Self::restore`].
    pub fn snapshot(&self) -> Vec<u8> {
        seal::<S>().close(&Saved::<S> {
            state: self.saved_state(),
            before: self.previous.problem.as_ref().map(|before| before.candidates().to_vec()),
            at_rest: self.previous.at_rest.clone(),
            settled: self.settled.clone(),
            sliding: self.previous.sliding.clone(),
            impulses: self.previous.impulses.clone(),
            substeps: self.previous.substeps,
            solver: self.previous.solver.save(),
            active_rows: self.previous.active_rows.clone(),
        })
    }

    /// The world that a snapshot was taken of.
    ///
    /// # Errors
    /// [`SimulationError::Snapshot`] for anything that is not one, whole and undamaged.
    pub fn restore(bytes: &[u8]) -> Result<Self, SimulationError> {
        let saved: Saved<S> = seal::<S>().open(bytes).map_err(fault)?;
        let SavedState { scene, origin, dt, reuse, restitution, formulation, cones, coulomb_tolerance, .. } =
            &saved.state;
        let scene = io::from_json(scene, "its scene").and_then(S::of_any).map_err(fault)?;
        let options = Options {
            dt: *dt,
            reuse: *reuse,
            restitution: *restitution,
            formulation: *formulation,
            cones: *cones,
            coulomb_tolerance: *coulomb_tolerance,
        };
        let mut world = Self::resting(scene, *origin, options).map_err(fault)?;
        if !saved.fits(world.state.velocities.len()) {
            return Err(fault(UNFIT));
        }
        world.state.velocities = saved.state.velocities;
        world.state.forces = saved.state.forces;
        world.state.motionless = saved.state.motionless;
        world.steps = saved.state.steps;
        world.settled = saved.settled;
        let gravity = world.state.scene.gravity();
        let previous = &mut world.previous;
        previous.problem = saved.before.map(|contacts| previous.formulate(contacts, &options, gravity));
        let rows = previous.problem.as_ref().map_or(0, ContactProblem::len);
        if saved.at_rest.as_ref().is_some_and(|solution| solution.q.len() != rows) {
            return Err(fault(UNFIT));
        }
        previous.at_rest = saved.at_rest;
        previous.sliding = saved.sliding;
        previous.impulses = saved.impulses;
        previous.substeps = saved.substeps;
        previous.active_rows = saved.active_rows;
        if let Some(before) = &previous.problem {
            let matrix = |q: Vec<f64>| before.problem(&world.state.inverse_mass, q);
            previous.solver.restore(&saved.solver, &matrix).map_err(fault)?;
        }
        Ok(world)
    }
}

const UNFIT: &str = "its parts do not fit together";

impl<S: Moving> Saved<S> {
    /// Whether the parts have the sizes of `n` bodies and of one another.
    fn fits(&self, n: usize) -> bool {
        let SavedState { velocities, forces, motionless, .. } = &self.state;
        let points = self.before.as_ref().map_or(0, Vec::len);
        let finite = |v: &S::Velocity| v.as_ref().iter().all(|v| v.is_finite());
        let between = |candidate: &CandidateOf<S>| {
            let CandidateContact { id, .. } = candidate;
            id.bodies[0] < id.bodies[1] && id.bodies[1] < n
        };
        [velocities.len(), forces.len(), motionless.len()] == [n; 3]
            && [self.sliding.len(), self.impulses.len()] == [points; 2]
            && self.before.iter().flatten().all(between)
            && velocities.iter().chain(forces).all(finite)
            && self.state.origin.as_ref().iter().all(|x| x.is_finite())
    }
}
