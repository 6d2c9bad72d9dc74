//! Predictor and corrector.

use super::{
    matrix::BodyMatrix,
    restoring::{REST, Restoring, share_of_loads},
    scaled::{Scaled, ScaledPoint, largest, largest_of},
    scaling::{Scaling, step},
};

/// What was found.
#[derive(Debug, Clone)]
pub struct Found {
    /// How it ended.
    pub end: End,
    /// Accelerations, body after body: m/s^2, rad/s^2.
    pub accelerations: Vec<f64>,
    /// Point after point: magnitudes along the edges, or the three components, N.
    pub forces: Vec<f64>,
    /// Of the push; not a number without one.
    pub factor: f64,
    /// Of each of these whether it bears rather than opens, `f > s` in the problem's own scale.
    pub bearing: Vec<bool>,
    /// Matrices factored.
    pub iterations: usize,
    /// `f' s` for each cone, in units of the problem's own scale: how far it is from (2).
    pub gap: f64,
}

/// How an interior point method ended. Whoever asks judges the answer in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The forces hold every body, to working precision; the gap may still be larger.
    AtRest,
    /// The residuals and the gap are as small as working precision allows, or so small that more is not worth its time.
    Converged,
    /// No further progress.
    Stalled,
    /// There was no memory for the factor.
    OutOfMemory,
}

/// Gap for each cone, in the problem's own scale. Accelerations differ from the right ones by its square root at most: so much
/// where a contact neither bears nor opens, as between blocks that fall side by side.
const GAP: f64 = 1e-24;
/// The same where the factor of a push is to be greatest, which the gap of all cones together bounds.
const GAP_OF_PUSH: f64 = 1e-18;
/// And the residuals: forces balance the loads to some digits more than counts, whatever is between.
const RESIDUAL_OF_PUSH: f64 = 1e-12;
/// The same where the factor need not be known so well.
const RESIDUAL_WITHIN: f64 = 1e-10;
/// Forces and accelerations of contacts to begin with, in the problem's own scale: some ten of the largest load, since blocks bear one
/// another, and nearly none, as where all stands. Of 41 structures (docs/theory/interior-point.md) iterations are 508; from one of both
/// 607, from ten times less of the second 497, from a hundred times less digits are lost.
const START: [f64; 2] = [10.0, 0.01];
/// The same where there are no masses: velocities are near one. From 1 a wall of 900 blocks takes 42 iterations to its largest push, from
/// 10 to 100 it takes 34.
const START_WITHOUT_MASSES: [f64; 2] = [10.0, 10.0];
/// Residuals in the problem's own scale: rounding of some ten terms of the largest force, or of one.
const RESIDUAL: f64 = 1e-14;
/// Iterations are some 10 to 25; ten times as many say that there is no progress.
const MOST: usize = 200;
/// An iteration that leaves more than this share of gap and residual is none, and how many of them in a row are the end.
const PROGRESS: f64 = 0.9;
const PATIENCE: usize = 8;
/// The same from a gap on at which accelerations are good to a share of 1e-6 at least, if contacts close by no more than a share of the
/// fastest body that proves a fall: more is worth a few iterations, not many.
const LATE: f64 = 1e-12;
const LATE_CLOSING: f64 = 1e-10;
const LATE_PROGRESS: f64 = 0.3;
const LATE_PATIENCE: usize = 2;
/// Share of the way to the border of the cones.
const SHARE: f64 = 0.995;
/// Weight of the proximal term: of the gap, within bounds. It changes no answer; larger is slower, smaller loses digits.
const PROXIMAL: f64 = 1e-7;
const PROXIMAL_BOUNDS: [f64; 2] = [1e-15, 1e-8];
/// The same where layers give way by one for a force of one: beside them it may be larger, and fewer digits are lost.
const PROXIMAL_WITH_LAYERS: [f64; 2] = [1e-8, 1e-6];
/// Weight of the proximal term on the motion where there are no masses.
const PROXIMAL_MASS: f64 = 1e-9;
/// The same between layers, where bodies go 1e5 times as far as these give way, or further where something falls.
const PROXIMAL_MASS_WITH_LAYERS: f64 = 1e-10;
/// Refinements of a step, until what is left is rounding, or this share of the residuals that the step is to take away: the next
/// step takes that away too.
const REFINEMENTS: usize = 3;
const REFINED: f64 = 1e-16;
const REFINED_BESIDE: f64 = 1e-4;

