//! The scaling of Nesterov and Todd: the W with `W f = W^-1 s`, for rays and for second-order cones of three components.

use super::scaled::{Scaled, ScaledPoint, largest_of};

/// W at a pair (f, s) inside the cones.
pub(super) struct Scaling {
    /// Of a ray `(W^2 + delta)^-1`, where W^2 is `s / f`.
    inverses: Vec<f64>,
    /// Of each round cone, in order.
    rounds: Vec<Round>,
    /// Weight of the proximal term.
    pub delta: f64,
}

/// `W = eta (2 v v' - diag(1, -1, -1))` with `v` the root of `w`: the eigenvectors of W are (1, axis), (1, -axis) and the tangent
/// square to it, its eigenvalues eta (w_0 + |w|), eta / (w_0 + |w|) and eta. Kept apart, since as entries of a matrix the
/// smallest eigenvalue would be lost beside the largest.
struct Round {
    eta: f64,
    w: [f64; 3],
    axis: [f64; 2],
    /// `(W^2 + delta)^-1` along the three eigenvectors.
    inverse: [f64; 3],
}

/// Length of the last two components; they are near one, so that no square overflows.
fn radius(x: &[f64]) -> f64 {
    (x[1] * x[1] + x[2] * x[2]).sqrt()
}

/// `x_0^2 - x_1^2 - x_2^2`, without the loss of digits near the border of the cone.
fn determinant(x: &[f64]) -> f64 {
    let radius = radius(x);
    (x[0] - radius) * (x[0] + radius)
}

impl Scaling {
    pub fn at<const B: usize, const D: usize, const N: usize>(
        problem: &Scaled<B, D, N>,
        f: &[f64],
        s: &[f64],
        delta: f64,
    ) -> Self {
        let mut inverses: Vec<f64> = f.iter().zip(s).map(|(f, s)| f / (s + delta * f)).collect();
        let mut rounds = Vec::new();
        for point in problem.points.iter().filter(|point| point.round) {
            inverses[point.own()].fill(0.0);
            rounds.push(Round::at(&f[point.own()], &s[point.own()], delta));
        }
        Self { inverses, rounds, delta }
    }

    /// `(W^2 + delta)^-1 x`, in place.
    pub fn divide<const B: usize, const D: usize, const N: usize>(&self, problem: &Scaled<B, D, N>, x: &mut [f64]) {
        if !problem.any_round {
            x.iter_mut().zip(&self.inverses).for_each(|(x, inverse)| *x *= inverse);
            return;
        }
        let mut rounds = self.rounds.iter();
        for point in &problem.points {
            let x = &mut x[point.own()];
            if point.round {
                rounds.next().expect("one for each").divide(x);
            } else {
                x.iter_mut().zip(&self.inverses[point.own()]).for_each(|(x, inverse)| *x *= inverse);
            }
        }
    }

    /// `(W^2 + delta)^-1` of each point as a matrix on the directions; to be asked in their order.
    pub fn weights<const B: usize, const D: usize, const N: usize>(
        &self,
        problem: &Scaled<B, D, N>,
    ) -> impl FnMut(&ScaledPoint<B, D, N>) -> [[f64; D]; D] {
        let mut rounds = self.rounds.iter();
        move |point| {
            let mut weight = [[0.0; D]; D];
            let edges = &problem.edges[point.own()];
            if point.round {
                let inner = rounds.next().expect("one for each").matrix();
                for i in 0..D {
                    (0..D).for_each(|k| weight[i][k] = edges[i][i] * inner[i][k] * edges[k][k]);
                }
            } else {
                for (edge, inverse) in edges.iter().zip(&self.inverses[point.own()]) {
                    for i in 0..D {
                        (0..D).for_each(|k| weight[i][k] += inverse * edge[i] * edge[k]);
                    }
                }
            }
            weight
        }
    }

    /// What is asked of `W^2 df + ds + s`: the centre `mu e` for the product, corrected for the second order of the step (df, ds).
    pub fn centre<const B: usize, const D: usize, const N: usize>(
        &self,
        problem: &Scaled<B, D, N>,
        f: &[f64],
        mu: f64,
        [df, ds]: [&[f64]; 2],
        out: &mut [f64],
    ) {
        (0..f.len()).for_each(|j| out[j] = (mu - df[j] * ds[j]) / f[j]);
        for (point, round) in problem.points.iter().filter(|point| point.round).zip(&self.rounds) {
            let own = point.own();
            let centred = round.centre(&f[own.clone()], mu, &df[own.clone()], &ds[own.clone()]);
            out[own].copy_from_slice(&centred);
        }
    }
}

impl Round {
    fn at(f: &[f64], s: &[f64], delta: f64) -> Self {
        let (root_f, root_s) = (determinant(f).sqrt(), determinant(s).sqrt());
        let eta = (root_s / root_f).sqrt();
        let inner: f64 = (0..3).map(|k| f[k] / root_f * (s[k] / root_s)).sum();
        let gamma = ((1.0 + inner) / 2.0).sqrt();
        let sign = [1.0, -1.0, -1.0];
        let w = [0, 1, 2].map(|k| (s[k] / root_s + sign[k] * f[k] / root_f) / (2.0 * gamma));
        let radius = radius(&w);
        let axis = if radius > 0.0 { [w[1] / radius, w[2] / radius] } else { [1.0, 0.0] };
        let (stretch, square) = (w[0] + radius, eta * eta);
        let squares = [square * stretch * stretch, square / (stretch * stretch), square];
        Self { eta, w, axis, inverse: squares.map(|square| (square + delta).recip()) }
    }

