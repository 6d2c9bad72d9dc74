//! Dantzig's principal pivoting on a masked problem: the object that keeps its factor between solves.
//!
//! Solves `w = M z + q`, `0 <= z` complementary to `w >= 0`, on the rows that are present, for symmetric positive
//! semidefinite `M`. A *major cycle* takes the most violated row i and drives `z_i` up until `w_i` is zero. On the way, a
//! *minor cycle* exchanges one pair whenever an active `z_j` or the `w_j` of a row considered before reaches
//! zero. With such an `M` a row enters only with a positive Schur complement, so single pivots suffice and the
//! active block `M_CC` stays nonsingular however singular `M` is.
//!
//! Cottle and Dantzig (1968); Baraff, Fast contact force computation for nonpenetrating rigid bodies (1994);
//! Loomis and Balkcom, Computation reuse for rigid-body dynamics (2006).

mod attempt;
mod blocks;
mod certify;
mod doubt;
mod drive;
mod follow;
mod settle;
mod snapshot;
mod state;

pub use follow::Origin;
pub use state::SolverState;

use crate::{
    basis::Basis,
    cone::Columns,
    counts::Counts,
    error::LcpError,
    factor::{self, ActiveFactor},
    matrix::SparseColumns,
    problem::Problem,
    ratio::Candidate,
    reuse::Start,
    scaling::Scaling,
    settings::Settings,
    solution::{Solution, Status},
};
use attempt::{Doubtful, REPAIRS, Repair, Zero};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What is known of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Role {
    /// Not part of the problem being solved.
    Absent,
    /// Present; never driven, so minor cycles do not guard it.
    Waiting,
    /// Considered: kept feasible from now on.
    Considered,
}

/// Dantzig's method as an object: rows of one complete problem come and go, `q` changes, states are rolled back to, and
/// [`Self::solve`] answers for the rows present, starting from what it had.
///
/// The answer is that of a fresh solve of the rows present (`w` is; `z` too where it is unique). Between two solves the
/// factor of the active block is moved by the rows that enter and leave it, never rebuilt.
///
/// Stopped on the way ([`crate::interrupt`]), it has the rows and the `q` from before the call, and the next solve begins
/// from nothing.
///
/// Everything inside is scaled to a unit diagonal; what goes in and comes out is in the caller's units.
///
/// ```
/// use drystone_lcp::{Problem, Settings, Solver, Status};
///
/// let problem = Problem::from_dense(&[2.0, 1.0, 1.0, 2.0], vec![-5.0, -6.0])?;
/// let mut solver = Solver::new(problem, Settings::default())?;
/// solver.add_rows(&[0, 1])?;
/// assert_eq!(solver.solve()?, Status::Solved);
/// solver.remove_rows(&[0])?;
/// solver.set_q_at(&[1], &[-4.0])?;
/// assert_eq!(solver.solve()?, Status::Solved);
/// assert!(solver.z(0) == 0.0 && (solver.z(1) - 2.0).abs() < 1e-12);
/// # Ok::<(), drystone_lcp::LcpError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Solver {
    problem: Problem,
    scaling: Scaling,
    /// Scaled to a unit diagonal. Snapshots hold it too, which tells them from those of other solvers.
    m: Arc<SparseColumns>,
    load: Arc<Load>,
    /// Largest scaled `q` of a present row.
    q_size: f64,
    settings: Settings,
    factor: Box<dyn ActiveFactor>,
    active: Basis,
    role: Vec<Role>,
    z: Vec<f64>,
    w: Vec<f64>,
    /// The row driven last: it may have `z > 0` without being active.
    driven: Option<usize>,
    /// Whether the state is complementary; a solve settles it first where it is not.
    settled: bool,
    dz: Vec<f64>,
    /// Where `dz` may differ from zero.
    moving: Vec<usize>,
    dw: Vec<f64>,
    /// Where `dw` may differ from zero.
    reached: Vec<usize>,
    is_reached: Vec<bool>,
    candidates: Vec<Candidate>,
    counts: Counts,
    counts_at_solve: Counts,
    residual: f64,
    ray: Option<Vec<f64>>,
    /// What counts as zero in the present attempt.
    zero: Zero,
    doubtful: Doubtful,
}

/// `q` in the caller's unit and scaled.
#[derive(Debug, Clone)]
struct Load {
    q: Vec<f64>,
    scaled: Vec<f64>,
}

