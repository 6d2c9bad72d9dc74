//! The best state of an island that was found, and how good it has to be.

use crate::system::{State, System};

/// A state, and its error.
pub(crate) struct Best<const B: usize, const D: usize> {
    pub state: State<B, D>,
    pub error: f64,
}

impl<const B: usize, const D: usize> Best<B, D> {
    pub fn new(system: &System<B, D>, state: &State<B, D>) -> Self {
        Self { state: state.clone(), error: system.error(state) }
    }

    /// Keeps a state that is better. Returns its error.
    pub fn keep(&mut self, system: &System<B, D>, state: &State<B, D>) -> f64 {
        let error = system.error(state);
        if error < self.error {
            self.error = error;
            self.state.clone_from(state);
        }
        error
    }
}

/// What an error is compared with, m/s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Goal {
    /// It counts as solved.
    pub tolerance: f64,
    /// It is not made smaller still, but where that is free: bodies at rest are still.
    pub end: f64,
}

/// Of the tolerance, and of the caller's speed of one: above what gaps that differ by rounding leave, and below what gravity gives in a step by a
/// tenth of a billionth, which moves nothing.
const END: [f64; 2] = [1e-2, 1e-10];

impl Goal {
    pub fn new(tolerance: f64, scale: f64) -> Self {
        let [beside, least] = [END[0] * tolerance, END[1] * scale];
        Self { tolerance, end: if scale > 0.0 { least } else { beside }.min(tolerance) }
    }
}
