//! The laws of motion that a step can be made by, behind one trait.

use super::{
    acceleration_level::AccelerationLevel,
    error::StepFailure,
    solve::Motion,
    velocity_level::{Velocity, VelocityLevel},
    world::World,
};
use crate::contact::approach::Approach;
use serde::{Deserialize, Serialize};

/// What the unknowns of a step are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Formulation {
    /// Impulses and velocities, in one problem: Stewart and Trinkle's, Anitescu and Potra's. It always has a solution.
    #[default]
    Velocity,
    /// Forces and accelerations, after impulses where bodies collide: Baraff's, and the paper's. Where no forces exist, impulses
    /// take their place and the step's record says so.
    Acceleration,
}

impl Formulation {
    /// As users of other languages write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
        }
    }

    pub(super) fn law(self) -> &'static dyn Law {
        match self {
            Self::Velocity => &ByVelocity,
            Self::Acceleration => &AccelerationLevel,
        }
    }
}

/// How the velocities at the end of a step follow from those at its beginning. Contacts before and integration after
/// are the same for all.
pub(super) trait Law {
    /// Solves a step. `free` (bodies) are the velocities without contacts, `v* = v + h M^-1 F`.
    fn motion(&self, world: &mut World, contacts: &VelocityLevel, free: &[Velocity]) -> Result<Motion, StepFailure>;
}

/// One problem of impulses and velocities: `velocity_level.rs`.
#[derive(Debug)]
struct ByVelocity;

impl Law for ByVelocity {
    fn motion(&self, world: &mut World, contacts: &VelocityLevel, free: &[Velocity]) -> Result<Motion, StepFailure> {
        let offset = |approach: &Approach| match world.rebound(approach, free) {
            Some(rebound) => rebound,
            None => approach.gap.max(0.0) / world.options().dt,
        };
        let offsets: Vec<f64> = contacts.approaches().iter().map(offset).collect();
        world.solve(contacts, free, &offsets)
    }
}
