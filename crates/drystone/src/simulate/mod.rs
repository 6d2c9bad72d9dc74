//! How does it move? Simulation with exact contact, in the plane and in space, and with computation reuse.
//!
//! [`World`] holds bodies in motion and makes steps; `step.rs` reads as the paper's SIMULATE:
//!
//! ```text
//! contacts -> formulate -> solve -> find motionless -> integrate
//! ```
//!
//! - contacts: [`crate::contact::approach`], what touches or may touch within the step;
//! - formulate: `velocity_level.rs`, one complementarity problem of impulses and velocities;
//! - solve: in space `round.rs`, on round cones; else `solve.rs` solves it until `friction.rs` finds Coulomb's law kept; `reuse.rs` says what is taken over;
//! - find motionless: `motionless.rs`, whose blocks keep their place bit for bit;
//! - integrate: `integrate.rs`, and `project.rs` where blocks came to overlap.
//!
//! [`run`] makes many steps and records them. Loomis and Balkcom, Computation reuse for rigid-body dynamics (2006), section
//! IV; the theory is in docs/theory/velocity-level.md. What depends on the dimension is behind one trait, `moving.rs`.

mod acceleration_level;
mod at_rest;
mod coulomb;
mod error;
mod formulation;
mod friction;
mod in_plane;
mod in_space;
mod integrate;
mod islands;
mod motionless;
mod moving;
mod origin;
mod project;
mod pushes;
mod reuse;
mod round;
mod run;
mod settled;
mod sliding;
mod snapshot;
mod solve;
mod standing;
mod step;
mod velocity_level;
mod world;

pub use acceleration_level::Inconsistent;
pub use error::{SimulationError, StepFailure};
pub use formulation::Formulation;
pub use friction::{FRICTION_ACCEPTED, FRICTION_TOLERANCE};
pub use moving::Moving;
pub use reuse::Reuse;
pub use run::{Ending, Run, run};
pub use snapshot::snapshot_dimension;
pub use step::StepRecord;
pub use velocity_level::Velocity;
pub use world::{ContactImpulse, Options, World};
