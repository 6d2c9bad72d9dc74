//! Steps of a world at rest without a solve: impulses that keep everything where it is, if there are any.
//!
//! Bodies at rest stay so if impulses along the closed contacts take up what would move them,
//!
//! ```text
//! G p = -M v*,    p >= 0,
//! ```
//!
//! and then w = A p + q is zero on their rows and nowhere negative: the problem of `contact_problem.rs` is solved, and A was never
//! made. To decide this takes far less than that problem (docs/theory/equilibrium.md), for G is sparser than A. The next step
//! that differs solves from there (Theorem 1). Where something falls at once this tells nothing.

use super::{
    previous_step::{PreviousStep, RestSolution},
    step_problem::{Motion, StepProblem},
};
use crate::{
    geometry::product,
    scene::SceneOf,
    simulate::{
        formulate::contact_problem::ContactProblem,
        kinematics::{Kinematics, axes, components, masses},
        motionless::motionless_bodies,
        options::Reuse,
        state::State,
    },
};
use drystone_lcp::{
    Counts, LcpError, Settings, Start,
    cone::{ConeSolver, Membership},
    interior::{End, Gauss, worth_of_pivots},
};
use std::time::Instant;

/// Impulses of the rows that bear where all bodies can stay where they are, and the work it took to find out.
struct Decision {
    start: Option<Start>,
    work: Counts,
}

/// Solves a step in which all bodies, at rest so far, stay so. None if they do not, if that is not taken over, or if
/// there is a step before. `work` is what it took either way.
pub fn stay_at_rest<S: Kinematics>(
    state: &State<S>,
    previous: &mut PreviousStep<S>,
    step: &StepProblem<'_, S>,
    work: &mut Counts,
) -> Option<Motion<S>> {
    if state.options.reuse != Reuse::Full || previous.problem.is_some() || !state.is_at_rest() {
        return None;
    }
    let begun = Instant::now();
    let contacts = step.contacts;
    let decision = impulses_at_rest(&state.scene, contacts, (step.free, step.offsets), &state.inverse_mass).ok()?;
    *work = *work + decision.work;
    let start = decision.start?;
    let mut p = vec![0.0; contacts.len()];
    start.indices.iter().zip(&start.z).for_each(|(&row, &z)| p[row] = z);
    let velocities = contacts.velocities(step.free, &state.inverse_mass, |row| p[row]);
    let residual = residual(state, step, &velocities, &p);
    // Beside large impulses a residual that may stand could still move a small body.
    let still = motionless_bodies(&state.scene, &velocities, state.options.dt);
    if residual > Settings::default().residual || still.contains(&false) {
        return None;
    }
    let none = vec![0.0; contacts.candidates().len()];
    let (_, friction_error) = step.coulomb_error(&velocities, &none, |row| p[row]);
    let q = contacts.q(step.free, step.offsets, &none);
    previous.at_rest = Some(RestSolution { start, q });
    Some(Motion {
        velocities,
        sliding: none,
        impulses: (0..contacts.candidates().len()).map(|k| contacts.impulse(k, |row| p[row])).collect(),
        friction_error,
        exact: true,
        residual,
        solves: 1,
        rows_reused: 0,
        time: begun.elapsed(),
        counts: *work,
        collisions: 0,
        inconsistent: None,
    })
}

