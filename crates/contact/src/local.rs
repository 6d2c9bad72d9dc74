//! One contact alone: its impulse from Coulomb's law, exactly.
//!
//! With `u = W p + q` there are three ways (the law's three parts). It parts: `q_n >= 0` and p = 0. It sticks: `p = -W^-1 q`
//! where that lies in the cone. It slides: `u_n = 0` and `u_t = -alpha p_t`, `|p_t| = mu p_n` for some alpha > 0. For every alpha
//! the first two equations are linear in p; at alpha = 0 it would stick, which is outside of the cone, and for alpha without
//! bound p_t goes to zero and p_n to `-q_n / W_nn > 0`: so there is a root of `mu p_n / |p_t| = 1`, whatever mu. The ratio is nearly linear in
//! alpha (as in the secular equation of trust regions; Moré and Sorensen 1983), so Newton's method, kept within
//! its bracket, takes two or three steps. Tangents are turned so that `W_tt` is diagonal, which makes each of them cheap.
//!
//! The same local problem, other ways to its root: Bonnefon and Daviet, Quartic formulation of Coulomb 3D frictional contact, 2011 (a
//! polynomial's roots); Hwangbo, Lee and Hutter, Per-contact iteration method for solving contact dynamics, 2018 (a bisection).

use crate::law::{dot, tangential};

/// `W` of one contact in its own frame, and what is made of it once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Local<const D: usize> {
    pub friction: f64,
    /// `W_nn`, `W_nt`: the first row.
    pub normal: [f64; D],
    /// `W_tt`, diagonal; the first entry is not used.
    pub tangent: [f64; D],
    /// Mean of W's diagonal: an impulse times it is a speed. One where nothing moves.
    pub weight: f64,
    /// `W^-1`.
    inverse: [[f64; D]; D],
    /// Whether W can be inverted.
    regular: bool,
}

/// Newton steps on alpha: two or three are the rule.
const MOST: usize = 60;
/// Change of alpha, relative, below which it is known.
const KNOWN: f64 = 1e-14;
/// Share of its diagonal's product that W's determinant must keep to be inverted.
const REGULAR: f64 = 1e-12;

impl<const D: usize> Local<D> {
    pub fn new(friction: f64, normal: [f64; D], tangent: [f64; D]) -> Self {
        // By the Schur complement of the diagonal W_tt.
        let mut schur = normal[0];
        let mut share = [0.0; D];
        let mut regular = normal[0] > 0.0;
        for k in 1..D {
            regular &= tangent[k] > 0.0;
            share[k] = normal[k] / tangent[k];
            schur -= normal[k] * share[k];
        }
        regular &= schur > REGULAR * normal[0];
        let mut inverse = [[0.0; D]; D];
        if regular {
            inverse[0][0] = 1.0 / schur;
            for i in 1..D {
                inverse[0][i] = -share[i] / schur;
                inverse[i][0] = inverse[0][i];
                for j in 1..D {
                    inverse[i][j] = share[i] * share[j] / schur;
                }
                inverse[i][i] += 1.0 / tangent[i];
            }
        }
        let trace = normal[0] + tangent[1..].iter().sum::<f64>();
        let weight = if trace > 0.0 { trace / D as f64 } else { 1.0 };
        Self { friction, normal, tangent, weight, inverse, regular }
    }

    /// `W p`.
    #[inline(always)]
    pub fn times(&self, p: &[f64; D]) -> [f64; D] {
        let mut u = [dot(&self.normal, p); D];
        for k in 1..D {
            u[k] = self.normal[k] * p[0] + self.tangent[k] * p[k];
        }
        u
    }

    /// The impulse for the velocity `q` without it. `alpha`: where the root was last; it is where it is now afterwards.
    #[inline]
    pub fn solve(&self, q: &[f64; D], alpha: &mut f64) -> [f64; D] {
        if q[0] >= 0.0 || self.normal[0] <= 0.0 {
            return [0.0; D];
        }
        if self.friction == 0.0 {
            let mut p = [0.0; D];
            p[0] = -q[0] / self.normal[0];
            return p;
        }
        if self.regular {
            let mut p = [0.0; D];
            for k in 0..D {
                p[k] = -dot(&self.inverse[k], q);
            }
            if tangential(&p) <= self.friction * p[0] {
                return p;
            }
        }
        self.slide(q, alpha)
    }

