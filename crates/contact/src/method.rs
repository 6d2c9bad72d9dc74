//! Sweeps, then Newton's method, on one island.

use crate::{
    newton::Newton,
    settings::Settings,
    solution::Counts,
    sweep::sweep,
    system::{State, System},
};
use drystone_lcp::interrupt::poll;

/// Attempts, one after the other until one ends in a solution: sweeps at its beginning, and how soft its Newton steps are
/// ([`Newton::step`]). All but the first begin at the best that was found. What was measured: docs/theory/step-solver.md.
const ATTEMPTS: [(usize, f64); 4] = [(6, 1.0), (3, 10.0), (3, 0.1), (3, 1.0)];
/// Newton steps of an attempt.
const PATIENCE: usize = 100;
/// An error so much smaller than the tolerance is not made smaller still; and Newton steps that may be spent on getting there, each of
/// which mostly doubles the digits.
const ENOUGH: f64 = 1e-5;
const POLISHING: usize = 5;

/// Where a search is.
struct Search<'a, const B: usize, const D: usize> {
    system: &'a System<B, D>,
    tolerance: f64,
    best: State<B, D>,
    error: f64,
}

impl<const B: usize, const D: usize> Search<'_, B, D> {
    /// Keeps a state that is better than what was there. Whether it solves the problem.
    fn keep(&mut self, state: &State<B, D>) -> bool {
        let error = self.system.error(state);
        if error < self.error {
            self.error = error;
            self.best.clone_from(state);
        }
        error <= self.tolerance
    }

    /// Sweeps, until nothing changes any more. Whether that solves it.
    fn sweep(&mut self, state: &mut State<B, D>, most: usize, counts: &mut Counts) -> bool {
        for round in 0..most {
            counts.sweeps += 1;
            counts.local_solves += self.system.len();
            if sweep(self.system, state, round % 2 == 1) <= ENOUGH * self.tolerance {
                break;
            }
        }
        self.system.move_by(state);
        self.keep(state)
    }
}

/// Solves one island from where `state` is, and leaves the best that was found there. Returns its error.
pub(crate) fn solve<const B: usize, const D: usize>(
    system: &System<B, D>,
    state: &mut State<B, D>,
    tolerance: f64,
    settings: &Settings,
    counts: &mut Counts,
) -> f64 {
    system.move_by(state);
    let mut search = Search { system, tolerance, best: state.clone(), error: system.error(state) };
    if search.error <= ENOUGH * tolerance {
        return search.error;
    }
    let mut newton = None;
    let most = counts.newton_steps + settings.newton_steps;
    for (sweeps, softness) in ATTEMPTS {
        let done = search.sweep(state, sweeps, counts);
        if done && search.error <= ENOUGH * tolerance {
            break;
        }
        if newton.is_none() {
            newton = Newton::new(system);
        }
        let Some(newton) = &mut newton else { break };
        let mut left = if done { POLISHING } else { PATIENCE };
        while left > 0 && search.error > ENOUGH * tolerance && counts.newton_steps < most {
            if !newton.step(system, state, softness) {
                break;
            }
            counts.newton_steps += 1;
            poll(64 * D * B * system.len());
            left -= 1;
            if search.keep(state) {
                left = left.min(POLISHING);
            }
        }
        state.clone_from(&search.best);
        if search.error <= tolerance {
            break;
        }
    }
    state.clone_from(&search.best);
    search.error
}
