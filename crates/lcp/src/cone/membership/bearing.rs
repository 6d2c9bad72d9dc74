//! What has been shown to bear load need not be walked through again.
//!
//! Rows that come between two answers are a group, mostly those of one block. A basic column belongs to the newest group it
//! touches, the block that it carries, and presses on older ones. It *bears* if however hard it is
//! pressed, the forces below only grow:
//!
//! ```text
//! B^-1 r has no entry that lowers a force or moves a unit column,   r = what a unit of the column does to older rows
//! ```
//!
//! *The bearing lemma.* Let every pivot of a solve have put a column of the newest group into a row of that group. A column of it
//! bears if `B^-1 r`, walked through the groups it presses on and no further, raises none but bearing columns.
//! *Proof.* `B` is block triangular by groups: what r reaches beyond these groups is the sum of what the bearing
//! columns raised pass on, and that only raises forces, by induction on the groups.
//!
//! So a walk may stop at a bearing column whose force grows. The values of bearing columns are then too small, never too
//! large, and what they lack stands in the balance of the rows that were not told. If such a value, smaller than it
//! ought to be, is the one to block a step, all values are brought up to date first.
//!
//! A column bears as long as no column of the groups that it presses on leaves or stops bearing.

use super::{
    super::basis_factor::Reach,
    basis::OUT,
    journal::{Change, Journal},
    {Basic, ConeSolver, ROUNDED, ROUNDING},
};
use serde::{Deserialize, Serialize};

/// Groups of rows, which columns are known to bear, and how far the values below these lag behind.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Bearing {
    /// Of each column.
    pub bears: Vec<bool>,
    /// Number of the newest group of rows, whether the next row starts another, and the groups' rows as rings.
    pub groups: u32,
    pub group_closed: bool,
    next_in_group: Vec<u32>,
    /// The newest group has pivots in other groups' rows, or other groups' columns.
    pub mixed: bool,
    /// Values below bearing columns are not up to date, for how many answers, and whether that is allowed.
    pub behind: bool,
    pub answers_behind: usize,
    pub lazy: bool,
}

impl Bearing {
    pub fn unknown(rows: usize, columns: usize) -> Self {
        Self {
            bears: vec![false; columns],
            groups: 0,
            group_closed: true,
            next_in_group: vec![OUT; rows],
            mixed: false,
            behind: false,
            answers_behind: 0,
            lazy: false,
        }
    }

    /// The rows of a group, from one of them on.
    fn rows_of_group(&self, first: u32) -> impl Iterator<Item = u32> + '_ {
        std::iter::successors(Some(first), move |&row| {
            Some(self.next_in_group[row as usize]).filter(|&next| next != first)
        })
    }

    /// A column is not known to bear any more.
    pub fn doubt(&mut self, j: u32, journal: &mut Journal) {
        if std::mem::take(&mut self.bears[j as usize]) {
            journal.note(Change::Doubted(j));
        }
    }

    pub fn resize(&mut self, rows: usize, columns: usize) {
        self.bears.resize(columns, false);
        self.next_in_group.resize(rows, OUT);
    }
}

/// Groups looked at before a value is taken to be behind.
const NEAREST: usize = 16;

impl ConeSolver {
    /// The direction without what bearing columns pass on.
    pub(super) fn direction_to_bearing(&mut self) {
        let Self { basis, pivot, bearing, .. } = self;
        pivot.direction.clear();
        basis.factor.walk_upper(&pivot.spike, |p, rate| {
            pivot.direction.push((p, rate));
            match basis.basic[p as usize] {
                Basic::Column(j) if bearing.bears[j as usize] && rate <= ROUNDED => {
                    bearing.behind = true;
                    Reach::Group
                }
                _ => Reach::All,
            }
        });
    }

    /// Whether the value in a position may be larger than it says: something has not been passed on to its group, or to
    /// one that presses on it. Looks at the nearest groups only.
    pub(super) fn is_behind(&self, position: u32) -> bool {
        if !self.bearing.behind
            || !matches!(self.basis.basic[position as usize], Basic::Column(j) if self.bearing.bears[j as usize])
        {
            return false;
        }
        let mut above = vec![position];
        let mut looked_at = 0;
        while let Some(&first) = above.get(looked_at) {
            for row in self.bearing.rows_of_group(first) {
                if looked_at == NEAREST || self.balance.sums[row as usize].abs() > ROUNDING * self.balance.size {
                    return true;
                }
                above.extend(self.bearing_on(row));
            }
            looked_at += 1;
        }
        false
    }

