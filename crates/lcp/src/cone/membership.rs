//! Primal simplex, phase one, on a basis that is kept: `f >= 0` with `G f = h` on the rows that are present.
//!
//! The basis holds 3 columns a block: generators, and unit columns of rows not yet carried. As long as a unit column has a
//! value its row is out of balance; the sum of these is driven down. What a new row or column does not reach is
//! not touched: in a stack the cost of a block is the path of its load to the ground.
//!
//! Dantzig, Linear Programming and Extensions (1963), chapter 5; the factor is [`BasisFactor`].

use super::{basis_factor::BasisFactor, columns::Columns, pricing::Pricing, sparse_vector::SparseVector};
use crate::{counts::Counts, error::LcpError};

/// What a solve found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Membership {
    /// `h` is in the cone: `f` was found and its residual is within the tolerance.
    Inside,
    /// `h` is not in the cone: the certificate y has `y' G <= 0` and `y' h > 0`.
    Outside,
    /// The pivot limit was reached.
    PivotLimit,
    /// Accuracy was lost and rebuilding the factor did not bring it back.
    NumericalTrouble,
}

/// What is basic in a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Basic {
    /// The unit column of the position's own row: what the row lacks to balance.
    Unit,
    Column(u32),
}

/// A basic value that limits the step.
#[derive(Debug, Clone, Copy)]
struct Blocking {
    position: u32,
    ratio: f64,
    size: f64,
}

#[derive(Debug, Clone, Copy)]
enum Change {
    Row(u32),
    Pivot { position: u32, entered: u32, left: Basic },
}

/// A point to return to with [`ConeSolver::roll_back`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mark {
    changes: usize,
    factor: usize,
    rows: usize,
    /// Times the factor had been rebuilt: positions differ from one to the next.
    rebuilds: usize,
}

/// Decides `h in cone(G)` on growing and shrinking sets of rows. A column takes part once all its rows are present.
#[derive(Debug, Clone)]
pub struct ConeSolver {
    g: Columns,
    h: Vec<f64>,
    row_scale: Vec<f64>,
    column_scale: Vec<f64>,
    factor: BasisFactor,
    basic: Vec<Basic>,
    /// Position of a basic column, or `OUT`.
    position: Vec<u32>,
    /// Rows of each column that are absent.
    missing: Vec<u32>,
    present: Vec<bool>,
    rows: Vec<u32>,
    x: Vec<f64>,
    /// Positions that may be infeasible.
    suspects: Vec<u32>,
    pricing: Pricing,
    y: SparseVector,
    direction: SparseVector,
    spike: SparseVector,
    blocking: Vec<Blocking>,
    /// `G f - h` of every present row as of the last check, the worst of them since all were summed, and the largest
    /// value seen.
    balance: Vec<f64>,
    worst: f64,
    size: f64,
    /// Positions whose value changed since the last check, columns that left, and rows to sum again.
    changed: Vec<u32>,
    is_changed: Vec<bool>,
    left: Vec<u32>,
    stale: Vec<u32>,
    changes: Vec<Change>,
    /// Values overwritten since the last mark, to restore it exactly.
    overwritten: Vec<(u32, f64)>,
    last_mark: Option<Mark>,
    residual: f64,
    counts: Counts,
    /// The last pivots showed that digits were lost.
    shaky: bool,
}

const OUT: u32 = u32::MAX;
/// A basic value within this of zero is zero. Values are forces relative to the scaled `h` (largest entry one): rounding
/// along a path of a thousand blocks is near 1e-13.
const ZERO: f64 = 1e-10;
/// Rate of the infeasibility below which a column does not help (columns have a largest entry of one).
const RATE: f64 = 1e-9;
/// Entries of `B^-1 g` at or below this do not block: rounding.
const PIVOT: f64 = 1e-10;
/// An entry above this (columns have a largest entry of one) makes a good pivot whatever the others are.
const SAFE_PIVOT: f64 = 1e-2;
/// How far below zero a value may go for the sake of a better pivot (Harris).
const SLACK: f64 = 1e-12;
/// Imbalance above which the values are refined: a thousandth of what is allowed, ten times what rounding leaves in a
/// sum of some hundred terms.
const ROUNDING: f64 = 1e-12;
/// Most refinements in a row; each gains several digits as long as the factor is any good.
const REFINEMENTS: usize = 3;
/// Largest imbalance of a row of a solution, relative to the larger of `h` and the largest column times its value.
const RESIDUAL: f64 = 1e-9;
/// A pivot computed along its row and along its column may differ by this share before the factor is built again.
const DISAGREEMENT: f64 = 1e-8;
/// Factors of a row operation above this cost too many digits.
const GROWTH: f64 = 1e6;
/// The infeasibility must fall by this share to count as progress.
const PROGRESS: f64 = 1e-12;
/// Pivots without progress after which entering and leaving go by least index (Bland 1977), which cannot cycle.
const STALL: usize = 100;

