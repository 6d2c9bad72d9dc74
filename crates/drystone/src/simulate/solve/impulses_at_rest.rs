//! Impulses that keep all bodies where they are, in the way of [`check`](crate::check::check_blocks_while): straight across the joints
//! (docs/theory/load-takedown.md), by pivots as long as these are no slower, by the interior-point method.

use crate::{
    geometry::{norm, product},
    ladder::Ladder,
    scene::SceneOf,
    simulate::{
        formulate::contact_problem::{ContactProblem, wrench},
        kinematics::{Kinematics, axes, components, masses},
        state::State,
    },
    takedown::{Stack, Takedown, Touching},
};
use drystone_lcp::{
    Counts, LcpError, Start,
    cone::{ConeSolver, Membership},
    interior::{End, Gauss},
};

/// A contact that could close at this share of the speed that a step gives to free bodies, or less, is closed: rounding of
/// the corners of blocks whose faces are not along the axes. A tenth of what the residual of a solution may be.
const NEGLIGIBLE: f64 = 1e-10;

/// Impulses of the rows that bear where all bodies can stay where they are, and the work it took to find out.
pub struct Decision {
    pub start: Option<Start>,
    pub work: Counts,
}

/// What has to keep all bodies where they are.
pub struct AtRest<'a, S: Kinematics> {
    state: &'a State<S>,
    contacts: &'a ContactProblem<S>,
    /// Contacts that are closed, and their rows.
    closed: Vec<usize>,
    rows: Vec<usize>,
    /// `-M v*` of every body, and the units of these.
    loads: Vec<f64>,
    units: Vec<f64>,
    /// Those that can move, from the supports upward.
    bodies: Vec<usize>,
}

impl<'a, S: Kinematics> AtRest<'a, S> {
    /// `free` are the bodies' velocities without contacts.
    pub fn new(
        state: &'a State<S>,
        contacts: &'a ContactProblem<S>,
        (free, offsets): (&[S::Velocity], &[f64]),
    ) -> Self {
        let fastest = fastest::<S>(free);
        let closed: Vec<usize> = (0..offsets.len()).filter(|&k| offsets[k] <= NEGLIGIBLE * fastest).collect();
        let rows = closed.iter().flat_map(|&k| contacts.rows(k)).collect();
        let (loads, units) = loads(&state.scene, free);
        Self { state, contacts, closed, rows, loads, units, bodies: upward(&state.scene) }
    }

    /// Looks for such impulses.
    ///
    /// # Errors
    /// [`LcpError`] for numbers that are not finite.
    pub fn decide(&self) -> Result<Decision, LcpError> {
        let ladder = Ladder::new(components::<S>(), self.bodies.len());
        let mut work = Counts::default();
        if let Some(start) = self.straight() {
            return Ok(Decision { start: Some(start), work });
        }
        if ladder.pivots_next() {
            let (found, solver) = self.by_pivots(ladder.effort_from_nothing())?;
            work = solver.counts();
            if found != Membership::PivotLimit || !solver.is_exhausted() {
                let start = (found == Membership::Inside).then(|| self.start(|column| solver.f(column)));
                return Ok(Decision { start, work });
            }
        }
        let Some((problem, forces)) = self.by_interior_point() else { return Ok(Decision { start: None, work }) };
        let mut solver = self.solver()?;
        let start = match from_interior(&problem, &forces, &self.bodies, &mut solver) {
            Membership::Inside => self.start(|column| solver.f(column)),
            _ => self.start(|column| forces[column]),
        };
        Ok(Decision { start: Some(start), work: work + solver.counts() })
    }

    /// Puts the bodies up one by one; [`Membership::PivotLimit`] beyond an effort.
    fn by_pivots(&self, most: usize) -> Result<(Membership, ConeSolver), LcpError> {
        let (size, mut solver) = (components::<S>(), self.solver()?);
        solver.limit_effort(most);
        for &body in &self.bodies {
            solver.add_rows(&(size * body..size * (body + 1)).collect::<Vec<_>>());
            solver.decide();
        }
        Ok((solver.solve(), solver))
    }

