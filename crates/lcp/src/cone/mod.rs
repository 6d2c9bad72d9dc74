//! Is a vector in the cone of some generators? The question behind every equilibrium.
//!
//! ```text
//! find f >= 0 with G f = h,   or y with y' G <= 0 and y' h > 0   (Farkas: exactly one of them exists)
//! ```
//!
//! With `M = G' W G` and `q = -G' W h` (W positive definite) such an f solves the complementarity problem with w = 0,
//! and the active columns of G are far sparser than `M`. So a sequence of related problems whose answer is mostly "yes"
//! is decided on G: rows and columns come and go, the factor of the basis follows them, and only what a change
//! reaches is touched.

mod answer;
mod basic;
mod basis_factor;
mod columns;
mod due;
mod extended;
mod lists;
mod membership;
mod pricing;
mod sparse_vector;

pub use answer::{Doubt, Membership};
pub use columns::Columns;
pub use membership::{ConeSolver, Greatest, Load, Mark};
