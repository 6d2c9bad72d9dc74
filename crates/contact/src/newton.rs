//! Newton's method on contacts that give way, in body space.
//!
//! With the impulses p(y) of [`Softened`] contacts the velocities of a step are the root of
//!
//! ```text
//! G(y) = y* - y + J' p(y),    (I + J' N J / eps) dy = G                                  (1)
//! ```
//!
//! (1) has one block for each chunk and for each pair that touches, however many contacts lie between, and a root whatever the rank of J.
//! G is smooth but for changes between sticking, sliding and parting, so lengths are tried: a step is taken where the next one, with
//! the same matrix, would be shorter (Deuflhard's natural level function; the size of G itself says little, as it is stiff in some
//! directions by 1 / eps).

use crate::{
    law::{Part, dot},
    matrix::BlockMatrix,
    softened::Softened,
    system::{State, System},
    wide::wide,
};
use drystone_lcp::interrupt::poll;

/// Pairs of sides, of all contacts, that a matrix is made for: .4 GB. Contacts of two bodies have one each; where rows of J are full more are
/// swept only, as their matrix would be too.
const MOST_PAIRS: usize = 1 << 24;
/// Most steps of a solve.
const MOST: usize = 15;
/// The shortest length that is tried. It is taken whatever comes of it.
const SHORTEST: f64 = 0.01;
/// Steps that are [`SHORT`] in a row, after which no root is near.
const SHORT_STEPS: usize = 3;
const SHORT: f64 = 0.07;

/// The softened problem and what its steps need, made once for an island.
pub(crate) struct Newton<const B: usize, const D: usize> {
    pub matrix: BlockMatrix<B>,
    /// Of every contact and pair of its sides where the block between their chunks is.
    between: Vec<(u32, bool)>,
    /// Reference impulses, or changes of them, m/s.
    reference: Vec<[f64; D]>,
    /// What each contact does.
    pub parts: Vec<Part>,
    /// The contacts at y.
    pub contacts: Vec<Softened<D>>,
    y: Vec<[f64; B]>,
    /// Relative velocities there.
    u: Vec<[f64; D]>,
    /// G there.
    pub left: Vec<[f64; B]>,
    step: Vec<[f64; B]>,
    next: Vec<[f64; B]>,
    /// y and u where a step begins, and what all of it changes of u.
    begin: (Vec<[f64; B]>, Vec<[f64; D]>),
    change: Vec<[f64; D]>,
}

impl<const B: usize, const D: usize> Newton<B, D> {
    /// None if it would take too much memory.
    pub fn new(system: &System<B, D>) -> Option<Self> {
        let count = |sides: std::ops::Range<usize>| sides.len() * sides.len().saturating_sub(1) / 2;
        if (0..system.len()).map(|k| count(system.sides(k))).sum::<usize>() > MOST_PAIRS {
            return None;
        }
        let mut pairs = Vec::with_capacity(system.len());
        for k in 0..system.len() {
            for a in system.sides(k) {
                pairs.extend((a + 1..system.sides(k).end).map(|b| (system.chunks[a], system.chunks[b])));
            }
        }
        let matrix = BlockMatrix::new(system.free.len(), &pairs)?;
        let between = pairs.iter().map(|&(a, b)| matrix.between(a, b)).collect::<Option<Vec<_>>>()?;
        let (chunks, relative) = (vec![[0.0; B]; system.free.len()], vec![[0.0; D]; system.len()]);
        Some(Self {
            matrix,
            between,
            reference: relative.clone(),
            parts: Vec::new(),
            contacts: Vec::with_capacity(system.len()),
            y: chunks.clone(),
            u: relative.clone(),
            left: chunks.clone(),
            step: chunks.clone(),
            next: chunks.clone(),
            begin: (chunks, relative.clone()),
            change: relative,
        })
    }

