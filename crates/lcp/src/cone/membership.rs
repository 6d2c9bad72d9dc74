//! Primal simplex, phase one, on a basis that is kept: `f >= 0` with `G f = h` on the rows that are present.
//!
//! The basis holds 3 columns a block: generators, and unit columns of rows not yet carried. As long as a unit column has a
//! value its row is out of balance; the sum of these is driven down. What a new row or column does not reach is
//! not touched: in a stack the cost of a block is the path of its load to the ground.
//!
//! Dantzig, Linear Programming and Extensions (1963), chapter 5; the factor is [`BasisFactor`].

mod balance;
mod basis;
mod bearing;
mod doubt;
mod greatest;
mod growing;
mod journal;
mod leaving;
mod phase_one;
mod present;
mod problem;
mod rebuilding;
mod values;
mod wear;

pub use greatest::{Greatest, Load};
pub use journal::Mark;

use super::{
    answer::{Doubt, Membership},
    basic::{Basic, infeasible},
    columns::Columns,
    pricing::Pricing,
};
use crate::{counts::Counts, error::LcpError, interrupt::Tally};
use balance::Balance;
use basis::Basis;
use bearing::Bearing;
use journal::{Change, Journal};
use phase_one::Pivot;
use present::Present;
use problem::Scaled;
use serde::{Deserialize, Serialize};
use values::Values;

/// Decides `h in cone(G)` on growing and shrinking sets of rows. A column takes part once all its rows are present.
///
/// Its parts, each with what always holds of it, in the order in which an answer needs them: [`Self::solve`] prices columns
/// with the multipliers, a `Pivot` changes the `Basis`, the `Values` follow and with them the `Balance`; when all
/// are feasible it is inside.
///
/// Stopped on the way ([`crate::interrupt`]), it is of no further use: take a new one.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ConeSolver {
    problem: Scaled,
    present: Present,
    basis: Basis,
    values: Values,
    balance: Balance,
    bearing: Bearing,
    pricing: Pricing,
    pivot: Pivot,
    journal: Journal,
    residual: f64,
    /// How near the last answer is to either side, if it was borderline.
    doubt: Option<Doubt>,
    counts: Counts,
    #[serde(skip)]
    limits: Limits,
    #[serde(skip)]
    tally: Tally,
}

/// What answers may take.
#[derive(Debug, Clone, Copy)]
struct Limits {
    /// See [`ConeSolver::limit_effort`].
    effort: usize,
    /// See [`ConeSolver::only_in_64_bits`].
    only_in_64_bits: bool,
}

impl Default for Limits {
    /// Any.
    fn default() -> Self {
        Self { effort: usize::MAX, only_in_64_bits: false }
    }
}

/// Rate of the infeasibility, relative to the largest multiplier, below which a column does not help (columns have a
/// largest entry of one): less is rounding of the multipliers.
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
/// What is this small in an answer to a unit load is rounding.
const ROUNDED: f64 = 1e-15;
/// The values are brought up to date after as many answers, or as a sixteenth of the rows: little beside these answers.
const MOST_BEHIND: usize = 64;
/// Entries of the factor for each row that are never too many, and how many times more than after it was built last are.
const ENTRIES: usize = 32;
const FILL: usize = 3;
/// Replaced columns for each row of the complete problem that the factor may keep before it is built again.
const REPLACEMENTS: usize = 16;
/// The infeasibility must fall by this share to count as progress.
const PROGRESS: f64 = 1e-12;
/// Pivots without progress after which entering and leaving go by least index (Bland 1977), which cannot cycle.
const STALL: usize = 200;

impl ConeSolver {
    /// Whether both have the same generators and loads.
    pub fn same_problem(&self, other: &Self) -> bool {
        self.problem.is_same(&other.problem)
    }

    /// Takes the generators of the complete problem, `h`, and for each row the unit in which its imbalance is measured
    /// (positive); no row is present.
    ///
    /// # Errors
    /// [`LcpError::Structure`] if lengths differ or a unit is not positive, [`LcpError::VectorNotFinite`].
    pub fn new(g: Columns, h: &[f64], unit: &[f64]) -> Result<Self, LcpError> {
        let (m, n) = (g.rows(), g.len());
        let problem = Scaled::new(g, h, unit)?;
        Ok(Self {
            present: Present::none(&problem.g),
            basis: Basis::of_units(m, n),
            values: Values::zeros(m, n),
            balance: Balance::of_nothing(m),
            bearing: Bearing::unknown(m, n),
            pricing: Pricing::new(n),
            pivot: Pivot::none(m),
            journal: Journal::default(),
            residual: 0.0,
            doubt: None,
            counts: Counts::default(),
            limits: Limits::default(),
            tally: Tally::default(),
            problem,
        })
    }

    /// Says what the load of each row's own block is in the unit of its row, if that is not one: at most one. Imbalance is judged
    /// by it.
    ///
    /// # Panics
    /// If there is not one for each row.
    pub fn with_own_loads(mut self, own: Vec<f64>) -> Self {
        assert_eq!(own.len(), self.problem.h.len(), "one for each row");
        self.problem.wide = own.iter().any(|&own| own < 1.0);
        self.problem.own = own;
        self
    }

    /// Columns that enter before all others: as long as one of them lowers the imbalance, no other is looked at.
    pub fn prefer(&mut self, columns: std::ops::Range<usize>) {
        self.pricing.prefer(columns.start as u32..columns.end as u32);
    }

    /// Work done since the solver was made; every pivot is a major cycle here.
    pub fn counts(&self) -> Counts {
        Counts { entries_solved: self.basis.factor.read(), ..self.counts }
    }