    fn slide(&self, q: &[f64; D], alpha: &mut f64) -> [f64; D] {
        let (mut low, mut high) = (0.0_f64, f64::INFINITY);
        let mut at = if *alpha > 0.0 { *alpha } else { self.normal[0] };
        let mut p = [0.0; D];
        for _ in 0..MOST {
            let (mut above, mut below) = (-q[0], self.normal[0]);
            let (mut d_above, mut d_below) = (0.0, 0.0);
            for k in 1..D {
                let s = 1.0 / (self.tangent[k] + at);
                let bs = self.normal[k] * s;
                above += bs * q[k];
                below -= bs * self.normal[k];
                d_above -= bs * s * q[k];
                d_below += bs * bs;
            }
            p[0] = above / below;
            let d_normal = (d_above - p[0] * d_below) / below;
            let (mut square, mut d_square) = (0.0, 0.0);
            for k in 1..D {
                let s = 1.0 / (self.tangent[k] + at);
                p[k] = -(q[k] + self.normal[k] * p[0]) * s;
                let d = -(self.normal[k] * d_normal + p[k]) * s;
                square += p[k] * p[k];
                d_square += p[k] * d;
            }
            let size = square.sqrt();
            // h = mu p_n / |p_t| - 1 grows through zero.
            let limit = self.friction * p[0];
            if limit > size {
                high = at;
            } else {
                low = at;
            }
            if size == 0.0 {
                at = 0.5 * (low + high);
                continue;
            }
            let h = limit / size - 1.0;
            let slope = (self.friction * d_normal - limit * d_square / square) / size;
            let mut next = at - h / slope;
            if !(next > low && next < high) {
                next = if high.is_finite() { 0.5 * (low + high) } else { 4.0 * at };
            }
            let change = (next - at).abs();
            at = next;
            if change <= KNOWN * at || h.abs() <= KNOWN {
                break;
            }
        }
        *alpha = at;
        self.on_the_edge(p)
    }

    /// Puts friction on the edge of its cone, off which the last digit of alpha leaves it.
    fn on_the_edge(&self, mut p: [f64; D]) -> [f64; D] {
        p[0] = p[0].max(0.0);
        let size = tangential(&p);
        if size > 0.0 {
            let factor = self.friction * p[0] / size;
            for x in &mut p[1..] {
                *x *= factor;
            }
        }
        p
    }
}

#[cfg(test)]
mod tests {
    use super::Local;
    use crate::law::error;
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// Any semidefinite W, nearly singular ones too, and any friction: the law holds to rounding.
    #[test]
    fn one_contact_obeys_the_law() {
        let mut random = Pcg64Mcg::seed_from_u64(1);
        let mut counts = [0; 3];
        for round in 0..20_000 {
            // W = R R' with a diagonal W_tt: two tangential rows square to one another, a normal row that leans on both.
            let lean: [f64; 2] = [random.random_range(-3.0..3.0), random.random_range(-3.0..3.0)];
            let own: f64 = if round % 5 == 0 { 1e-6 } else { random.random_range(0.01..2.0) };
            let tangent: [f64; 3] = [0.0, random.random_range(0.01..2.0), random.random_range(0.01..2.0)];
            let (a, b) = (lean[0] * tangent[1].sqrt(), lean[1] * tangent[2].sqrt());
            let normal = [own + lean[0].powi(2) + lean[1].powi(2), a, b];
            let friction = [0.0, 0.1, 0.5, 1.0, 10.0][round % 5];
            let local = Local::<3>::new(friction, normal, tangent);
            let q = [0, 1, 2].map(|_| random.random_range(-1.0..1.0));
            let p = local.solve(&q, &mut 0.0);
            let moved = local.times(&p);
            let u = [0, 1, 2].map(|k| q[k] + moved[k]);
            let size = p.iter().fold(1.0_f64, |size, p| size.max(p.abs() * local.weight));
            assert!(error(friction, &u, &p, local.weight) < 1e-9 * size, "{round}: {local:?} {q:?} {p:?} {u:?}");
            counts[if p[0] == 0.0 { 0 } else { usize::from(u[1].hypot(u[2]) > 1e-6) + 1 }] += 1;
        }
        assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
    }
}