pub(super) struct Interior<const B: usize, const D: usize, const N: usize> {
    problem: Scaled<B, D, N>,
    a: Vec<[f64; B]>,
    f: Vec<f64>,
    s: Vec<f64>,
    /// Number of cones.
    cones: usize,
    /// So many bodies, the first, have no mass: none in (1), all where a cost takes the place of the masses, all but the layers
    /// where these do.
    massless: usize,
    /// What a unit of each force costs; with masses the offset.
    cost: Vec<f64>,
    /// Factor of the push, in its own unit.
    t: f64,
    /// Whether forces that hold the bodies are the answer whatever the gap: so without an offset.
    rests: bool,
    /// Power of the push in the motion: one where the factor is to be greatest, else none.
    rate: f64,
    /// `f' s` of all cones that is enough there: it is the rate times what the factors of the forces and of the motion differ by.
    enough: f64,
}

/// A Newton step, and the vectors that it takes.
struct Step<const B: usize> {
    da: Vec<[f64; B]>,
    df: Vec<f64>,
    ds: Vec<f64>,
    /// `J da`.
    moved: Vec<f64>,
    correction: Vec<f64>,
    /// What the push alone does, `H^-1 push`, its `push' H^-1 push`, and the change of its factor.
    pushed: Vec<[f64; B]>,
    yielding: f64,
    dt: f64,
    left: Vec<[f64; B]>,
    other: Vec<f64>,
    /// Bodies without mass, and what takes the place of it.
    massless: usize,
    proximal_mass: f64,
    /// What is added to the matrix's diagonal where there would be no factor.
    more: f64,
}

/// Residuals of (2) at a point.
struct Residuals<const B: usize> {
    /// `M a - J' f - F`.
    balance: Vec<[f64; B]>,
    /// `J a`, and the cost.
    motion: Vec<f64>,
    /// What the power of the push lacks.
    power: f64,
    worst: f64,
    gap: f64,
    /// The largest force.
    force: f64,
}

impl<const B: usize, const D: usize, const N: usize> Interior<B, D, N> {
    pub fn new(problem: Scaled<B, D, N>) -> Self {
        Self::from(START, problem)
    }

    /// The same from ones.
    pub fn from_ones(problem: Scaled<B, D, N>) -> Self {
        Self::from([1.0, 1.0], problem)
    }

    /// From forces and accelerations on the axes of the cones.
    fn from(start: [f64; 2], problem: Scaled<B, D, N>) -> Self {
        let mut axes = vec![1.0; problem.forces()];
        let mut cones = axes.len();
        for point in problem.points.iter().filter(|point| point.round) {
            axes[point.own()].copy_from_slice(&[1.0, 0.0, 0.0]);
            cones -= 2;
        }
        let [f, s] = start.map(|start| axes.iter().map(|axis| start * axis).collect());
        let a = vec![[0.0; B]; problem.load.len()];
        let (cost, rests) = (problem.offset(), problem.has_no_offset());
        Self { a, f, s, cones, massless: 0, cost, rests, t: 0.0, rate: 0.0, enough: 0.0, problem }
    }

    /// The forces of least cost that hold the bodies, from some that do: (2) with `s = J a + cost` and no masses. Where
    /// costs are of no particular kind these are the ones of a vertex: as many are positive as there are rows, or fewer.
    pub fn of_least_cost(problem: Scaled<B, D, N>, forces: &[f64], cost: Vec<f64>) -> Self {
        let f = problem.in_own_units(forces);
        let massless = problem.load.len();
        Self { f, s: cost.clone(), cost, massless, ..Self::new(problem) }
    }

