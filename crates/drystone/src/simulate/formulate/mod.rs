//! The second stage of a step: from candidate contacts to the problem of its impulses and velocities.

pub mod contact_problem;
pub mod free_motion;
pub mod islands;
pub mod restitution;