    /// Solves the problem that is softened by `eps` about the state's impulses, from its velocities; the state
    /// then has its impulses, and the velocities that these give. What G may leave: `beside` what yielding does, or `small`, m/s. `steps` are
    /// counted. False, and the state is as it was, if it is not solved.
    pub fn solve(
        &mut self,
        system: &System<B, D>,
        state: &mut State<B, D>,
        (eps, beside, small): (f64, f64, f64),
        steps: &mut usize,
    ) -> bool {
        self.begin_at(system, state, eps);
        let mut short = 0;
        for made in 0..=MOST {
            if self.is_near(system, eps, beside, small) {
                self.end_at(system, state);
                return true;
            }
            if made == MOST || short == SHORT_STEPS {
                break;
            }
            *steps += 1;
            let Some(length) = self.advance(system, eps) else { return false };
            short = if length < SHORT { short + 1 } else { 0 };
        }
        false
    }

    /// Finds what each contact does at a state whose velocities are those of its impulses. Whether that differs from the last time.
    pub fn classify(&mut self, system: &System<B, D>, state: &State<B, D>) -> bool {
        let part = |k: usize| {
            let (u, local) = (system.relative(k, &state.y), &system.contacts[k]);
            let z: [f64; D] = std::array::from_fn(|i| local.weight * state.p[k][i] - u[i]);
            Part::of(local.friction, &z)
        };
        let mut changed = self.parts.len() != system.len();
        self.parts.resize(system.len(), Part::Parts);
        for (k, known) in self.parts.iter_mut().enumerate() {
            let found = part(k);
            changed |= found != *known;
            *known = found;
        }
        changed
    }

    /// One step to the impulses with which contacts do what they were found to do, by changes of them: what yielding leaves is
    /// as small beside the changes as eps. With the matrix of the last time unless `anew`. False if there is none.
    pub fn increment(&mut self, system: &System<B, D>, state: &mut State<B, D>, eps: f64, anew: bool) -> bool {
        self.contacts.clear();
        self.left.fill([0.0; B]);
        for (k, local) in system.contacts.iter().enumerate() {
            let (u, r) = (system.relative(k, &state.y), state.p[k].map(|p| p * local.weight));
            let z = std::array::from_fn(|i| r[i] - u[i] / eps);
            let contact = Softened::with(self.parts[k], local.friction, &z);
            let change: [f64; D] = std::array::from_fn(|i| contact.p[i] - r[i]);
            system.give(k, &change.map(|p| p / local.weight), &mut self.left);
            self.reference[k] = change;
            self.contacts.push(contact);
        }
        if anew {
            self.assemble(system, eps);
            if !self.matrix.factor() {
                return false;
            }
        }
        self.matrix.solve(&mut self.left);
        for (k, local) in system.contacts.iter().enumerate() {
            let mut change = self.reference[k];
            if let Some(n) = self.contacts[k].derivative() {
                let u = system.change(k, &self.left);
                (0..D).for_each(|i| change[i] -= dot(&n[i], &u) / eps);
            }
            (0..D).for_each(|i| state.p[k][i] += change[i] / local.weight);
        }
        system.move_by(state);
        true
    }

    fn begin_at(&mut self, system: &System<B, D>, state: &State<B, D>, eps: f64) {
        for (k, local) in system.contacts.iter().enumerate() {
            self.reference[k] = state.p[k].map(|p| p * local.weight);
        }
        self.y.clone_from(&state.y);
        self.u.iter_mut().enumerate().for_each(|(k, u)| *u = system.relative(k, &state.y));
        self.evaluate(system, eps);
    }

    fn end_at(&self, system: &System<B, D>, state: &mut State<B, D>) {
        for (k, local) in system.contacts.iter().enumerate() {
            state.p[k] = self.contacts[k].p.map(|p| p / local.weight);
        }
        system.move_by(state);
    }

    /// Solves (1). False if it has no solution.
    fn direction(&mut self, system: &System<B, D>, eps: f64) -> bool {
        self.assemble(system, eps);
        if !self.matrix.factor() {
            return false;
        }
        self.step.clone_from(&self.left);
        self.matrix.solve(&mut self.step);
        square(&self.step).is_finite()
    }

    /// Along the step from where it began.
    fn go(&mut self, length: f64) {
        along(&mut self.y, &self.begin.0, length, &self.step);
        along(&mut self.u, &self.begin.1, length, &self.change);
    }