    /// The forces of least norm that hold the bodies, the norm being that of what the layers bear: (2) with masses for the layers
    /// only, which are the bodies from `layers` on.
    pub fn of_least_norm(problem: Scaled<B, D, N>, layers: usize) -> Self {
        Self { massless: layers, ..Self::new(problem) }
    }

    fn has_layers(&self) -> bool {
        self.massless > 0 && self.massless < self.a.len()
    }

    /// Forces that hold the bodies under as much of the push as can be, and the motion in which more of it moves them: (2) with
    /// `s = J a`, no masses, `- J' f - t push = F` and `push' a = push' push`, so that velocities are near one as loads are.
    pub fn of_greatest_push(problem: Scaled<B, D, N>, within: f64) -> Self {
        let rate = product(&problem.push, &problem.push);
        let enough = within * problem.push_unit * rate;
        Self { rate, enough, ..Self::without_masses(problem) }
    }

    /// Forces that hold the bodies and the motion in which the loads do most work: (2) with `s = J a + offset` and no masses.
    pub fn of_least_energy(problem: Scaled<B, D, N>) -> Self {
        Self::without_masses(problem)
    }

    fn without_masses(problem: Scaled<B, D, N>) -> Self {
        let massless = problem.load.len();
        Self { massless, ..Self::from(START_WITHOUT_MASSES, problem) }
    }

    /// None if stopped.
    pub fn solve(mut self, go_on: &mut dyn FnMut() -> bool) -> Option<Found> {
        let Some(mut matrix) = BodyMatrix::new(&self.problem) else {
            return Some(self.found(End::OutOfMemory, 0, f64::INFINITY));
        };
        let proximal_mass = if self.has_layers() { PROXIMAL_MASS_WITH_LAYERS } else { PROXIMAL_MASS };
        let mut step = Step { massless: self.massless, proximal_mass, ..Step::new(self.a.len(), self.f.len()) };
        if self.has_layers() && !self.begin(&mut matrix, &mut step) {
            return Some(self.found(End::Stalled, 0, f64::INFINITY));
        }
        let (mut best, mut since, mut residuals) = ([f64::INFINITY; 2], 0, self.residuals());
        let mut restoring = Restoring::new(self.a.len(), self.f.len());
        for iteration in 0..MOST {
            let merit = residuals.merit();
            if self.rests && self.massless == 0 && iteration > 0 {
                let left = self.share_left(&residuals);
                if left <= REST {
                    return Some(self.found(End::AtRest, iteration + restoring.looks, residuals.gap));
                }
                if let Some(forces) = restoring.look(&self.problem, &mut matrix, &self.f, left) {
                    self.f.copy_from_slice(forces);
                    self.a.fill([0.0; B]);
                    return Some(self.found(End::AtRest, iteration + restoring.looks, residuals.gap));
                }
            }
            if merit <= 1.0 || self.rate > 0.0 && self.enough_of_push(&residuals) {
                return Some(self.found(End::Converged, iteration + restoring.looks, residuals.gap));
            }
            let late = residuals.gap < LATE;
            let settled = late && residuals.worst <= LATE_CLOSING * largest(&self.a);
            let (progress, patience) = if settled { (LATE_PROGRESS, LATE_PATIENCE) } else { (PROGRESS, PATIENCE) };
            let end = if late { End::Converged } else { End::Stalled };
            // Between layers and under a push bodies go far before the forces hold them, and the gap grows on the way.
            let reached = if self.has_layers() || self.rate > 0.0 { [residuals.worst, merit] } else { [merit; 2] };
            let better = (0..2).any(|k| reached[k] < progress * best[k]);
            since = if better { 0 } else { since + 1 };
            best = [0, 1].map(|k| reached[k].min(best[k]));
            if !go_on() {
                return None;
            }
            if since > patience || !self.iterate(&mut matrix, &mut step, &residuals) {
                return Some(self.found(end, iteration + restoring.looks, residuals.gap));
            }
            residuals = self.residuals();
        }
        Some(self.found(End::Stalled, MOST, residuals.gap))
    }

