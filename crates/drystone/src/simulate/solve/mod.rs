//! The third stage of a step: impulses and velocities that obey Coulomb's law.

mod active_rows;
mod anderson;
mod choice;
mod impulses_at_rest;
mod pivots;
mod previous_step;
mod rest;
mod round_cones;
mod step_problem;
mod tolerance;
mod warm_start;

pub use active_rows::ActiveRows;
pub use previous_step::{PreviousStep, RestSolution};
pub use round_cones::solve_nearly;
pub use step_problem::{Effort, Motion, StepProblem};
pub use tolerance::{FRICTION_ACCEPTED, FRICTION_TOLERANCE};
pub use warm_start::SavedStart;

use super::{error::StepFailure, kinematics::Kinematics, options::Reuse, state::State};
use drystone_lcp::{Counts, Status};
use pivots::Unsolved;
use round_cones::Round;

/// Pivots of a step, times its rows, after which an answer on round cones takes their place, if there is one near the law: they take a sixth of a second in
/// the plane, and twice that in space. A wall of 200 bricks that a block hit took up to 140,000 pivots a step, 19 s.
const EFFORT: usize = 3_000_000;

/// Solves a step: as one at rest, on round cones, or by pivots; if these fail, from scratch with the solver's own tolerances. Where pivots do not come
/// to the law, Newton's method goes on from there on round cones; where they would take too long, it takes their place.
///
/// # Errors
/// [`StepFailure::Unsolved`]; nothing is taken over then.
pub fn solve<S: Kinematics>(
    state: &State<S>,
    previous: &mut PreviousStep<S>,
    step: &StepProblem<'_, S>,
) -> Result<Motion<S>, StepFailure> {
    let mut work = Counts::default();
    if let Some(motion) = rest::stay_at_rest(state, previous, step, &mut work) {
        return Ok(motion);
    }
    let coarse = match round_cones::solve_on_round_cones(state, previous, step) {
        Round::Solved(motion) => return Ok(Motion { counts: motion.counts + work, ..motion }),
        Round::Coarse(motion) => Some(motion),
        Round::Left => None,
    };
    let effort = if state.options.reuse == Reuse::Full { EFFORT } else { usize::MAX };
    let answer = match pivots::solve_by_pivots(state, previous, step, effort) {
        Err(Unsolved::TooHard) => {
            let round = coarse.or_else(|| round_cones::from_impulses_before(state, previous, step));
            if let Some(motion) = round.filter(|motion| round_cones::may_replace_pivots(step, motion)) {
                previous.forget_pivots();
                return Ok(Motion { counts: motion.counts + work, ..motion });
            }
            from_scratch(state, previous, step, false)
        }
        Err(Unsolved::Failed(_)) => from_scratch(state, previous, step, true),
        answer => answer,
    };
    let motion = answer.map_err(|unsolved| {
        previous.forget();
        let status = match unsolved {
            Unsolved::Failed(status) => status,
            Unsolved::TooHard => Status::PivotLimit,
        };
        StepFailure::Unsolved { status: status.name() }
    })?;
    let nearer = if motion.exact { None } else { round_cones::solve_after_pivots(state, step, &motion) };
    let motion = match nearer {
        Some(mut nearer) => {
            nearer.add_earlier(&motion);
            nearer
        }
        None => motion,
    };
    Ok(Motion { counts: motion.counts + work, ..motion })
}

/// By pivots that take over nothing, however long they take; with the solver's own tolerances if `relaxed`.
fn from_scratch<S: Kinematics>(
    state: &State<S>,
    previous: &mut PreviousStep<S>,
    step: &StepProblem<'_, S>,
    relaxed: bool,
) -> Result<Motion<S>, Unsolved> {
    if relaxed {
        previous.solver.restart();
    } else {
        previous.solver.forget();
    }
    previous.problem = None;
    pivots::solve_by_pivots(state, previous, step, usize::MAX)
}
