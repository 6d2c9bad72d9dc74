//! What can be wrong with what a simulation is given, and how a step can fail.

use crate::{
    bounds::{Bounds, COORDINATE, Plain, TIME_STEP},
    error::SceneError,
};
use thiserror::Error;

/// Bad input to a simulation.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// A time step that is not above zero, or out of [`bounds`](crate::bounds).
    #[error("dt is {}: a time step is {TIME_STEP}", Plain(*.value))]
    TimeStep {
        /// The value.
        value: f64,
    },
    /// A coefficient of restitution outside [0, 1].
    #[error("restitution is {value}: give a number from 0 (no rebound) to 1")]
    Restitution {
        /// The value.
        value: f64,
    },
    /// A tolerance of Coulomb's law that is not above 0, or above 1.
    #[error("coulomb_tolerance is {value}: give a share of the contacts' speeds above 0, at most 1; 1e-8 is usual")]
    CoulombTolerance {
        /// The value.
        value: f64,
    },
    /// A formulation that there is in the plane only.
    #[error("formulation \"{formulation}\" is for scenes in the plane: in space give \"velocity\"")]
    NoSuchLaw {
        /// What was asked for.
        formulation: &'static str,
    },
    /// A NaN or an infinity in a force, an impulse or a velocity.
    #[error("block \"{body}\": {quantity} is {value}: give finite numbers")]
    NotFinite {
        /// The block.
        body: String,
        /// What was given.
        quantity: &'static str,
        /// The value.
        value: f64,
    },
    /// A force, an impulse, a velocity or a place out of [`bounds`](crate::bounds).
    #[error("block \"{body}\": {quantity} has {}: it must be {bounds}: {}", Plain(*.value), .bounds.advice)]
    OutOfBounds {
        /// The block.
        body: String,
        /// What was given.
        quantity: &'static str,
        /// The value.
        value: f64,
        /// What is allowed.
        bounds: Bounds,
    },
    /// A velocity or a push for a block that never moves.
    #[error("block \"{body}\" is fixed: it takes no {quantity}")]
    Fixed {
        /// The block.
        body: String,
        /// What was given.
        quantity: &'static str,
    },
    /// A scene to be taken up that does not begin with the world's bodies.
    #[error("the scene does not begin with the world's bodies as they are now: add to a copy of the world's scene")]
    OtherBodies,
    /// A body that has a surface and no convex pieces.
    #[error(
        "block \"{body}\" is a closed surface: bodies that move are made of convex pieces; cut it into them (add_mesh and \
         imports.load do with surface=False), or take its hull"
    )]
    Surface {
        /// The block.
        body: String,
    },
    /// A support that is to settle.
    #[error(
        "support \"{body}\" has a settlement, which check answers for a structure at rest: simulate \
         without_settlements(), or put the support where it has gone to"
    )]
    Settlement {
        /// The support.
        body: String,
    },
    /// Bytes that are no snapshot of a world, or a damaged one.
    #[error("this is no snapshot of a world: {reason}")]
    Snapshot {
        /// What is wrong.
        reason: String,
    },
    /// The scene, or a block to be added.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// Why a step could not be made. The world is as it was before the step.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum StepFailure {
    /// The complementarity problem of the step was not solved, from scratch neither.
    #[error("the contact problem was not solved: {status}")]
    Unsolved {
        /// The solver's status.
        status: &'static str,
    },
    /// A block turns by more than a thousand radians in the step within reach of another. (From one radian on a step is made in
    /// several.)
    #[error(
        "block \"{body}\" turns by more than a thousand radians within one step next to \"{other}\": \
         take a time step of {dt:.3e} s or less"
    )]
    TooFast {
        /// Name of the block.
        body: String,
        /// Name of the other.
        other: String,
        /// A time step in which it turns by no more than one radian.
        dt: f64,
    },
    /// A position or a velocity has left its [`bounds`](crate::bounds), or is no number any more.
    #[error("block \"{body}\": its place or velocity is beyond {:e} m, m/s or rad/s", COORDINATE.most)]
    OutOfBounds {
        /// The block.
        body: String,
    },
}

impl StepFailure {
    /// In one word, as users of other languages see it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Unsolved { .. } => "unsolved",
            Self::TooFast { .. } => "too_fast",
            Self::OutOfBounds { .. } => "out_of_bounds",
        }
    }
}