    fn enough_of_push(&self, &Residuals { gap, worst, .. }: &Residuals<B>) -> bool {
        let near = gap * self.cones as f64 <= self.enough && worst <= RESIDUAL_WITHIN;
        near || gap <= GAP_OF_PUSH && worst <= RESIDUAL_OF_PUSH
    }

    /// Begins where the contacts would be if each gave way by as much as it bears, pushed into the cones: there bodies without
    /// mass have gone as far as they must, about. False if there is no factor.
    fn begin(&mut self, matrix: &mut BodyMatrix<B>, way: &mut Step<B>) -> bool {
        let problem = &self.problem;
        let unit = |point: &ScaledPoint<B, D, N>| {
            let mut weight = [[0.0; D]; D];
            for edge in &problem.edges[point.own()] {
                (0..D).for_each(|i| (0..D).for_each(|k| weight[i][k] += edge[i] * edge[k]));
            }
            weight
        };
        matrix.assemble(&problem.points, |body| way.diagonal(body), unit);
        if matrix.factor().is_none() {
            return false;
        }
        self.a.copy_from_slice(&problem.load);
        matrix.solve(&mut self.a);
        problem.motion(&self.a, &mut way.moved);
        let (mut inside, mut outside) = (0.0_f64, 0.0_f64);
        for point in &problem.points {
            let moved = &way.moved[point.own()];
            let [least, most] = if point.round {
                let across = moved[1].hypot(moved[2]);
                [moved[0] - across, moved[0] + across]
            } else {
                [moved.iter().copied().fold(f64::INFINITY, f64::min), moved.iter().copied().fold(0.0, f64::max)]
            };
            (inside, outside) = (inside.max(-least), outside.max(most));
        }
        // s as the contacts open and f as they close, each with its own share of the cones' axes.
        for point in &problem.points {
            for (k, j) in point.own().enumerate() {
                let axis = if point.round && k > 0 { 0.0 } else { 1.0 };
                self.s[j] = way.moved[j] + (1.0 + 1.1 * inside) * axis;
                self.f[j] = (1.0 + 1.1 * outside) * axis - way.moved[j];
            }
        }
        true
    }

    /// One step of predictor and corrector. False if there is none.
    fn iterate(&mut self, matrix: &mut BodyMatrix<B>, way: &mut Step<B>, residuals: &Residuals<B>) -> bool {
        let problem = &self.problem;
        let [least, most] = if self.has_layers() { PROXIMAL_WITH_LAYERS } else { PROXIMAL_BOUNDS };
        let delta = (PROXIMAL * residuals.gap).clamp(least, most);
        let scaling = Scaling::at(problem, &self.f, &self.s, delta);
        matrix.assemble(&problem.points, |body| way.diagonal(body), scaling.weights(problem));
        let Some(more) = matrix.factor() else { return false };
        way.more = more;
        way.push(problem, matrix);
        way.correction.fill(0.0);
        way.newton(problem, matrix, &scaling, residuals, &self.s, 0);
        let length = step(problem, &self.f, &way.df).min(step(problem, &self.s, &way.ds));
        let centring = (self.gap_after(way, length) / residuals.gap).clamp(0.0, 1.0).powi(3);
        let target = centring * residuals.gap;
        scaling.centre(problem, &self.f, target, [&way.df, &way.ds], &mut way.correction);
        way.newton(problem, matrix, &scaling, residuals, &self.s, REFINEMENTS);
        let mut lengths =
            [step(problem, &self.f, &way.df), step(problem, &self.s, &way.ds)].map(|length| SHARE * length);
        if self.massless < self.a.len() {
            lengths = [lengths[0].min(lengths[1]); 2]; // masses couple forces and accelerations
        }
        if !(way.da.iter().flatten().chain(&way.df).chain(&lengths).all(|d| d.is_finite())) {
            return false;
        }
        let [of_forces, of_motion] = lengths;
        self.a.iter_mut().flatten().zip(way.da.iter().flatten()).for_each(|(a, da)| *a += of_motion * da);
        self.f.iter_mut().zip(&way.df).for_each(|(f, df)| *f += of_forces * df);
        self.t += of_forces * way.dt;
        self.s.iter_mut().zip(&way.ds).for_each(|(s, ds)| *s += of_motion * ds);
        true
    }

