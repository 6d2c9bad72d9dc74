//! From one problem to the next, of which a part is the same: the simulation's case, where some bodies move.
//!
//! A row's entries are the products of its generator with those of the rows it shares a body with. Between two rows
//! whose generators stayed, the entry stays, and so does their part of the factor. Rows whose generators moved leave the
//! factor, take their new entries and come back with the `z` they had; rows that are gone leave for good. The next solve then
//! settles the state and goes on from there, as after any change (`settle.rs`).

use super::{Load, Role, Solver};
use crate::{
    error::LcpError,
    factor::{self, ActiveFactor},
    interrupt::or_else,
    matrix::SparseColumns,
    problem::Problem,
    scaling::Scaling,
};
use std::{cell::Cell, sync::Arc};

/// Where a row of the new problem comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// It is new, and absent until it is added.
    New,
    /// It was this row, with other entries.
    Moved(usize),
    /// It was this row, and its entries with every other `Same` row are bit for bit what they were.
    Same(usize),
}

impl Origin {
    /// The row that it was, if it was there.
    pub fn old(self) -> Option<usize> {
        match self {
            Self::New => None,
            Self::Moved(old) | Self::Same(old) => Some(old),
        }
    }
}

/// A row that moved comes back into the factor if its pivot (unit diagonal) is above this; else it waits, and is driven like
/// any other if it is violated. A direction through such a row could be 1e5 long, and cost as many digits.
const COMES_BACK: f64 = 1e-10;

/// The problem and its scaling from before.
type Before = Cell<Option<(Problem, Scaling)>>;

impl Solver {
    /// Goes over to another problem. `origins` (n) says which row each of its rows was; what the rows were (present or not,
    /// active, `z`) they are again. Returns the number of active rows that stayed in the factor untouched.
    ///
    /// # Errors
    /// [`LcpError::Origins`], [`LcpError::RowChanged`] if two rows are not what they are said to be, and as
    /// [`Self::new`]; nothing has changed then.
    pub fn follow(&mut self, problem: Problem, origins: &[Origin]) -> Result<usize, LcpError> {
        problem.require_symmetric()?;
        let (role, load) = (self.role.clone(), Arc::clone(&self.load));
        let before = Cell::new(None);
        let go_over = |solver: &mut Self| solver.go_over(problem, origins, &before);
        or_else(self, go_over, |solver| {
            if let Some((problem, scaling)) = before.take() {
                solver.m = Arc::new(problem.m().scaled_symmetrically(&scaling.d));
                (solver.problem, solver.scaling) = (problem, scaling);
            }
            solver.begin_anew(&role, load);
        })
    }

    /// The old problem goes to `before` as soon as it is not this solver's any more.
    fn go_over(&mut self, problem: Problem, origins: &[Origin], before: &Before) -> Result<usize, LcpError> {
        let place = self.places(problem.len(), origins)?;
        let in_place = place.len() == origins.len() && place.iter().enumerate().all(|(i, &new)| new == Some(i));
        if in_place && problem.m().same_pattern(&self.m) {
            return self.follow_in_place(problem, origins, before);
        }
        let scaling = Scaling::new(&problem);
        let m = problem.m().scaled_symmetrically(&scaling.d);
        self.require_same(&m, origins)?;

        let stays = |&old: &usize| place[old].is_some_and(|new| origins[new] == Origin::Same(old));
        let (staying, leaving): (Vec<usize>, Vec<usize>) = self.active.members().iter().partition(|old| stays(old));
        self.take_out(&leaving);
        let (factor, kept) = self.carried_factor(&m, &place);
        let mut next = Self::assembled(problem, scaling, m, factor, self.settings.clone());
        next.counts = self.counts;
        next.counts_at_solve = self.counts_at_solve;
        next.take_over(self, origins, &place);
        for i in staying.iter().filter_map(|&old| place[old]) {
            if kept {
                next.active.insert(i);
            } else {
                next.come_back(i);
            }
        }
        leaving.iter().filter_map(|&old| place[old]).for_each(|i| next.come_back(i));
        next.recompute_w();
        *self = next;
        Ok(if kept { staying.len() } else { 0 })
    }

