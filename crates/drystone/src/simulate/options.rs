//! How a world makes its steps: what its user chooses.

use crate::formulate::Cones;
use serde::{Deserialize, Serialize};

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
    /// How far a step may be from Coulomb's law to count as exact, of the largest of the contacts' speeds and what gravity gives in a
    /// step; from above 0 to 1. See [`StepRecord::exact`](super::StepRecord::exact).
    pub coulomb_tolerance: f64,
}

/// Eight digits of a double, a margin of four beside what rounding leaves in well scaled problems and two beside what it
/// leaves where friction decides.
pub const COULOMB_TOLERANCE: f64 = 1e-8;

impl Default for Options {
    fn default() -> Self {
        Self {
            dt: 1.0 / 240.0,
            reuse: Reuse::Full,
            restitution: 0.0,
            formulation: Formulation::Velocity,
            cones: Cones::default(),
            coulomb_tolerance: COULOMB_TOLERANCE,
        }
    }
}

/// How much of the computation a step takes over from the step before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Reuse {
    /// Nothing: every solve from scratch.
    None,
    /// Loomis and Balkcom's: when the motionless set changes, its own problem is solved from scratch; every full solve
    /// starts from that solution (Theorem 1).
    Motionless,
    /// Everything that did not move: forces, active set and factor rows; contact geometry too.
    Full,
}

impl Reuse {
    /// As users of other languages write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Motionless => "motionless",
            Self::Full => "full",
        }
    }
}

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