/// A state of a [`Solver`] to return to: what is known of each row, `q`, and the active rows with their values.
#[derive(Debug, Clone)]
pub struct Snapshot {
    matrix: Arc<SparseColumns>,
    load: Arc<Load>,
    role: Vec<Role>,
    active: Vec<(usize, f64)>,
    settled: bool,
}

/// Numbers of pivots at which a solve ends.
#[derive(Debug, Clone, Copy)]
struct Ends {
    /// The caller wants no more.
    stop: usize,
    /// There is no answer, but for what can be proved without pivots.
    limit: usize,
}

impl Ends {
    fn at(limit: usize) -> Self {
        Self { stop: usize::MAX, limit }
    }
}

/// How a major cycle ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cycle {
    Feasible,
    Ray,
    Limit,
    LostAccuracy,
    /// The caller asked to stop.
    Stopped,
}

/// What a recomputation of `z` and `w` from the factor found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Checked {
    Solved,
    StillViolated,
    LostAccuracy,
}

/// Zero-length steps in one major cycle, as a multiple of the active rows, after which ties go by least index.
const STALL: usize = 2;
/// Active `w` at or below this, in the problem's own scale, are rounding: correcting for them would only add noise
/// along the nearly dependent rows of the active block.
const ROUNDING: f64 = 1e-13;
/// Times a solve may find new violations after recomputing `w` before the factor is built again.
const ROUNDS: usize = 20;
/// Residual of a direction on the active rows (unit diagonal, relative) above which it is refined once.
const REFINE: f64 = 1e-13;

impl Solver {
    /// Analyses the complete problem. No row is present yet.
    ///
    /// # Errors
    /// [`LcpError::NotSymmetric`], [`LcpError::NotSemidefinite`].
    pub fn new(problem: Problem, settings: Settings) -> Result<Self, LcpError> {
        problem.require_symmetric()?;
        let scaling = Scaling::new(&problem);
        let m = problem.m().scaled_symmetrically(&scaling.d);
        let factor = factor::choose(&m);
        Ok(Self::assembled(problem, scaling, m, factor, settings))
    }

    /// A solver of these parts without any row.
    fn assembled(
        problem: Problem,
        scaling: Scaling,
        m: SparseColumns,
        factor: Box<dyn ActiveFactor>,
        settings: Settings,
    ) -> Self {
        let scaled = scaling.d.iter().zip(problem.q()).map(|(d, q)| d * q).collect();
        let n = problem.len();
        Self {
            factor,
            active: Basis::new(n),
            role: vec![Role::Absent; n],
            z: vec![0.0; n],
            w: vec![0.0; n],
            driven: None,
            settled: true,
            dz: vec![0.0; n],
            moving: Vec::new(),
            dw: vec![0.0; n],
            reached: Vec::new(),
            is_reached: vec![false; n],
            candidates: Vec::new(),
            counts: Counts::default(),
            counts_at_solve: Counts::default(),
            residual: 0.0,
            ray: None,
            zero: Zero::of(&settings),
            doubtful: Doubtful::default(),
            m: Arc::new(m),
            load: Arc::new(Load { q: problem.q().to_vec(), scaled }),
            q_size: 0.0,
            problem,
            scaling,
            settings,
        }
    }

    /// The problem `M = G' W G`, `q = -G' W h` of generators; see [`Problem::from_generators`].
    ///
    /// # Errors
    /// As [`Problem::from_generators`] and [`Self::new`].
    pub fn from_generators(g: &Columns, inverse_mass: &[f64], h: &[f64], settings: Settings) -> Result<Self, LcpError> {
        Self::new(Problem::from_generators(g, inverse_mass, h)?, settings)
    }

    /// The complete problem, with the present `q`.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Work done since the solver was made.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Residual of the last solve, in the problem's own scale.
    pub fn residual(&self) -> f64 {
        self.residual
    }

    /// Rows that are present, ascending.
    pub fn rows(&self) -> Vec<usize> {
        (0..self.role.len()).filter(|&i| self.role[i] != Role::Absent).collect()
    }

    /// `z_i` of the last solve, in the caller's unit; zero for a row that is not present. After a change of rows or of
    /// `q` only the next solve says what it is.
    pub fn z(&self, i: usize) -> f64 {
        self.z[i] * self.scaling.d[i]
    }

    /// Number of active rows: those in the factor.
    pub fn active_rows(&self) -> usize {
        self.active.members().len()
    }

