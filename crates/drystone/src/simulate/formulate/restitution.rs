//! How fast the contacts of a step may close, and how fast they part after an impact.

use super::contact_problem::ContactProblem;
use crate::{
    geometry::norm,
    simulate::{kinematics::Kinematics, state::State},
};

/// Impacts slower than what gravity gives in this many steps do not rebound: they are contacts that rest.
const RESTING_STEPS: f64 = 4.0;

/// Contacts that close more slowly rest, m/s.
pub fn resting_speed<S: Kinematics>(state: &State<S>) -> f64 {
    RESTING_STEPS * state.options.dt * norm(state.scene.gravity().as_ref())
}

/// How fast the contacts of a step may close, m/s.
#[derive(Debug, Clone)]
pub struct Offsets {
    /// To the end of the gap.
    closing: Vec<f64>,
    /// Where bodies collide, how fast they come: below zero.
    arriving: Vec<Option<f64>>,
}

impl Offsets {
    /// `free` are the velocities without contacts. Without restitution nothing rebounds.
    pub fn new<S: Kinematics>(state: &State<S>, contacts: &ContactProblem<S>, free: &[S::Velocity]) -> Self {
        let resting = resting_speed(state);
        let arriving = |k: usize| {
            if state.options.restitution == 0.0 {
                return None;
            }
            let [arriving, _] = contacts.opening_and_sliding(k, &state.velocities);
            let [free, _] = contacts.opening_and_sliding(k, free);
            let gap = contacts.candidates()[k].gap.max(0.0);
            (arriving < -resting && gap + state.options.dt * free <= 0.0).then_some(arriving)
        };
        let closing = |k: usize| contacts.candidates()[k].gap.max(0.0) / state.options.dt;
        let count = contacts.candidates().len();
        Self { closing: (0..count).map(closing).collect(), arriving: (0..count).map(arriving).collect() }
    }

    /// Whether bodies collide and rebound.
    pub fn rebound(&self) -> bool {
        self.arriving.iter().any(Option::is_some)
    }

    /// The offsets: where bodies collide Newton's law of impact, `e u_n`.
    pub fn with(&self, restitution: f64) -> Vec<f64> {
        let offset = |(closing, arriving): (&f64, &Option<f64>)| match arriving {
            Some(arriving) if restitution > 0.0 => restitution * arriving,
            _ => *closing,
        };
        self.closing.iter().zip(&self.arriving).map(offset).collect()
    }
}
