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

use crate::{
    basis::Basis,
    counts::Counts,
    error::LcpError,
    factor::{self, ActiveFactor},
    matrix::SparseColumns,
    problem::Problem,
    ratio::{Blocker, Candidate, TieRule, ratio_test},
    reuse::{Start, StartError},
    scaling::Scaling,
    settings::Settings,
    solution::{Solution, Status},
};

/// What is known of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// Not part of the problem being solved.
    Absent,
    /// Present; never driven, so minor cycles do not guard it.
    Waiting,
    /// Considered: kept feasible from now on.
    Considered,
}

/// Dantzig's method as an object: rows of one complete problem are added, solved, and rolled back to.
///
/// Everything inside is scaled to a unit diagonal; what goes in and comes out is in the caller's units.
#[derive(Debug)]
pub struct Solver {
    problem: Problem,
    scaling: Scaling,
    m: SparseColumns,
    q: Vec<f64>,
    settings: Settings,
    factor: Box<dyn ActiveFactor>,
    active: Basis,
    role: Vec<Role>,
    z: Vec<f64>,
    w: Vec<f64>,
    dz: Vec<f64>,
    dw: Vec<f64>,
    candidates: Vec<Candidate>,
    counts: Counts,
    counts_at_solve: Counts,
    residual: f64,
    ray: Option<Vec<f64>>,
}

/// A solved state to return to: what is known of each row, and the active rows with their values.
#[derive(Debug, Clone)]
pub struct Snapshot {
    role: Vec<Role>,
    active: Vec<(usize, f64)>,
}

/// How a major cycle ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cycle {
    Feasible,
    Ray,
    Limit,
    LostAccuracy,
}

/// What a recomputation of `z` and `w` from the factor found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Checked {
    Solved,
    StillViolated,
    LostAccuracy,
}

