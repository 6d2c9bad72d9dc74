//! What an attempt takes for zero, and what is done before the next one: see `doubt.rs`.

use crate::settings::Settings;

/// What counts as zero in an attempt.
#[derive(Debug, Clone, Copy)]
pub(super) struct Zero {
    /// Rows with `w` above minus this are feasible, in the problem's own scale.
    pub feasibility: f64,
    /// That scale is q's alone; beside z only rounding counts as zero.
    pub beside_q: bool,
    /// Along a ray that says nothing z is moved out until the violation is zero beside it.
    pub goes_out: bool,
    /// A curvature at or below this, relative to the direction's size.
    pub singular: f64,
    /// A curvature at or below this, relative to the square of the direction's size.
    pub curvature: f64,
}

/// Rounding of a curvature relative to the square of the direction's size: some fifty units in the last place.
pub(super) const CURVATURE_ROUNDING: f64 = 1e-14;
/// The same where it stands between a ray and a pivot: four units in the last place.
pub(super) const FINE_CURVATURE: f64 = 1e-15;
/// A component of a direction that is rounding even there, relative to the largest.
pub(super) const FINE_PIVOT: f64 = 1e-14;
/// Rounding of `M z` relative to z's largest entry, below which no w can be told from zero.
pub(super) const IMAGE_ROUNDING: f64 = 2e-15;

impl Zero {
    /// In the first attempt.
    pub fn of(settings: &Settings) -> Self {
        let Settings { feasibility, singular, .. } = *settings;
        Self { feasibility, beside_q: false, goes_out: false, singular, curvature: CURVATURE_ROUNDING }
    }
}

/// What is done before another attempt.
#[derive(Debug, Clone, Copy)]
pub(super) enum Repair {
    /// The factor is built again.
    Refactor,
    /// Everything is forgotten.
    Restart,
    /// Everything is forgotten, and only the last digit counts as rounding.
    Finer,
    /// Everything is forgotten, and curvatures up to this count as zero.
    Coarser(f64),
}

/// The repairs, in the order in which they are tried.
pub(super) const REPAIRS: [Repair; 6] = [
    Repair::Refactor,
    Repair::Restart,
    Repair::Finer,
    Repair::Coarser(1e-11),
    Repair::Coarser(1e-9),
    Repair::Coarser(1e-7),
];

/// What attempts without an answer leave for the end.
#[derive(Debug, Clone, Default)]
pub(super) struct Doubtful {
    /// A certificate that is not a clear one, in the caller's unit.
    pub ray: Option<Vec<f64>>,
    /// A scaled z whose residual is small in its own scale, but far out.
    pub far: Option<Vec<f64>>,
}
