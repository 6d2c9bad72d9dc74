//! The third stage of a step: impulses and velocities that obey Coulomb's law.

mod active_rows;
mod anderson;
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
pub use step_problem::{Motion, StepProblem};
pub use tolerance::{FRICTION_ACCEPTED, FRICTION_TOLERANCE};
pub use warm_start::SavedStart;

use super::{error::StepFailure, kinematics::Kinematics, state::State};
use drystone_lcp::Counts;

/// Solves a step: as one at rest, on round cones, or by pivots; if these fail, from scratch with the solver's own tolerances. Where pivots do not come
/// to the law, Newton's method goes on from there on round cones.
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
    if let Some(motion) = round_cones::solve_on_round_cones(state, previous, step) {
        return Ok(Motion { counts: motion.counts + work, ..motion });
    }
    let answer = pivots::solve_by_pivots(state, previous, step).or_else(|_| {
        previous.solver.restart();
        previous.problem = None;
        pivots::solve_by_pivots(state, previous, step)
    });
    let motion = answer.map_err(|status| {
        previous.forget();
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
