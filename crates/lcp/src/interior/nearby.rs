//! How forces inside the cones can follow a change of the loads.
//!
//! Forces f inside the cones hold the bodies under F. Under F + dF do
//!
//! ```text
//! f + df,   df = -D J (J' D J)^-1 dF,   J' df = -dF,                                   (1)
//! ```
//!
//! if they stay in the cones. D is the inverse of the Hessian of the cones' logarithmic barrier at f: of all changes that balance dF,
//! (1) is the least in the norm in which the border of the cones is at least one away from f (Dikin's ellipsoid). It is linear in dF,
//! so the changes for some loads tell those for all sums of them.

use super::{
    matrix::BodyMatrix,
    problem::Gauss,
    scaled::{Scaled, ScaledPoint},
};

/// Solves for what the change before has left of a load: rounding after the first.
const REFINEMENTS: usize = 1;

/// The matrix of (1), analysed once, factored at some forces.
#[derive(Debug)]
pub struct Nearby {
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    Plane(Box<Kept<3, 2>>),
    Space(Box<Kept<6, 3>>),
}

struct Kept<const B: usize, const D: usize> {
    problem: Scaled<B, D, 2>,
    matrix: BodyMatrix<B>,
    f: Vec<f64>,
    moved: Vec<f64>,
}

impl Nearby {
    /// None if there is no memory for it.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn new(problem: &Gauss) -> Option<Self> {
        let kind = match problem.size {
            3 => Kind::Plane(Box::new(Kept::new(problem)?)),
            6 => Kind::Space(Box::new(Kept::new(problem)?)),
            size => panic!("a body has 3 or 6 unknowns, not {size}"),
        };
        Some(Self { kind })
    }

    /// Takes forces inside the cones, point after point. False if some body could not be held by them whatever they were.
    pub fn at(&mut self, forces: &[f64]) -> bool {
        match &mut self.kind {
            Kind::Plane(kept) => kept.at(forces),
            Kind::Space(kept) => kept.at(forces),
        }
    }

    /// The changes (1) of those forces for some loads, each body after body.
    pub fn changes(&mut self, loads: &[Vec<f64>]) -> Vec<Vec<f64>> {
        match &mut self.kind {
            Kind::Plane(kept) => kept.changes(loads),
            Kind::Space(kept) => kept.changes(loads),
        }
    }
}

impl<const B: usize, const D: usize> std::fmt::Debug for Kept<B, D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Kept").field("forces", &self.f.len()).finish_non_exhaustive()
    }
}

impl<const B: usize, const D: usize> Kept<B, D> {
    fn new(problem: &Gauss) -> Option<Self> {
        let problem = Scaled::new(problem);
        let (f, moved) = (Vec::new(), vec![0.0; problem.forces()]);
        Some(Self { matrix: BodyMatrix::new(&problem)?, problem, f, moved })
    }

    fn at(&mut self, forces: &[f64]) -> bool {
        self.f = self.problem.in_own_units(forces);
        self.matrix.reset(|_| 0.0);
        for (index, point) in self.problem.points.iter().enumerate() {
            self.matrix.add(index, point, &weight(&self.problem, point, &self.f));
        }
        self.matrix.factor().is_some()
    }

    fn changes(&mut self, loads: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let Self { problem, matrix, f, moved } = self;
        let mut all_left: Vec<_> = loads.iter().map(|load| problem.load_in_own_units(load)).collect();
        let mut changes = vec![vec![0.0; f.len()]; loads.len()];
        for _ in 0..=REFINEMENTS {
            for ((left, df), load) in all_left.iter_mut().zip(&mut changes).zip(loads) {
                matrix.solve(left);
                problem.motion(left, moved);
                for point in &problem.points {
                    give_way(point.round, &f[point.own()], &moved[point.own()], &mut df[point.own()]);
                }
                *left = problem.load_in_own_units(load);
                problem.add_wrenches(df, 1.0, left);
            }
        }
        changes.iter().map(|df| problem.in_newtons(df)).collect()
    }
}

/// D of a point, on its directions.
pub(super) fn weight<const B: usize, const D: usize>(
    problem: &Scaled<B, D, 2>,
    point: &ScaledPoint<B, D, 2>,
    f: &[f64],
) -> [[f64; D]; D] {
    let (edges, f) = (&problem.edges[point.own()], &f[point.own()]);
    let mut weight = [[0.0; D]; D];
    let mut add = |one: &[f64; D], other: &[f64; D], value: f64| {
        (0..D).for_each(|i| (0..D).for_each(|j| weight[i][j] += one[i] * value * other[j]));
    };
    if !point.round {
        edges.iter().zip(f).for_each(|(edge, f)| add(edge, edge, f * f));
        return weight;
    }
    for (k, edge) in edges.iter().enumerate() {
        let (mut unit, mut column) = ([0.0; 3], [0.0; 3]);
        unit[k] = -1.0;
        give_way(true, f, &unit, &mut column);
        edges.iter().zip(column).for_each(|(other, value)| add(other, edge, value));
    }
    weight
}

/// Takes D times a motion from the forces of a point: the squares of the magnitudes along edges, `2 f f' - det(f) diag(1, -1, -1)`
/// in a round cone.
pub(super) fn give_way(round: bool, f: &[f64], moved: &[f64], df: &mut [f64]) {
    if !round {
        df.iter_mut().zip(f.iter().zip(moved)).for_each(|(df, (f, moved))| *df -= f * f * moved);
        return;
    }
    let radius = f[1].hypot(f[2]);
    let determinant = (f[0] - radius) * (f[0] + radius);
    let along: f64 = f.iter().zip(moved).map(|(f, moved)| f * moved).sum();
    for (k, df) in df.iter_mut().enumerate() {
        let sign = if k == 0 { 1.0 } else { -1.0 };
        *df -= 2.0 * along * f[k] - sign * determinant * moved[k];
    }
}

#[cfg(test)]
mod tests {
    use super::{
        super::{Cone, Gauss, Point},
        Nearby,
    };

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
        let mut nearby = Nearby::new(&problem).expect("three unknowns");
        assert!(nearby.at(&forces));
        let changes = nearby.changes(&loads);
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
        let mut nearby = Nearby::new(&problem).expect("six unknowns");
        assert!(nearby.at(&forces));
        let [change] = &nearby.changes(std::slice::from_ref(&load))[..] else { panic!("one") };
        let mut left = load;
        for (point, df) in problem.points.iter().zip(change.chunks(3)) {
            for (row, df) in point.jacobian[1].iter().zip(df) {
                left.iter_mut().zip(row).for_each(|(left, row)| *left += row * df);
            }
        }
        assert!(left.iter().all(|left| left.abs() < 1e-12), "{left:?}");
    }
}
