//! Linear complementarity problems, solved by pivoting, with computation reuse.
//!
//! Given a matrix `M` (n x n) and a vector `q` (n), find `z` and `w` with
//!
//! ```text
//! w = M z + q,    0 <= z  complementary to  w >= 0    (so z' w = 0)
//! ```
//!
//! Read in this order: [`Problem`] (what is solved), [`Solution`] and [`Status`] (what comes back),
//! [`Settings`] (every tolerance), [`Solver`] (Dantzig's principal pivoting on a masked problem, the object
//! that keeps its factor between solves), [`Start`] (reuse of a sub-problem's solution), then the methods
//! [`Dantzig`], [`Block`] and [`Lemke`] behind one trait, [`Method`].
//!
//! ```
//! use drystone_lcp::{Dantzig, Method, Problem, Settings, Status};
//!
//! let problem = Problem::from_dense(&[2.0, 1.0, 1.0, 2.0], vec![-5.0, -6.0])?;
//! let solution = Dantzig.solve(&problem, None, &Settings::default())?;
//! assert_eq!(solution.status, Status::Solved);
//! assert!((solution.z[0] - 4.0 / 3.0).abs() < 1e-12 && (solution.z[1] - 7.0 / 3.0).abs() < 1e-12);
//! # Ok::<(), drystone_lcp::LcpError>(())
//! ```

mod basis;
mod certificate;
pub mod cone;
mod counts;
mod error;
pub mod factor;
mod generators;
pub mod interior;
pub mod interrupt;
mod matrix;
mod pivot;
mod problem;
mod ratio;
pub mod refined;
mod reuse;
mod scaling;
pub mod sealed;
mod settings;
mod solution;
mod solver;

pub use counts::Counts;
pub use error::{LcpError, StartError};
pub use matrix::SparseColumns;
pub use pivot::{Block, Dantzig, Lemke, Method};
pub use problem::Problem;
pub use reuse::Start;
pub use settings::Settings;
pub use solution::{Solution, Status, residual};
pub use solver::{Origin, Snapshot, Solver, SolverState};

/// The first page of this crate; its example is run with the others.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct FirstPage;