    /// The same for a problem with the same rows, of which some have other entries at the same places.
    fn follow_in_place(&mut self, problem: Problem, origins: &[Origin], before: &Before) -> Result<usize, LcpError> {
        let moved = |i: usize| matches!(origins[i], Origin::Moved(_));
        for column in (0..problem.len()).filter(|&column| !moved(column)) {
            let ((rows, values), (_, old)) = (problem.m().column(column), self.problem.m().column(column));
            for ((&row, &value), &before) in rows.iter().zip(values).zip(old) {
                if value != before && !moved(row) {
                    return Err(LcpError::RowChanged { row, column, value, before });
                }
            }
        }
        let leaving: Vec<usize> = self.active.members().iter().copied().filter(|&i| moved(i)).collect();
        let stayed = self.active.members().len() - leaving.len();
        self.take_out(&leaving);
        leaving.iter().for_each(|&i| self.active.remove(i));
        let scaling = self.scaling.after(&problem, moved);
        let old_scaling = std::mem::replace(&mut self.scaling, scaling);
        let d = &self.scaling.d;
        for i in (0..origins.len()).filter(|&i| self.role[i] != Role::Absent) {
            self.settled &= !moved(i) && self.load.q[i] == problem.q()[i];
            self.z[i] *= old_scaling.d[i] / d[i];
        }
        let scaled = d.iter().zip(problem.q()).map(|(d, q)| d * q).collect();
        self.load = Arc::new(Load { q: problem.q().to_vec(), scaled });
        self.driven = None;
        before.set(Some((std::mem::replace(&mut self.problem, problem), old_scaling)));
        Arc::make_mut(&mut self.m).scale_again(self.problem.m(), &self.scaling.d, moved);
        leaving.into_iter().for_each(|i| self.come_back(i));
        self.measure_q();
        // Where something has changed the next solve computes w; else it is what it was.
        Ok(stayed)
    }

    /// Takes active rows out of the factor, and leaves everything else as it is.
    fn take_out(&mut self, rows: &[usize]) {
        for &row in rows {
            self.counts.factor_rows += 1;
            self.factor.remove(row);
        }
    }

    /// The new number of every old row, if it has one.
    fn places(&self, n: usize, origins: &[Origin]) -> Result<Vec<Option<usize>>, LcpError> {
        if origins.len() != n {
            let reason = format!("{} origins for a problem with {n} rows", origins.len());
            return Err(LcpError::Origins { reason });
        }
        let mut place = vec![None; self.role.len()];
        for (i, old) in origins.iter().enumerate().filter_map(|(i, origin)| Some((i, origin.old()?))) {
            if old >= place.len() {
                return Err(LcpError::RowOutOfRange { row: old, n: place.len() });
            }
            if place[old].replace(i).is_some() {
                return Err(LcpError::Origins { reason: format!("two rows come from row {old}") });
            }
        }
        Ok(place)
    }

    fn require_same(&self, m: &SparseColumns, origins: &[Origin]) -> Result<(), LcpError> {
        for (column, origin) in origins.iter().enumerate() {
            let &Origin::Same(old_column) = origin else { continue };
            let (rows, values) = m.column(column);
            for (&row, &value) in rows.iter().zip(values) {
                let Origin::Same(old_row) = origins[row] else { continue };
                let before = self.m.get(old_row, old_column);
                if before != value {
                    return Err(LcpError::RowChanged { row, column, value, before });
                }
            }
        }
        Ok(())
    }

    /// The factor for a matrix of another pattern, and whether it still holds the rows that stayed.
    fn carried_factor(&self, m: &SparseColumns, place: &[Option<usize>]) -> (Box<dyn ActiveFactor>, bool) {
        let chosen = factor::choose(m);
        let dense = chosen.renumbered(0, &[]).is_some();
        match self.factor.renumbered(m.len(), place).filter(|_| dense) {
            Some(factor) => (factor, true),
            None => (chosen, false),
        }
    }

    /// Roles, values and whether the state is settled; not yet the active set.
    fn take_over(&mut self, before: &Self, origins: &[Origin], place: &[Option<usize>]) {
        self.settled = before.settled;
        for (i, old) in origins.iter().enumerate().filter_map(|(i, origin)| Some((i, origin.old()?))) {
            self.role[i] = before.role[old];
            self.z[i] = before.z[old] * (before.scaling.d[old] / self.scaling.d[i]);
            let same = origins[i] == Origin::Same(old) && before.load.q[old] == self.load.q[i];
            self.settled &= same || self.role[i] == Role::Absent;
        }
        self.settled &= place.iter().zip(&before.z).all(|(new, &z)| new.is_some() || z == 0.0);
        self.measure_q();
    }

    /// Puts an active row back into the factor, or lets it wait.
    fn come_back(&mut self, i: usize) {
        self.counts.factor_rows += 1;
        match self.factor.insert(&self.m, i) {
            Ok(pivot) if pivot > COMES_BACK => self.active.insert(i),
            refused => {
                if refused.is_ok() {
                    self.factor.remove(i);
                }
                self.settled &= self.z[i] == 0.0;
                self.z[i] = 0.0;
            }
        }
    }
}
