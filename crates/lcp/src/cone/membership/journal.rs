//! Going back: the state at a mark, restored from what was changed since.

use super::{Basic, ConeSolver, basis::BasisSet, values::Values};
use serde::{Deserialize, Serialize};

/// What was done, in order, so that it can be taken back, last first. Empty unless somebody may come back: nothing is noted before the
/// first mark.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Journal {
    /// What to take back at a mark, and whether there is one.
    changes: Vec<Change>,
    marked: bool,
    /// Times all marks ended.
    era: usize,
    /// Values overwritten since the first mark whose values come back from memory, whether there is one, and how often
    /// they were lost.
    overwritten: Vec<(u32, f64)>,
    remembers: bool,
    generation: usize,
    /// Room for [`ConeSolver::roll_back`].
    #[serde(skip)]
    rolled_back: Vec<u32>,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) enum Change {
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

impl Journal {
    /// Notes a change, if there is a mark to go back to.
    pub fn note(&mut self, change: Change) {
        if self.marked {
            self.changes.push(change);
        }
    }

    /// Notes a value that is about to be overwritten, if there is a mark that it belongs to.
    pub fn remember(&mut self, position: u32, values: &Values) {
        if self.remembers {
            self.overwritten.push((position, values.basic[position as usize]));
        }
    }

    /// The same of many.
    pub fn remember_all(&mut self, positions: impl Iterator<Item = u32>, values: &Values) {
        if self.remembers {
            self.overwritten.extend(positions.map(|p| (p, values.basic[p as usize])));
        }
    }

    /// From here on values come back by computation, not from memory.
    pub fn lose_values(&mut self) {
        self.overwritten.clear();
        self.generation += 1;
        self.remembers = false;
    }

    /// All marks end.
    fn end(&mut self) {
        self.changes.clear();
        self.lose_values();
        self.marked = false;
        self.era += 1;
    }
}

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
        if self.journal.overwritten.len() > OVERWRITTEN * self.basis.basic.len() {
            self.journal.lose_values();
        }
        self.journal.marked = true;
        self.journal.remembers = true;
        Mark {
            changes: self.journal.changes.len(),
            factor: self.basis.factor.mark(),
            rebuilds: self.counts.refactorisations,
            overwritten: self.journal.overwritten.len(),
            values: self.journal.generation,
            behind: self.bearing.behind,
            feasible: self.values.suspects.is_empty(),
            era: self.journal.era,
        }
    }

    /// Whether [`Self::roll_back`] restores every value from memory, which costs no more than what was changed since. If not,
    /// the values are computed from the mark's basis, and its factor may have to be built.
    pub fn remembers(&self, mark: Mark) -> bool {
        mark.era == self.journal.era && mark.values == self.journal.generation
    }

    /// Pivots between a mark and the state as it is, without those that were taken back.
    pub fn pivots_since(&self, mark: Mark) -> usize {
        let pivots = |change: &&Change| matches!(change, Change::Pivot { .. });
        self.journal.changes[mark.changes..].iter().filter(pivots).count()
    }

    /// Returns to a mark: bit for bit if it is [remembered](Self::remembers); else the values are computed again from its
    /// basis.
    ///
    /// # Panics
    /// If marks have ended since: by [`Self::forget`], or because rows or columns came to the problem or went from it.
    pub fn roll_back(&mut self, mark: Mark) {
        assert_eq!(mark.era, self.journal.era, "a mark that has ended");
        let same_positions = mark.rebuilds == self.counts.refactorisations;
        let remembered = self.remembers(mark);
        let mut gone = std::mem::take(&mut self.journal.rolled_back);
        let mut basis = if same_positions { BasisSet::default() } else { self.basis.set(&self.present.rows) };
        while self.journal.changes.len() > mark.changes
            && let Some(change) = self.journal.changes.pop()
        {
            self.take_back(change, (!same_positions).then_some(&mut basis), &mut gone);
            self.tally.count(self.present.rows.len());
        }
        if same_positions {
            self.basis.factor.undo_to(mark.factor);
        }
        self.values.suspects.clear();
        if remembered {
            self.restore_values(mark);
        } else {
            self.journal.lose_values();
            if !same_positions {
                self.rebuild(&basis);
            }
            self.recompute_values();
        }
        gone.retain(|&row| !self.present.is_there[row as usize]); // some had been there before
        self.values.forget(&gone);
        gone.clear();
        self.journal.rolled_back = gone;
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
                self.basis.put(position, left);
            }
            (Change::Gone { row, group }, _) => {
                let member = self.present.rows.iter().copied().find(|&other| self.basis.factor.group(other) == group);
                self.join_group(row, group, member);
                self.present.bring(row, &self.problem.g);
            }
            (Change::Bears(j), _) => self.bearing.bears[j as usize] = false,
            (Change::Doubted(j), _) => self.bearing.bears[j as usize] = true,
            (Change::Row(row), _) => {
                self.take_row(row);
                gone.push(row);
            }
        }
    }

    /// Puts the values of a mark back.
    fn restore_values(&mut self, mark: Mark) {
        while self.journal.overwritten.len() > mark.overwritten
            && let Some((position, value)) = self.journal.overwritten.pop()
        {
            self.set_value(position, value);
        }
        self.bearing.behind |= mark.behind;
        if !mark.feasible {
            self.values.suspects.clone_from(&self.present.rows);
        }
    }

    /// Nobody goes back from here: all marks end, and what was kept for them is given up.
    pub fn forget(&mut self) {
        self.basis.factor.forget();
        self.journal.end();
    }
}
