//! A step by pivots: its problem again and again, until sliding contacts obey Coulomb's law.
//!
//! The convex problem lets a sliding contact part: on the edge that opposes the sliding, w = 0 means
//! `u_n + c = mu (|u_t| - s)`, so with s = 0 a sliding body is lifted at mu |u_t|. With `s = |u_t|` the contact stays
//! closed, and the conditions are Coulomb's. So solve, take the sliding speeds found for s, and solve again: the same A
//! with another q, from the forces of the last time. In the region of one active set the map from s to |u_t| is linear, and a
//! few differences of iterates ([`anderson`](super::anderson)) jump to its fixed point; alone it contracts by about
//! mu^2 / (1 + mu^2).
//!
//! G. De Saxcé and Z.-Q. Feng, "The bipotential method: a constructive approach to design the complete contact law with
//! friction and improved numerical algorithms", 1998; V. Acary, F. Cadoux, C. Lemaréchal and J. Malick, "A formulation of the
//! linear discrete Coulomb friction problem via convex optimization", 2011 (existence, and this iteration).

use super::{
    anderson::FixedPoint,
    previous_step::PreviousStep,
    rest::{other_start, start_from_interior},
    step_problem::{Motion, StepProblem},
    tolerance::{BEFORE_NEWTON, FRICTION_ACCEPTED, MOST_SOLVES, acceptable},
    warm_start::NextProblem,
};
use crate::{
    contact::candidates::shift,
    simulate::{
        kinematics::Kinematics,
        options::{COULOMB_TOLERANCE, Reuse},
        state::State,
    },
};
use drystone_lcp::{Counts, LcpError, Status};
use std::time::{Duration, Instant};

/// One solve for assumed sliding speeds.
struct Trial<S: Kinematics> {
    velocities: Vec<S::Velocity>,
    sliding: Vec<f64>,
    error: f64,
}

/// Why there is no answer. What the solver had taken over is of no use then.
pub enum Unsolved {
    /// A solve failed.
    Failed(Status),
    /// It takes more than was allowed.
    TooHard,
}

/// Takes over what can be, then looks for the fixed point of the sliding speeds. `effort`: most pivots of all its solves, times the rows of the problem.
///
/// # Errors
/// [`Unsolved`].
pub fn solve_by_pivots<S: Kinematics>(
    state: &State<S>,
    previous: &mut PreviousStep<S>,
    step: &StepProblem<'_, S>,
    mut effort: usize,
) -> Result<Motion<S>, Unsolved> {
    let mut time = Duration::ZERO;
    let mut assumed = previous.sliding_at(step.contacts, FRICTION_ACCEPTED);
    let rows_reused = load(state, previous, step, &assumed, &mut time).map_err(Unsolved::Failed)?;
    let speed = step.free.iter().fold(0.0, |fastest, v| shift::<S>(v).max(fastest));
    let tolerance = step.coulomb_tolerance(state);
    // More than the usual tolerance is asked for by those who want to be done sooner.
    let sooner = if state.options.coulomb_tolerance > COULOMB_TOLERANCE { tolerance } else { 0.0 };
    let most = if state.options.reuse == Reuse::Full { BEFORE_NEWTON } else { MOST_SOLVES };
    let mut point = FixedPoint::new();
    let mut best = (f64::INFINITY, Vec::new());
    let mut solves = 0;
    loop {
        let trial = try_sliding(state, previous, step, &assumed, (&mut time, &mut effort))?;
        solves += 1;
        if acceptable(trial.error, solves, speed) || trial.error <= sooner || solves > most {
            let exact = acceptable(trial.error, most, speed) || trial.error <= tolerance;
            return Ok(Motion { exact, solves, rows_reused, time, ..motion(previous, step, trial) });
        }
        if trial.error < best.0 {
            best = (trial.error, assumed.clone());
        }
        assumed = if solves == most {
            std::mem::take(&mut best.1)
        } else {
            point.next(&assumed, &trial.sliding, trial.error)
        };
    }
}

/// Hands the matrix to the solver unless it has it. Returns the rows that come with their factor.
fn load<S: Kinematics>(
    state: &State<S>,
    previous: &mut PreviousStep<S>,
    step: &StepProblem<'_, S>,
    assumed: &[f64],
    time: &mut Duration,
) -> Result<usize, Status> {
    let other = |problem: &_, start: &_| other_start(state, problem, start);
    previous.make_solver_at_rest(&state.inverse_mass, other).map_err(trouble)?;
    let PreviousStep { problem: before, solver, .. } = previous;
    let problem = step.contacts;
    let next = NextProblem { problem, previous: before.as_ref(), motionless: &state.motionless };
    if solver.has_matrix(&next) {
        return Ok(solver.active_rows());
    }
    let q = problem.q(step.free, step.offsets, assumed);
    let matrix = match next.previous.zip(solver.last_problem()) {
        Some(before) => problem.problem_after(before, &state.inverse_mass, q),
        None => problem.problem(&state.inverse_mass, q),
    };
    let matrix = matrix.map_err(trouble)?;
    let begun = Instant::now();
    if next.previous.is_none()
        && let Some(start) = start_from_interior(state, step, assumed)
        && solver.load_solved(matrix.clone(), &start).is_ok()
    {
        *time += begun.elapsed();
        return Ok(0);
    }
    let rows_reused = solver.load(&next, matrix).map_err(trouble);
    *time += begun.elapsed();
    rows_reused
}

fn try_sliding<S: Kinematics>(
    state: &State<S>,
    previous: &mut PreviousStep<S>,
    step: &StepProblem<'_, S>,
    assumed: &[f64],
    (time, effort): (&mut Duration, &mut usize),
) -> Result<Trial<S>, Unsolved> {
    let q = step.contacts.q(step.free, step.offsets, assumed);
    let begun = Instant::now();
    let before = previous.solver.counts().pivots;
    let status = previous.solver.solve(&q, *effort / q.len().max(1));
    *effort = effort.saturating_sub(q.len() * (previous.solver.counts().pivots - before));
    *time += begun.elapsed();
    match status.map_err(|error| Unsolved::Failed(trouble(error)))? {
        Some(Status::Solved) => {}
        Some(status) => return Err(Unsolved::Failed(status)),
        None => return Err(Unsolved::TooHard),
    }
    let solver = previous.solver.solver();
    let velocities = step.contacts.velocities(step.free, &state.inverse_mass, |row| solver.z(row));
    let (sliding, error) = step.coulomb_error(&velocities, assumed, |row| solver.z(row));
    Ok(Trial { velocities, sliding, error })
}

fn motion<S: Kinematics>(previous: &PreviousStep<S>, step: &StepProblem<'_, S>, trial: Trial<S>) -> Motion<S> {
    let solver = previous.solver.solver();
    let impulse = |k: usize| step.contacts.impulse(k, |row| solver.z(row));
    let Trial { velocities, sliding, error } = trial;
    Motion {
        velocities,
        sliding,
        impulses: (0..step.contacts.candidates().len()).map(impulse).collect(),
        friction_error: error,
        exact: false,
        unseen: 0.0,
        residual: solver.residual(),
        solves: 0,
        rows_reused: 0,
        time: Duration::ZERO,
        counts: Counts::default(),
        collisions: 0,
        inconsistent: None,
        unfinished: false,
    }
}

/// The matrix of a step is symmetric and semidefinite by its making; where it does not look so, accuracy is lost.
fn trouble(_: LcpError) -> Status {
    Status::NumericalTrouble
}
