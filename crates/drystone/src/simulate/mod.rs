//! How does it move? Simulation with exact contact, in the plane and in space, and with computation reuse.
//!
//! [`World`] holds bodies in motion and makes steps; `step.rs` reads as the paper's SIMULATE:
//!
//! ```text
//! contacts -> formulate -> solve -> find motionless -> integrate
//! ```
//!
//! - contacts: `contacts.rs`, what touches or may touch within the step;
//! - formulate: `formulate/`, one complementarity problem of impulses and velocities;
//! - solve: `solve/`, in space on round cones where most blocks move, else by pivots; `solve/warm_start/` says what is taken over;
//! - find motionless: `motionless.rs`, whose blocks keep their place bit for bit;
//! - integrate: `integrate/`, and overlaps are taken back.
//!
//! Each is a function of plain data (`State`, what the step before left) and knows the stages before it only. `laws/`
//! says which problems are solved in which order, [`World`] holds the data, and what changes it is above.
//!
//! [`run`] makes many steps and records them. Loomis and Balkcom, Computation reuse for rigid-body dynamics (2006), section
//! IV; the theory is in docs/theory/velocity-level.md. What depends on the dimension is behind one trait, `kinematics.rs`.

mod bearing;
mod contacts;
mod error;
mod formulate;
mod in_plane;
mod in_space;
mod integrate;
mod kinematics;
mod laws;
mod motionless;
mod moving;
mod options;
mod origin;
mod parted;
mod pushes;
mod record;
mod run;
mod settled;
mod snapshot;
mod solve;
mod state;
mod step;
mod world;

pub use error::{SimulationError, StepFailure};
pub use formulate::contact_problem::Velocity;
pub use kinematics::Kinematics;
pub use moving::Moving;
pub use options::{COULOMB_TOLERANCE, Formulation, Options, Reuse};
pub use parted::parted;
pub use record::{Inconsistent, StepRecord};
pub use run::{Ending, Kept, Run, run};
pub use snapshot::snapshot_dimension;
pub use solve::{FRICTION_ACCEPTED, FRICTION_TOLERANCE};
pub use world::{ContactImpulse, World};
