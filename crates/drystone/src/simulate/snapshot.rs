//! A world as bytes, and back: what goes on from them goes on bit for bit.
//!
//! The bytes are JSON: the scene in its own format, velocities, pending forces, and what the next step takes over, the numbers
//! of the factor included. Numbers are written so that they read back to the same bits.

use super::{
    error::SimulationError,
    formulation::Formulation,
    reuse::{Kept, Reuse},
    sliding::Carried,
    velocity_level::{Velocity, VelocityLevel},
    world::{Options, World},
};
use crate::{contact::approach::Approach, io};
use serde::{Deserialize, Serialize};

const FORMAT: &str = "drystone-world";
const VERSION: u64 = 1;

#[derive(Serialize, Deserialize)]
struct Saved {
    format: String,
    version: u64,
    scene: String,
    dt: f64,
    reuse: Reuse,
    restitution: f64,
    /// Absent in what was written before there was a choice.
    #[serde(default)]
    formulation: Formulation,
    velocities: Vec<Velocity>,
    forces: Vec<[f64; 3]>,
    motionless: Vec<bool>,
    steps: u64,
    before: Option<Vec<Approach>>,
    sliding: Vec<f64>,
    impulses: Vec<[f64; 2]>,
    kept: Kept,
    #[serde(default)]
    carried: Carried,
}

impl World {
    /// The whole state, to go on from with [`Self::restore`].
    pub fn snapshot(&self) -> Vec<u8> {
        let saved = Saved {
            format: FORMAT.to_owned(),
            version: VERSION,
            scene: io::to_json(&self.scene),
            dt: self.options.dt,
            reuse: self.options.reuse,
            restitution: self.options.restitution,
            formulation: self.options.formulation,
            velocities: self.velocities.clone(),
            forces: self.forces.clone(),
            motionless: self.motionless.clone(),
            steps: self.steps,
            before: self.before.as_ref().map(|before| before.approaches().to_vec()),
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
        let fault = |reason: String| SimulationError::Snapshot { reason };
        let saved: Saved = serde_json::from_slice(bytes).map_err(|error| fault(error.to_string()))?;
        if saved.format != FORMAT || saved.version != VERSION {
            let reason =
                format!("it is {} of version {}, not {FORMAT} of version {VERSION}", saved.format, saved.version);
            return Err(fault(reason));
        }
        let scene = io::from_json(&saved.scene, "the snapshot's scene")?.in_plane()?;
        let Saved { dt, reuse, restitution, formulation, .. } = saved;
        let mut world = Self::resting(scene, Options { dt, reuse, restitution, formulation })?;
        let n = world.velocities.len();
        let (points, finite) =
            (saved.before.as_ref().map_or(0, Vec::len), |v: &[f64; 3]| v.iter().all(|v| v.is_finite()));
        if [saved.velocities.len(), saved.forces.len(), saved.motionless.len()] != [n; 3]
            || saved.sliding.len() != points
            || saved.impulses.len() != points
            || saved.before.iter().flatten().any(|approach| approach.id.bodies.iter().any(|&body| body >= n))
            || !saved.velocities.iter().chain(&saved.forces).all(finite)
        {
            return Err(fault("its parts do not fit together".to_owned()));
        }
        world.velocities = saved.velocities;
        world.forces = saved.forces;
        world.motionless = saved.motionless;
        world.steps = saved.steps;
        world.before = saved.before.map(VelocityLevel::new);
        world.sliding = saved.sliding;
        world.impulses = saved.impulses;
        world.carried = saved.carried;
        if let Some(before) = &world.before {
            let matrix = |q: Vec<f64>| before.problem(&world.inverse_mass, q);
            world.route.take_up(&saved.kept, &matrix).map_err(|error| fault(error.to_string()))?;
        }
        Ok(world)
    }
}
