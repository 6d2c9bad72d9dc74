//! Sweeps, then the augmented Lagrangian with Newton's method, on one island.
//!
//! Contacts give way by eps of their own yielding about reference impulses; what is found is the next reference, with less of eps. So eps
//! only says how far one goes at once, not what is found: at the end impulses stay, and the law holds exactly.

use crate::{
    drift,
    newton::Newton,
    settings::Settings,
    solution::Counts,
    sweep::sweep,
    system::{State, System},
};

/// Sweeps at the beginning.
const SWEEPS: usize = 6;
/// eps at first, at most and at least; and by how much it falls after a solve of few steps, or grows after one that failed. What was
/// measured: docs/theory/step-solver.md.
const FIRST: f64 = 0.1;
const SOFTEST: f64 = 1.0;
const HARDEST: f64 = 1e-8;
const HARDER: f64 = 0.3;
const SOFTER: f64 = 5.0;
/// Few Newton steps of one solve.
const FEW: usize = 3;
/// What a solve may leave of the velocities beside what yielding does, and beside the tolerance. Measured: with a third of the first a
/// quarter more steps.
const BESIDE: f64 = 1.0;
const UNSEEN: f64 = 1e-3;
/// An error so much smaller than the tolerance is not made smaller still; what is within the tolerance is polished until then, as
/// long as that halves the error. Where it does not eps grows, so that rounding is felt less.
const ENOUGH: f64 = 1e-5;
const POLISHED: std::ops::Range<f64> = 1e-5..1e-1;
/// Impulses drift where no contact changes its state and the error stays, within a quarter.
const STAYS: std::ops::Range<f64> = 0.8..1.25;

/// The best that was found.
struct Best<const B: usize, const D: usize> {
    state: State<B, D>,
    error: f64,
}

impl<const B: usize, const D: usize> Best<B, D> {
    /// Keeps a state that is better. Returns its error.
    fn keep(&mut self, system: &System<B, D>, state: &State<B, D>) -> f64 {
        let error = system.error(state);
        if error < self.error {
            self.error = error;
            self.state.clone_from(state);
        }
        error
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
    let mut best = Best { state: state.clone(), error: system.error(state) };
    if best.error > ENOUGH * tolerance {
        for round in 0..SWEEPS {
            counts.sweeps += 1;
            counts.local_solves += system.len();
            if sweep(system, state, round % 2 == 1) <= ENOUGH * tolerance {
                break;
            }
        }
        system.move_by(state);
        best.keep(system, state);
    }
    if best.error > ENOUGH * tolerance {
        harden(system, state, &mut best, (tolerance, settings.newton_steps), counts);
    }
    state.clone_from(&best.state);
    best.error
}

/// Solves softened problems, each from what the one before found.
fn harden<const B: usize, const D: usize>(
    system: &System<B, D>,
    state: &mut State<B, D>,
    best: &mut Best<B, D>,
    (tolerance, most): (f64, usize),
    counts: &mut Counts,
) {
    let Some(mut newton) = Newton::new(system) else { return };
    let (mut eps, mut least, mut steps) = (FIRST, HARDEST, 0);
    let (mut before, mut parts, mut last) = (state.p.clone(), Vec::new(), f64::INFINITY);
    while steps < most {
        let begun = steps;
        before.clone_from(&state.p);
        if !newton.solve(system, state, (eps, BESIDE, UNSEEN * tolerance), &mut steps) {
            if eps >= SOFTEST {
                break;
            }
            least = eps;
            eps = (SOFTER * eps).min(SOFTEST);
            continue;
        }
        let error = best.keep(system, state);
        if best.error <= tolerance {
            polish(system, &mut newton, best, (tolerance, eps), &mut steps);
            break;
        }
        let same = newton.contacts.iter().map(|contact| contact.part).eq(parts.iter().copied());
        parts.clear();
        parts.extend(newton.contacts.iter().map(|contact| contact.part));
        if same && STAYS.contains(&(error / last)) {
            let frictions = system.contacts.iter().map(|local| local.friction);
            drift::follow(&before, &mut state.p, frictions.zip(parts.iter().copied()));
        } else if steps - begun <= FEW {
            eps = (HARDER * eps).max(least);
        }
        least = (HARDER * least).max(HARDEST);
        last = error;
    }
    counts.newton_steps += steps;
}

/// Makes the error of what is solved smaller.
fn polish<const B: usize, const D: usize>(
    system: &System<B, D>,
    newton: &mut Newton<B, D>,
    best: &mut Best<B, D>,
    (tolerance, eps): (f64, f64),
    steps: &mut usize,
) {
    let mut eps = eps.max(POLISHED.start);
    let mut state = best.state.clone();
    while best.error > ENOUGH * tolerance && eps < POLISHED.end {
        let before = best.error;
        let solved = newton.polish(system, &mut state, eps, steps);
        if !solved || best.keep(system, &state) > 0.5 * before {
            state.clone_from(&best.state);
            eps *= 10.0;
        }
    }
}
