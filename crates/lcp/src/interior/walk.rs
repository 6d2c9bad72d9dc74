//! How far a load can grow, from forces well inside the cones that hold it.
//!
//! Forces f inside the cones hold the bodies under F, and are to follow F + t dF as far as there are any, or to t = 1. With D the
//! inverse of the Hessian of the cones' barrier at f (`metric.rs`), and r what f leaves of the load, a step is
//!
//! ```text
//! df = alpha (f - D J v0) - dt D J v1,   (J' D J) v0 = J' f + r,   (J' D J) v1 = dF     (1)
//! ```
//!
//! Its first part is Newton's step towards the forces of the largest barrier under the same load, its second one the least change
//! that takes up dt more of dF (affine scaling; I. I. Dikin 1967). dt is most of the way to the border of the cones. The motion
//! `v = v0 + (dt / alpha) v1` is that of Newton's step for the load and the barrier together. Where no contact closes in it,
//! J v in the dual cones, it proves that t is at most `-F'v / dF'v`: no more work of the loads can be borne (R. D. C. Monteiro
//! and I. Adler 1989 on such steps and their multipliers). Then nothing has to converge: a step or two suffice for what is
//! borne, and the bound says when the rest is not worth its time.

use super::{method::product, metric::Metric, scaling::way_to_border};

/// Steps: 3 for what is borne and 10 for what is not, about.
const MOST: usize = 40;
/// Share of the way to the border of the cones that the load takes, and that the centring takes.
const REACH: f64 = 0.95;
const CENTRING: f64 = 0.45;
/// Gap between what is borne and the bound, of the former, at which the mechanism is near enough to that of the limit.
const GAP: f64 = 0.1;
/// A step that takes up less of the whole load leads nowhere.
const LEAST: f64 = 1e-6;

/// Where a walk ended.
#[derive(Debug, Clone)]
pub struct Walked {
    /// How much of the load more was taken up, at most one.
    pub share: f64,
    /// Forces inside the cones, point after point, that hold the bodies there, N; to rounding where the share is one.
    pub forces: Vec<f64>,
    /// A motion in which no contact closes, body after body, in no particular unit; empty if none was found.
    pub motion: Vec<f64>,
    /// The share at which the loads do no work in it, so that no more can be borne. Infinite without one.
    pub bound: f64,
}

impl<const B: usize, const D: usize> Metric<B, D> {
    /// See [`Barrier::walk`](super::Barrier::walk).
    pub(super) fn walk(&mut self, forces: &[f64], load: &[f64], more: &[f64]) -> Option<Walked> {
        let mut f = self.problem.in_own_units(forces);
        let (load, more) = (self.problem.load_in_own_units(load), self.problem.load_in_own_units(more));
        let (mut share, mut bound, mut motion) = (0.0, f64::INFINITY, Vec::new());
        let (mut centring, mut growth) = (vec![0.0; f.len()], vec![0.0; f.len()]);
        for _ in 0..MOST {
            self.factor(&f, 0.0)?;
            let v0 = self.centring(&f, &plus(&load, share, &more), &mut centring);
            let v1 = self.give_way(&f, more.clone(), &mut growth);
            let alpha = (CENTRING * way_to_border(&self.problem, &f, &centring)).min(1.0);
            f.iter_mut().zip(&centring).for_each(|(f, df)| *f += alpha * df);
            let most = REACH * way_to_border(&self.problem, &f, &growth);
            let dt = most.min(1.0 - share);
            f.iter_mut().zip(&growth).for_each(|(f, df)| *f += dt * df);
            share += dt;
            if dt.is_nan() || dt < LEAST || !f.iter().all(|f| f.is_finite()) {
                return None;
            }
            if most.is_finite() {
                let v = plus(&v0, most / alpha, &v1);
                let proved = self.bound(&load, &more, &v, &mut centring);
                if proved < bound {
                    (bound, motion) = (proved, v);
                }
            }
            if dt < most {
                self.settle(&mut f, &plus(&load, 1.0, &more), &mut centring)?;
                share = 1.0;
            }
            if share == 1.0 || bound < 1.0 && bound - share <= GAP * share {
                let (forces, motion) = (self.problem.in_newtons(&f), self.problem.accelerations(&motion));
                return Some(Walked { share, forces, motion, bound });
            }
        }
        None
    }

    /// Newton's step towards the largest barrier under a load, and its v0.
    fn centring(&mut self, f: &[f64], load: &[[f64; B]], change: &mut [f64]) -> Vec<[f64; B]> {
        let mut left = load.to_vec();
        self.problem.add_wrenches(f, 2.0, &mut left);
        let v = self.give_way(f, left, change);
        change.iter_mut().zip(f).for_each(|(change, f)| *change += f);
        v
    }

    /// `v = (J' D J)^-1 load` and the change `-D J v`, which takes the load up.
    fn give_way(&mut self, f: &[f64], mut load: Vec<[f64; B]>, change: &mut [f64]) -> Vec<[f64; B]> {
        change.fill(0.0);
        self.take_up(f, &mut load, change);
        load
    }

    /// How much more can be borne at most, by a motion; infinite if a contact closes in it, or `more` does no work.
    fn bound(&self, load: &[[f64; B]], more: &[[f64; B]], v: &[[f64; B]], opening: &mut [f64]) -> f64 {
        self.problem.motion(v, opening);
        let opens = self.problem.points.iter().all(|point| {
            let s = &opening[point.own()];
            if point.round { s[0] >= s[1].hypot(s[2]) } else { s.iter().all(|s| *s >= 0.0) }
        });
        let of_more = product(more, v);
        if opens && of_more > 0.0 { -product(load, v) / of_more } else { f64::INFINITY }
    }

