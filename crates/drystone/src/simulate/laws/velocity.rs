//! Impulses and velocities at the end of the step, in one problem: docs/theory/velocity-level.md.

use super::{impact::solve_with_rebounds, law::Law};
use crate::simulate::{
    error::StepFailure,
    formulate::{contact_problem::ContactProblem, free_motion::energy_gained, restitution::Offsets},
    kinematics::Kinematics,
    solve::{Effort, Motion, PreviousStep, StepProblem, solve_nearly},
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
        effort: Effort,
    ) -> Result<Motion<S>, StepFailure> {
        let offsets = Offsets::new(state, contacts, free);
        let gained = |ends: &[S::Velocity]| energy_gained(state, ends);
        solve_with_rebounds(state, previous, contacts, (free, &offsets, effort), gained)
    }

    fn nearly(
        &self,
        state: &State<S>,
        previous: &PreviousStep<S>,
        contacts: &ContactProblem<S>,
        free: &[S::Velocity],
    ) -> Option<Motion<S>> {
        let offsets = Offsets::new(state, contacts, free).with(state.options.restitution);
        solve_nearly(state, previous, &StepProblem { contacts, free, offsets: &offsets, effort: Effort::Soon })
    }
}
