//! Going back: the state at a mark, restored from what was changed since.

use super::{Basic, Change, ConeSolver, keeping::BasisSet};
use serde::{Deserialize, Serialize};

/// A point to return to with [`ConeSolver::roll_back`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mark {
    changes: usize,
    factor: usize,
    /// Times the factor had been rebuilt: positions differ from one to the next.
    rebuilds: usize,
    overwritten: usize,
    /// Which list of overwritten values that is.
    values: usize,
    behind: bool,
    feasible: bool,
    /// Which list of changes.
    era: usize,
}

/// Overwritten values for each row of the problem that are kept at most; older ones are computed again where they are
/// wanted. Forces are seldom brought up to date more often than that on the way to where a search steps back from.
const OVERWRITTEN: usize = 64;

impl ConeSolver {
    /// The state as it is, to come back to with [`Self::roll_back`]. Marks are taken back last first.
    pub fn mark(&mut self) -> Mark {
        if self.overwritten.len() > OVERWRITTEN * self.basic.len() {
            self.lose_values();
        }
        self.marked = true;
        self.remembers = true;
        Mark {
            changes: self.changes.len(),
            factor: self.factor.mark(),
            rebuilds: self.counts.refactorisations,
            overwritten: self.overwritten.len(),
            values: self.values,
            behind: self.behind,
            feasible: self.suspects.is_empty(),
            era: self.era,
        }
    }

    /// Whether [`Self::roll_back`] restores every value from memory, which costs no more than what was changed since. If not,
    /// the values are computed from the mark's basis, and its factor may have to be built.
    pub fn remembers(&self, mark: Mark) -> bool {
        mark.era == self.era && mark.values == self.values
    }

    /// Pivots between a mark and the state as it is, without those that were taken back.
    pub fn pivots_since(&self, mark: Mark) -> usize {
        let pivots = |change: &&Change| matches!(change, Change::Pivot { .. });
        self.changes[mark.changes..].iter().filter(pivots).count()
    }

    /// Returns to a mark: bit for bit if it is [remembered](Self::remembers); else the values are computed again from its
    /// basis.
    ///
    /// # Panics
    /// If marks have ended since: by [`Self::forget`], or because rows or columns came to the problem or went from it.
    pub fn roll_back(&mut self, mark: Mark) {
        assert_eq!(mark.era, self.era, "a mark that has ended");
        let same_positions = mark.rebuilds == self.counts.refactorisations;
        let remembered = self.remembers(mark);
        let mut gone = std::mem::take(&mut self.rolled_back);
        let mut basis = if same_positions { BasisSet::default() } else { self.basis_set() };
        while self.changes.len() > mark.changes
            && let Some(change) = self.changes.pop()
        {
            self.take_back(change, (!same_positions).then_some(&mut basis), &mut gone);
            self.tally.count(self.rows.len());
        }
        if same_positions {
            self.factor.undo_to(mark.factor);
        }
        self.suspects.clear();
        if remembered {
            self.restore_values(mark);
        } else {
            self.lose_values();
            if !same_positions {
                self.rebuild(&basis);
            }
            self.recompute_values();
        }
        gone.retain(|&row| !self.present[row as usize]); // some had been there before
        self.forget_values(&gone);
        gone.clear();
        self.rolled_back = gone;
    }

    /// Undoes a change, the last first; rows that had come are noted as gone. A pivot is undone in `basis`, if that is given.
    fn take_back(&mut self, change: Change, basis: Option<&mut BasisSet>, gone: &mut Vec<u32>) {
        match (change, basis) {
            (Change::Pivot { position, entered, left }, Some(basis)) => {
                basis.take(position, entered);
                basis.put(position, left);
            }
            (Change::Pivot { position, entered, left }, None) => {
                if let Basic::Column(j) = entered {
                    self.take_out(j);
                }
                self.put(position, left);
            }
            (Change::Gone { row, group }, _) => {
                let member = self.rows.iter().copied().find(|&other| self.factor.group(other) == group);
                self.join_group(row, group, member);
                self.bring_row(row);
            }
            (Change::Bears(j), _) => self.bears[j as usize] = false,
            (Change::Doubted(j), _) => self.bears[j as usize] = true,
            (Change::Row(row), _) => {
                self.take_row(row);
                gone.push(row);
            }
        }
    }

    /// Puts the values of a mark back.
    fn restore_values(&mut self, mark: Mark) {
        while self.overwritten.len() > mark.overwritten
            && let Some((position, value)) = self.overwritten.pop()
        {
            self.set_value(position, value);
        }
        self.behind |= mark.behind;
        if !mark.feasible {
            self.suspects.clone_from(&self.rows);
        }
    }

    /// Nobody goes back from here: all marks end, and what was kept for them is given up.
    pub fn forget(&mut self) {
        self.changes.clear();
        self.factor.forget();
        self.lose_values();
        self.marked = false;
        self.era += 1;
    }

    /// From here on values come back by computation, not from memory.
    pub(super) fn lose_values(&mut self) {
        self.overwritten.clear();
        self.values += 1;
        self.remembers = false;
    }

    /// Notes a change, if there is a mark to go back to.
    pub(super) fn note(&mut self, change: Change) {
        if self.marked {
            self.changes.push(change);
        }
    }

    /// Notes a value that is about to be overwritten, if there is a mark that it belongs to.
    pub(super) fn remember(&mut self, p: u32) {
        if self.remembers {
            self.overwritten.push((p, self.x[p as usize]));
        }
    }
}
