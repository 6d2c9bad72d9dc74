//! The augmented Lagrangian with Newton's method, on one island; its end, and where it begins at a known answer, exactly.
//!
//! Contacts give way by eps of their own yielding about reference impulses; what is found is the next reference, with less of eps. So eps
//! only says how far one goes at once, not what is found: at the end impulses stay, and the law holds exactly.

use crate::{
    active_set,
    best::{Best, Goal},
    drift, lemke,
    newton::Newton,
    path, regions,
    settings::Settings,
    solution::Counts,
    sweep::sweep,
    system::{State, System},
};

/// Sweeps at the beginning.
const SWEEPS: usize = 6;
/// The same where Newton's method would take too much memory.
const SWEEPS_ALONE: usize = 100;
/// eps at first, at most and at least; and by how much it falls after a solve of few steps, or grows after one that failed. What was
/// measured: docs/theory/step-solver.md.
const FIRST: f64 = 0.1;
const SOFTEST: f64 = 1.0;
const HARDEST: f64 = 1e-8;
const HARDER: f64 = 0.3;
const SOFTER: f64 = 5.0;
/// Few Newton steps of one solve.
const FEW: usize = 3;
/// Solves in a row that leave the error as it was, after which eps falls however many steps they took: what drifts is not there yet.
const LINGERS: usize = 6;
/// What a solve may leave of the velocities beside what yielding does, and beside the tolerance. Measured: with a third of the first a
/// quarter more steps.
const BESIDE: f64 = 1.0;
const UNSEEN: f64 = 1e-3;
/// The same once that is reached; from then on steps, and solves in a row that do not halve the error, at most.
const LEFT: f64 = 1e-4;
const POLISHING: usize = 30;
const STALE: usize = 4;
/// eps at first where the start is within the tolerance.
const NEARLY: f64 = 1e-3;
/// Below this share of the tolerance the end is tried exactly, in so many steps that are not good; and again at a tenth of the error.
const ENDING: f64 = 1e-2;
const AT_END: usize = 4;
/// Newton steps from a start that are not good, by the components of an impulse: in the plane, where the law is linear piece by piece, most
/// islands are solved so. What was measured: docs/theory/step-solver.md.
const FROM_START: [usize; 2] = [8, 2];
/// In space, where all steps lead nowhere: one more from no impulses for so many of them. Of 480 steps of heaps of 200 and of 500 boxes one is not exact so, three
/// are without; what does not arrive then does not in twice as many.
const FOR_ONE_FROM_NOTHING: usize = 4;

/// Solves one island from where `state` is, and leaves the best that was found there. Returns its error.
pub(crate) fn solve<const B: usize, const D: usize>(
    system: &System<B, D>,
    state: &mut State<B, D>,
    goal: Goal,
    settings: &Settings,
    counts: &mut Counts,
) -> f64 {
    system.move_by(state);
    let mut best = Best::new(system, state);
    if best.error <= active_set::UNSEEN * goal.tolerance {
        return best.error;
    }
    let Some(mut newton) = Newton::new(system) else {
        sweeps(system, state, &mut best, (goal.tolerance, SWEEPS_ALONE), counts);
        state.clone_from(&best.state);
        return best.error;
    };
    let from_error = (goal, path::FIRST, settings.newton_steps);
    let warm = state.p.iter().any(|p| p[0] > 0.0);
    if warm {
        counts.newton_steps += active_set::solve(system, &mut newton, &mut best, goal, FROM_START[D - 2]);
        // What the active set's method left is nearer to the answer than the start, though it ended nowhere.
        state.clone_from(&best.state);
    }
    // In the plane a way through the pieces leads to the answer; where not, one that begins elsewhere may.
    if D == 2 && warm && best.error > goal.end {
        counts.newton_steps += path::solve(system, &mut newton, state, &mut best, from_error);
    }
    if best.error > goal.tolerance {
        sweeps(system, state, &mut best, (goal.tolerance, SWEEPS), counts);
        if D == 2 {
            counts.newton_steps += path::solve(system, &mut newton, state, &mut best, from_error);
            state.clone_from(&best.state);
        }
    }
    if best.error > if D == 2 { goal.tolerance } else { goal.end } {
        counts.newton_steps += harden(system, state, &mut best, &mut newton, (goal, settings.newton_steps));
    }
    if D == 3 && warm && best.error > goal.tolerance {
        let most = settings.newton_steps / FOR_ONE_FROM_NOTHING;
        again_from_nothing(system, &mut best, &mut newton, (goal, most), counts);
    }
    // In the plane a way from nothing arrives: for what is in error, or for all.
    let Settings { newton_steps, changes, from_nothing, .. } = *settings;
    if D == 2 && changes > 0 && best.error > from_nothing * goal.tolerance {
        counts.newton_steps += regions::solve(system, &mut newton, &mut best, (goal, changes));
        if best.error > from_nothing * goal.tolerance {
            counts.newton_steps += lemke::solve(system, &mut newton, &mut best, (goal, newton_steps, changes));
        }
    }
    state.clone_from(&best.state);
    best.error
}

