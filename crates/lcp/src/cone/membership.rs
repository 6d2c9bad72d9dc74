//! Primal simplex, phase one, on a basis that is kept: `f >= 0` with `G f = h` on the rows that are present.
//!
//! The basis holds 3 columns a block: generators, and unit columns of rows not yet carried. As long as a unit column has a
//! value its row is out of balance; the sum of these is driven down. What a new row or column does not reach is
//! not touched: in a stack the cost of a block is the path of its load to the ground.
//!
//! Dantzig, Linear Programming and Extensions (1963), chapter 5; the factor is [`BasisFactor`].

mod bearing;
mod checking;
mod doubt;
mod greatest;
mod growing;
mod keeping;
mod leaving;
mod marks;
mod phase_one;
mod wear;

pub use greatest::{Greatest, Load};
pub use marks::Mark;

use super::{
    answer::{Doubt, Membership},
    basic::{Basic, ZERO, infeasible},
    basis_factor::BasisFactor,
    columns::Columns,
    pricing::Pricing,
    sparse_vector::SparseVector,
};
use crate::{counts::Counts, error::LcpError, interrupt::Tally};
use serde::{Deserialize, Serialize};

/// A basic value that limits the step.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Blocking {
    position: u32,
    ratio: f64,
    rate: f64,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
enum Change {
    /// A row came.
    Row(u32),
    Gone {
        row: u32,
        group: u32,
    },
    /// A column was found to bear; it is not known to any more.
    Bears(u32),
    Doubted(u32),
    Pivot {
        position: u32,
        entered: Basic,
        left: Basic,
    },
}

/// Decides `h in cone(G)` on growing and shrinking sets of rows. A column takes part once all its rows are present.
///
/// Stopped on the way ([`crate::interrupt`]), it is of no further use: take a new one.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ConeSolver {
    g: Columns,
    h: Vec<f64>,
    row_scale: Vec<f64>,
    /// The load of each row's own block in the unit of the row.
    own: Vec<f64>,
    /// Some blocks weigh so much less than others that their own load is small in the unit of their rows.
    wide: bool,
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
    /// Force of each column: its basic value, zero where it is not basic.
    force: Vec<f64>,
    /// Positions that may be infeasible.
    suspects: Vec<u32>,
    pricing: Pricing,
    y: SparseVector,
    /// `B^-1 g` as (position, rate); nothing that is zero.
    direction: Vec<(u32, f64)>,
    spike: SparseVector,
    blocking: Vec<Blocking>,
    /// `G f - h` of every present row, and since all were summed from nothing the worst of them and the largest force.
    balance: Vec<f64>,
    worst: f64,
    size: f64,
    /// Columns whose force changed since the last check, and rows that came since.
    changed: Vec<u32>,
    new_rows: Vec<u32>,
    /// Checks since every row was summed from nothing.
    carried: usize,
    /// Columns known to bear, see `bearing.rs`.
    bears: Vec<bool>,
    /// Number of the newest group of rows, whether the next row starts another, and the groups' rows as rings.
    groups: u32,
    group_closed: bool,
    next_in_group: Vec<u32>,
    /// The newest group has pivots in other groups' rows, or other groups' columns.
    mixed: bool,
    /// Values below bearing columns are not up to date, for how many answers, and whether that is allowed.
    behind: bool,
    answers_behind: usize,
    lazy: bool,
    /// What to take back at a mark, and whether there ever was one.
    changes: Vec<Change>,
    marked: bool,
    /// Times all marks ended.
    era: usize,
    /// Values overwritten since the first mark whose values come back from memory, whether there is one, and how often
    /// they were lost.
    overwritten: Vec<(u32, f64)>,
    remembers: bool,
    values: usize,
    residual: f64,
    /// How near the last answer is to either side, if it was borderline.
    doubt: Option<Doubt>,
    /// A basic value within this of zero is zero: [`ZERO`], or what rounding leaves of the largest force.
    zero: f64,
    counts: Counts,
    /// The last pivots showed that digits were lost.
    shaky: bool,
    /// Entries of the factor above which it is built again in a sparser order.
    most_entries: usize,
    /// See [`Self::limit_effort`].
    #[serde(skip, default = "unlimited")]
    most_effort: usize,
    /// See [`Self::only_in_64_bits`].
    #[serde(skip)]
    only_in_64_bits: bool,
    /// Room for [`Self::roll_back`].
    #[serde(skip)]
    rolled_back: Vec<u32>,
    #[serde(skip)]
    tally: Tally,
}

