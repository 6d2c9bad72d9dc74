//! States of a solver to return to.

use super::{Load, Snapshot, Solver};
use crate::error::LcpError;
use std::sync::Arc;

impl Solver {
    /// The state, to come back to with [`Self::restore`]: which rows are present, `q`, and the active rows with their
    /// values. Taken after a solve it is a solved state, and going back to it costs no pivot.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            matrix: Arc::clone(&self.m),
            load: Arc::clone(&self.load),
            role: self.role.clone(),
            active: self.active.members().iter().map(|&i| (i, self.z[i])).collect(),
            settled: self.settled,
        }
    }

    /// Returns to a snapshot of this solver. The factor is moved by the rows in which the active sets differ. Work
    /// counts go on.
    ///
    /// # Errors
    /// [`LcpError::ForeignSnapshot`] for a snapshot of another solver; nothing has changed then.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), LcpError> {
        if !Arc::ptr_eq(&self.m, &snapshot.matrix) {
            return Err(LcpError::ForeignSnapshot);
        }
        self.or_as_before(|solver| solver.go_to(snapshot));
        Ok(())
    }

    fn go_to(&mut self, snapshot: &Snapshot) {
        if !Arc::ptr_eq(&self.load, &snapshot.load) {
            self.take_load(Arc::clone(&snapshot.load));
        }
        self.role.copy_from_slice(&snapshot.role);
        self.measure_q();
        self.z.fill(0.0);
        self.driven = None;
        self.settled = snapshot.settled;
        let mut wanted = vec![false; self.z.len()];
        for &(i, z) in &snapshot.active {
            wanted[i] = true;
            self.z[i] = z;
        }
        for i in self.active.members().to_vec() {
            if !wanted[i] {
                self.leave(i);
            }
        }
        let mut refused = Vec::new();
        for &(i, _) in &snapshot.active {
            if !self.active.contains(i) && !self.enter(i) {
                refused.push(i);
            }
        }
        if !refused.is_empty() {
            self.refactor();
            for i in refused {
                if !self.enter(i) {
                    self.z[i] = 0.0;
                    self.settled = false;
                }
            }
        }
        self.recompute_w();
    }

    pub(super) fn take_load(&mut self, load: Arc<Load>) {
        self.problem.set_q(&load.q);
        self.load = load;
    }
}
