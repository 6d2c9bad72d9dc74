//! Steps of a world at rest without a solve: impulses that keep everything where it is, if there are any.
//!
//! Bodies at rest stay so if impulses along the closed contacts take up what would move them,
//!
//! ```text
//! G p = -M v*,    p >= 0,
//! ```
//!
//! and then w = A p + q is zero on their rows and nowhere negative: the problem of `contact_problem.rs` is solved, and A was never
//! made. To decide this takes far less than that problem (`impulses_at_rest.rs`), for G is sparser than A. The next step
//! that differs solves from there (Theorem 1). Where something falls at once this tells nothing.

use super::{
    impulses_at_rest::{AtRest, loads},
    previous_step::{PreviousStep, RestSolution},
    step_problem::{Motion, StepProblem},
};
use crate::{
    contact::candidates::CandidateOf,
    ladder::FEW_ROWS,
    simulate::{
        formulate::contact_problem::ContactProblem,
        kinematics::{Kinematics, is_zero},
        motionless::motionless_bodies,
        options::Reuse,
        state::State,
    },
};
use drystone_lcp::{Counts, Settings, Start, interior::End};
use std::time::Instant;

/// Solves a step in which all bodies that touch others, at rest so far, stay so; the rest flies. None if they do not, if that is not taken
/// over, or if the step before was solved in another way. `work` is what it took either way.
pub fn stay_at_rest<S: Kinematics>(
    state: &State<S>,
    previous: &mut PreviousStep<S>,
    step: &StepProblem<'_, S>,
    work: &mut Counts,
) -> Option<Motion<S>> {
    let known = previous.at_rest.is_some();
    if state.options.reuse != Reuse::Full || (previous.problem.is_some() && !known) {
        return None;
    }
    let touching = touching(state, step.contacts);
    let moves = |(velocity, touching): (&S::Velocity, &bool)| *touching && !is_zero(velocity);
    if state.velocities.iter().zip(&touching).any(moves) {
        return None;
    }
    let begun = Instant::now();
    let contacts = step.contacts;
    let mut free = step.free.to_vec();
    free.iter_mut().zip(&touching).filter(|(_, touching)| !**touching).for_each(|(v, _)| *v = S::Velocity::default());
    let start = if known {
        same_impulses(previous, contacts)?
    } else {
        let decision = AtRest::new(state, contacts, (&free, step.offsets)).decide().ok()?;
        *work = *work + decision.work;
        decision.start?
    };
    let p = start.spread(contacts.len());
    let mut velocities = contacts.velocities(&free, &state.inverse_mass, |row| p[row]);
    let residual = residual(state, &StepProblem { free: &free, ..*step }, &velocities, &p);
    // Beside large impulses a residual that may stand could still move a small body.
    let still = motionless_bodies(state, &velocities, 0.0);
    if residual > Settings::default().residual || still.contains(&false) {
        return None;
    }
    let none = vec![0.0; contacts.candidates().len()];
    let (_, friction_error) = step.coulomb_error(&velocities, &none, |row| p[row]);
    let q = contacts.q(step.free, step.offsets, &none);
    previous.at_rest = Some(RestSolution { start, q });
    let flying = (0..touching.len()).filter(|&body| !touching[body]);
    flying.for_each(|body| velocities[body] = step.free[body]);
    Some(Motion {
        velocities,
        sliding: none,
        impulses: (0..contacts.candidates().len()).map(|k| contacts.impulse(k, |row| p[row])).collect(),
        friction_error,
        exact: true,
        unseen: 0.0,
        residual,
        solves: 1,
        rows_reused: 0,
        time: begun.elapsed(),
        counts: *work,
        collisions: 0,
        inconsistent: None,
        unfinished: false,
    })
}

/// Which bodies have a contact.
fn touching<S: Kinematics>(state: &State<S>, contacts: &ContactProblem<S>) -> Vec<bool> {
    let mut touching = vec![false; state.inverse_mass.len()];
    contacts.candidates().iter().flat_map(|candidate| candidate.id.bodies).for_each(|body| touching[body] = true);
    touching
}

