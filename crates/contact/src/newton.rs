//! Newton's method on the natural map, in body space, with a proximal term.
//!
//! A step solves, with the map's derivative at every contact ([`Map`]),
//!
//! ```text
//! (I - DP + eps) dp + DP E' J dy = -F,    dy = J' dp                                   (1)
//! (I + J' (I - DP + eps)^-1 DP E' J) dy = -J' (I - DP + eps)^-1 F                      (2)
//! ```
//!
//! (2) has one block for each chunk and for each pair that touches, however many contacts lie between. Many impulses give the same
//! motion, the normal case, and gaps that differ in the eighth digit say which corner of a face bears: then (1) without eps has no
//! solution, or many, and with little of it steps are long and lead nowhere. So eps follows the residual (Levenberg and
//! Marquardt; the proximal point method), and near the end, where it is small, the step is refined to that of (1) without it.

use crate::{
    law::project,
    map::Map,
    matrix::BlockMatrix,
    sweep::sweep,
    system::{State, System},
};
use drystone_lcp::interrupt::poll;

/// Bounds of eps, which has no unit: of a contact's own yielding, how much softer it is taken. Measured: with less at the
/// beginning a third more steps fail, with more the end is slow.
const SOFTNESS: [f64; 2] = [1e-6, 1e-2];
/// From here on a step is refined.
const NEARLY_HARD: f64 = 1e-5;
/// Refinements at most, each until what is left is rounding.
const REFINEMENTS: usize = 4;
const REFINED: f64 = 1e-14;
/// A step is halved so often to make the map less.
const HALVINGS: usize = 2;
/// Share of the promised decrease that is asked for (Armijo).
const DECREASE: f64 = 1e-4;
/// Where no length makes the map less: the least share of the way to the first contact that lets go.
const LEAST: f64 = 0.01;
/// Sweeps after such a step.
const REPAIRS: usize = 2;

/// What a step takes, made once for an island.
pub(crate) struct Newton<const B: usize, const D: usize> {
    matrix: BlockMatrix<B>,
    /// Of every contact and pair of its sides where the block between their chunks is.
    between: Vec<(u32, bool)>,
    maps: Vec<Map<D>>,
    dp: Vec<[f64; D]>,
    change: Vec<[f64; D]>,
    dy: Vec<[f64; B]>,
    right: Vec<[f64; B]>,
    trial: State<B, D>,
}

impl<const B: usize, const D: usize> Newton<B, D> {
    /// None if there is no memory for it.
    pub fn new(system: &System<B, D>) -> Option<Self> {
        let mut pairs = Vec::with_capacity(system.len());
        for k in 0..system.len() {
            for a in system.sides(k) {
                pairs.extend((a + 1..system.sides(k).end).map(|b| (system.chunks[a], system.chunks[b])));
            }
        }
        let matrix = BlockMatrix::new(system.free.len(), &pairs)?;
        let between = pairs.iter().map(|&(a, b)| matrix.between(a, b)).collect::<Option<Vec<_>>>()?;
        let (chunks, contacts) = (vec![[0.0; B]; system.free.len()], vec![[0.0; D]; system.len()]);
        Some(Self {
            matrix,
            between,
            maps: Vec::with_capacity(system.len()),
            dp: contacts.clone(),
            change: contacts,
            dy: chunks.clone(),
            right: chunks,
            trial: system.state(),
        })
    }

    /// One step; eps is `softness` times as large as usual. False if there is none.
    pub fn step(&mut self, system: &System<B, D>, state: &mut State<B, D>, softness: f64) -> bool {
        let square = self.evaluate(system, state);
        let largest = state.p.iter().zip(&system.contacts).map(|(p, local)| p[0] * local.weight).fold(0.0, f64::max);
        let eps = (softness * square.sqrt() / largest).clamp(SOFTNESS[0], SOFTNESS[1]);
        if !(square > 0.0 && self.direction(system, eps)) {
            return false;
        }
        for halvings in 0..=HALVINGS {
            let length = 0.5_f64.powi(halvings as i32);
            let mut trial = std::mem::take(&mut self.trial);
            for (k, p) in trial.p.iter_mut().enumerate() {
                for i in 0..D {
                    p[i] = state.p[k][i] + length * self.dp[k][i];
                }
            }
            system.move_by(&mut trial);
            let after = self.evaluate(system, &trial);
            if after <= (1.0 - DECREASE * length) * square {
                std::mem::swap(&mut state.y, &mut trial.y);
                std::mem::swap(&mut state.p, &mut trial.p);
                self.trial = trial;
                return true;
            }
            self.trial = trial;
        }
        self.let_go(system, state);
        true
    }

    /// The map everywhere; its square.
    fn evaluate(&mut self, system: &System<B, D>, state: &State<B, D>) -> f64 {
        self.maps.clear();
        let mut sum = 0.0;
        for k in 0..system.len() {
            let local = &system.contacts[k];
            let p = state.p[k].map(|p| p * local.weight);
            let (map, square) = Map::at(local.friction, &system.relative(k, &state.y), &p);
            sum += square;
            self.maps.push(map);
        }
        sum
    }