    /// A row of each newer group that presses on a row by a column that bears.
    fn bearing_on(&self, row: u32) -> impl Iterator<Item = u32> + '_ {
        let bearing =
            self.problem.g.columns_of(row).iter().map(|&(j, _)| j).filter(|&j| self.bearing.bears[j as usize]);
        let group = self.basis.factor.group(row);
        bearing.map(|j| self.carried_row(j)).filter(move |&carried| self.basis.factor.group(carried) != group)
    }

    /// Brings the values up to date where loads have not been passed on.
    pub(super) fn catch_up(&mut self) {
        if std::mem::take(&mut self.bearing.behind) {
            self.sum_rows();
            self.refine();
        }
    }

    /// Looks which columns of the newest group bear (the bearing lemma).
    pub(super) fn certify_newest(&mut self) {
        if std::mem::take(&mut self.bearing.mixed) {
            return;
        }
        let newest = self.bearing.groups;
        for k in (0..self.present.rows.len()).rev() {
            let row = self.present.rows[k];
            if self.basis.factor.group(row) != newest {
                break;
            }
            if let Basic::Column(j) = self.basis.basic[row as usize]
                && !self.bearing.bears[j as usize]
                && self.is_borne(j)
            {
                self.bearing.bears[j as usize] = true;
                self.journal.note(Change::Bears(j));
            }
        }
    }

    /// Whether what a column presses on older rows only raises forces that are borne.
    fn is_borne(&mut self, j: u32) -> bool {
        let newest = self.bearing.groups;
        self.pivot.spike.clear();
        for &(row, value) in self.problem.g.column(j) {
            if self.basis.factor.group(row) != newest {
                self.pivot.spike.set(row, value);
            }
        }
        if self.pivot.spike.index().is_empty() {
            return true; // on fixed bodies
        }
        self.basis.factor.count_walks();
        self.basis.factor.apply_operations(&mut self.pivot.spike);
        let Self { basis, pivot, bearing, .. } = self;
        let mut borne = true;
        basis.factor.walk_upper(&pivot.spike, |p, rate| {
            borne &= match basis.basic[p as usize] {
                Basic::Column(j) => bearing.bears[j as usize] && rate <= ROUNDED,
                Basic::Unit => rate.abs() <= ROUNDED,
            };
            Reach::Group
        });
        borne
    }

    /// The basis changes in a row: whatever presses on its group, or on what presses on it, is not known to bear any more.
    pub(super) fn distrust(&mut self, row: u32) {
        if self.basis.factor.group(row) == self.bearing.groups {
            return; // nothing presses on the newest group
        }
        self.bearing.mixed = true;
        let mut doubtful = vec![row];
        while let Some(first) = doubtful.pop() {
            let (group, mut row) = (self.basis.factor.group(first), first);
            loop {
                for e in 0..self.problem.g.columns_of(row).len() {
                    let (j, _) = self.problem.g.columns_of(row)[e];
                    if self.bearing.bears[j as usize] && self.column_group(j) != group {
                        self.bearing.doubt(j, &mut self.journal);
                        doubtful.push(self.carried_row(j));
                    }
                }
                row = self.bearing.next_in_group[row as usize];
                if row == first {
                    break;
                }
            }
        }
    }

    /// A row of the newest group that a column touches.
    pub(super) fn carried_row(&self, j: u32) -> u32 {
        let rows = self.problem.g.column(j).iter().map(|&(row, _)| row);
        rows.max_by_key(|&row| self.basis.factor.group(row)).expect("a basic column has entries")
    }

    /// The newest group that a column touches.
    pub(super) fn column_group(&self, j: u32) -> u32 {
        self.basis.factor.group(self.carried_row(j))
    }

    /// Puts a row that comes into the newest group, which is a new one if there was an answer in between.
    pub(super) fn join_newest_group(&mut self, row: u32) {
        if std::mem::take(&mut self.bearing.group_closed) {
            self.bearing.groups += 1;
            self.bearing.mixed = false;
        }
        self.join_group(row, self.bearing.groups, self.present.rows.last().copied());
    }

    /// Puts a row into a group, of which another row may be a member.
    pub(super) fn join_group(&mut self, row: u32, group: u32, member: Option<u32>) {
        self.basis.factor.set_group(row, group);
        self.bearing.next_in_group[row as usize] = row;
        if let Some(member) = member.filter(|&member| self.basis.factor.group(member) == group) {
            self.bearing.next_in_group.swap(member as usize, row as usize);
        }
    }

    /// Takes a row out of its group's ring.
    pub(super) fn leave_group(&mut self, row: u32) {
        let before = self.bearing.rows_of_group(row).last().expect("the row itself");
        self.bearing.next_in_group.swap(before as usize, row as usize);
    }
}
