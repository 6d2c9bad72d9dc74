//! Exactly: impulses with which every contact does what it is found to do, and then what it does again.
//!
//! Who sticks, slides and parts is told by `p - u` of each contact, in m/s. For that active set Newton's method solves
//!
//! ```text
//! u = 0 (sticks),    u_n = 0 and p_t = -mu p_n u_t / |u_t| (slides),    p = 0 (parts)
//! ```
//!
//! for changes of the impulses and of the velocities, as small as the error is, so that no digit is lost to what they are changes of:
//! the end is as near to the law as J v can be computed. Redundant contacts may leave no solution, when their gaps differ by rounding, or many; each gives way by
//! eps (a proximal term). While the set stays the same its matrix is kept.
//!
//! Far from the answer sets may go round in circles; so this ends what is nearly solved, and tries a start that may nearly be the answer
//! (a primal-dual active set method: Hintermüller, Ito and Kunisch, 2002).

use crate::{
    best::{Best, Goal},
    newton::Newton,
    system::{State, System},
};

/// An error so much smaller than the tolerance is not made smaller still.
pub(crate) const UNSEEN: f64 = 1e-5;
/// eps: this share of the error beside the largest impulse, but at least and at most this. What is as hard as the least lets a load that redundant
/// contacts cannot share wander to where one lets go in a step or two; what is softer than the most, at first, goes nowhere.
const SHARE: f64 = 0.1;
const HARD: f64 = 1e-7;
const SOFT: f64 = 0.1;
/// Where that leaves an error as large as it was it falls by so much, down to the hardest.
const HARDER: f64 = 1e-2;
const HARDEST: f64 = 1e-11;
/// A step that leaves at most this share of the error is not counted.
const GOOD: f64 = 0.8;
/// A matrix is kept while each step with it leaves at most this share of the error.
const KEPT: f64 = 0.1;
/// From the best state, in at most so many Newton steps that are not good. Keeps what is better. Returns the steps.
pub(crate) fn solve<const B: usize, const D: usize>(
    system: &System<B, D>,
    newton: &mut Newton<B, D>,
    best: &mut Best<B, D>,
    goal: Goal,
    most: usize,
) -> usize {
    let mut state = best.state.clone();
    let mut left = most;
    let (mut eps, mut least, mut steps) = (SOFT, HARD, 0);
    let (mut last, mut anew) = (best.error, true);
    loop {
        let changed = newton.classify(system, &state);
        let made = changed || anew;
        if made {
            if left == 0 {
                return steps;
            }
            left -= 1;
            steps += 1;
            eps = (SHARE * last / largest(system, &state)).clamp(least, SOFT);
        }
        let known = best.error;
        if !newton.increment(system, &mut state, eps, made) {
            return steps;
        }
        let error = best.keep(system, &state);
        if best.error <= GOOD * known {
            left = (left + 1).min(most);
        }
        let slow = !changed && error > KEPT * last;
        if error <= UNSEEN * goal.tolerance || error.is_nan() || (slow && error <= goal.end) {
            return steps;
        }
        if slow && made && error > 0.5 * last {
            least *= HARDER;
            if least < HARDEST {
                return steps;
            }
        }
        anew = slow;
        last = error;
    }
}

/// The largest impulse, m/s.
fn largest<const B: usize, const D: usize>(system: &System<B, D>, state: &State<B, D>) -> f64 {
    state.p.iter().zip(&system.contacts).map(|(p, local)| p[0] * local.weight).fold(f64::MIN_POSITIVE, f64::max)
}
