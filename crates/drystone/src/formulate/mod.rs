//! From contacts to a complementarity problem, and from its solution back to forces and accelerations.
//!
//! The only place that knows both geometry and the solver. With generalised velocities (3 a block, in space 6), mass matrix
//! `M`, applied wrench `F` and the generators' wrench columns `G`, forces are `G f`, `f >= 0`, accelerations are
//! `M^-1 (F + G f)`, and
//!
//! ```text
//! w = A f + b,    0 <= f  complementary to  w >= 0,    A = G' M^-1 G,    b = G' M^-1 F
//! ```
//!
//! (Loomis and Balkcom 2006, equation 4; with friction this is the convex, maximum-dissipation form.)

mod answers;
mod assembly;
mod block_rows;
mod block_set;
mod body_space;
mod cones;
mod generator;
mod hands;
mod loads;
mod motion;
mod part;
mod push;
mod self_stress;

pub(crate) use answers::force_at;
pub use answers::{Acceleration, ContactForce};
pub use assembly::Assembly;
pub use block_rows::BlockRows;
pub use block_set::BlockSet;
pub(crate) use body_space::{BodySpace, Constrained};
pub use cones::{Bound, Cones, FACETS, FrictionCone};
pub(crate) use cones::{cone_edges, tangents};
pub use generator::{Generator, Wrench};
pub(crate) use motion::Moving;
pub use part::{Assemble, Components, Part};
pub use push::{Push, PushOf};
