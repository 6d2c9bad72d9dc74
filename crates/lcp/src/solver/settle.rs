//! What keeps a state right: complementarity after a change of rows or of `q`, the check of a result, repairs.

use super::{Checked, Load, ROUNDING, Role, Solver, largest};
use crate::interrupt::{or_else, poll};
use std::sync::Arc;

impl Solver {
    /// Puts row j into the active set. False if the factor refuses it.
    pub(super) fn enter(&mut self, j: usize) -> bool {
        let entered = self.factor.insert(&self.m, j).is_ok();
        if entered {
            self.counts.factor_rows += 1;
            self.active.insert(j);
        }
        entered
    }

    /// Takes row j out of the active set, with `z_j = 0`.
    pub(super) fn leave(&mut self, j: usize) {
        self.z[j] = 0.0;
        if self.active.contains(j) {
            self.counts.factor_rows += 1;
            self.factor.remove(j);
            self.active.remove(j);
        }
    }

    /// Makes the state a complementary start again after rows were taken out, `q` was changed, or a solve ended without an
    /// answer: `w = 0` and `z >= 0` on the active rows, `z = 0` elsewhere. Rows that are violated then wait to be driven; every
    /// other considered row stays guarded. From such a state each major cycle is finite and makes one more row a
    /// considered one, whatever the state was before.
    pub(super) fn settle(&mut self) {
        for j in 0..self.z.len() {
            if !self.active.contains(j) {
                self.z[j] = 0.0;
            }
        }
        self.driven = None;
        self.recompute_w();
        if self.active_residual() > ROUNDING * self.own_scale() && !self.settle_active() {
            self.refactor();
            self.recompute_w();
            if !self.settle_active() {
                self.restart();
            }
        }
        let threshold = self.violation();
        for j in 0..self.w.len() {
            if self.role[j] == Role::Considered && !self.active.contains(j) && self.w[j] < -threshold {
                self.role[j] = Role::Waiting;
            }
        }
        self.settled = true;
    }

    /// Recomputes every `w`, then as [`Self::check`].
    pub(super) fn recompute(&mut self) -> Checked {
        for z in &mut self.z {
            *z = z.max(0.0);
        }
        self.recompute_w();
        self.check()
    }

    /// Moves the active `z` so that the active `w` vanish, and judges the result. `w` has just been computed from `z`.
    pub(super) fn check(&mut self) -> Checked {
        if self.active_residual() > ROUNDING * self.own_scale() && !self.settle_active() {
            return Checked::LostAccuracy;
        }
        self.residual = self.residual_of_w();
        if self.most_violated().is_some_and(|i| !self.active.contains(i)) {
            Checked::StillViolated
        } else if self.residual <= self.settings.residual {
            Checked::Solved
        } else {
            Checked::LostAccuracy
        }
    }

    /// Largest `|w|` on the active rows, where it should be zero.
    pub(super) fn active_residual(&self) -> f64 {
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
            self.counts.entries_solved += self.factor.solve(&mut correction);
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
                self.leave(j);
            }
            self.recompute_w();
            if leaving.is_none() {
                return true;
            }
        }
    }

    pub(super) fn recompute_w(&mut self) {
        self.w.copy_from_slice(&self.load.scaled);
        let mut work = self.z.len();
        for j in 0..self.z.len() {
            if self.z[j] != 0.0 {
                self.m.add_column(j, self.z[j], &mut self.w);
                work += self.m.column(j).0.len();
            }
        }
        poll(work);
    }

    /// Builds the factor again. Rows that it refuses leave the active set, and the state is to be settled then.
    pub(super) fn refactor(&mut self) {
        self.counts.refactorisations += 1;
        self.factor.clear();
        let members = self.active.members().to_vec();
        self.active.clear();
        for j in members {
            if !self.enter(j) {
                self.z[j] = 0.0;
                self.settled = false;
            }
        }
    }

    /// Does something that may be stopped on the way; if it is, the rows and `q` are what they were, and the next solve begins
    /// from nothing.
    pub(super) fn or_as_before<T>(&mut self, change: impl FnOnce(&mut Self) -> T) -> T {
        let (role, load) = (self.role.clone(), Arc::clone(&self.load));
        or_else(self, change, |solver| solver.begin_anew(&role, load))
    }

    /// From whatever was left behind: these rows, this load, and nothing else.
    pub(super) fn begin_anew(&mut self, role: &[Role], load: Arc<Load>) {
        self.take_load(load);
        self.role.copy_from_slice(role);
        self.measure_q();
        self.dz.fill(0.0);
        self.moving.clear();
        self.dw.fill(0.0);
        self.reached.clear();
        self.is_reached.fill(false);
        self.ray = None;
        self.restart();
    }

    /// Forgets everything but which rows are present.
    pub(super) fn restart(&mut self) {
        self.counts.refactorisations += 1;
        self.factor.clear();
        self.active.clear();
        self.z.fill(0.0);
        self.driven = None;
        self.settled = true;
        for role in &mut self.role {
            if *role == Role::Considered {
                *role = Role::Waiting;
            }
        }
        self.recompute_w();
    }

    /// The scale of the present rows' problem, see [`crate::Settings`]. Only active rows and the driven one have `z > 0`.
    pub(super) fn own_scale(&self) -> f64 {
        let driven = self.driven.map_or(0.0, |i| self.z[i].abs());
        largest(&self.z, self.active.members()).max(driven).max(self.q_size)
    }

    /// Largest scaled `q` of a present row.
    pub(super) fn measure_q(&mut self) {
        let present = (0..self.role.len()).filter(|&i| self.role[i] != Role::Absent);
        self.q_size = present.fold(0.0, |size, i| size.max(self.load.scaled[i].abs()));
    }

    /// `max |min(z, w)|` over the present rows, in the problem's own scale, from a fresh `w = M z + q`.
    pub(super) fn present_residual(&mut self) -> f64 {
        self.recompute_w();
        self.residual_of_w()
    }

    /// The same from the present `w`, which has just been computed from `z`.
    fn residual_of_w(&self) -> f64 {
        let (mut worst, mut size) = (0.0_f64, self.q_size);
        for i in (0..self.z.len()).filter(|&i| self.role[i] != Role::Absent) {
            worst = worst.max(self.z[i].min(self.w[i]).abs());
            size = size.max(self.z[i].abs());
        }
        if worst == 0.0 { 0.0 } else { worst / size }
    }
}