    /// Takes every row out. `q` stays, and work counts go on.
    pub fn clear(&mut self) {
        self.factor.clear();
        self.active.clear();
        self.role.fill(Role::Absent);
        self.z.fill(0.0);
        self.w.fill(0.0);
        self.driven = None;
        self.settled = true;
        self.q_size = 0.0;
    }

    /// Adds rows of the complete problem with `z = 0`; rows already present stay as they are.
    ///
    /// # Errors
    /// [`LcpError::RowOutOfRange`]; nothing has changed then.
    pub fn add_rows(&mut self, rows: &[usize]) -> Result<(), LcpError> {
        self.require_rows(rows)?;
        for &i in rows {
            if self.role[i] == Role::Absent {
                self.role[i] = Role::Waiting;
                self.w[i] = self.load.scaled[i] + self.m.column_dot(i, &self.z);
                self.q_size = self.q_size.max(self.load.scaled[i].abs());
            }
        }
        Ok(())
    }

    /// Takes rows out: their `z` becomes zero, and they leave the factor. The next solve starts from the active rows that
    /// remain. Rows that are not present stay so.
    ///
    /// # Errors
    /// [`LcpError::RowOutOfRange`]; nothing has changed then.
    pub fn remove_rows(&mut self, rows: &[usize]) -> Result<(), LcpError> {
        self.require_rows(rows)?;
        self.or_as_before(|solver| {
            for &i in rows {
                solver.role[i] = Role::Absent;
                // Without force nothing else feels that the row has gone.
                solver.settled &= solver.z[i] == 0.0;
                solver.leave(i);
            }
            solver.measure_q();
        });
        Ok(())
    }

    /// Replaces `q` (n) of the complete problem. The next solve starts from the active rows of the last one.
    ///
    /// # Errors
    /// [`LcpError::Shape`], [`LcpError::VectorNotFinite`]; nothing has changed then.
    pub fn set_q(&mut self, q: &[f64]) -> Result<(), LcpError> {
        let n = self.problem.len();
        if q.len() != n {
            return Err(LcpError::Shape { rows: n, columns: n, q: q.len() });
        }
        self.change_q(q.iter().copied().enumerate())
    }

    /// Replaces `q` on some rows, present or not; of a row given twice the last value counts.
    ///
    /// # Errors
    /// [`LcpError::RowOutOfRange`], [`LcpError::ValuesForRows`], [`LcpError::VectorNotFinite`]; nothing has changed
    /// then.
    pub fn set_q_at(&mut self, rows: &[usize], values: &[f64]) -> Result<(), LcpError> {
        self.require_rows(rows)?;
        if rows.len() != values.len() {
            return Err(LcpError::ValuesForRows { rows: rows.len(), values: values.len() });
        }
        self.change_q(rows.iter().copied().zip(values.iter().copied()))
    }

    fn change_q(&mut self, changes: impl Iterator<Item = (usize, f64)> + Clone) -> Result<(), LcpError> {
        if let Some((index, value)) = changes.clone().find(|(_, value)| !value.is_finite()) {
            return Err(LcpError::VectorNotFinite { index, value });
        }
        let load = Arc::make_mut(&mut self.load);
        for (i, value) in changes {
            self.settled &= load.q[i] == value || self.role[i] == Role::Absent;
            load.q[i] = value;
            load.scaled[i] = self.scaling.d[i] * value;
        }
        self.take_load(Arc::clone(&self.load));
        self.measure_q();
        Ok(())
    }

    fn require_rows(&self, rows: &[usize]) -> Result<(), LcpError> {
        let n = self.problem.len();
        rows.iter().find(|&&row| row >= n).map_or(Ok(()), |&row| Err(LcpError::RowOutOfRange { row, n }))
    }

    /// Replaces the state by the solution of a principal sub-problem (Theorem 1).
    ///
    /// # Errors
    /// [`LcpError::Start`] says why the start is refused; no row is present then.
    pub fn start_from(&mut self, start: &Start) -> Result<(), LcpError> {
        self.or_as_before(|solver| solver.take_start(start))
    }

    fn take_start(&mut self, start: &Start) -> Result<(), LcpError> {
        self.clear();
        start.require_well_formed(self.problem.len())?;
        for (&i, &z) in start.indices.iter().zip(&start.z) {
            self.role[i] = Role::Considered;
            self.z[i] = z / self.scaling.d[i];
        }
        self.measure_q();
        self.recompute_w();
        if let Err(error) = start.require_complementary(&self.z, &self.w, &self.scaling.d, self.q_size) {
            self.clear();
            return Err(error.into());
        }
        for &i in &start.indices {
            if self.z[i] > 0.0 {
                self.admit(i);
            }
        }
        self.recompute_w();
        Ok(())
    }

