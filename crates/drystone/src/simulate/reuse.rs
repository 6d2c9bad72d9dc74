//! What one solve takes over from those before it: nothing, the motionless part, or all that has not moved.

use super::{moving::Moving, velocity_level::VelocityLevel};
use crate::contact::approach::ApproachOf;
use drystone_lcp::{Counts, LcpError, Problem, Settings, Solver, SolverState, Start, Status};
use serde::{Deserialize, Serialize};

/// How much of the computation a step takes over from the step before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Reuse {
    /// Nothing: every solve from scratch.
    None,
    /// Loomis and Balkcom's: when the motionless set changes, its own problem is solved from scratch; every full solve
    /// starts from that solution (Theorem 1).
    Motionless,
    /// Everything that did not move: forces, active set and factor rows; contact geometry too.
    Full,
}

impl Reuse {
    /// As users of other languages write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Motionless => "motionless",
            Self::Full => "full",
        }
    }

    pub(super) fn route<S: Moving>(self) -> Box<dyn Route<S>> {
        match self {
            Self::None => Box::new(FromScratch::default()),
            Self::Motionless => Box::new(FromMotionless::<S>::default()),
            Self::Full => Box::new(FromLast::default()),
        }
    }
}

/// What a route is given of a step, besides the problem.
pub(super) struct Situation<'a, S: Moving> {
    pub problem: &'a VelocityLevel<S>,
    /// The approaches of the step before, if this route has solved it.
    pub before: Option<&'a VelocityLevel<S>>,
    /// Bodies that did not move in the step before, fixed ones included.
    pub motionless: &'a [bool],
}

/// A way to the solution of a step's problem. The answer is the same by all of them.
pub(super) trait Route<S: Moving>: std::fmt::Debug + Send + Sync {
    /// Whether the problem is that of the step before but for q, so that its matrix need not be made.
    fn has_matrix(&self, _situation: &Situation<'_, S>) -> bool {
        false
    }

    /// The problem of the step before, if the matrix of this one is to be made from it.
    fn last(&self) -> Option<&Problem> {
        None
    }

    /// Takes the matrix of a step. Returns how many rows of the active block came with their factor.
    fn begin(&mut self, situation: &Situation<'_, S>, matrix: Problem) -> Result<usize, LcpError>;

    /// Takes the matrix of the step before, which was solved without a solver.
    fn begin_from(&mut self, matrix: Problem, solved: &Start) -> Result<(), LcpError> {
        let rows = all_rows(matrix.len());
        let solver = self.held_mut().take(matrix)?;
        solver.start_from(solved)?;
        solver.add_rows(&rows)
    }

    /// Solves it for this q.
    fn solve(&mut self, q: &[f64]) -> Result<Status, LcpError>;

    /// The solver that it works with.
    fn held(&self) -> &Held;

    /// The same, to change it.
    fn held_mut(&mut self) -> &mut Held;

    /// The solver with the solution, after a solve.
    fn solver(&self) -> &Solver {
        self.held().solver.as_ref().expect(SOLVED)
    }

    /// Rows that bear; none without a solver.
    fn active_rows(&self) -> usize {
        self.held().solver.as_ref().map_or(0, Solver::active_rows)
    }

    /// All work so far.
    fn counts(&self) -> Counts {
        self.held().counts()
    }

    /// Forgets what it took over.
    fn forget(&mut self) {
        self.held_mut().forget();
    }

    /// Forgets what it took over, and is content with the solver's own tolerances until it forgets again.
    fn restart(&mut self) {
        self.forget();
        self.held_mut().relaxed = true;
    }

    /// What it keeps, to be written down after a step.
    fn kept(&self) -> Kept<ApproachOf<S>>;

    /// Takes up what was written down. `matrix` makes the problem of the step before from its q.
    fn take_up(
        &mut self,
        kept: &Kept<ApproachOf<S>>,
        matrix: &dyn Fn(Vec<f64>) -> Result<Problem, LcpError>,
    ) -> Result<(), LcpError>;
}

/// What a route keeps between two steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Kept<A> {
    /// Of the motionless route: rows of the motionless part, their q and z.
    motionless: Option<Part<A>>,
    /// Of the full route: q and the solver's state.
    last: Option<(Vec<f64>, SolverState)>,
    relaxed: bool,
}

const SOLVED: &str = "a problem is taken before it is solved";