/// A start of the step's problem from nothing: the rows that bear in the answer of the interior-point method, with their
/// impulses. None where that has no answer, or for so few rows that pivots are sooner there.
pub fn start_from_interior<S: Kinematics>(
    state: &State<S>,
    step: &StepProblem<'_, S>,
    assumed: &[f64],
) -> Option<Start> {
    if step.contacts.len() <= FEW {
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

/// Most rows of a first step for which pivots from nothing are as good.
const FEW: usize = 200;

/// A contact that could close at this share of the speed that a step gives to free bodies, or less, is closed: rounding of
/// the corners of blocks whose faces are not along the axes. A tenth of what the residual of a solution may be.
const NEGLIGIBLE: f64 = 1e-10;

/// Looks for impulses that keep all bodies where they are. `free` are their velocities without contacts, `inverse_mass` is the
/// diagonal of M^-1, zero for fixed bodies.
///
/// # Errors
/// [`LcpError`] for numbers that are not finite.
fn impulses_at_rest<S: Kinematics>(
    scene: &SceneOf<S>,
    contacts: &ContactProblem<S>,
    (free, offsets): (&[S::Velocity], &[f64]),
    inverse_mass: &[S::Velocity],
) -> Result<Decision, LcpError> {
    let candidates = contacts.candidates().iter().enumerate();
    let fastest = fastest::<S>(free);
    let is_closed = |offset: f64| offset <= NEGLIGIBLE * fastest;
    let closed: Vec<usize> = candidates.filter(|(k, _)| is_closed(offsets[*k])).map(|(k, _)| k).collect();
    let rows: Vec<usize> = closed.iter().flat_map(|&k| contacts.rows(k)).collect();
    let (loads, units) = loads(scene, free);
    let fresh = || {
        let mut solver = ConeSolver::new(contacts.generators(rows.iter().copied(), inverse_mass)?, &loads, &units)?;
        solver.only_in_64_bits();
        Ok::<_, LcpError>(solver)
    };
    let (mut solver, size, bodies) = (fresh()?, components::<S>(), upward(scene));
    solver.limit_effort(worth_of_pivots(size, bodies.len()));
    for &body in &bodies {
        solver.add_rows(&(size * body..size * (body + 1)).collect::<Vec<_>>());
        solver.decide();
    }
    let mut found = solver.solve();
    let (mut work, mut inner) = (solver.counts(), None);
    if found == Membership::PivotLimit && solver.is_exhausted() {
        solver = fresh()?;
        inner = by_interior_point(contacts, &closed, (&loads, inverse_mass), &bodies);
        if let Some((problem, forces)) = &inner {
            found = from_interior(problem, forces, &bodies, &mut solver);
            work = work + solver.counts();
        }
    }
    let bearing = |(column, &row): (usize, &usize)| match (&inner, found) {
        (_, Membership::Inside) => (row, solver.f(column)),
        (Some((_, forces)), _) => (row, forces[column]),
        (None, _) => (row, 0.0),
    };
    let stands = found == Membership::Inside || inner.is_some();
    let (indices, z) = rows.iter().enumerate().map(bearing).filter(|(_, p)| *p > 0.0).unzip();
    Ok(Decision { start: stands.then_some(Start { indices, z }), work })
}

/// Impulses by the interior-point method, one for each row of the closed contacts, with the problem that they solve. None where it
/// finds that something moves.
fn by_interior_point<S: Kinematics>(
    contacts: &ContactProblem<S>,
    closed: &[usize],
    (loads, inverse_mass): (&[f64], &[S::Velocity]),
    bodies: &[usize],
) -> Option<(Gauss, Vec<f64>)> {
    let problem = contacts.gauss(closed, (loads, inverse_mass), bodies);
    let found = problem.solve();
    (found.end == End::AtRest).then_some((problem, found.forces))
}

/// What a solver says from the basis to which the interior-point method leads: fewer rows bear then, and do not depend on one
/// another, so that later steps can begin from them. Where the pivots that remain are many it gives up.
fn from_interior(problem: &Gauss, forces: &[f64], bodies: &[usize], solver: &mut ConeSolver) -> Membership {
    let Some(basis) = problem.basis(forces, |_| false) else { return Membership::PivotLimit };
    for &body in bodies {
        solver.add_group(&(problem.size * body..problem.size * (body + 1)).collect::<Vec<_>>());
    }
    solver.start_from(basis);
    solver.limit_effort(solver.effort() + worth_of_pivots(problem.size, bodies.len()));
    solver.solve()
}

/// The largest component of some velocities.
fn fastest<S: Kinematics>(velocities: &[S::Velocity]) -> f64 {
    velocities.iter().flat_map(|v| v.as_ref()).fold(0.0, |most: f64, v| v.abs().max(most))
}

/// The movable bodies by height.
fn upward<S: Kinematics>(scene: &SceneOf<S>) -> Vec<usize> {
    let (bodies, gravity) = (scene.bodies(), scene.gravity());
    let depth = |i: usize| product(&gravity, &S::place(&bodies[i].pose));
    let mut order: Vec<usize> = (0..bodies.len()).filter(|&i| !bodies[i].fixed).collect();
    order.sort_by(|&a, &b| depth(b).total_cmp(&depth(a)));
    order
}

/// `-M v*`, and the unit in which each entry's imbalance is measured: what gives the body the largest speed of all, at its
/// centre of mass or at its radius of gyration.
fn loads<S: Kinematics>(scene: &SceneOf<S>, free: &[S::Velocity]) -> (Vec<f64>, Vec<f64>) {
    let fastest = fastest::<S>(free);
    let speed = if fastest > 0.0 { fastest } else { 1.0 };
    let (mut loads, mut units) = (Vec::new(), Vec::new());
    for (body, free) in scene.bodies().iter().zip(free) {
        let masses = masses(body);
        for (axis, (mass, velocity)) in masses.as_ref().iter().zip(free.as_ref()).enumerate() {
            let of_unit = if axis < axes::<S>() { *mass } else { (mass * body.mass()).sqrt() };
            loads.push(-mass * velocity);
            units.push(of_unit * speed);
        }
    }
    (loads, units)
}
