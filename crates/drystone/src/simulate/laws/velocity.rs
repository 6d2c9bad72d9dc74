//! Impulses and velocities at the end of the step, in one problem: docs/theory/velocity-level.md.

use super::law::Law;
use crate::simulate::{
    error::StepFailure,
    formulate::{contact_problem::ContactProblem, restitution::offsets},
    kinematics::Kinematics,
    solve::{Motion, PreviousStep, StepProblem, solve},
    state::State,
};

/// One problem of impulses and velocities.
#[derive(Debug)]
pub struct VelocityLevel;

impl<S: Kinematics> Law<S> for VelocityLevel {
    fn motion(
        &self,
        state: &State<S>,
        previous: &mut PreviousStep<S>,
        contacts: &ContactProblem<S>,
        free: &[S::Velocity],
    ) -> Result<Motion<S>, StepFailure> {
        let offsets = offsets(state, contacts, free);
        solve(state, previous, &StepProblem { contacts, free, offsets: &offsets })
    }
}