    /// Newton's steps towards the largest barrier up to the first full one, and the balance to rounding. More of them would bring
    /// forces that can follow other loads further, but not so much that it pays.
    fn settle(&mut self, f: &mut [f64], load: &[[f64; B]], change: &mut [f64]) -> Option<()> {
        for _ in 0..MOST {
            self.factor(f, 0.0)?;
            self.centring(f, load, change);
            let alpha = (REACH * way_to_border(&self.problem, f, change)).min(1.0);
            let before = f.to_vec();
            f.iter_mut().zip(&*change).for_each(|(f, df)| *f += alpha * df);
            if alpha == 1.0 {
                let mut left = load.to_vec();
                self.problem.add_wrenches(f, 1.0, &mut left);
                self.give_way(&before, left, change);
                f.iter_mut().zip(&*change).for_each(|(f, df)| *f += df);
                return Some(());
            }
        }
        None
    }
}

fn plus<const B: usize>(a: &[[f64; B]], factor: f64, b: &[[f64; B]]) -> Vec<[f64; B]> {
    a.iter().zip(b).map(|(a, b)| std::array::from_fn(|k| a[k] + factor * b[k])).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Barrier, Cone, Gauss, Point};

    /// A body of mass 2 on points 1 m apart, under its weight of 20 N and a friction of a half: it bears 10 N sideways.
    fn block(round: bool) -> (Gauss, Vec<f64>) {
        let cone = match round {
            true => Cone::Round { friction: 0.5 },
            false => Cone::Edges(vec![[1.0, 0.5, 0.0], [1.0, -0.5, 0.0]]),
        };
        let at = |x: f64, y: f64| {
            let mut jacobian = [[[0.0; 6]; 3]; 2];
            jacobian[1] = match round {
                false => [[0.0, 1.0, x, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0; 6]],
                true => [[0.0, 1.0, 0.0, y, 0.0, x], [1.0, 0.0, 0.0, 0.0, -y, 0.0], [0.0, 0.0, 1.0, 0.0, -x, 0.0]],
            };
            Point { bodies: [None, Some(0)], jacobian, cone: cone.clone() }
        };
        let corners = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)];
        let points: Vec<Point> = corners[..if round { 4 } else { 2 }].iter().map(|&(x, y)| at(x, y)).collect();
        let forces = if round { [5.0, 0.0, 0.0].repeat(4) } else { vec![5.0; 4] };
        let size = if round { 6 } else { 3 };
        let mut load = vec![0.0; size];
        load[1] = -20.0;
        (Gauss { size, inverse_mass: vec![0.5; size], load, points, ..Gauss::default() }, forces)
    }

    fn sideways(size: usize, force: f64) -> Vec<f64> {
        let mut load = vec![0.0; size];
        load[0] = force;
        load
    }

    /// What forces leave of a load, at most.
    fn left(problem: &Gauss, forces: &[f64], load: &[f64], more: &[f64]) -> f64 {
        let mut left: Vec<f64> = load.iter().zip(more).map(|(a, b)| a + b).collect();
        let mut rest = forces;
        for point in &problem.points {
            let (own, others) = rest.split_at(point.cone.unknowns());
            rest = others;
            for (force, row) in point.cone.force(own).iter().zip(&point.jacobian[1]) {
                left.iter_mut().zip(row).for_each(|(left, row)| *left += force * row);
            }
        }
        left.iter().fold(0.0, |most, left| most.max(left.abs()))
    }

    #[test]
    fn what_is_borne_is_held_to_rounding() {
        for round in [false, true] {
            let (problem, forces) = block(round);
            let more = sideways(problem.size, 9.9);
            let mut barrier = Barrier::new(&problem).expect("memory");
            let walked = barrier.walk(&forces, &problem.load, &more).expect("it leads there");
            assert!(walked.share == 1.0, "{walked:?}");
            assert!(left(&problem, &walked.forces, &problem.load, &more) < 1e-12, "{walked:?}");
            for point in walked.forces.chunks(if round { 3 } else { 1 }) {
                assert!(if round { 0.5 * point[0] > point[1].hypot(point[2]) } else { point[0] > 0.0 });
            }
        }
    }

    #[test]
    fn a_motion_bounds_what_is_not_borne() {
        for round in [false, true] {
            let (problem, forces) = block(round);
            let mut barrier = Barrier::new(&problem).expect("memory");
            let walked = barrier.walk(&forces, &problem.load, &sideways(problem.size, 40.0)).expect("it leads there");
            // A quarter of the 40 N; the bound is a proof, so never below.
            assert!(walked.share <= 0.25 && 0.25 <= walked.bound, "{walked:?}");
            assert!(walked.bound - walked.share <= 0.1 * walked.share, "{walked:?}");
            let slide = &walked.motion[..2];
            assert!(slide[0] > 0.0 && slide[1] >= 0.5 * slide[0] * (1.0 - 1e-12), "it opens by the angle of friction");
        }
    }

    #[test]
    fn nothing_limits_more_weight() {
        let (problem, forces) = block(false);
        let mut barrier = Barrier::new(&problem).expect("memory");
        let more = vec![0.0, -1e3, 0.0];
        let walked = barrier.walk(&forces, &problem.load, &more).expect("it leads there");
        assert!(walked.share == 1.0 && walked.bound.is_infinite(), "{walked:?}");
        assert!(left(&problem, &walked.forces, &problem.load, &more) < 1e-10, "{walked:?}");
    }
}
