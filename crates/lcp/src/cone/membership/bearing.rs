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
    {Basic, Change, ConeSolver, ROUNDED, ROUNDING},
};

/// Groups looked at before a value is taken to be behind.
const NEAREST: usize = 16;

impl ConeSolver {
    /// The direction without what bearing columns pass on.
    pub(super) fn direction_to_bearing(&mut self) {
        let Self { factor, spike, direction, basic, bears, behind, .. } = self;
        direction.clear();
        factor.walk_upper(spike, |p, rate| {
            direction.push((p, rate));
            match basic[p as usize] {
                Basic::Column(j) if bears[j as usize] && rate <= ROUNDED => {
                    *behind = true;
                    Reach::Group
                }
                _ => Reach::All,
            }
        });
    }

    /// Whether the value in a position may be larger than it says: something has not been passed on to its group, or to
    /// one that presses on it. Looks at the nearest groups only.
    pub(super) fn is_behind(&self, position: u32) -> bool {
        if !self.behind || !matches!(self.basic[position as usize], Basic::Column(j) if self.bears[j as usize]) {
            return false;
        }
        let mut above = vec![position];
        let mut looked_at = 0;
        while let Some(&first) = above.get(looked_at) {
            for row in self.rows_of_group(first) {
                if looked_at == NEAREST || self.balance[row as usize].abs() > ROUNDING * self.size {
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
        let bearing = self.g.columns_of(row).iter().map(|&(j, _)| j).filter(|&j| self.bears[j as usize]);
        let group = self.factor.group(row);
        bearing.map(|j| self.carried_row(j)).filter(move |&carried| self.factor.group(carried) != group)
    }

    /// The rows of a group, from one of them on.
    fn rows_of_group(&self, first: u32) -> impl Iterator<Item = u32> + '_ {
        std::iter::successors(Some(first), move |&row| {
            Some(self.next_in_group[row as usize]).filter(|&next| next != first)
        })
    }

    /// Brings the values up to date where loads have not been passed on.
    pub(super) fn catch_up(&mut self) {
        if std::mem::take(&mut self.behind) {
            self.sum_rows();
            self.refine();
        }
    }

    /// Looks which columns of the newest group bear (the bearing lemma).
    pub(super) fn certify_newest(&mut self) {
        if std::mem::take(&mut self.mixed) {
            return;
        }
        let newest = self.groups;
        for k in (0..self.rows.len()).rev() {
            let row = self.rows[k];
            if self.factor.group(row) != newest {
                break;
            }
            if let Basic::Column(j) = self.basic[row as usize]
                && !self.bears[j as usize]
                && self.is_borne(j)
            {
                self.bears[j as usize] = true;
                self.note(Change::Bears(j));
            }
        }
    }

    /// Whether what a column presses on older rows only raises forces that are borne.
    fn is_borne(&mut self, j: u32) -> bool {
        let newest = self.groups;
        self.spike.clear();
        for &(row, value) in self.g.column(j) {
            if self.factor.group(row) != newest {
                self.spike.set(row, value);
            }
        }
        if self.spike.index().is_empty() {
            return true; // on fixed bodies
        }
        self.factor.count_walks();
        self.factor.apply_operations(&mut self.spike);
        let Self { factor, spike, basic, bears, .. } = self;
        let mut borne = true;
        factor.walk_upper(spike, |p, rate| {
            borne &= match basic[p as usize] {
                Basic::Column(j) => bears[j as usize] && rate <= ROUNDED,
                Basic::Unit => rate.abs() <= ROUNDED,
            };
            Reach::Group
        });
        borne
    }

    /// The basis changes in a row: whatever presses on its group, or on what presses on it, is not known to bear any more.
    pub(super) fn distrust(&mut self, row: u32) {
        if self.factor.group(row) == self.groups {
            return; // nothing presses on the newest group
        }
        self.mixed = true;
        let mut doubtful = vec![row];
        while let Some(first) = doubtful.pop() {
            let (group, mut row) = (self.factor.group(first), first);
            loop {
                for e in 0..self.g.columns_of(row).len() {
                    let (j, _) = self.g.columns_of(row)[e];
                    if self.bears[j as usize] && self.column_group(j) != group {
                        self.bears_no_more(j);
                        doubtful.push(self.carried_row(j));
                    }
                }
                row = self.next_in_group[row as usize];
                if row == first {
                    break;
                }
            }
        }
    }

    /// A row of the newest group that a column touches.
    pub(super) fn carried_row(&self, j: u32) -> u32 {
        let rows = self.g.column(j).iter().map(|&(row, _)| row);
        rows.max_by_key(|&row| self.factor.group(row)).expect("a basic column has entries")
    }

    /// The newest group that a column touches.
    pub(super) fn column_group(&self, j: u32) -> u32 {
        self.factor.group(self.carried_row(j))
    }

    /// Puts a row that comes into the newest group, which is a new one if there was an answer in between.
    pub(super) fn join_newest_group(&mut self, row: u32) {
        if std::mem::take(&mut self.group_closed) {
            self.groups += 1;
            self.mixed = false;
        }
        self.join_group(row, self.groups, self.rows.last().copied());
    }

    /// Puts a row into a group, of which another row may be a member.
    pub(super) fn join_group(&mut self, row: u32, group: u32, member: Option<u32>) {
        self.factor.set_group(row, group);
        self.next_in_group[row as usize] = row;
        if let Some(member) = member.filter(|&member| self.factor.group(member) == group) {
            self.next_in_group.swap(member as usize, row as usize);
        }
    }

    /// Takes a row out of its group's ring.
    pub(super) fn leave_group(&mut self, row: u32) {
        let before = self.rows_of_group(row).last().expect("the row itself");
        self.next_in_group.swap(before as usize, row as usize);
    }
}
