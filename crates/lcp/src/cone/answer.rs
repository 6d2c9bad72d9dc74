//! How a decision can end, and what the numbers of an answer must hold.

use serde::{Deserialize, Serialize};

/// What a solve found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Membership {
    /// `h` is in the cone: `f` was found and its residual is within the tolerance.
    Inside,
    /// `h` is not in the cone: the certificate y has `y' G <= 0` and `y' h > 0`.
    Outside,
    /// Neither is proved: forces that leave next to nothing, and a motion with some power, or neither of the two; see
    /// `extended.rs` for what counts.
    Borderline,
    /// The pivot limit was reached.
    PivotLimit,
    /// Accuracy was lost and rebuilding the factor did not bring it back.
    NumericalTrouble,
}

/// How near a borderline answer is to either side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Doubt {
    /// Least imbalance that any forces leave, in a block's own load.
    pub imbalance: f64,
    /// Power of the certificate, as a multiple of what rounding could make of the forces.
    pub power: f64,
}

impl Doubt {
    /// Whether a certificate is proved, and it is only that forces leave no more than they may: a limit, not rounding.
    pub fn is_at_a_limit(&self) -> bool {
        self.power > MARGIN
    }
}

/// Imbalance of a row that forces may leave: of the largest force in it, and of the block's own load (the row's unit).
pub(super) const OF_FORCE: f64 = 1e-9;
pub(super) const OF_LOAD: f64 = 1e-6;
/// The power of a certificate must be above as many times what rounding could make of the forces.
pub(super) const MARGIN: f64 = 10.0;
