//! What a law of motion is.

use crate::simulate::{
    error::StepFailure,
    formulate::contact_problem::ContactProblem,
    kinematics::Kinematics,
    solve::{Effort, Motion, PreviousStep},
    state::State,
};

/// How the velocities at the end of a step follow from those at its beginning. Contacts before and integration after
/// are the same for all.
pub trait Law<S: Kinematics>: Sync {
    /// Solves a step. `free` (bodies) are the velocities without contacts, `v* = v + h M^-1 F`. With less than the full effort the motion may be
    /// [`unfinished`](Motion::unfinished).
    ///
    /// # Errors
    /// [`StepFailure::Unsolved`].
    fn motion(
        &self,
        state: &State<S>,
        previous: &mut PreviousStep<S>,
        contacts: &ContactProblem<S>,
        free: &[S::Velocity],
        effort: Effort,
    ) -> Result<Motion<S>, StepFailure>;

    /// Velocities near those of [`Self::motion`], where these are found much sooner: enough to see who meets. None otherwise.
    fn nearly(
        &self,
        _state: &State<S>,
        _previous: &PreviousStep<S>,
        _contacts: &ContactProblem<S>,
        _free: &[S::Velocity],
    ) -> Option<Motion<S>> {
        None
    }
}
