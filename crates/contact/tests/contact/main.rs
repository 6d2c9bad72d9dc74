//! The crate as its users see it.

mod bad_input;
mod common;
mod matrices;
mod modes;
mod random;
mod truths;