impl ConeSolver {
    /// Takes the generators of the complete problem, `h`, and for each row the unit in which its imbalance is measured
    /// (positive); no row is present.
    ///
    /// # Errors
    /// [`LcpError::Structure`] if lengths differ or a unit is not positive, [`LcpError::VectorNotFinite`].
    pub fn new(mut g: Columns, h: &[f64], unit: &[f64]) -> Result<Self, LcpError> {
        let (m, n) = (g.rows(), g.len());
        if h.len() != m || unit.len() != m {
            let reason = format!("G has {m} rows, h has {} and the units have {}", h.len(), unit.len());
            return Err(LcpError::Structure { reason });
        }
        if let Some(index) = h.iter().position(|value| !value.is_finite()) {
            return Err(LcpError::VectorNotFinite { index, value: h[index] });
        }
        if let Some(row) = unit.iter().position(|&unit| unit.is_nan() || unit <= 0.0 || unit.is_infinite()) {
            return Err(LcpError::Structure { reason: format!("the unit of row {row} is {}", unit[row]) });
        }
        let row_scale: Vec<f64> = unit.iter().map(|unit| unit.recip()).collect();
        let column_scale = g.scale(&row_scale);
        let missing = (0..n as u32).map(|j| g.column(j).len() as u32).collect();
        Ok(Self {
            h: h.iter().zip(&row_scale).map(|(h, scale)| h * scale).collect(),
            row_scale,
            column_scale,
            factor: BasisFactor::identity(m),
            basic: vec![Basic::Unit; m],
            position: vec![OUT; n],
            missing,
            present: vec![false; m],
            rows: Vec::new(),
            x: vec![0.0; m],
            suspects: Vec::new(),
            pricing: Pricing::new(n),
            y: SparseVector::zero(m),
            direction: SparseVector::zero(m),
            spike: SparseVector::zero(m),
            blocking: Vec::new(),
            balance: vec![0.0; m],
            worst: 0.0,
            size: 1.0,
            changed: Vec::new(),
            is_changed: vec![false; m],
            left: Vec::new(),
            stale: Vec::new(),
            changes: Vec::new(),
            overwritten: Vec::new(),
            last_mark: None,
            residual: 0.0,
            counts: Counts::default(),
            shaky: false,
            g,
        })
    }

    /// Work done since the solver was made; every pivot is a major cycle here.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Largest imbalance of a present row in the last solution, in the row's unit.
    pub fn residual(&self) -> f64 {
        self.residual
    }

    /// Numbers stored in the factor.
    pub fn entries(&self) -> usize {
        self.factor.entries()
    }

    /// `f_j`, in the caller's unit.
    pub fn f(&self, j: usize) -> f64 {
        match self.position[j] {
            OUT => 0.0,
            position => self.x[position as usize].max(0.0) * self.column_scale[j],
        }
    }

    /// After [`Membership::Outside`]: the nonzero multipliers y, one for each row, in units that make `y' G` consistent.
    pub fn certificate(&self) -> Vec<(usize, f64)> {
        let mut rows: Vec<(usize, f64)> = self
            .y
            .iter()
            .filter(|&(_, value)| value != 0.0)
            .map(|(row, value)| (row as usize, value * self.row_scale[row as usize]))
            .collect();
        rows.sort_unstable_by_key(|entry| entry.0);
        rows
    }

