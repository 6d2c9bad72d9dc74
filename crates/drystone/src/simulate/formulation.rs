//! The laws of motion that a step can be made by, behind one trait.

use super::{error::StepFailure, moving::Moving, solve::Motion, velocity_level::VelocityLevel, world::World};
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
}

/// How the velocities at the end of a step follow from those at its beginning. Contacts before and integration after
/// are the same for all.
pub trait Law<S: Moving>: Sync {
    /// Solves a step. `free` (bodies) are the velocities without contacts, `v* = v + h M^-1 F`.
    fn motion(
        &self,
        world: &mut World<S>,
        contacts: &VelocityLevel<S>,
        free: &[S::Velocity],
    ) -> Result<Motion<S>, StepFailure>;
}

/// One problem of impulses and velocities: `velocity_level.rs`.
#[derive(Debug)]
pub(super) struct ByVelocity;

impl<S: Moving> Law<S> for ByVelocity {
    fn motion(
        &self,
        world: &mut World<S>,
        contacts: &VelocityLevel<S>,
        free: &[S::Velocity],
    ) -> Result<Motion<S>, StepFailure> {
        let offset = |k: usize| match world.rebound(contacts, k, free) {
            Some(rebound) => rebound,
            None => contacts.approaches()[k].gap.max(0.0) / world.options().dt,
        };
        let offsets: Vec<f64> = (0..contacts.approaches().len()).map(offset).collect();
        world.solve(contacts, free, &offsets)
    }
}
