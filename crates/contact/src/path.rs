//! From any impulses to the answer, on ways through the sets of contacts that part, stick and slide (`way.rs`); in the plane.
//!
//! Any impulses p and the velocities u that they give obey the law for `p - E` and `u - E` (all in m/s), where E is the error of Alart's and Curnier's
//! natural map there, `E = p - P(p - u)`. E is then taken away in equal parts, `(1 - t) E`. Where Newton's method goes round in circles this
//! mostly arrives; from far away the way may be a loop, and Lemke's from nothing leads to the answer (`lemke.rs`).

use crate::{
    best::{Best, Goal},
    drift,
    newton::Newton,
    place::Place,
    system::{State, System},
    way::Way,
};

/// eps at first where nothing is known of the state, at least and at most; by how much it falls after each way, and grows after one that did not
/// arrive.
pub(crate) const FIRST: f64 = 1e-2;
const HARDEST: f64 = 1e-7;
const SOFTEST: f64 = 0.1;
const HARDER: f64 = 0.1;
const SOFTER: f64 = 10.0;
/// How fast the least eps falls again after one that did not arrive.
const AGAIN: f64 = 0.3;
/// Ways that may not arrive, and those in a row that may leave half of the error once that is within the tolerance.
const FAILED: usize = 3;
const STALE: usize = 2;
/// A matrix is kept while each step with it leaves at most this share of the error.
const KEPT: f64 = 0.1;
/// Changes on one way at most; of those that arrive few have more than a hundred. On all ways, for each Newton step that is allowed: a change takes half as
/// long.
const MOST: usize = 400;
const FOR_A_STEP: usize = 2;

/// Follows the way from a state, again with less of eps from where it ended, until the error is small. With `first` of eps, and the changes that so many
/// Newton steps are worth. Keeps what is better. Returns the matrices that were factored or updated.
pub(crate) fn solve<const B: usize, const D: usize>(
    system: &System<B, D>,
    newton: &mut Newton<B, D>,
    start: &State<B, D>,
    best: &mut Best<B, D>,
    (goal, first, most): (Goal, f64, usize),
) -> usize {
    let mut state = start.clone();
    let (mut eps, mut least, mut steps) = (first, HARDEST, 0);
    let (mut failed, mut stale, mut last) = (0, 0, f64::NAN);
    while steps < FOR_A_STEP * most {
        let (mut at, begun) = (state.clone(), steps);
        let places = (0..system.len()).map(|k| Place::in_error(system, &state, k, eps)).collect();
        if !Way::new(system, newton, places, eps).follow(&mut at, MOST, &mut steps) {
            failed += 1;
            if failed == FAILED {
                break;
            }
            eps = (SOFTER * eps).min(SOFTEST);
            least = eps;
            continue;
        }
        let (known, before) = (best.error, state.p.clone());
        let mut error = best.keep(system, &at);
        state.clone_from(&at);
        let drifts = steps - begun == 1 && drift::STAYS.contains(&(error / last));
        last = error;
        while error > goal.end && newton.increment(system, &mut at, eps, false) {
            let next = best.keep(system, &at);
            if next.is_nan() || next > KEPT * error {
                break;
            }
            error = next;
            state.clone_from(&at);
        }
        stale = if best.error > 0.5 * known { stale + 1 } else { 0 };
        if best.error <= goal.end || (best.error <= goal.tolerance && stale == STALE) {
            break;
        }
        if drifts {
            let frictions = system.contacts.iter().map(|local| local.friction);
            drift::follow(&before, &mut state.p, frictions.zip(newton.parts.iter().copied()), 1.0);
            system.move_by(&mut state);
            continue;
        }
        eps = (HARDER * eps).max(least);
        least = (AGAIN * least).max(HARDEST);
    }
    steps
}