    /// One step. Its length, None if there is none.
    fn advance(&mut self, system: &System<B, D>, eps: f64) -> Option<f64> {
        if !self.direction(system, eps) {
            return None;
        }
        self.begin.0.clone_from(&self.y);
        self.begin.1.clone_from(&self.u);
        wide(
            #[inline(always)]
            || {
                for k in 0..system.len() {
                    self.change[k] = system.change(k, &self.step);
                }
            },
        );
        let mut length = 1.0;
        loop {
            self.go(length);
            self.evaluate(system, eps);
            if length < SHORTEST {
                return Some(length);
            }
            self.next.clone_from(&self.left);
            self.matrix.solve(&mut self.next);
            if square(&self.next) <= square(&self.step) {
                return Some(length);
            }
            length *= 0.5;
        }
    }

    /// Contacts and G at y and u.
    fn evaluate(&mut self, system: &System<B, D>, eps: f64) {
        wide(
            #[inline(always)]
            || self.evaluate_contacts(system, eps),
        );
    }

    #[inline(always)]
    fn evaluate_contacts(&mut self, system: &System<B, D>, eps: f64) {
        self.contacts.clear();
        for ((left, y), free) in self.left.iter_mut().zip(&self.y).zip(&system.free) {
            for k in 0..B {
                left[k] = free[k] - y[k];
            }
        }
        for (k, local) in system.contacts.iter().enumerate() {
            let mut z = self.reference[k];
            for i in 0..D {
                z[i] -= self.u[k][i] / eps;
            }
            let contact = Softened::at(local.friction, &z);
            if contact.p[0] > 0.0 {
                system.give(k, &contact.p.map(|p| p / local.weight), &mut self.left);
            }
            self.contacts.push(contact);
        }
    }

    /// Whether what G leaves of the velocities at contacts is small beside what yielding does, or than `small`.
    fn is_near(&self, system: &System<B, D>, eps: f64, beside: f64, small: f64) -> bool {
        let mut yielding = 0.0_f64;
        for (contact, reference) in self.contacts.iter().zip(&self.reference) {
            for i in 0..D {
                yielding = yielding.max((contact.p[i] - reference[i]).abs());
            }
        }
        let most = (beside * eps * yielding).max(small);
        (0..system.len()).all(|k| system.change(k, &self.left).iter().all(|u| u.abs() <= most))
    }

    /// The matrix of (1).
    pub fn assemble(&mut self, system: &System<B, D>, eps: f64) {
        poll(64 * D * B * system.len());
        wide(
            #[inline(always)]
            || self.add_contacts(system, eps),
        );
    }

    #[inline(always)]
    fn add_contacts(&mut self, system: &System<B, D>, eps: f64) {
        self.matrix.reset();
        let mut first = 0;
        for (k, local) in system.contacts.iter().enumerate() {
            let sides = system.sides(k);
            let mut pair = first;
            first += sides.len() * sides.len().saturating_sub(1) / 2;
            let Some(mut n) = self.contacts[k].derivative() else { continue };
            n.iter_mut().flatten().for_each(|n| *n /= eps * local.weight);
            for a in sides.clone() {
                let of_a = weighted(&n, &system.rows[a]);
                add(self.matrix.own(system.chunks[a]), &system.rows[a], &of_a);
                for b in a + 1..sides.end {
                    let of_b = weighted(&n, &system.rows[b]);
                    let (place, upper) = self.between[pair];
                    pair += 1;
                    add(self.matrix.block(place, upper), &system.rows[a], &of_b);
                    add(self.matrix.block(place, !upper), &system.rows[b], &of_a);
                }
            }
        }
    }
}

/// `x = begin + length step`.
fn along<const N: usize>(x: &mut [[f64; N]], begin: &[[f64; N]], length: f64, step: &[[f64; N]]) {
    for ((x, begin), step) in x.iter_mut().zip(begin).zip(step) {
        for k in 0..N {
            x[k] = begin[k] + length * step[k];
        }
    }
}

fn square<const B: usize>(x: &[[f64; B]]) -> f64 {
    x.iter().flatten().map(|x| x * x).sum()
}

/// `N J`.
#[inline(always)]
fn weighted<const B: usize, const D: usize>(n: &[[f64; D]; D], rows: &[[f64; B]; D]) -> [[f64; B]; D] {
    let mut product = [[0.0; B]; D];
    for i in 0..D {
        for j in 0..D {
            for c in 0..B {
                product[i][c] += n[i][j] * rows[j][c];
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
