//! The last stage of a step: from velocities to places, and overlaps taken back.

mod advance;
mod projection;

pub use advance::integrate;
pub use projection::project;
