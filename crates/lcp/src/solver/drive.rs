//! The pivots: major cycles that drive one row each, and the minor cycles within them.

use super::{
    Cycle, Ends, REFINE, Role, STALL, Solver,
    attempt::{CURVATURE_ROUNDING, FINE_CURVATURE, FINE_PIVOT, IMAGE_ROUNDING},
    largest, take,
};
use crate::{
    error::LcpError,
    interrupt::poll,
    ratio::{Blocker, Candidate, TieRule, ratio_test},
    settings::PROGRESS,
};

impl Solver {
    pub(super) fn drive_all(&mut self, ends: Ends, go_on: &mut dyn FnMut() -> bool) -> Result<Cycle, LcpError> {
        while let Some(i) = self.most_violated() {
            if !go_on() {
                return Ok(Cycle::Stopped);
            }
            let cycle = self.major_cycle(i, ends)?;
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
        let own_scale = self.own_scale();
        if self.zero.beside_q {
            return (self.zero.feasibility * self.q_size).max(IMAGE_ROUNDING * own_scale);
        }
        self.zero.feasibility * own_scale
    }

    /// Drives `z_i` up until `w_i` is zero, keeping every row considered before feasible.
    fn major_cycle(&mut self, i: usize, ends: Ends) -> Result<Cycle, LcpError> {
        self.role[i] = Role::Considered;
        self.driven = Some(i);
        self.counts.major_cycles += 1;
        let mut stalled = 0;
        loop {
            if self.counts.pivots >= ends.stop {
                return Ok(Cycle::Stopped);
            }
            if self.counts.pivots >= ends.limit {
                return Ok(Cycle::Limit);
            }
            self.direction(i);
            let size = largest(&self.dz, self.active.members()).max(1.0);
            let slope = self.curvature(i);
            if slope.is_nan() {
                return Ok(Cycle::LostAccuracy);
            }
            if slope < -self.settings.residual * size * size {
                return Err(LcpError::NotSemidefinite { index: i, eigenvalue: slope / self.direction_squared() });
            }
            self.collect_candidates(i, slope, self.least_slope(size), self.settings.pivot * size);
            let rule = if stalled > STALL * (self.active.members().len() + 4) {
                TieRule::LeastIndex
            } else {
                TieRule::LargestRate
            };
            let slack = 0.1 * self.violation();
            let mut blocked = ratio_test(&self.candidates, slack, rule);
            let dependent = slope <= self.least_slope(size);
            if dependent && self.w[i] > self.violation() {
                // Only rounding lifts a row along such a direction.
                return Ok(Cycle::LostAccuracy);
            }
            if dependent && self.zero.goes_out && self.go_out(i, size, blocked.map(|(step, _)| step)) {
                return Ok(Cycle::Feasible);
            }
            if blocked.is_none() && self.w[i] < -self.violation() {
                if self.certify_ray(i, size, slope)? {
                    return Ok(Cycle::Ray);
                }
                let rounding = if self.is_little(i) { CURVATURE_ROUNDING } else { FINE_CURVATURE };
                if slope <= rounding * size * size {
                    return Ok(Cycle::LostAccuracy);
                }
                // Not a ray: what was taken for rounding blocks it, `w_i` at the latest.
                self.collect_candidates(i, slope, 0.0, FINE_PIVOT * size);
                blocked = ratio_test(&self.candidates, 0.0, TieRule::LargestRate);
            }
            let Some((step, blocker)) = blocked else {
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

    /// `dz' dz`, at least one.
    fn direction_squared(&self) -> f64 {
        1.0 + self.active.members().iter().map(|&j| self.dz[j] * self.dz[j]).sum::<f64>()
    }

    /// Curvature at or below which row i depends on the active rows. Rounding in `M` alone, one unit in the last place of
    /// a unit diagonal, changes `dz' M dz` by the square of the direction's size.
    fn least_slope(&self, size: f64) -> f64 {
        (self.zero.singular * size).max(self.zero.curvature * size * size)
    }

    /// Everything that falls towards zero: `w_i` of the driving row, active `z`, and `w` of considered rows, faster than at
    /// `least_slope` and `floor`. Their order does not matter to the ratio test.
    fn collect_candidates(&mut self, i: usize, slope: f64, least_slope: f64, floor: f64) {
        self.candidates.clear();
        if slope > least_slope {
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

    /// Nothing blocks the direction: y = dz then proves that there is no solution, if it is a certificate.
    /// `y' M y = 0` with `(M y)_j = a` not zero is negative curvature: `y - a e_j` has `y' M y - a^2` (unit diagonal).
    fn certify_ray(&mut self, i: usize, size: f64, slope: f64) -> Result<bool, LcpError> {
        let present = |&j: &usize| self.role[j] != Role::Absent;
        let worst = self.reached.iter().copied().filter(present).fold(0.0_f64, |worst, j| worst.max(self.dw[j].abs()));
        let curvature = slope - worst * worst;
        if curvature < -self.settings.residual * size * size {
            let eigenvalue = curvature / (self.direction_squared() + worst * worst);
            return Err(LcpError::NotSemidefinite { index: i, eigenvalue });
        }
        let direction = self.dz.clone();
        let certified = self.take_certificate(&direction);
        if certified {
            self.residual = self.present_residual();
        }
        Ok(certified)
    }

    /// Moves z along a ray that says nothing, until the violation of row i passes for zero beside z. False if that is not
    /// so little, or if something blocks the way before (at the step `blocked`).
    fn go_out(&mut self, i: usize, size: f64, blocked: Option<f64>) -> bool {
        let step = -self.w[i] / (self.zero.feasibility * size);
        let goes = self.is_little(i) && blocked.is_none_or(|blocked| step < blocked);
        if goes {
            self.advance(i, step.max(0.0));
        }
        goes && self.w[i] >= -self.violation()
    }

    /// Whether the violation of row i, as the progress along the direction, says nothing.
    fn is_little(&self, i: usize) -> bool {
        let present = |&j: &usize| self.role[j] != Role::Absent;
        let rows = self.reached.iter().chain(&self.moving).copied().filter(present);
        let q_size = rows.fold(0.0_f64, |size, j| size.max(self.load.scaled[j].abs()));
        -self.w[i] <= PROGRESS * q_size * self.direction_sum()
    }

    /// Sum of the entries of the direction, which are not negative along a ray.
    fn direction_sum(&self) -> f64 {
        1.0 + self.active.members().iter().map(|&j| self.dz[j].max(0.0)).sum::<f64>()
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