/// Sweeps and solves softened problems from no impulses: where the start leads nowhere, that may lead to the answer, and does so soon then. Keeps what is
/// better.
fn again_from_nothing<const B: usize, const D: usize>(
    system: &System<B, D>,
    best: &mut Best<B, D>,
    newton: &mut Newton<B, D>,
    (goal, most): (Goal, usize),
    counts: &mut Counts,
) {
    let mut state = system.state();
    let mut other = Best::new(system, &state);
    sweeps(system, &mut state, &mut other, (goal.tolerance, SWEEPS), counts);
    counts.newton_steps += harden(system, &mut state, &mut other, newton, (goal, most));
    best.keep(system, &other.state);
}

/// Sweeps, until nothing changes any more.
fn sweeps<const B: usize, const D: usize>(
    system: &System<B, D>,
    state: &mut State<B, D>,
    best: &mut Best<B, D>,
    (tolerance, most): (f64, usize),
    counts: &mut Counts,
) {
    for round in 0..most {
        counts.sweeps += 1;
        counts.local_solves += system.len();
        if sweep(system, state, round % 2 == 1) <= active_set::UNSEEN * tolerance {
            break;
        }
    }
    system.move_by(state);
    best.keep(system, state);
}

/// Solves softened problems, each from what the one before found; then exactly. Returns the steps.
fn harden<const B: usize, const D: usize>(
    system: &System<B, D>,
    state: &mut State<B, D>,
    best: &mut Best<B, D>,
    newton: &mut Newton<B, D>,
    (goal, mut most): (Goal, usize),
) -> usize {
    let Goal { tolerance, end } = goal;
    let (mut reached, mut stale, mut stayed, mut near) = (false, 0, 0, ENDING * tolerance);
    let (mut eps, mut least, mut steps) = (if best.error > tolerance { FIRST } else { NEARLY }, HARDEST, 0);
    let (mut before, mut parts, mut last) = (state.p.clone(), Vec::new(), f64::INFINITY);
    // Where nothing is left to do a solve takes no step; a problem without a solution would go on so for ever.
    let (mut solves, most_solves) = (0, most);
    while steps < most && solves < most_solves {
        solves += 1;
        let begun = steps;
        before.clone_from(&state.p);
        if !newton.solve(system, state, (eps, BESIDE, if reached { LEFT } else { UNSEEN } * tolerance), &mut steps) {
            if eps >= SOFTEST {
                break;
            }
            least = eps;
            eps = (SOFTER * eps).min(SOFTEST);
            continue;
        }
        let known = best.error;
        let error = best.keep(system, state);
        if best.error <= tolerance && !reached {
            (reached, most) = (true, most.min(steps + POLISHING));
        }
        if best.error <= near {
            steps += active_set::solve(system, newton, best, goal, AT_END);
            if best.error <= end {
                return steps;
            }
            near = 0.1 * best.error;
        }
        stale = if best.error > 0.5 * known { stale + 1 } else { 0 };
        if reached && stale == STALE {
            return steps;
        }
        let stays = drift::STAYS.contains(&(error / last));
        stayed = if stays { stayed + 1 } else { 0 };
        let same = newton.contacts.iter().map(|contact| contact.part).eq(parts.iter().copied());
        parts.clear();
        parts.extend(newton.contacts.iter().map(|contact| contact.part));
        if same && stays {
            let frictions = system.contacts.iter().map(|local| local.friction);
            drift::follow(&before, &mut state.p, frictions.zip(parts.iter().copied()), drift::BEYOND);
        } else if steps - begun <= FEW || stayed == LINGERS {
            eps = (HARDER * eps).max(least);
            stayed = 0;
        }
        least = (HARDER * least).max(HARDEST);
        last = error;
    }
    steps
}