    /// Such impulses on rows that do not depend on one another, by the interior-point method. None if it leads to none.
    pub fn on_a_basis(&self) -> Option<Start> {
        let (problem, forces) = self.by_interior_point()?;
        let mut solver = self.solver().ok()?;
        let found = from_interior(&problem, &forces, &self.bodies, &mut solver);
        (found == Membership::Inside).then(|| self.start(|column| solver.f(column)))
    }

    /// A solver without rows.
    fn solver(&self) -> Result<ConeSolver, LcpError> {
        let columns = self.contacts.generators(self.rows.iter().copied(), &self.state.inverse_mass)?;
        let mut solver = ConeSolver::new(columns, &self.loads, &self.units)?;
        solver.only_in_64_bits();
        Ok(solver)
    }

    /// The rows that bear, by the impulse of each column of [`Self::solver`].
    fn start(&self, impulse: impl Fn(usize) -> f64) -> Start {
        let impulses = self.rows.iter().enumerate().map(|(column, &row)| (row, impulse(column)));
        let (indices, z) = impulses.filter(|(_, p)| *p > 0.0).unzip();
        Start { indices, z }
    }

    /// Impulses by the interior-point method, one for each row, with the problem that they solve. None where it finds that
    /// something moves.
    fn by_interior_point(&self) -> Option<(Gauss, Vec<f64>)> {
        let problem = self.contacts.gauss(&self.closed, (&self.loads, &self.state.inverse_mass), &self.bodies);
        let found = problem.solve();
        (found.end == End::AtRest).then_some((problem, found.forces))
    }

    /// Impulses straight across the joints, if every body bears by these. Each is shared out evenly among the edges of its cone, so that
    /// the rows that bear depend on one another.
    fn straight(&self) -> Option<Start> {
        let along = Takedown::normal_forces(&self.stack())?;
        let mut p = vec![0.0; self.contacts.len()];
        for (&k, along) in self.closed.iter().zip(along) {
            let rows = self.contacts.rows(k);
            let share = self.contacts.friction(k).hypot(1.0) / rows.len() as f64;
            p[rows].fill(along * share);
        }
        Some(self.start(|column| p[self.rows[column]]))
    }

    fn stack(&self) -> Stack {
        let size = components::<S>();
        let packed = |values: &[f64]| {
            let mut all = [0.0; 6];
            all[..size].copy_from_slice(values);
            all
        };
        let gravity = self.state.scene.gravity();
        let mut place = vec![None; self.state.inverse_mass.len()];
        self.bodies.iter().enumerate().for_each(|(k, &body)| place[body] = Some(k));
        let touching = |&k: &usize| {
            let candidate = &self.contacts.candidates()[k];
            let pushed = |side: usize, sign| wrench::<S>(&candidate.levers[side], &candidate.normal, sign);
            Touching {
                blocks: candidate.id.bodies.map(|body| place[body]),
                wrenches: [pushed(0, -1.0), pushed(1, 1.0)].map(|pushed| packed(pushed.as_ref())),
                rise: -product(&candidate.normal, &gravity) / norm(gravity.as_ref()),
            }
        };
        let of = |body: usize| size * body..size * (body + 1);
        Stack {
            size,
            upward: (0..self.bodies.len()).collect(),
            loads: self.bodies.iter().map(|&body| packed(&self.loads[of(body)]).map(|load| -load)).collect(),
            units: self.bodies.iter().map(|&body| packed(&self.units[of(body)])).collect(),
            touching: self.closed.iter().map(touching).collect(),
        }
    }
}

/// What a solver says from the basis to which the interior-point method leads: fewer rows bear then, and do not depend on one
/// another, so that later steps can begin from them. Where its factor, or the pivots that remain, take long it gives up.
fn from_interior(problem: &Gauss, forces: &[f64], bodies: &[usize], solver: &mut ConeSolver) -> Membership {
    let Some(basis) = problem.basis(forces, |_| false) else { return Membership::PivotLimit };
    for &body in bodies {
        solver.add_group(&(problem.size * body..problem.size * (body + 1)).collect::<Vec<_>>());
    }
    solver.limit_effort(solver.effort() + Ladder::new(problem.size, bodies.len()).effort_of_interior_point());
    solver.start_from(basis);
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
pub fn loads<S: Kinematics>(scene: &SceneOf<S>, free: &[S::Velocity]) -> (Vec<f64>, Vec<f64>) {
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