/// A tighter bound on violated rows than the solver's own 1e-11: what is left of a violation moves a body that should stand still.
/// In the largest scenes tried (6,000 rows) rounding leaves 2e-14.
const FEASIBLE: f64 = 1e-13;

fn settings(relaxed: bool) -> Settings {
    let own = Settings::default();
    if relaxed { own } else { Settings { feasibility: FEASIBLE, ..own } }
}

fn all_rows(n: usize) -> Vec<usize> {
    (0..n).collect()
}

/// A route's solver, the work of those it had before, and whether it is content with the solver's own tolerances.
#[derive(Debug, Default)]
pub(super) struct Held {
    solver: Option<Solver>,
    spent: Counts,
    relaxed: bool,
}

impl Held {
    /// A new solver for this problem; no row is present.
    fn take(&mut self, matrix: Problem) -> Result<&mut Solver, LcpError> {
        let solver = Solver::new(matrix, settings(self.relaxed))?;
        self.spent = self.counts();
        Ok(self.solver.insert(solver))
    }

    fn solver_mut(&mut self) -> &mut Solver {
        self.solver.as_mut().expect(SOLVED)
    }

    fn counts(&self) -> Counts {
        self.spent + self.solver.as_ref().map(Solver::counts).unwrap_or_default()
    }

    fn forget(&mut self) {
        self.spent = self.counts();
        (self.solver, self.relaxed) = (None, false);
    }
}

#[derive(Debug, Default)]
struct FromScratch {
    held: Held,
}

impl<S: Moving> Route<S> for FromScratch {
    fn held(&self) -> &Held {
        &self.held
    }

    fn held_mut(&mut self) -> &mut Held {
        &mut self.held
    }

    fn begin(&mut self, _: &Situation<'_, S>, matrix: Problem) -> Result<usize, LcpError> {
        self.held.take(matrix)?;
        Ok(0)
    }

    fn solve(&mut self, q: &[f64]) -> Result<Status, LcpError> {
        let solver = self.held.solver_mut();
        solver.clear();
        solver.set_q(q)?;
        solver.add_rows(&all_rows(q.len()))?;
        solver.solve()
    }

    fn kept(&self) -> Kept<ApproachOf<S>> {
        Kept { motionless: None, last: None, relaxed: self.held.relaxed }
    }

    fn take_up(
        &mut self,
        kept: &Kept<ApproachOf<S>>,
        _: &dyn Fn(Vec<f64>) -> Result<Problem, LcpError>,
    ) -> Result<(), LcpError> {
        self.held.forget();
        self.held.relaxed = kept.relaxed;
        Ok(())
    }
}

/// The motionless part of a step's problem with its solution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Part<A> {
    /// Approaches between motionless and fixed bodies, to tell whether it is still the same part.
    approaches: Vec<A>,
    q: Vec<f64>,
    z: Vec<f64>,
}

#[derive(Debug)]
struct FromMotionless<S: Moving> {
    full: FromScratch,
    part: Option<Part<ApproachOf<S>>>,
    rows: Vec<usize>,
}

impl<S: Moving> Default for FromMotionless<S> {
    fn default() -> Self {
        Self { full: FromScratch::default(), part: None, rows: Vec::new() }
    }
}

impl<S: Moving> FromMotionless<S> {
    /// Solves the motionless part alone unless that has been done.
    fn solve_part(&mut self, situation: &Situation<'_, S>, problem: &Problem) -> Result<(), LcpError> {
        let still = |&k: &usize| {
            let bodies = situation.problem.approaches()[k].id.bodies;
            bodies.iter().all(|&body| situation.motionless[body])
        };
        let part: Vec<usize> = (0..situation.problem.approaches().len()).filter(still).collect();
        self.rows = part.iter().flat_map(|&k| situation.problem.rows(k)).collect();
        let approaches: Vec<_> = part.iter().map(|&k| situation.problem.approaches()[k]).collect();
        let q: Vec<f64> = self.rows.iter().map(|&row| problem.q()[row]).collect();
        let known = |part: &Part<ApproachOf<S>>| {
            let same = part.approaches.iter().zip(&approaches).all(|(old, new)| old.same_geometry(new));
            same && part.approaches.len() == approaches.len() && part.q == q
        };
        if self.part.as_ref().is_some_and(known) {
            return Ok(());
        }
        let mut solver = Solver::new(problem.principal(&self.rows), settings(self.full.held.relaxed))?;
        solver.add_rows(&all_rows(self.rows.len()))?;
        let status = solver.solve()?;
        self.full.held.spent = self.full.held.spent + solver.counts();
        let z = (0..self.rows.len()).map(|row| solver.z(row)).collect();
        self.part = (status == Status::Solved).then_some(Part { approaches, q, z });
        Ok(())
    }
}