    /// Adds rows, out of balance by `h` until the next solve. Rows already present stay as they are.
    pub fn add_rows(&mut self, rows: &[usize]) {
        for &row in rows {
            if std::mem::replace(&mut self.present[row], true) {
                continue;
            }
            self.rows.push(row as u32);
            self.changes.push(Change::Row(row as u32));
            for &(j, _) in self.g.columns_of(row as u32) {
                self.missing[j as usize] -= 1;
            }
            self.basic[row] = Basic::Unit;
            self.x[row] = self.h[row];
            self.change(row as u32);
            self.suspects.push(row as u32);
        }
    }

    /// The state as it is, to come back to with [`Self::roll_back`]. Marks are taken back last first.
    pub fn mark(&mut self) -> Mark {
        let mark = Mark {
            changes: self.changes.len(),
            factor: self.factor.mark(),
            rows: self.rows.len(),
            rebuilds: self.counts.refactorisations,
        };
        self.overwritten.clear();
        self.last_mark = Some(mark);
        mark
    }

    /// Returns to a mark. To the latest one, the values come back bit for bit; to an earlier one they are computed
    /// again from its basis.
    pub fn roll_back(&mut self, mark: Mark) {
        let same_positions = mark.rebuilds == self.counts.refactorisations;
        let exact = self.last_mark == Some(mark);
        let mut basic_columns = if same_positions { Vec::new() } else { self.basic_columns() };
        while self.changes.len() > mark.changes
            && let Some(change) = self.changes.pop()
        {
            match change {
                Change::Pivot { position, entered, left } if same_positions => {
                    self.position[entered as usize] = OUT;
                    self.put(position, left);
                }
                Change::Pivot { entered, left, .. } => {
                    basic_columns.retain(|&j| j != entered);
                    if let Basic::Column(j) = left {
                        basic_columns.push(j);
                    }
                }
                Change::Row(row) => {
                    self.present[row as usize] = false;
                    for &(j, _) in self.g.columns_of(row) {
                        self.missing[j as usize] += 1;
                    }
                }
            }
        }
        if same_positions {
            self.factor.undo_to(mark.factor);
        }
        if exact {
            self.suspects.clear();
            while let Some((position, value)) = self.overwritten.pop() {
                self.change(position);
                self.x[position as usize] = value;
            }
            self.rows.truncate(mark.rows);
        } else {
            if !same_positions {
                self.rebuild(&basic_columns);
            }
            self.rows.truncate(mark.rows);
            self.suspects.clear();
            self.recompute_values();
        }
        self.overwritten.clear();
        self.last_mark = exact.then_some(mark);
    }

    /// Decides whether `h` is in the cone of the present columns.
    pub fn solve(&mut self) -> Membership {
        let limit = self.counts.pivots + 1000 + 50 * self.rows.len();
        let (mut rebuilt, mut refined) = (false, 0);
        loop {
            let found = self.phase_one(limit);
            let sound = match found {
                Some(Membership::Inside) => {
                    self.residual = self.imbalance();
                    if self.residual > ROUNDING {
                        self.recheck_all(); // the worst may be of long ago
                        self.residual = self.imbalance();
                    }
                    if self.residual > ROUNDING && refined < REFINEMENTS {
                        refined += 1;
                        self.refine();
                        continue;
                    }
                    self.residual <= RESIDUAL
                }
                Some(Membership::Outside) => self.certifies(),
                Some(_) => return Membership::PivotLimit,
                None => false,
            };
            match found {
                Some(found) if sound => return found,
                _ if rebuilt => return Membership::NumericalTrouble,
                _ => (rebuilt, refined) = (true, 0),
            }
            let columns = self.basic_columns();
            if !self.rebuild(&columns) {
                return Membership::NumericalTrouble;
            }
            self.recompute_values();
        }
    }