    /// Largest imbalance of a present row in the last solution, in the row's unit.
    pub fn residual(&self) -> f64 {
        self.residual
    }

    /// After [`Membership::Borderline`]: how near to either side it is.
    pub fn doubt(&self) -> Option<Doubt> {
        self.doubt
    }

    /// Number of columns of the problem.
    pub fn columns(&self) -> usize {
        self.problem.g.len()
    }

    /// Numbers stored in the factor.
    pub fn entries(&self) -> usize {
        self.basis.factor.entries()
    }

    /// `f_j`, in the caller's unit.
    pub fn f(&self, j: usize) -> f64 {
        self.values.force[j].max(0.0) * self.problem.column_scale[j]
    }

    /// After [`Membership::Outside`]: the nonzero multipliers y, one for each row, in units that make `y' G` consistent.
    pub fn certificate(&self) -> Vec<(usize, f64)> {
        let mut rows: Vec<(usize, f64)> = self
            .pivot
            .multipliers
            .iter()
            .filter(|&(_, value)| value != 0.0)
            .map(|(row, value)| (row as usize, value * self.problem.row_scale[row as usize]))
            .collect();
        rows.sort_unstable_by_key(|entry| entry.0);
        rows
    }

    /// After [`Membership::Outside`]: the multiplier of a row, until the next answer.
    pub fn multiplier(&self, row: usize) -> f64 {
        self.pivot.multipliers.get(row as u32) * self.problem.row_scale[row]
    }

    /// After [`Membership::Outside`]: `y' h`, until the next answer.
    pub fn certificate_power(&self) -> f64 {
        self.pivot.multipliers.iter().map(|(row, value)| value * self.problem.h[row as usize]).sum()
    }

    /// The columns of the basis, for another solver to [start from](Self::start_from).
    pub fn basic_columns(&self) -> impl Iterator<Item = usize> {
        self.present.rows.iter().filter_map(|&row| self.basis.column_in(row)).map(|j| j as usize)
    }

    /// Adds rows, out of balance by `h` until the next solve. Rows already present stay as they are.
    pub fn add_rows(&mut self, rows: &[usize]) {
        for &row in rows {
            if self.present.is_there[row] {
                continue;
            }
            self.join_newest_group(row as u32);
            self.present.bring(row as u32, &self.problem.g);
            self.journal.note(Change::Row(row as u32));
            self.basis.basic[row] = Basic::Unit;
            self.values.basic[row] = self.problem.h[row];
            self.balance.sums[row] = -self.problem.h[row];
            self.balance.new_rows.push(row as u32);
            self.values.suspects.push(row as u32);
        }
    }

    /// [`Self::add_rows`] as a group of their own, as those are that come after an answer: rows of one block belong together.
    pub fn add_group(&mut self, rows: &[usize]) {
        self.bearing.group_closed = true;
        self.add_rows(rows);
    }

    /// Effort so far: numbers of the factor read, and columns priced.
    pub fn effort(&self) -> usize {
        self.basis.factor.effort() + self.pricing.effort()
    }

    /// Answers are [`Membership::PivotLimit`] from now on if they would take the effort beyond this.
    pub fn limit_effort(&mut self, most: usize) {
        self.limits.effort = most;
    }

    /// Where 64-bit numbers do not decide, answers are [`Membership::NumericalTrouble`] from now on, instead of those of many more
    /// digits, which take long: for who has another way.
    pub fn only_in_64_bits(&mut self) {
        self.limits.only_in_64_bits = true;
    }

    /// Whether its effort is beyond the limit.
    pub fn is_exhausted(&self) -> bool {
        self.effort() > self.limits.effort
    }

    /// Decides whether `h` is in the cone of the present columns, and finds `f` if so.
    pub fn solve(&mut self) -> Membership {
        self.catch_up();
        self.bearing.lazy = false;
        self.answer()
    }

    /// Decides whether `h` is in the cone of the present columns, without passing every load on to the ground: where what
    /// is below was shown to bear (`bearing.rs`), the answer does not wait for its forces. [`Self::solve`] brings `f`
    /// and the residual up to date; until then both are those of an earlier moment there.
    pub fn decide(&mut self) -> Membership {
        self.bearing.answers_behind += 1;
        if self.bearing.answers_behind > MOST_BEHIND.max(self.present.rows.len() / 16) {
            return self.solve();
        }
        self.bearing.lazy = true;
        self.answer()
    }

    fn answer(&mut self) -> Membership {
        let limit = self.counts.pivots + 1000 + 50 * self.present.rows.len();
        let (mut rebuilt, mut refined) = (false, 0);
        self.bearing.group_closed = true;
        self.doubt = None;
        loop {
            let found = self.phase_one(limit);
            let sound = match found {
                Some(Membership::Inside) => {
                    self.certify_newest();
                    self.residual = self.imbalance();
                    if self.residual > ROUNDING {
                        self.bearing.behind = false; // the refinement passes everything on
                        self.sum_rows(); // the worst may be of long ago
                        self.residual = self.imbalance();
                    }
                    let sound = self.residual <= RESIDUAL && self.balances();
                    if (self.residual > ROUNDING || !sound) && refined < REFINEMENTS {
                        refined += 1;
                        self.refine();
                        continue;
                    }
                    sound
                }
                Some(Membership::Outside) => self.certifies(),
                Some(_) => return Membership::PivotLimit,
                None => false,
            };
            match found {
                Some(found) if sound => return found,
                _ if rebuilt => return self.decide_extended(),
                _ => (rebuilt, refined) = (true, 0),
            }
            if !self.rebuild(&self.basis.set(&self.present.rows)) {
                return self.decide_extended();
            }
            self.recompute_values();
        }
    }
}