impl<S: Moving> Route<S> for FromMotionless<S> {
    fn held(&self) -> &Held {
        &self.full.held
    }

    fn held_mut(&mut self) -> &mut Held {
        &mut self.full.held
    }

    fn begin(&mut self, situation: &Situation<'_, S>, matrix: Problem) -> Result<usize, LcpError> {
        self.solve_part(situation, &matrix)?;
        Route::<S>::begin(&mut self.full, situation, matrix)
    }

    fn solve(&mut self, q: &[f64]) -> Result<Status, LcpError> {
        let Some(part) = &self.part else { return Route::<S>::solve(&mut self.full, q) };
        let solver = self.full.held.solver_mut();
        solver.clear();
        solver.set_q(q)?;
        let start = Start { indices: self.rows.clone(), z: part.z.clone() };
        match solver.start_from(&start) {
            Ok(()) => {
                solver.add_rows(&all_rows(q.len()))?;
                solver.solve()
            }
            // The part's q has changed since: sliding speeds are corrected on the way.
            Err(LcpError::Start(_)) => Route::<S>::solve(&mut self.full, q),
            Err(error) => Err(error),
        }
    }

    fn forget(&mut self) {
        self.full.held.forget();
        self.part = None;
    }

    fn kept(&self) -> Kept<ApproachOf<S>> {
        Kept { motionless: self.part.clone(), last: None, relaxed: self.full.held.relaxed }
    }

    fn take_up(
        &mut self,
        kept: &Kept<ApproachOf<S>>,
        _: &dyn Fn(Vec<f64>) -> Result<Problem, LcpError>,
    ) -> Result<(), LcpError> {
        self.forget();
        self.part.clone_from(&kept.motionless);
        self.full.held.relaxed = kept.relaxed;
        Ok(())
    }
}

#[derive(Debug, Default)]
struct FromLast {
    held: Held,
}

impl<S: Moving> Route<S> for FromLast {
    fn held(&self) -> &Held {
        &self.held
    }

    fn held_mut(&mut self) -> &mut Held {
        &mut self.held
    }

    fn has_matrix(&self, situation: &Situation<'_, S>) -> bool {
        let same = |before: &VelocityLevel<S>| {
            let pairs = before.approaches().iter().zip(situation.problem.approaches());
            before.len() == situation.problem.len() && pairs.into_iter().all(|(old, new)| old.same_geometry(new))
        };
        self.held.solver.is_some() && situation.before.is_some_and(same)
    }

    fn last(&self) -> Option<&Problem> {
        self.held.solver.as_ref().map(Solver::problem)
    }

    fn begin(&mut self, situation: &Situation<'_, S>, matrix: Problem) -> Result<usize, LcpError> {
        let rows = all_rows(matrix.len());
        let (Some(before), Some(solver)) = (situation.before, self.held.solver.as_mut()) else {
            let solver = self.held.take(matrix)?;
            solver.add_rows(&rows)?;
            return Ok(0);
        };
        let kept = solver.follow(matrix, &situation.problem.origins(before))?;
        solver.add_rows(&rows)?;
        Ok(kept)
    }

    fn solve(&mut self, q: &[f64]) -> Result<Status, LcpError> {
        let solver = self.held.solver_mut();
        if solver.problem().q() != q {
            solver.set_q(q)?;
        }
        solver.solve()
    }

    fn kept(&self) -> Kept<ApproachOf<S>> {
        let last = self.held.solver.as_ref().map(|solver| (solver.problem().q().to_vec(), solver.state()));
        Kept { motionless: None, last, relaxed: self.held.relaxed }
    }

    fn take_up(
        &mut self,
        kept: &Kept<ApproachOf<S>>,
        matrix: &dyn Fn(Vec<f64>) -> Result<Problem, LcpError>,
    ) -> Result<(), LcpError> {
        self.held.forget();
        self.held.relaxed = kept.relaxed;
        if let Some((q, state)) = &kept.last {
            self.held.solver = Some(Solver::from_state(matrix(q.clone())?, settings(self.held.relaxed), state)?);
        }
        Ok(())
    }
}
