//! A world as bytes, and back: what goes on from them goes on bit for bit.
//!
//! The bytes are JSON: the scene in its own format, velocities, pending forces, and what the next step takes over, the numbers
//! of the factor included. Numbers are written so that they read back to the same bits.

use super::{
    error::SimulationError,
    formulation::Formulation,
    moving::Moving,
    reuse::{Kept, Reuse},
    settled::Settled,
    sliding::Carried,
    standing::Stood,
    velocity_level::VelocityLevel,
    world::{Options, World},
};
use crate::{contact::approach::ApproachOf, formulate::Cones, io};
use serde::{Deserialize, Serialize};

const FORMAT: &str = "drystone-world";
/// 1 kept impulses along normals and tangents, and arms of contacts.
const VERSION: u64 = 2;

#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct Saved<S: Moving> {
    format: String,
    version: u64,
    scene: String,
    dt: f64,
    reuse: Reuse,
    restitution: f64,
    formulation: Formulation,
    cones: Cones,
    velocities: Vec<S::Velocity>,
    forces: Vec<S::Velocity>,
    motionless: Vec<bool>,
    steps: u64,
    before: Option<Vec<ApproachOf<S>>>,
    stood: Option<Stood>,
    settled: Option<Settled<S>>,
    sliding: Vec<f64>,
    impulses: Vec<S::Vector>,
    kept: Kept<ApproachOf<S>>,
    carried: Carried,
}

/// What there is to know before the rest can be read.
#[derive(Deserialize)]
struct Head {
    format: String,
    version: u64,
    scene: String,
}

/// The dimension of the world that a snapshot was taken of.
///
/// # Errors
/// [`SimulationError::Snapshot`] for anything that is not one.
pub fn snapshot_dimension(bytes: &[u8]) -> Result<usize, SimulationError> {
    Ok(io::from_json(&head(bytes)?.scene, "the snapshot's scene")?.dimension())
}

fn fault(reason: impl ToString) -> SimulationError {
    SimulationError::Snapshot { reason: reason.to_string() }
}

fn head(bytes: &[u8]) -> Result<Head, SimulationError> {
    let head: Head = serde_json::from_slice(bytes).map_err(fault)?;
    let (format, version) = (&head.format, head.version);
    if format != FORMAT || version != VERSION {
        return Err(fault(format!("it is {format} of version {version}, not {FORMAT} of version {VERSION}")));
    }
    Ok(head)
}

impl<S: Moving> World<S> {
    /// The whole state, to go on from with [`Self::restore`].
    pub fn snapshot(&self) -> Vec<u8> {
        let saved = Saved::<S> {
            format: FORMAT.to_owned(),
            version: VERSION,
            scene: S::to_json(&self.scene),
            dt: self.options.dt,
            reuse: self.options.reuse,
            restitution: self.options.restitution,
            formulation: self.options.formulation,
            cones: self.options.cones,
            velocities: self.velocities.clone(),
            forces: self.forces.clone(),
            motionless: self.motionless.clone(),
            steps: self.steps,
            before: self.before.as_ref().map(|before| before.approaches().to_vec()),
            stood: self.stood.clone(),
            settled: self.settled.clone(),
            sliding: self.sliding.clone(),
            impulses: self.impulses.clone(),
            kept: self.route.kept(),
            carried: self.carried.clone(),
        };
        serde_json::to_vec(&saved).expect("numbers and names are always written")
    }

    /// The world that a snapshot was taken of.
    ///
    /// # Errors
    /// [`SimulationError::Snapshot`] for anything that is not one, whole and undamaged.
    pub fn restore(bytes: &[u8]) -> Result<Self, SimulationError> {
        let scene = S::of_any(io::from_json(&head(bytes)?.scene, "the snapshot's scene")?)?;
        let saved: Saved<S> = serde_json::from_slice(bytes).map_err(fault)?;
        let Saved { dt, reuse, restitution, formulation, cones, .. } = saved;
        let mut world = Self::resting(scene, Options { dt, reuse, restitution, formulation, cones })?;
        let n = world.velocities.len();
        let (points, finite) =
            (saved.before.as_ref().map_or(0, Vec::len), |v: &S::Velocity| v.as_ref().iter().all(|v| v.is_finite()));
        if [saved.velocities.len(), saved.forces.len(), saved.motionless.len()] != [n; 3]
            || saved.sliding.len() != points
            || saved.impulses.len() != points
            || saved.before.iter().flatten().any(|approach| approach.id.bodies.iter().any(|&body| body >= n))
            || !saved.velocities.iter().chain(&saved.forces).all(finite)
        {
            return Err(fault("its parts do not fit together"));
        }
        world.velocities = saved.velocities;
        world.forces = saved.forces;
        world.motionless = saved.motionless;
        world.steps = saved.steps;
        world.before = saved.before.map(|approaches| world.problem_of(approaches));
        let rows = world.before.as_ref().map_or(0, VelocityLevel::len);
        if saved.stood.as_ref().is_some_and(|stood| stood.q.len() != rows) {
            return Err(fault("its parts do not fit together"));
        }
        world.stood = saved.stood;
        world.settled = saved.settled;
        world.sliding = saved.sliding;
        world.impulses = saved.impulses;
        world.carried = saved.carried;
        if let Some(before) = &world.before {
            let matrix = |q: Vec<f64>| before.problem(&world.inverse_mass, q);
            world.route.take_up(&saved.kept, &matrix).map_err(fault)?;
        }
        Ok(world)
    }
}