    /// Drives the infeasibility down until it is gone or cannot fall. None if a pivot was refused.
    fn phase_one(&mut self, limit: usize) -> Option<Membership> {
        let (mut stalled, mut best) = (0, f64::INFINITY);
        loop {
            self.rebuild_if_shaky()?;
            let x = &self.x;
            let basic = &self.basic;
            self.suspects.retain(|&p| infeasible(basic[p as usize], x[p as usize]) != 0.0);
            if self.suspects.is_empty() {
                return Some(Membership::Inside);
            }
            if self.counts.pivots >= limit {
                return Some(Membership::PivotLimit);
            }
            self.multipliers();
            let infeasibility: f64 = self.suspects.iter().map(|&p| self.x[p as usize].abs()).sum();
            stalled = if infeasibility < best * (1.0 - PROGRESS) { 0 } else { stalled + 1 };
            best = best.min(infeasibility);
            if stalled == STALL {
                self.shaky = true; // a factor gone wrong is the likelier reason
                continue;
            }
            let least_index = stalled > STALL;
            let (missing, position) = (&self.missing, &self.position);
            let allowed = |j: u32| missing[j as usize] == 0 && position[j as usize] == OUT;
            let Some(entering) = self.pricing.entering(&self.g, &self.y, allowed, RATE, least_index) else {
                return Some(Membership::Outside);
            };
            self.column_spike(entering);
            let (step, leaving, rate) = match self.balanced_row() {
                Some((row, rate)) => (0.0, row, rate),
                None => {
                    self.direction_from_spike();
                    let (step, leaving) = self.ratio_test(least_index)?;
                    (step, leaving, self.direction.get(leaving))
                }
            };
            if step > 0.0 {
                self.step(step);
            }
            self.exchange(entering, leaving, step, rate)?;
        }
    }

    /// Builds the factor again if a pivot showed lost digits. None if that fails.
    fn rebuild_if_shaky(&mut self) -> Option<()> {
        if std::mem::take(&mut self.shaky) {
            let columns = self.basic_columns();
            if !self.rebuild(&columns) {
                return None;
            }
            self.recompute_values();
            self.shaky = false;
        }
        Some(())
    }

    /// `y = B^-T c` with c the rate at which the infeasibility grows with each basic value.
    fn multipliers(&mut self) {
        self.y.clear();
        self.suspects.sort_unstable();
        self.suspects.dedup();
        for &p in &self.suspects {
            self.y.set(p, infeasible(self.basic[p as usize], self.x[p as usize]));
        }
        self.factor.solve_transposed(&mut self.y);
    }

    /// `L^-1 g` of a column.
    fn column_spike(&mut self, j: u32) {
        self.spike.clear();
        for &(row, value) in self.g.column(j) {
            self.spike.set(row, value);
        }
        self.factor.apply_operations(&mut self.spike);
    }

    /// `B^-1 g`.
    fn direction_from_spike(&mut self) {
        self.direction.clear();
        for (row, value) in self.spike.iter() {
            self.direction.set(row, value);
        }
        self.factor.solve_upper(&mut self.direction);
    }