    /// Drives every violated row that is present to feasibility.
    ///
    /// # Errors
    /// [`LcpError::NotSemidefinite`] if a direction of negative curvature shows up.
    pub fn solve(&mut self) -> Result<Status, LcpError> {
        Ok(self.solve_while(&mut || true)?.expect("nobody stops it"))
    }

    /// The same, but asks before every major cycle whether to go on. None if not; the next solve goes on from there.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn solve_while(&mut self, go_on: &mut dyn FnMut() -> bool) -> Result<Option<Status>, LcpError> {
        self.answer(|solver, limit| solver.solve_present(Ends::at(limit), go_on))
    }

    /// The same with at most so many pivots. None if they do not suffice; the next solve goes on from there.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn solve_within(&mut self, pivots: usize) -> Result<Option<Status>, LcpError> {
        let stop = self.counts.pivots.saturating_add(pivots);
        self.answer(|solver, limit| solver.solve_present(Ends { stop, limit }, &mut || true))
    }

    /// Keeps the accounts of one solve; `method` is given the number of pivots at which it has to stop.
    fn answer<S: From<Status> + PartialEq>(
        &mut self,
        method: impl FnOnce(&mut Self, usize) -> Result<S, LcpError>,
    ) -> Result<S, LcpError> {
        self.counts_at_solve = self.counts;
        self.ray = None;
        let present = self.role.iter().filter(|&&role| role != Role::Absent).count();
        self.zero = Zero::of(&self.settings);
        self.doubtful = Doubtful::default();
        let limit = self.counts.pivots + self.settings.pivot_limit_for(present);
        let answer = self.or_as_before(|solver| method(solver, limit));
        // Without an answer the row driven last has both z > 0 and w < 0.
        self.settled &= answer.as_ref().is_ok_and(|status| *status == Status::Solved.into());
        answer
    }

    fn solve_present(&mut self, ends: Ends, go_on: &mut dyn FnMut() -> bool) -> Result<Option<Status>, LcpError> {
        let mut rounds = 0;
        let mut repairs = REPAIRS.iter();
        loop {
            let changed = !self.settled;
            if changed {
                self.settle();
            }
            let cycles = self.counts.major_cycles;
            let cycle = self.drive_all(ends, go_on)?;
            // Settling has computed w from z.
            let fresh = changed && cycles == self.counts.major_cycles;
            match cycle {
                Cycle::Feasible => match if fresh { self.check() } else { self.recompute() } {
                    Checked::Solved => match self.conclude(true) {
                        None => {
                            self.zero.beside_q = true;
                            continue;
                        }
                        answer => return Ok(answer),
                    },
                    Checked::StillViolated if rounds < ROUNDS => {
                        rounds += 1;
                        continue;
                    }
                    Checked::StillViolated | Checked::LostAccuracy => rounds = 0,
                },
                Cycle::Ray => return Ok(Some(Status::NoSolution)),
                Cycle::Stopped => return Ok(None),
                Cycle::Limit | Cycle::LostAccuracy => {}
            }
            self.settled = false;
            if let Some(status) = self.late_answer() {
                return Ok(Some(status));
            }
            if cycle == Cycle::Limit {
                return self.beyond_the_limit().map(Some);
            }
            let Some(repair) = repairs.next() else { return self.last_resort().map(Some) };
            if matches!(repair, Repair::Finer) && self.certify_in_null_space()? {
                return Ok(Some(Status::NoSolution));
            }
            self.repair(*repair);
        }
    }

    /// The pair of the last solve, in the caller's units. Rows that are not present have `z = 0`, and as `w` what would be
    /// theirs.
    pub fn solution(&self, status: Status) -> Solution {
        let z: Vec<f64> = (0..self.z.len()).map(|i| self.z(i)).collect();
        Solution {
            w: self.problem.w(&z),
            status,
            residual: self.residual,
            ray: self.ray.clone(),
            counts: self.counts - self.counts_at_solve,
            z,
        }
    }
}

/// `z - change`, and zero where the difference is rounding: it must not be the largest number of a problem with q = 0.
fn take(z: f64, change: f64) -> f64 {
    let rest = z - change;
    if rest > ROUNDING * z { rest } else { 0.0 }
}

fn largest(x: &[f64], members: &[usize]) -> f64 {
    members.iter().fold(0.0, |size, &i| size.max(x[i].abs()))
}