    /// Components along the eigenvectors (1, axis) / 2^1/2, (1, -axis) / 2^1/2 and the tangent.
    fn along(&self, x: &[f64]) -> [f64; 3] {
        let [c, s] = self.axis;
        let radial = c * x[1] + s * x[2];
        [x[0] + radial, x[0] - radial, c * x[2] - s * x[1]]
    }

    fn divide(&self, x: &mut [f64]) {
        let [first, second, third] = self.along(x);
        let [c, s] = self.axis;
        let (first, second, third) =
            (first * self.inverse[0] / 2.0, second * self.inverse[1] / 2.0, third * self.inverse[2]);
        let radial = first - second;
        x.copy_from_slice(&[first + second, c * radial - s * third, s * radial + c * third]);
    }

    fn matrix(&self) -> [[f64; 3]; 3] {
        let [c, s] = self.axis;
        let half = [self.inverse[0] / 2.0, self.inverse[1] / 2.0, self.inverse[2]];
        let vectors = [[1.0, c, s], [1.0, -c, -s], [0.0, -s, c]];
        [0, 1, 2].map(|i| [0, 1, 2].map(|k| (0..3).map(|v| half[v] * vectors[v][i] * vectors[v][k]).sum()))
    }

    fn multiply(&self, x: &[f64]) -> [f64; 3] {
        let tangential = self.w[1] * x[1] + self.w[2] * x[2];
        let share = x[0] + tangential / (1.0 + self.w[0]);
        [self.w[0] * x[0] + tangential, x[1] + share * self.w[1], x[2] + share * self.w[2]].map(|x| self.eta * x)
    }

    fn divide_by_root(&self, x: &[f64]) -> [f64; 3] {
        let tangential = self.w[1] * x[1] + self.w[2] * x[2];
        let share = tangential / (1.0 + self.w[0]) - x[0];
        [self.w[0] * x[0] - tangential, x[1] + share * self.w[1], x[2] + share * self.w[2]].map(|x| x / self.eta)
    }

    /// `W (l \ (mu e - (W df) o (W^-1 ds)))` with `l = W f`; `o` is the product of the cone's Jordan algebra, `\` undoes it.
    fn centre(&self, f: &[f64], mu: f64, df: &[f64], ds: &[f64]) -> [f64; 3] {
        let l = self.multiply(f);
        let (p, q) = (self.multiply(df), self.divide_by_root(ds));
        let product = [p[0] * q[0] + p[1] * q[1] + p[2] * q[2], p[0] * q[1] + q[0] * p[1], p[0] * q[2] + q[0] * p[2]];
        let right = [mu - product[0], -product[1], -product[2]];
        let first = (l[0] * right[0] - l[1] * right[1] - l[2] * right[2]) / determinant(&l);
        self.multiply(&[first, (right[1] - first * l[1]) / l[0], (right[2] - first * l[2]) / l[0]])
    }
}

/// The largest step, at most one, that keeps `x + step d` in the cones.
pub(super) fn step<const B: usize, const D: usize, const N: usize>(
    problem: &Scaled<B, D, N>,
    x: &[f64],
    d: &[f64],
) -> f64 {
    way_to_border(problem, x, d).min(1.0)
}

/// The largest step that keeps `x + step d` in the cones; may be infinite.
pub(super) fn way_to_border<const B: usize, const D: usize, const N: usize>(
    problem: &Scaled<B, D, N>,
    x: &[f64],
    d: &[f64],
) -> f64 {
    if problem.any_round {
        let mut longest = f64::INFINITY;
        for point in &problem.points {
            let own = point.own();
            let here =
                if point.round { step_in_round(&x[own.clone()], &d[own]) } else { on_rays(&x[own.clone()], &d[own]) };
            longest = longest.min(here);
        }
        return longest;
    }
    on_rays(x, d)
}

fn on_rays(x: &[f64], d: &[f64]) -> f64 {
    largest_of([x, d], |[x, d]| -d / x).recip()
}

/// The first positive root of `determinant(x + t d)`, or of the first component.
fn step_in_round(x: &[f64], d: &[f64]) -> f64 {
    let a = determinant(d);
    let b = x[0] * d[0] - x[1] * d[1] - x[2] * d[2];
    let c = determinant(x).max(0.0);
    let mut longest = if d[0] < 0.0 { -x[0] / d[0] } else { f64::INFINITY };
    let discriminant = b * b - a * c;
    if discriminant >= 0.0 {
        let q = -(b + discriminant.sqrt().copysign(b));
        for root in [q / a, c / q] {
            if root > 0.0 {
                longest = longest.min(root);
            }
        }
    }
    longest
}