    /// A row in balance that the spike alone shows to block the step at once, which saves the direction. Of several the
    /// one with the largest entry.
    fn balanced_row(&self) -> Option<(u32, f64)> {
        let balanced = |p: u32| self.basic[p as usize] == Basic::Unit && self.x[p as usize].abs() <= ZERO;
        let entry = |p: u32| self.factor.first_solved(p, &self.spike).filter(|entry| entry.abs() > SAFE_PIVOT);
        self.spike
            .index()
            .iter()
            .filter(|&&p| balanced(p))
            .filter_map(|&p| Some((p, entry(p)?)))
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()).then(b.0.cmp(&a.0)))
    }

    /// How far the entering column can go until a basic value reaches zero, and which. A unit column at zero allows
    /// no step: a balanced row stays balanced.
    fn ratio_test(&mut self, least_index: bool) -> Option<(f64, u32)> {
        let slack = if least_index { 0.0 } else { SLACK };
        let mut bound = f64::INFINITY;
        self.blocking.clear();
        for (p, rate) in self.direction.iter() {
            let size = rate.abs();
            if size <= PIVOT {
                continue;
            }
            let (basic, value) = (self.basic[p as usize], self.x[p as usize]);
            let sign = infeasible(basic, value);
            let room = if sign != 0.0 {
                if sign * rate < 0.0 {
                    continue;
                }
                value.abs()
            } else if basic == Basic::Unit {
                0.0
            } else if rate > 0.0 {
                value.max(0.0)
            } else {
                continue;
            };
            let reach = (room + slack) / size;
            if room / size <= bound {
                self.blocking.push(Blocking { position: p, ratio: room / size, size });
                bound = bound.min(reach);
            }
        }
        let order = |b: &Blocking| {
            let unit = self.basic[b.position as usize] == Basic::Unit;
            (!unit, if least_index { 0.0 } else { -b.size }, self.leaving_index(b.position))
        };
        self.blocking
            .iter()
            .filter(|b| b.ratio <= bound)
            .min_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(std::cmp::Ordering::Equal))
            .map(|b| (b.ratio, b.position))
    }

    fn leaving_index(&self, p: u32) -> u32 {
        match self.basic[p as usize] {
            Basic::Unit => p,
            Basic::Column(j) => j,
        }
    }

    fn step(&mut self, step: f64) {
        for (p, rate) in self.direction.iter() {
            let x = &mut self.x[p as usize];
            if self.last_mark.is_some() {
                self.overwritten.push((p, *x));
            }
            if !std::mem::replace(&mut self.is_changed[p as usize], true) {
                self.changed.push(p);
            }
            *x -= step * rate;
            if infeasible(self.basic[p as usize], *x) != 0.0 {
                self.suspects.push(p);
            }
        }
    }

    /// One pivot. None if the factor refuses it.
    fn exchange(&mut self, entering: u32, leaving: u32, step: f64, rate: f64) -> Option<()> {
        let replacement = self.factor.replace(leaving, &self.spike)?;
        let disagreement = (replacement.rate - rate).abs() / rate.abs();
        self.shaky |= disagreement > DISAGREEMENT || replacement.growth > GROWTH;
        self.counts.pivots += 1;
        self.counts.major_cycles += 1;
        let left = self.basic[leaving as usize];
        if let Basic::Column(j) = left {
            self.position[j as usize] = OUT;
            self.left.push(j);
        }
        self.change(leaving);
        self.changes.push(Change::Pivot { position: leaving, entered: entering, left });
        self.put(leaving, Basic::Column(entering));
        self.remember(leaving);
        self.x[leaving as usize] = step;
        Some(())
    }

    fn put(&mut self, position: u32, basic: Basic) {
        self.basic[position as usize] = basic;
        if let Basic::Column(j) = basic {
            self.position[j as usize] = position;
        }
    }

    /// `x = B^-1 h` on the present rows.
    fn recompute_values(&mut self) {
        self.direction.clear();
        for &row in &self.rows {
            self.direction.set(row, self.h[row as usize]);
        }
        self.factor.apply_operations(&mut self.direction);
        self.factor.solve_upper(&mut self.direction);
        self.recheck_all();
        for k in 0..self.rows.len() {
            let row = self.rows[k];
            self.remember(row);
            let value = self.direction.get(row);
            self.x[row as usize] = value;
            if infeasible(self.basic[row as usize], value) != 0.0 {
                self.suspects.push(row);
            }
        }
    }

    /// Largest `|G f - h|` of a present row, relative to the largest column times its value, from `f` itself. If few
    /// values changed since the last time, only the rows of their columns are summed again; the others' stands.
    fn imbalance(&mut self) -> f64 {
        if 4 * self.changed.len() > self.rows.len() {
            self.sum_all_rows();
        } else {
            self.sum_changed_rows();
        }
        for &position in &self.changed {
            self.is_changed[position as usize] = false;
        }
        self.changed.clear();
        self.left.clear();
        self.worst / self.size
    }

    fn sum_all_rows(&mut self) {
        for &row in &self.rows {
            self.balance[row as usize] = -self.h[row as usize];
        }
        self.size = 1.0;
        for &p in &self.rows {
            if let Basic::Column(j) = self.basic[p as usize] {
                let f = self.x[p as usize].max(0.0);
                self.size = self.size.max(f);
                for &(row, value) in self.g.column(j) {
                    self.balance[row as usize] += f * value;
                }
            }
        }
        self.worst = self.rows.iter().fold(0.0_f64, |worst, &row| worst.max(self.balance[row as usize].abs()));
    }

    fn sum_changed_rows(&mut self) {
        self.stale.clear();
        self.stale.extend(&self.changed);
        for &position in &self.changed {
            self.is_changed[position as usize] = false;
            if let Basic::Column(j) = self.basic[position as usize] {
                self.size = self.size.max(self.x[position as usize]);
                self.left.push(j);
            }
        }
        for &j in &self.left {
            self.stale.extend(self.g.column(j).iter().map(|&(row, _)| row));
        }
        for &row in &self.stale {
            if std::mem::replace(&mut self.is_changed[row as usize], true) || !self.present[row as usize] {
                continue;
            }
            let force = |&(j, value): &(u32, f64)| match self.position[j as usize] {
                OUT => 0.0,
                position => value * self.x[position as usize].max(0.0),
            };
            let sum: f64 = self.g.columns_of(row).iter().map(force).sum();
            self.balance[row as usize] = sum - self.h[row as usize];
            self.worst = self.worst.max(self.balance[row as usize].abs());
        }
        for &row in &self.stale {
            self.is_changed[row as usize] = false;
        }
    }

    /// Every row is to be summed again.
    fn recheck_all(&mut self) {
        for k in 0..self.rows.len() {
            self.change(self.rows[k]);
        }
    }

    /// Notes that the value in a position is about to change.
    fn change(&mut self, position: u32) {
        if !std::mem::replace(&mut self.is_changed[position as usize], true) {
            self.changed.push(position);
        }
    }

    /// One step of iterative refinement on every basic value, from the imbalance just computed.
    fn refine(&mut self) {
        self.direction.clear();
        for k in 0..self.rows.len() {
            let row = self.rows[k];
            let unit = if self.basic[row as usize] == Basic::Unit { self.x[row as usize] } else { 0.0 };
            self.direction.set(row, -self.balance[row as usize] - unit);
        }
        self.factor.apply_operations(&mut self.direction);
        self.factor.solve_upper(&mut self.direction);
        self.step(-1.0);
    }

    /// Whether y proves that `h` is outside: `y' g <= 0` for every present column, up to rounding, and `y' h > 0`.
    fn certifies(&self) -> bool {
        let size = self.y.iter().fold(0.0_f64, |size, (_, value)| size.max(value.abs()));
        let power: f64 = self.y.iter().map(|(row, value)| value * self.h[row as usize]).sum();
        let rises = |&(j, _): &(u32, f64)| {
            let rate: f64 = self.g.column(j).iter().map(|&(row, value)| value * self.y.get(row)).sum();
            self.missing[j as usize] == 0 && rate > 10.0 * RATE * size
        };
        power > 0.0 && !self.y.iter().any(|(row, _)| self.g.columns_of(row).iter().any(rises))
    }

    fn basic_columns(&self) -> Vec<u32> {
        let column = |&p: &u32| match self.basic[p as usize] {
            Basic::Column(j) => Some(j),
            Basic::Unit => None,
        };
        self.rows.iter().filter_map(column).collect()
    }

    /// Builds the factor again from these columns, each in the free position where it is largest; one that depends on
    /// those before it stays out. False if the factor refuses one.
    fn rebuild(&mut self, columns: &[u32]) -> bool {
        self.counts.refactorisations += 1;
        self.last_mark = None;
        self.factor.reset();
        self.suspects.clear();
        for j in self.basic_columns() {
            self.position[j as usize] = OUT;
        }
        self.rows.iter().for_each(|&p| self.basic[p as usize] = Basic::Unit);
        for &j in columns {
            self.column_spike(j);
            self.direction_from_spike();
            let free = |&(p, _): &(u32, f64)| self.basic[p as usize] == Basic::Unit;
            let best = self.direction.iter().filter(free).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            let Some((p, _)) = best.filter(|best| best.1.abs() > PIVOT) else { continue };
            if self.factor.replace(p, &self.spike).is_none() {
                return false;
            }
            self.put(p, Basic::Column(j));
        }
        true
    }

    fn remember(&mut self, p: u32) {
        if self.last_mark.is_some() {
            self.overwritten.push((p, self.x[p as usize]));
        }
    }
}

/// Sign of the infeasibility of a basic value: a unit column must be zero, a generator not negative.
fn infeasible(basic: Basic, value: f64) -> f64 {
    if value < -ZERO {
        -1.0
    } else if value > ZERO && basic == Basic::Unit {
        1.0
    } else {
        0.0
    }
}