/// A pair with both sides above this, in the problem's own scale, is not complementary (validity of a start).
const START_TOLERANCE: f64 = 1e-9;
/// Zero-length steps in one major cycle, as a multiple of the active rows, after which ties go by least index.
const STALL: usize = 2;
/// Active `w` at or below this, in the problem's own scale, are rounding: correcting for them would only add noise
/// along the nearly dependent rows of the active block.
const ROUNDING: f64 = 1e-13;
/// Rounding of a curvature relative to the square of the direction's size: some fifty units in the last place.
const CURVATURE_ROUNDING: f64 = 1e-14;
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
        let q = scaling.d.iter().zip(problem.q()).map(|(d, q)| d * q).collect();
        let n = problem.len();
        Ok(Self {
            factor: factor::choose(&m),
            active: Basis::new(n),
            role: vec![Role::Absent; n],
            z: vec![0.0; n],
            w: vec![0.0; n],
            dz: vec![0.0; n],
            dw: vec![0.0; n],
            candidates: Vec::new(),
            counts: Counts::default(),
            counts_at_solve: Counts::default(),
            residual: 0.0,
            ray: None,
            problem,
            scaling,
            m,
            q,
            settings,
        })
    }

    /// The complete problem.
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

    /// `z_i` of a row, in the caller's unit; zero for a row that is not present.
    pub fn z(&self, i: usize) -> f64 {
        self.z[i] * self.scaling.d[i]
    }

    /// Takes every row out. Work counts go on.
    pub fn clear(&mut self) {
        self.factor.clear();
        self.active.clear();
        self.role.fill(Role::Absent);
        self.z.fill(0.0);
        self.w.fill(0.0);
    }

    /// Adds rows of the complete problem with `z = 0`; rows already present stay as they are.
    pub fn add_rows(&mut self, rows: &[usize]) {
        for &i in rows {
            if self.role[i] == Role::Absent {
                self.role[i] = Role::Waiting;
                self.w[i] = self.q[i] + self.m.column_dot(i, &self.z);
            }
        }
    }

    /// Replaces the state by the solution of a principal sub-problem (Theorem 1).
    ///
    /// # Errors
    /// [`LcpError::Start`] says why the start is refused; no row is present then.
    pub fn start_from(&mut self, start: &Start) -> Result<(), LcpError> {
        self.clear();
        start.require_well_formed(self.problem.len())?;
        for (&i, &z) in start.indices.iter().zip(&start.z) {
            self.role[i] = Role::Considered;
            self.z[i] = z / self.scaling.d[i];
        }
        self.recompute_w();
        if let Err(error) = self.require_complementary(start) {
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

    /// The solved state, to come back to with [`Self::restore`].
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { role: self.role.clone(), active: self.active.members().iter().map(|&i| (i, self.z[i])).collect() }
    }

    /// Returns to a snapshot of this solver. The factor is moved by the rows in which the active sets differ.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        self.role.copy_from_slice(&snapshot.role);
        self.z.fill(0.0);
        let mut wanted = vec![false; self.z.len()];
        for &(i, z) in &snapshot.active {
            wanted[i] = true;
            self.z[i] = z;
        }
        for i in self.active.members().to_vec() {
            if !wanted[i] {
                self.factor.remove(i);
                self.active.remove(i);
            }
        }
        let mut lost = false;
        for &(i, _) in &snapshot.active {
            if !self.active.contains(i) {
                lost |= self.factor.insert(&self.m, i).is_err();
                self.active.insert(i);
            }
        }
        if lost {
            self.refactor();
        }
        self.recompute_w();
    }

    /// Drives every violated row that is present to feasibility.
    ///
    /// # Errors
    /// [`LcpError::NotSemidefinite`] if a direction of negative curvature shows up.
    pub fn solve(&mut self) -> Result<Status, LcpError> {
        self.counts_at_solve = self.counts;
        self.ray = None;
        let present = self.role.iter().filter(|&&role| role != Role::Absent).count();
        let limit = self.counts.pivots + self.settings.pivot_limit_for(present);
        let mut rounds = 0;
        let mut repairs = [Self::refactor, Self::restart].into_iter();
        loop {
            match self.drive_all(limit)? {
                Cycle::Feasible => match self.recompute() {
                    Checked::Solved => return Ok(Status::Solved),
                    Checked::StillViolated if rounds < ROUNDS => {
                        rounds += 1;
                        continue;
                    }
                    Checked::StillViolated | Checked::LostAccuracy => rounds = 0,
                },
                Cycle::Ray => return Ok(Status::NoSolution),
                Cycle::Limit => {
                    self.residual = self.present_residual();
                    return Ok(Status::PivotLimit);
                }
                Cycle::LostAccuracy => {}
            }
            let Some(repair) = repairs.next() else {
                self.residual = self.present_residual();
                return Ok(Status::NumericalTrouble);
            };
            repair(self);
        }
    }

    /// The pair of the last solve, in the caller's units. Rows that are not present have `z = 0`.
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

    fn drive_all(&mut self, limit: usize) -> Result<Cycle, LcpError> {
        while let Some(i) = self.most_violated() {
            let cycle = self.major_cycle(i, limit)?;
            if cycle != Cycle::Feasible {
                return Ok(cycle);
            }
        }
        Ok(Cycle::Feasible)
    }

    /// The present row with the most negative `w`; the least index among equals, so that rounding does not
    /// decide the order of a symmetric structure.
    fn most_violated(&self) -> Option<usize> {
        const EQUAL: f64 = 1e-9;
        let threshold = self.settings.feasibility * self.own_scale();
        let violated = |&i: &usize| self.role[i] != Role::Absent && self.w[i] < -threshold;
        let worst = (0..self.w.len()).filter(violated).map(|i| self.w[i]).reduce(f64::min)?;
        (0..self.w.len()).filter(violated).find(|&i| self.w[i] <= worst * (1.0 - EQUAL))
    }

    /// Drives `z_i` up until `w_i` is zero, keeping every row considered before feasible.
    fn major_cycle(&mut self, i: usize, limit: usize) -> Result<Cycle, LcpError> {
        self.role[i] = Role::Considered;
        self.counts.major_cycles += 1;
        let mut stalled = 0;
        loop {
            if self.counts.pivots >= limit {
                return Ok(Cycle::Limit);
            }
            self.direction(i);
            let size = largest(&self.dz, self.active.members()).max(1.0);
            let slope = self.curvature(i);
            if slope.is_nan() {
                return Ok(Cycle::LostAccuracy);
            }
            if slope < -self.settings.residual * size * size {
                return Err(LcpError::NotSemidefinite { index: i, curvature: slope });
            }
            self.collect_candidates(i, slope, size);
            let rule = if stalled > STALL * (self.active.members().len() + 4) {
                TieRule::LeastIndex
            } else {
                TieRule::LargestRate
            };
            let slack = 0.1 * self.settings.feasibility * self.own_scale();
            let Some((step, blocker)) = ratio_test(&self.candidates, slack, rule) else {
                if self.w[i] < -self.settings.feasibility * self.own_scale() {
                    return self.certify_ray(i, size);
                }
                // Minor cycles have made the row feasible, and it depends on the active rows.
                self.admit(i);
                return Ok(Cycle::Feasible);
            };
            stalled = if step * size > slack { 0 } else { stalled + 1 };
            self.advance(i, step);
            if !self.exchange(i, blocker) {
                return Ok(Cycle::LostAccuracy);
            }
            if blocker == Blocker::Driving {
                return Ok(Cycle::Feasible);
            }
        }
    }

    /// The direction in which only `z_i` and the active `z` move and the active `w` stay zero:
    /// `dz_i = 1`, `dz_C = -M_CC^-1 M_Ci`, `dw = M dz`.
    fn direction(&mut self, i: usize) {
        self.dz.fill(0.0);
        let (rows, values) = self.m.column(i);
        for (&j, &value) in rows.iter().zip(values) {
            if self.active.contains(j) {
                self.dz[j] = -value;
            }
        }
        self.factor.solve(&mut self.dz);
        self.dz[i] = 1.0;
        self.multiply_direction(i);
        let size = largest(&self.dz, self.active.members()).max(1.0);
        if largest(&self.dw, self.active.members()) > REFINE * size {
            let mut correction = vec![0.0; self.dz.len()];
            for &j in self.active.members() {
                correction[j] = -self.dw[j];
            }
            self.factor.solve(&mut correction);
            for &j in self.active.members() {
                self.dz[j] += correction[j];
            }
            self.multiply_direction(i);
        }
    }

    /// `dz' M dz`, which equals `dw_i` but for the error of the active `dw`: that enters `dw_i` multiplied by the direction's
    /// size and here by nothing.
    fn curvature(&self, i: usize) -> f64 {
        self.dw[i] + self.active.members().iter().map(|&j| self.dz[j] * self.dw[j]).sum::<f64>()
    }

    /// Curvature at or below which row i depends on the active rows. Rounding in `M` alone, one unit in the last place of
    /// a unit diagonal, changes `dz' M dz` by the square of the direction's size.
    fn least_slope(&self, size: f64) -> f64 {
        (self.settings.singular * size).max(CURVATURE_ROUNDING * size * size)
    }

    fn multiply_direction(&mut self, i: usize) {
        self.dw.fill(0.0);
        self.m.add_column(i, 1.0, &mut self.dw);
        for &j in self.active.members() {
            self.m.add_column(j, self.dz[j], &mut self.dw);
        }
    }

    /// Everything that falls towards zero: `w_i` of the driving row, active `z`, and `w` of considered rows.
    fn collect_candidates(&mut self, i: usize, slope: f64, size: f64) {
        let floor = self.settings.pivot * size;
        self.candidates.clear();
        if slope > self.least_slope(size) {
            self.candidates.push(Candidate { blocker: Blocker::Driving, value: (-self.w[i]).max(0.0), rate: slope });
        }
        for &j in self.active.members() {
            if self.dz[j] < -floor {
                self.candidates.push(Candidate { blocker: Blocker::Leaves(j), value: self.z[j], rate: -self.dz[j] });
            }
        }
        for j in 0..self.w.len() {
            if self.dw[j] < -floor && self.role[j] == Role::Considered && j != i && !self.active.contains(j) {
                self.candidates.push(Candidate {
                    blocker: Blocker::Enters(j),
                    value: self.w[j].max(0.0),
                    rate: -self.dw[j],
                });
            }
        }
    }

    fn advance(&mut self, i: usize, step: f64) {
        if step == 0.0 {
            return;
        }
        self.z[i] += step;
        for &j in self.active.members() {
            self.z[j] += step * self.dz[j];
        }
        for (w, dw) in self.w.iter_mut().zip(&self.dw) {
            *w += step * dw;
        }
    }

    /// One pivot. False if the factor refuses it.
    fn exchange(&mut self, driving: usize, blocker: Blocker) -> bool {
        self.counts.pivots += 1;
        self.counts.minor_cycles += usize::from(blocker != Blocker::Driving);
        match blocker {
            Blocker::Leaves(j) => {
                self.factor.remove(j);
                self.active.remove(j);
                self.z[j] = 0.0;
                true
            }
            Blocker::Enters(_) | Blocker::Driving => {
                let j = if let Blocker::Enters(j) = blocker { j } else { driving };
                self.w[j] = 0.0;
                self.insert_or_refactor(j)
            }
        }
    }

    fn insert_or_refactor(&mut self, j: usize) -> bool {
        let mut inserted = self.factor.insert(&self.m, j).is_ok();
        if !inserted {
            self.refactor();
            inserted = self.factor.insert(&self.m, j).is_ok();
        }
        if inserted {
            self.active.insert(j);
        }
        inserted
    }

    /// Nothing blocks the direction: y = dz then proves that there is no solution, if `M y = 0`, `y >= 0`, `q' y < 0`.
    /// `y' M y = 0` with `(M y)_j = a` not zero is negative curvature: `y - a e_j` has `-a^2` (unit diagonal).
    fn certify_ray(&mut self, i: usize, size: f64) -> Result<Cycle, LcpError> {
        let y: Vec<f64> = self.dz.iter().map(|&value| value.max(0.0)).collect();
        let image = self.m.multiply_add(&y, &vec![0.0; y.len()]);
        let worst =
            (0..y.len()).filter(|&j| self.role[j] != Role::Absent).fold(0.0_f64, |worst, j| worst.max(image[j].abs()));
        let progress: f64 = y.iter().zip(&self.q).map(|(y, q)| y * q).sum();
        if worst * worst > self.settings.residual * size * size {
            return Err(LcpError::NotSemidefinite { index: i, curvature: -worst * worst });
        }
        if worst > self.settings.residual * size || progress >= 0.0 {
            return Ok(Cycle::LostAccuracy);
        }
        self.ray = Some(y.iter().zip(&self.scaling.d).map(|(y, d)| y * d).collect());
        self.residual = self.present_residual();
        Ok(Cycle::Ray)
    }

    /// Puts a row with `w_i = 0` and `z_i >= 0` into the factor. Where it depends on the rows already there, the values are
    /// moved along the null direction, which changes no `w`, until one of them is zero and leaves.
    fn admit(&mut self, i: usize) {
        loop {
            self.direction(i);
            let size = largest(&self.dz, self.active.members()).max(1.0);
            if self.curvature(i) > self.least_slope(size) {
                if self.factor.insert(&self.m, i).is_ok() {
                    self.active.insert(i);
                } else {
                    self.refactor();
                }
                return;
            }
            let leaving = self
                .active
                .members()
                .iter()
                .filter(|&&j| self.dz[j] > self.settings.pivot * size)
                .map(|&j| (self.z[j] / self.dz[j], j))
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
                .filter(|&(step, _)| step < self.z[i]);
            let step = leaving.map_or(self.z[i], |(step, _)| step);
            for &j in self.active.members() {
                self.z[j] = take(self.z[j], step * self.dz[j]);
            }
            self.z[i] = take(self.z[i], step);
            let Some((_, j)) = leaving else { return };
            self.z[j] = 0.0;
            self.factor.remove(j);
            self.active.remove(j);
            if self.z[i] == 0.0 {
                return;
            }
        }
    }

    fn require_complementary(&self, start: &Start) -> Result<(), StartError> {
        let tolerance = START_TOLERANCE * self.own_scale();
        for &index in &start.indices {
            let (z, w) = (self.z[index], self.w[index]);
            let unscaled = w / self.scaling.d[index];
            if w < -tolerance {
                return Err(StartError::Violated { index, w: unscaled });
            }
            if z > tolerance && w > tolerance {
                return Err(StartError::NotComplementary { index, z: self.z(index), w: unscaled });
            }
        }
        Ok(())
    }

    /// Recomputes every `w`, moves the active `z` so that the active `w` vanish, and judges the result.
    fn recompute(&mut self) -> Checked {
        for z in &mut self.z {
            *z = z.max(0.0);
        }
        self.recompute_w();
        if self.active_residual() > ROUNDING * self.own_scale() && !self.settle_active() {
            return Checked::LostAccuracy;
        }
        self.residual = self.present_residual();
        if self.most_violated().is_some_and(|i| !self.active.contains(i)) {
            Checked::StillViolated
        } else if self.residual <= self.settings.residual {
            Checked::Solved
        } else {
            Checked::LostAccuracy
        }
    }

    /// Largest `|w|` on the active rows, where it should be zero.
    fn active_residual(&self) -> f64 {
        largest(&self.w, self.active.members())
    }

    /// Moves the active `z` towards `w_C = 0`. Where that would take a value below zero, the step ends there and the
    /// row leaves, as in the inner loop of Lawson and Hanson's NNLS (1974): every step lowers
    /// `z' M z / 2 + q' z`. False if the factor has lost its meaning.
    fn settle_active(&mut self) -> bool {
        loop {
            let mut correction = vec![0.0; self.z.len()];
            for &j in self.active.members() {
                correction[j] = -self.w[j];
            }
            self.factor.solve(&mut correction);
            if self.active.members().iter().any(|&j| correction[j].is_nan()) {
                return false;
            }
            let leaving = self
                .active
                .members()
                .iter()
                .filter(|&&j| self.z[j] + correction[j] < 0.0)
                .map(|&j| (self.z[j] / -correction[j], j))
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let step = leaving.map_or(1.0, |(step, _)| step);
            for &j in self.active.members() {
                self.z[j] = (self.z[j] + step * correction[j]).max(0.0);
            }
            if let Some((_, j)) = leaving {
                self.counts.pivots += 1;
                self.counts.minor_cycles += 1;
                self.z[j] = 0.0;
                self.factor.remove(j);
                self.active.remove(j);
            }
            self.recompute_w();
            if leaving.is_none() {
                return true;
            }
        }
    }

    fn recompute_w(&mut self) {
        self.w.copy_from_slice(&self.q);
        for j in 0..self.z.len() {
            if self.z[j] != 0.0 {
                self.m.add_column(j, self.z[j], &mut self.w);
            }
        }
    }

    fn refactor(&mut self) {
        self.counts.refactorisations += 1;
        self.factor.clear();
        for j in self.active.members().to_vec() {
            if self.factor.insert(&self.m, j).is_err() {
                self.active.remove(j);
                self.role[j] = Role::Considered;
            }
        }
    }

    /// Forgets everything but which rows are present.
    fn restart(&mut self) {
        self.counts.refactorisations += 1;
        self.factor.clear();
        self.active.clear();
        self.z.fill(0.0);
        for role in &mut self.role {
            if *role == Role::Considered {
                *role = Role::Waiting;
            }
        }
        self.recompute_w();
    }

    fn own_scale(&self) -> f64 {
        self.scaling.own_scale(self.z.iter().fold(0.0, |size, z| size.max(z.abs())))
    }

    /// `max |min(z, w)|` over the present rows, in the problem's own scale, from a fresh `w = M z + q`.
    fn present_residual(&mut self) -> f64 {
        self.recompute_w();
        let worst = (0..self.z.len())
            .filter(|&i| self.role[i] != Role::Absent)
            .map(|i| self.z[i].min(self.w[i]).abs())
            .fold(0.0, f64::max);
        if worst == 0.0 { 0.0 } else { worst / self.own_scale() }
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