    fn gap_after(&self, way: &Step<B>, length: f64) -> f64 {
        let after = |j: usize| (self.f[j] + length * way.df[j]) * (self.s[j] + length * way.ds[j]);
        (0..self.f.len()).map(after).sum::<f64>() / self.cones.max(1) as f64
    }

    fn residuals(&self) -> Residuals<B> {
        let less = |(body, (a, load)): (usize, (&[f64; B], &[f64; B]))| {
            let mass = if body < self.massless { 0.0 } else { 1.0 };
            std::array::from_fn(|k| mass * a[k] - load[k])
        };
        let mut balance: Vec<[f64; B]> = self.a.iter().zip(&self.problem.load).enumerate().map(less).collect();
        self.problem.add_wrenches(&self.f, -1.0, &mut balance);
        add(&mut balance, -self.t, &self.problem.push);
        let mut motion = vec![0.0; self.s.len()];
        self.problem.motion(&self.a, &mut motion);
        motion.iter_mut().zip(&self.cost).for_each(|(motion, cost)| *motion += cost);
        let apart = largest_of([&motion, &self.s], |[motion, s]| (motion - s).abs());
        let power = if self.problem.push.is_empty() { 0.0 } else { self.rate - product(&self.problem.push, &self.a) };
        let worst = largest(&balance).max(apart).max(power.abs());
        let gap = self.f.iter().zip(&self.s).map(|(f, s)| f * s).sum::<f64>() / self.cones.max(1) as f64;
        let force = largest_of([&self.f], |[f]| f.abs());
        Residuals { balance, motion, power, worst, gap, force }
    }

    /// The largest share that the forces leave of a body's own load: `M a` and the residual.
    fn share_left(&self, residuals: &Residuals<B>) -> f64 {
        let left = self.a.iter().zip(&residuals.balance);
        share_of_loads(&self.problem.load, left.map(|(a, balance)| std::array::from_fn(|k| a[k] - balance[k])))
    }

    fn found(self, end: End, iterations: usize, gap: f64) -> Found {
        let (accelerations, forces) = (self.problem.accelerations(&self.a), self.problem.in_newtons(&self.f));
        let bearing = self.f.iter().zip(&self.s).map(|(f, s)| f > s).collect();
        let factor = self.t / self.problem.push_unit;
        Found { end, accelerations, forces, factor, bearing, iterations, gap }
    }
}

impl<const B: usize> Residuals<B> {
    /// At most one where all is as small as working precision allows.
    fn merit(&self) -> f64 {
        (self.worst / (RESIDUAL * self.force.max(1.0))).max(self.gap / GAP)
    }
}

impl<const B: usize> Step<B> {
    fn new(bodies: usize, forces: usize) -> Self {
        let (rows, columns) = (|| vec![[0.0; B]; bodies], || vec![0.0; forces]);
        let (da, left) = (rows(), rows());
        let (df, ds, moved, correction, other) = (columns(), columns(), columns(), columns(), columns());
        let (pushed, yielding, dt, massless) = (Vec::new(), 0.0, 0.0, 0);
        Self {
            da,
            df,
            ds,
            moved,
            correction,
            pushed,
            yielding,
            dt,
            left,
            other,
            massless,
            proximal_mass: 0.0,
            more: 0.0,
        }
    }

    /// Weight of a body's motion itself in the matrix: its mass, or a proximal term in its place.
    fn diagonal(&self, body: usize) -> f64 {
        if body < self.massless { self.proximal_mass } else { 1.0 }
    }

    /// What the push does by itself, for the matrix that was factored.
    fn push<const D: usize, const N: usize>(&mut self, problem: &Scaled<B, D, N>, matrix: &mut BodyMatrix<B>) {
        self.pushed.clone_from(&problem.push);
        if !self.pushed.is_empty() {
            matrix.solve(&mut self.pushed);
            self.yielding = product(&problem.push, &self.pushed);
        }
    }

