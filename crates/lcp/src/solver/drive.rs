//! The pivots: major cycles that drive one row each, and the minor cycles within them.

use super::{CURVATURE_ROUNDING, Cycle, REFINE, Role, STALL, Solver, largest, take};
use crate::{
    error::LcpError,
    interrupt::poll,
    ratio::{Blocker, Candidate, TieRule, ratio_test},
};

impl Solver {
    pub(super) fn drive_all(&mut self, limit: usize, go_on: &mut dyn FnMut() -> bool) -> Result<Cycle, LcpError> {
        while let Some(i) = self.most_violated() {
            if !go_on() {
                return Ok(Cycle::Stopped);
            }
            let cycle = self.major_cycle(i, limit)?;
            if cycle != Cycle::Feasible {
                return Ok(cycle);
            }
            if !self.settled {
                return Ok(Cycle::LostAccuracy);
            }
        }
        Ok(Cycle::Feasible)
    }

    /// The present row with the most negative `w`; the least index among equals, so that rounding does not
    /// decide the order of a symmetric structure.
    pub(super) fn most_violated(&self) -> Option<usize> {
        const EQUAL: f64 = 1e-9;
        let threshold = self.violation();
        let violated = |&i: &usize| self.w[i] < -threshold && self.role[i] != Role::Absent;
        let worst = (0..self.w.len()).filter(violated).map(|i| self.w[i]).reduce(f64::min)?;
        (0..self.w.len()).filter(violated).find(|&i| self.w[i] <= worst * (1.0 - EQUAL))
    }

    /// How far below zero a `w` counts as violated.
    pub(super) fn violation(&self) -> f64 {
        self.settings.feasibility * self.own_scale()
    }

    /// Drives `z_i` up until `w_i` is zero, keeping every row considered before feasible.
    fn major_cycle(&mut self, i: usize, limit: usize) -> Result<Cycle, LcpError> {
        self.role[i] = Role::Considered;
        self.driven = Some(i);
        self.counts.major_cycles += 1;
        let mut stalled = 0;
        loop {
            if self.counts.pivots >= limit {
                return Ok(Cycle::Limit);
            }
            self.direction(i);
            let size = largest(&self.dz, self.active.members()).max(1.0);
            let slope = self.curvature(i);
            if slope.is_nan() {
                return Ok(Cycle::LostAccuracy);
            }
            if slope < -self.settings.residual * size * size {
                return Err(LcpError::NotSemidefinite { index: i, curvature: slope });
            }
            self.collect_candidates(i, slope, size);
            let rule = if stalled > STALL * (self.active.members().len() + 4) {
                TieRule::LeastIndex
            } else {
                TieRule::LargestRate
            };
            let slack = 0.1 * self.violation();
            let Some((step, blocker)) = ratio_test(&self.candidates, slack, rule) else {
                if self.w[i] < -self.violation() {
                    return self.certify_ray(i, size);
                }
                // Minor cycles have made the row feasible, and it depends on the active rows.
                self.admit(i);
                return Ok(Cycle::Feasible);
            };
            stalled = if step * size > slack { 0 } else { stalled + 1 };
            self.advance(i, step);
            if !self.exchange(i, blocker) {
                return Ok(Cycle::LostAccuracy);
            }
            if blocker == Blocker::Driving {
                return Ok(Cycle::Feasible);
            }
        }
    }

    /// The direction in which only `z_i` and the active `z` move and the active `w` stay zero:
    /// `dz_i = 1`, `dz_C = -M_CC^-1 M_Ci`, `dw = M dz`.
    fn direction(&mut self, i: usize) {
        self.solve_direction(i);
        self.multiply_direction(i);
        let size = largest(&self.dz, self.active.members()).max(1.0);
        if largest(&self.dw, self.active.members()) > REFINE * size {
            let mut correction = vec![0.0; self.dz.len()];
            for &j in self.active.members() {
                correction[j] = -self.dw[j];
            }
            self.counts.entries_solved += self.factor.solve(&mut correction);
            for &j in self.active.members() {
                self.dz[j] += correction[j];
            }
            self.multiply_direction(i);
        }
    }

    /// `dz` of [`Self::direction`], as accurate as the factor.
    pub(super) fn solve_direction(&mut self, i: usize) {
        for &j in &self.moving {
            self.dz[j] = 0.0;
        }
        self.moving.clear();
        self.moving.extend_from_slice(self.active.members());
        self.moving.push(i);
        let (rows, values) = self.m.column(i);
        for (&j, &value) in rows.iter().zip(values) {
            if self.active.contains(j) {
                self.dz[j] = -value;
            }
        }
        self.counts.entries_solved += self.factor.solve(&mut self.dz);
        self.dz[i] = 1.0;
    }

    /// `dw = M dz`, and the rows that it reaches.
    fn multiply_direction(&mut self, i: usize) {
        for j in self.reached.drain(..) {
            self.dw[j] = 0.0;
            self.is_reached[j] = false;
        }
        let mut work = self.w.len() + self.add_to_dw(i, 1.0);
        for k in 0..self.active.members().len() {
            let j = self.active.members()[k];
            if self.dz[j] != 0.0 {
                work += self.add_to_dw(j, self.dz[j]);
            }
        }
        poll(work);
    }

