//! What is basic, and which values of it are feasible.

use serde::{Deserialize, Serialize};

/// What is basic in a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Basic {
    /// The unit column of the position's own row: what the row lacks to balance.
    Unit,
    Column(u32),
}

/// A basic value within this of zero is zero, and within what rounding leaves of the largest force. Values are forces
/// relative to the scaled `h` (largest entry one): rounding
/// along a path of a thousand blocks is near 1e-13.
pub(super) const ZERO: f64 = 1e-10;

/// Sign of the infeasibility of a basic value: a unit column must be zero, a generator not negative.
pub(super) fn infeasible(basic: Basic, value: f64, zero: f64) -> f64 {
    if value < -zero {
        -1.0
    } else if value > zero && basic == Basic::Unit {
        1.0
    } else {
        0.0
    }
}