/// The impulses of the step before, if each of its contacts that bears is still there.
fn same_impulses<S: Kinematics>(previous: &PreviousStep<S>, contacts: &ContactProblem<S>) -> Option<Start> {
    let (before, solution) = previous.problem.as_ref().zip(previous.at_rest.as_ref())?;
    let p = solution.start.spread(before.len());
    let mut start = Start { indices: Vec::new(), z: Vec::new() };
    for (k, old) in contacts.matches(before) {
        let Some(old) = old else { continue };
        for (row, old) in contacts.rows(k).zip(before.rows(old)).filter(|(_, old)| p[*old] > 0.0) {
            start.indices.push(row);
            start.z.push(p[old]);
        }
    }
    (start.indices.len() == solution.start.indices.len()).then_some(start)
}

/// A start of the step's problem from nothing: the rows that bear in the answer of the interior-point method, with their
/// impulses. None where that has no answer, or for so few rows that pivots are sooner there.
pub fn start_from_interior<S: Kinematics>(
    state: &State<S>,
    step: &StepProblem<'_, S>,
    assumed: &[f64],
) -> Option<Start> {
    if step.contacts.len() <= FEW_ROWS {
        return None;
    }
    let bodies: Vec<usize> = (0..state.scene.bodies().len()).filter(|&i| !state.scene.bodies()[i].fixed).collect();
    let all: Vec<usize> = (0..step.contacts.candidates().len()).collect();
    let (loads, _) = loads(&state.scene, step.free);
    let mut problem = step.contacts.gauss(&all, (&loads, &state.inverse_mass), &bodies);
    problem.offset = step.contacts.lifts(step.offsets, assumed);
    let found = problem.solve();
    let least = NOTHING * problem.load.iter().fold(0.0, |largest: f64, load| largest.max(load.abs()));
    let bears = |(row, p): &(usize, f64)| found.bearing[*row] && *p > least;
    let (indices, z) = found.forces.iter().copied().enumerate().filter(bears).unzip();
    (found.end == End::Converged).then_some(Start { indices, z })
}

/// Another solution of a step at rest, from one in which the rows that bear depend on one another, as those of a load takedown
/// do: by the interior-point method, so that they do not. None if it leads to none.
pub fn other_start<S: Kinematics>(state: &State<S>, contacts: &ContactProblem<S>, start: &Start) -> Option<Start> {
    let p = start.spread(contacts.len());
    // What would move the bodies is what these impulses take up.
    let at_rest = vec![S::Velocity::default(); state.inverse_mass.len()];
    let mut free = contacts.velocities(&at_rest, &state.inverse_mass, |row| p[row]);
    free.iter_mut().for_each(|v| v.as_mut().iter_mut().for_each(|v| *v = -*v));
    let offset = |candidate: &CandidateOf<S>| candidate.gap.max(0.0) / state.options.dt;
    let offsets: Vec<f64> = contacts.candidates().iter().map(offset).collect();
    AtRest::new(state, contacts, (&free, &offsets)).on_a_basis()
}

/// The natural residual of the step's problem, in its own scale (`drystone_lcp::solution::residual`): w is what the contacts
/// have after the impulses.
fn residual<S: Kinematics>(state: &State<S>, step: &StepProblem<'_, S>, velocities: &[S::Velocity], p: &[f64]) -> f64 {
    let none = vec![0.0; step.offsets.len()];
    let [q, w] = [step.free, velocities].map(|v| step.contacts.q(v, step.offsets, &none));
    let (mut worst, mut scale) = (0.0_f64, 0.0_f64);
    for (row, p) in p.iter().enumerate() {
        let root = step.contacts.yielding(row, &state.inverse_mass).sqrt();
        let d = if root > 0.0 { root.recip() } else { 1.0 };
        worst = worst.max((p / d).min(d * w[row]).abs());
        scale = scale.max(p / d).max((d * q[row]).abs());
    }
    if worst == 0.0 { 0.0 } else { worst / scale }
}

/// An impulse below this share of the largest that a step's loads give is what the gap has left.
const NOTHING: f64 = 1e-10;