    /// Gives a motion the power that it lacks by more or less of the push, and says how much.
    fn by_push<const D: usize, const N: usize>(
        &self,
        problem: &Scaled<B, D, N>,
        motion: &mut [[f64; B]],
        power: f64,
    ) -> f64 {
        if self.pushed.is_empty() {
            return 0.0;
        }
        let change = (power - product(&problem.push, motion)) / self.yielding;
        add(motion, change, &self.pushed);
        change
    }

    /// The Newton step of (2) for the product that `self.correction` asks for.
    fn newton<const D: usize, const N: usize>(
        &mut self,
        problem: &Scaled<B, D, N>,
        matrix: &mut BodyMatrix<B>,
        scaling: &Scaling,
        residuals: &Residuals<B>,
        s: &[f64],
        refinements: usize,
    ) {
        // f takes up what the cones ask for, W^2 df + ds + s = correction, where ds = J (a + da) - s + delta df.
        let asked = self.correction.iter().zip(&residuals.motion).map(|(correction, motion)| correction - motion);
        self.df.clear();
        self.df.extend(asked);
        scaling.divide(problem, &mut self.df);
        self.da.iter_mut().zip(&residuals.balance).for_each(|(da, balance)| *da = balance.map(|balance| -balance));
        problem.add_wrenches(&self.df, 1.0, &mut self.da);
        matrix.solve(&mut self.da);
        let mut da = std::mem::take(&mut self.da);
        self.dt = self.by_push(problem, &mut da, residuals.power);
        self.da = da;
        problem.motion(&self.da, &mut self.moved);
        self.give_way(problem, scaling, false);
        let scale = largest_of([&self.df], |[df]| df.abs()).max(1.0);
        let enough = (REFINED * scale).max(REFINED_BESIDE * residuals.worst);
        for _ in 0..refinements {
            for body in 0..self.left.len() {
                let (balance, da) = (&residuals.balance[body], &self.da[body]);
                let weight = self.diagonal(body) + self.more;
                self.left[body] = std::array::from_fn(|k| -balance[k] - weight * da[k]);
            }
            problem.add_wrenches(&self.df, 1.0, &mut self.left);
            add(&mut self.left, self.dt, &problem.push);
            let lacking = match self.pushed.is_empty() {
                true => 0.0,
                false => residuals.power - product(&problem.push, &self.da),
            };
            if largest(&self.left).max(lacking.abs()) <= enough {
                break;
            }
            matrix.solve(&mut self.left);
            let mut left = std::mem::take(&mut self.left);
            self.dt += self.by_push(problem, &mut left, lacking);
            self.left = left;
            problem.motion(&self.left, &mut self.other);
            self.da.iter_mut().flatten().zip(self.left.iter().flatten()).for_each(|(da, more)| *da += more);
            self.moved.iter_mut().zip(&self.other).for_each(|(moved, more)| *moved += more);
            self.give_way(problem, scaling, true);
        }
        for (j, ds) in self.ds.iter_mut().enumerate() {
            *ds = self.moved[j] + residuals.motion[j] - s[j] + scaling.delta * self.df[j];
        }
    }

    /// Takes from the forces what a motion changes in them: all of it, or what a refinement adds. In that order no digits of
    /// the forces are lost where `(W^2 + delta)^-1` is large.
    fn give_way<const D: usize, const N: usize>(
        &mut self,
        problem: &Scaled<B, D, N>,
        scaling: &Scaling,
        refined: bool,
    ) {
        if !refined {
            self.other.copy_from_slice(&self.moved);
        }
        scaling.divide(problem, &mut self.other);
        self.df.iter_mut().zip(&self.other).for_each(|(df, moved)| *df -= moved);
    }
}

/// Adds a multiple of some rows; nothing if there are none.
fn add<const B: usize>(sum: &mut [[f64; B]], factor: f64, more: &[[f64; B]]) {
    sum.iter_mut().flatten().zip(more.iter().flatten()).for_each(|(sum, more)| *sum += factor * more);
}

pub(super) fn product<const B: usize>(a: &[[f64; B]], b: &[[f64; B]]) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a * b).sum()
}