const OUT: u32 = u32::MAX;

fn unlimited() -> usize {
    usize::MAX
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
/// Rounding of a value, relative to the largest force.
const OF_LARGEST: f64 = 8.0 * f64::EPSILON;
/// Largest imbalance of a row of a solution, relative to the larger of `h` and the largest column times its value.
const RESIDUAL: f64 = 1e-9;
/// What is this small in an answer to a unit load is rounding.
const ROUNDED: f64 = 1e-15;
/// The values are brought up to date after as many answers, or as a sixteenth of the rows: little beside these answers.
const MOST_BEHIND: usize = 64;
/// A pivot computed along its row and along its column may differ by this share before the factor is built again.
const DISAGREEMENT: f64 = 1e-8;
/// Factors of a row operation above this cost too many digits.
const GROWTH: f64 = 1e6;
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
        (&self.g, &self.h, &self.row_scale) == (&other.g, &other.h, &other.row_scale)
    }

    /// Takes the generators of the complete problem, `h`, and for each row the unit in which its imbalance is measured
    /// (positive); no row is present.
    ///
    /// # Errors
    /// [`LcpError::Structure`] if lengths differ or a unit is not positive, [`LcpError::VectorNotFinite`].
    pub fn new(mut g: Columns, h: &[f64], unit: &[f64]) -> Result<Self, LcpError> {
        let (m, n) = (g.rows(), g.len());
        check(m, h, unit)?;
        let row_scale: Vec<f64> = unit.iter().map(|unit| unit.recip()).collect();
        let column_scale = g.scale(&row_scale);
        let missing = (0..n as u32).map(|j| g.column(j).len() as u32).collect();
        Ok(Self {
            h: h.iter().zip(&row_scale).map(|(h, scale)| h * scale).collect(),
            row_scale,
            own: vec![1.0; m],
            wide: false,
            column_scale,
            factor: BasisFactor::identity(m),
            basic: vec![Basic::Unit; m],
            position: vec![OUT; n],
            missing,
            present: vec![false; m],
            rows: Vec::new(),
            x: vec![0.0; m],
            force: vec![0.0; n],
            suspects: Vec::new(),
            pricing: Pricing::new(n),
            y: SparseVector::zero(m),
            direction: Vec::new(),
            spike: SparseVector::zero(m),
            blocking: Vec::new(),
            balance: vec![0.0; m],
            worst: 0.0,
            size: 1.0,
            changed: Vec::new(),
            new_rows: Vec::new(),
            carried: 0,
            bears: vec![false; n],
            groups: 0,
            group_closed: true,
            next_in_group: vec![OUT; m],
            mixed: false,
            behind: false,
            answers_behind: 0,
            lazy: false,
            changes: Vec::new(),
            marked: false,
            era: 0,
            overwritten: Vec::new(),
            remembers: false,
            values: 0,
            residual: 0.0,
            doubt: None,
            zero: ZERO,
            counts: Counts::default(),
            shaky: false,
            most_entries: 0,
            most_effort: unlimited(),
            only_in_64_bits: false,
            rolled_back: Vec::new(),
            tally: Tally::default(),
            g,
        })
    }

    /// Says what the load of each row's own block is in the unit of its row, if that is not one: at most one. Imbalance is judged
    /// by it.
    ///
    /// # Panics
    /// If there is not one for each row.
    pub fn with_own_loads(mut self, own: Vec<f64>) -> Self {
        assert_eq!(own.len(), self.h.len(), "one for each row");
        self.wide = own.iter().any(|&own| own < 1.0);
        self.own = own;
        self
    }

    /// Columns that enter before all others: as long as one of them lowers the imbalance, no other is looked at.
    pub fn prefer(&mut self, columns: std::ops::Range<usize>) {
        self.pricing.prefer(columns.start as u32..columns.end as u32);
    }

    /// Work done since the solver was made; every pivot is a major cycle here.
    pub fn counts(&self) -> Counts {
        Counts { entries_solved: self.factor.read(), ..self.counts }
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
        self.g.len()
    }

    /// Numbers stored in the factor.
    pub fn entries(&self) -> usize {
        self.factor.entries()
    }

    /// `f_j`, in the caller's unit.
    pub fn f(&self, j: usize) -> f64 {
        self.force[j].max(0.0) * self.column_scale[j]
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

    /// After [`Membership::Outside`]: the multiplier of a row, until the next answer.
    pub fn multiplier(&self, row: usize) -> f64 {
        self.y.get(row as u32) * self.row_scale[row]
    }

    /// After [`Membership::Outside`]: `y' h`, until the next answer.
    pub fn certificate_power(&self) -> f64 {
        self.y.iter().map(|(row, value)| value * self.h[row as usize]).sum()
    }

    /// Adds rows, out of balance by `h` until the next solve. Rows already present stay as they are.
    pub fn add_rows(&mut self, rows: &[usize]) {
        for &row in rows {
            if self.present[row] {
                continue;
            }
            self.join_newest_group(row as u32);
            self.bring_row(row as u32);
            self.note(Change::Row(row as u32));
            self.basic[row] = Basic::Unit;
            self.x[row] = self.h[row];
            self.balance[row] = -self.h[row];
            self.new_rows.push(row as u32);
            self.suspects.push(row as u32);
        }
    }

    /// A row is present from now on; it has joined its group.
    fn bring_row(&mut self, row: u32) {
        self.present[row as usize] = true;
        self.rows.push(row);
        for &(j, _) in self.g.columns_of(row) {
            self.missing[j as usize] -= 1;
        }
    }

    /// [`Self::add_rows`] as a group of their own, as those are that come after an answer: rows of one block belong together.
    pub fn add_group(&mut self, rows: &[usize]) {
        self.group_closed = true;
        self.add_rows(rows);
    }

    /// Effort so far: numbers of the factor read, and columns priced.
    pub fn effort(&self) -> usize {
        self.factor.effort() + self.pricing.effort()
    }

    /// Answers are [`Membership::PivotLimit`] from now on if they would take the effort beyond this.
    pub fn limit_effort(&mut self, most: usize) {
        self.most_effort = most;
    }

    /// Where 64-bit numbers do not decide, answers are [`Membership::NumericalTrouble`] from now on, instead of those of many more
    /// digits, which take long: for who has another way.
    pub fn only_in_64_bits(&mut self) {
        self.only_in_64_bits = true;
    }

    /// Whether its effort is beyond the limit.
    pub fn is_exhausted(&self) -> bool {
        self.effort() > self.most_effort
    }

    /// Decides whether `h` is in the cone of the present columns, and finds `f` if so.
    pub fn solve(&mut self) -> Membership {
        self.catch_up();
        self.lazy = false;
        self.answer()
    }

    /// Decides whether `h` is in the cone of the present columns, without passing every load on to the ground: where what
    /// is below was shown to bear (`bearing.rs`), the answer does not wait for its forces. [`Self::solve`] brings `f`
    /// and the residual up to date; until then both are those of an earlier moment there.
    pub fn decide(&mut self) -> Membership {
        self.answers_behind += 1;
        if self.answers_behind > MOST_BEHIND.max(self.rows.len() / 16) {
            return self.solve();
        }
        self.lazy = true;
        self.answer()
    }

    fn answer(&mut self) -> Membership {
        let limit = self.counts.pivots + 1000 + 50 * self.rows.len();
        let (mut rebuilt, mut refined) = (false, 0);
        self.group_closed = true;
        self.doubt = None;
        loop {
            let found = self.phase_one(limit);
            let sound = match found {
                Some(Membership::Inside) => {
                    self.certify_newest();
                    self.residual = self.imbalance();
                    if self.residual > ROUNDING {
                        self.behind = false; // the refinement passes everything on
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
            if !self.rebuild(&self.basis_set()) {
                return self.decide_extended();
            }
            self.recompute_values();
        }
    }
}

/// One finite entry of `h` and one positive unit for each row.
fn check(rows: usize, h: &[f64], unit: &[f64]) -> Result<(), LcpError> {
    if h.len() != rows || unit.len() != rows {
        let reason = format!("G has {rows} rows, h has {} and the units have {}", h.len(), unit.len());
        return Err(LcpError::Structure { reason });
    }
    if let Some(index) = h.iter().position(|value| !value.is_finite()) {
        return Err(LcpError::VectorNotFinite { index, value: h[index] });
    }
    match unit.iter().position(|&unit| unit.is_nan() || unit <= 0.0 || unit.is_infinite()) {
        Some(row) => Err(LcpError::Structure { reason: format!("the unit of row {row} is {}", unit[row]) }),
        None => Ok(()),
    }
}
