//! How forces inside the cones can follow a change of the loads.
//!
//! Forces f inside the cones hold the bodies under F. Under F + dF do
//!
//! ```text
//! f + df,   df = -D J (J' D J)^-1 dF,   J' df = -dF,                                   (1)
//! ```
//!
//! if they stay in the cones: the least change in the metric of the cones' barrier at f (`metric.rs`). It is linear in dF,
//! so the changes for some loads tell those for all sums of them.

use super::metric::Metric;

/// Solves for what the change before has left of a load: rounding after the first.
const REFINEMENTS: usize = 1;

impl<const B: usize, const D: usize> Metric<B, D> {
    /// The changes (1) of some forces for some loads. None if some body could not be held by these forces whatever they were.
    pub(super) fn changes(&mut self, forces: &[f64], loads: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        let f = self.problem.in_own_units(forces);
        self.factor(&f, 0.0)?;
        let mut changes = Vec::with_capacity(loads.len());
        for load in loads {
            let load = self.problem.load_in_own_units(load);
            let (mut left, mut df) = (load.clone(), vec![0.0; f.len()]);
            for _ in 0..=REFINEMENTS {
                self.take_up(&f, &mut left, &mut df);
                left.copy_from_slice(&load);
                self.problem.add_wrenches(&df, 1.0, &mut left);
            }
            changes.push(self.problem.in_newtons(&df));
        }
        Some(changes)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Barrier, Cone, Gauss, Point};

    /// A body of mass 2 on two points 1 m apart, under its weight and a friction of a half.
    fn block(round: bool) -> Gauss {
        let row = |x: f64| {
            let mut jacobian = [[[0.0; 6]; 3]; 2];
            jacobian[1] = match round {
                false => [[0.0, 1.0, x, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0; 6]],
                true => [[0.0, 1.0, 0.0, 0.0, 0.0, x], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, -x, 0.0]],
            };
            jacobian
        };
        let cone = match round {
            true => Cone::Round { friction: 0.5 },
            false => Cone::Edges(vec![[1.0, 0.5, 0.0], [1.0, -0.5, 0.0]]),
        };
        let point = |x: f64| Point { bodies: [None, Some(0)], jacobian: row(x), cone: cone.clone() };
        let size = if round { 6 } else { 3 };
        let mut load = vec![0.0; size];
        load[1] = -20.0;
        Gauss { size, inverse_mass: vec![0.5; size], load, points: vec![point(-0.5), point(0.5)], ..Gauss::default() }
    }

    #[test]
    fn forces_follow_a_load_and_balance_it() {
        let problem = block(false);
        let forces = [5.0; 4]; // along the edges: 10 up at each point
        let loads = [vec![0.0, -4.0, 0.0], vec![2.0, 0.0, 0.0], vec![0.0, 0.0, 1.0]];
        let mut barrier = Barrier::new(&problem).expect("three unknowns");
        let changes = barrier.changes(&forces, &loads).expect("forces that hold it");
        for (load, change) in loads.iter().zip(&changes) {
            let [a, b, c, d] = change[..] else { panic!("four unknowns") };
            let sums = [0.5 * (a - b + c - d), a + b + c + d, 0.5 * (c + d - a - b)];
            for (sum, load) in sums.iter().zip(load) {
                assert!((sum + load).abs() < 1e-12, "{sums:?} against {load}");
            }
        }
        assert!(changes[0].iter().all(|df| (df - 1.0).abs() < 1e-12), "alike at all edges");
    }

    #[test]
    fn in_round_cones_too() {
        let mut problem = block(true);
        // Nothing turns it about the line of its two points, so that it needs no force there.
        problem.points.push(Point { bodies: [None, Some(0)], ..problem.points[0].clone() });
        problem.points[2].jacobian[1] =
            [[0.0, 1.0, 0.0, -0.5, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.5, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]];
        let forces = [8.0, 1.0, 0.0, 8.0, -1.0, 0.0, 4.0, 0.0, 0.5];
        let load = vec![1.0, -2.0, 0.5, 0.1, 0.2, -0.3];
        let mut barrier = Barrier::new(&problem).expect("six unknowns");
        let changes = barrier.changes(&forces, std::slice::from_ref(&load)).expect("forces that hold it");
        let [change] = &changes[..] else { panic!("one") };
        let mut left = load;
        for (point, df) in problem.points.iter().zip(change.chunks(3)) {
            for (row, df) in point.jacobian[1].iter().zip(df) {
                left.iter_mut().zip(row).for_each(|(left, row)| *left += row * df);
            }
        }
        assert!(left.iter().all(|left| left.abs() < 1e-12), "{left:?}");
    }
}