    /// Returns the number of entries.
    fn add_to_dw(&mut self, j: usize, factor: f64) -> usize {
        let (rows, values) = self.m.column(j);
        for (&i, &value) in rows.iter().zip(values) {
            self.dw[i] += factor * value;
            if !std::mem::replace(&mut self.is_reached[i], true) {
                self.reached.push(i);
            }
        }
        rows.len()
    }

    /// `dz' M dz`, which equals `dw_i` but for the error of the active `dw`: that enters `dw_i` multiplied by the direction's
    /// size and here by nothing.
    fn curvature(&self, i: usize) -> f64 {
        self.dw[i] + self.active.members().iter().map(|&j| self.dz[j] * self.dw[j]).sum::<f64>()
    }

    /// Curvature at or below which row i depends on the active rows. Rounding in `M` alone, one unit in the last place of
    /// a unit diagonal, changes `dz' M dz` by the square of the direction's size.
    fn least_slope(&self, size: f64) -> f64 {
        (self.settings.singular * size).max(CURVATURE_ROUNDING * size * size)
    }

    /// Everything that falls towards zero: `w_i` of the driving row, active `z`, and `w` of considered rows. Their order
    /// does not matter to the ratio test.
    fn collect_candidates(&mut self, i: usize, slope: f64, size: f64) {
        let floor = self.settings.pivot * size;
        self.candidates.clear();
        if slope > self.least_slope(size) {
            self.candidates.push(Candidate { blocker: Blocker::Driving, value: (-self.w[i]).max(0.0), rate: slope });
        }
        for &j in self.active.members() {
            if self.dz[j] < -floor {
                self.candidates.push(Candidate { blocker: Blocker::Leaves(j), value: self.z[j], rate: -self.dz[j] });
            }
        }
        for &j in &self.reached {
            if self.dw[j] < -floor && self.role[j] == Role::Considered && j != i && !self.active.contains(j) {
                self.candidates.push(Candidate {
                    blocker: Blocker::Enters(j),
                    value: self.w[j].max(0.0),
                    rate: -self.dw[j],
                });
            }
        }
    }

    fn advance(&mut self, i: usize, step: f64) {
        if step == 0.0 {
            return;
        }
        self.z[i] += step;
        for &j in self.active.members() {
            self.z[j] += step * self.dz[j];
        }
        for &j in &self.reached {
            self.w[j] += step * self.dw[j];
        }
    }

    /// One pivot. False if the factor refuses it.
    fn exchange(&mut self, driving: usize, blocker: Blocker) -> bool {
        self.counts.pivots += 1;
        self.counts.minor_cycles += usize::from(blocker != Blocker::Driving);
        match blocker {
            Blocker::Leaves(j) => {
                self.leave(j);
                true
            }
            Blocker::Enters(_) | Blocker::Driving => {
                let j = if let Blocker::Enters(j) = blocker { j } else { driving };
                self.w[j] = 0.0;
                self.insert_or_refactor(j)
            }
        }
    }

    pub(super) fn insert_or_refactor(&mut self, j: usize) -> bool {
        if self.enter(j) {
            return true;
        }
        self.refactor();
        self.settled && self.enter(j)
    }

    /// Nothing blocks the direction: y = dz then proves that there is no solution, if `M y = 0`, `y >= 0`, `q' y < 0`.
    /// `y' M y = 0` with `(M y)_j = a` not zero is negative curvature: `y - a e_j` has `-a^2` (unit diagonal).
    fn certify_ray(&mut self, i: usize, size: f64) -> Result<Cycle, LcpError> {
        let y: Vec<f64> = self.dz.iter().map(|&value| value.max(0.0)).collect();
        let image = self.m.multiply_add(&y, &vec![0.0; y.len()]);
        let worst =
            (0..y.len()).filter(|&j| self.role[j] != Role::Absent).fold(0.0_f64, |worst, j| worst.max(image[j].abs()));
        let progress: f64 = y.iter().zip(&self.load.scaled).map(|(y, q)| y * q).sum();
        if worst * worst > self.settings.residual * size * size {
            return Err(LcpError::NotSemidefinite { index: i, curvature: -worst * worst });
        }
        if worst > self.settings.residual * size || progress >= 0.0 {
            return Ok(Cycle::LostAccuracy);
        }
        self.ray = Some(y.iter().zip(&self.scaling.d).map(|(y, d)| y * d).collect());
        self.residual = self.present_residual();
        Ok(Cycle::Ray)
    }

    /// Puts a row with `w_i = 0` and `z_i >= 0` into the factor. Where it depends on the rows already there, the values are
    /// moved along the null direction, which changes no `w`, until one of them is zero and leaves.
    pub(super) fn admit(&mut self, i: usize) {
        loop {
            self.direction(i);
            let size = largest(&self.dz, self.active.members()).max(1.0);
            if self.curvature(i) > self.least_slope(size) {
                if !self.insert_or_refactor(i) {
                    self.settled = false;
                }
                return;
            }
            let leaving = self
                .active
                .members()
                .iter()
                .filter(|&&j| self.dz[j] > self.settings.pivot * size)
                .map(|&j| (self.z[j] / self.dz[j], j))
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
                .filter(|&(step, _)| step < self.z[i]);
            let step = leaving.map_or(self.z[i], |(step, _)| step);
            for &j in self.active.members() {
                self.z[j] = take(self.z[j], step * self.dz[j]);
            }
            self.z[i] = take(self.z[i], step);
            let Some((_, j)) = leaving else { return };
            self.leave(j);
            if self.z[i] == 0.0 {
                return;
            }
        }
    }
}