    /// Where contacts that all bear cannot: along the step until the first one lets go, as an active-set method does.
    fn let_go(&self, system: &System<B, D>, state: &mut State<B, D>) {
        let mut length = 1.0_f64;
        for (p, dp) in state.p.iter().zip(&self.dp) {
            if p[0] > 0.0 && dp[0] < 0.0 {
                length = length.min(-p[0] / dp[0]);
            }
        }
        length = length.max(LEAST);
        for ((p, dp), local) in state.p.iter_mut().zip(&self.dp).zip(&system.contacts) {
            for i in 0..D {
                p[i] += length * dp[i];
            }
            *p = project(local.friction, p).point;
        }
        system.move_by(state);
        (0..REPAIRS).for_each(|round| {
            sweep(system, state, round % 2 == 1);
        });
    }

    /// Solves (1) for the impulses.
    fn direction(&mut self, system: &System<B, D>, eps: f64) -> bool {
        self.assemble(system, eps);
        if !self.matrix.factor() {
            return false;
        }
        self.dp.fill([0.0; D]);
        self.dy.fill([0.0; B]);
        let refinements = if eps > NEARLY_HARD { 0 } else { REFINEMENTS };
        for round in 0..=refinements {
            let [left, size] = self.residual(system, eps, round > 0);
            if round > 0 && left <= REFINED * size {
                break;
            }
            self.matrix.solve(&mut self.right);
            for k in 0..system.len() {
                let map = &self.maps[k];
                let taken = map.divided(&map.projected(&map.lifted(&system.change(k, &self.right))), eps);
                for i in 0..D {
                    self.dp[k][i] += self.change[k][i] - taken[i];
                }
            }
            self.dy.fill([0.0; B]);
            for k in 0..system.len() {
                let weight = system.contacts[k].weight;
                system.give(k, &self.dp[k].map(|dp| dp / weight), &mut self.dy);
            }
        }
        for (dp, local) in self.dp.iter_mut().zip(&system.contacts) {
            *dp = dp.map(|dp| dp / local.weight);
        }
        self.dp.iter().flatten().all(|dp| dp.is_finite())
    }

    /// What the step so far leaves of (1) without eps, as the right side of (2). The largest of it, and of F.
    fn residual(&mut self, system: &System<B, D>, eps: f64, begun: bool) -> [f64; 2] {
        let mut largest = [0.0_f64; 2];
        self.right.fill([0.0; B]);
        for k in 0..system.len() {
            let map = &self.maps[k];
            let mut left = map.value.map(|value| -value);
            if begun {
                let moved = map.projected(&map.lifted(&system.change(k, &self.dy)));
                let kept = map.projected(&self.dp[k]);
                for i in 0..D {
                    left[i] -= self.dp[k][i] - kept[i] + moved[i];
                }
            }
            for i in 0..D {
                largest = [largest[0].max(left[i].abs()), largest[1].max(map.value[i].abs())];
            }
            self.change[k] = map.divided(&left, eps);
            let weight = system.contacts[k].weight;
            system.give(k, &self.change[k].map(|change| change / weight), &mut self.right);
        }
        largest
    }

    /// The matrix of (2).
    fn assemble(&mut self, system: &System<B, D>, eps: f64) {
        poll(8 * B * B * self.between.len());
        self.matrix.reset();
        let mut first = 0;
        for k in 0..system.len() {
            let sides = system.sides(k);
            let count = sides.len();
            let pairs = first;
            first += count * count.saturating_sub(1) / 2;
            if !self.maps[k].bears() {
                continue;
            }
            let mut weight = self.maps[k].weight(eps);
            weight.iter_mut().flatten().for_each(|weight| *weight /= system.contacts[k].weight);
            let mut pair = pairs;
            for a in sides.clone() {
                let of_a = weighted(&weight, &system.rows[a]);
                add(self.matrix.own(system.chunks[a]), &system.rows[a], &of_a);
                for b in a + 1..sides.end {
                    let of_b = weighted(&weight, &system.rows[b]);
                    let (place, upper) = self.between[pair];
                    pair += 1;
                    add(self.matrix.block(place, upper), &system.rows[a], &of_b);
                    add(self.matrix.block(place, !upper), &system.rows[b], &of_a);
                }
            }
        }
    }
}

/// `N J`.
#[inline(always)]
fn weighted<const B: usize, const D: usize>(weight: &[[f64; D]; D], rows: &[[f64; B]; D]) -> [[f64; B]; D] {
    let mut product = [[0.0; B]; D];
    for i in 0..D {
        for j in 0..D {
            for c in 0..B {
                product[i][c] += weight[i][j] * rows[j][c];
            }
        }
    }
    product
}

/// Adds `J' (N J)`.
#[inline(always)]
fn add<const B: usize, const D: usize>(block: &mut [[f64; B]; B], rows: &[[f64; B]; D], weighted: &[[f64; B]; D]) {
    for i in 0..B {
        for d in 0..D {
            for j in 0..B {
                block[i][j] += rows[d][i] * weighted[d][j];
            }
        }
    }
}
