//! The methods, one file each, behind one trait.

mod block;
mod dantzig;
mod lemke;

pub use block::Block;
pub use dantzig::Dantzig;
pub use lemke::Lemke;
pub(crate) use lemke::lemke_on;

use crate::{error::LcpError, problem::Problem, reuse::Start, settings::Settings, solution::Solution};

/// A method for `w = M z + q`, `0 <= z` complementary to `w >= 0`.
pub trait Method {
    /// Name of the method, as users of other languages write it.
    fn name(&self) -> &'static str;

    /// Solves the problem, from scratch or from a named start.
    ///
    /// # Errors
    /// [`LcpError`] for bad input only; every other outcome is a [`Status`](crate::Status).
    fn solve(&self, problem: &Problem, start: Option<&Start>, settings: &Settings) -> Result<Solution, LcpError>;
}
