//! Forces well inside the friction cones, and the cases around that follow from them.

use crate::{
    formulate::{Assembly, BlockSet, BodySpace, FrictionCone, Push},
    judgement::AT_REST,
    proof::accelerations_under,
};
use drystone_lcp::interior::{Cone, Gauss, Nearby};
use std::sync::Arc;

/// Most centres: each takes as much memory as forces for every load.
const MOST: usize = 64;

/// Forces at a case, and how they change with the factors.
#[derive(Debug)]
pub(super) struct Centre {
    case: Vec<f64>,
    forces: Vec<f64>,
    changes: Vec<Vec<f64>>,
    /// What the forces leave of each block's loads, as the speed of its fastest point, m/s^2; and what the changes leave of a load.
    left: Vec<f64>,
    left_of: Vec<Vec<f64>>,
}

impl Centre {
    pub fn case(&self) -> &[f64] {
        &self.case
    }

    fn away(&self, case: &[f64]) -> Vec<f64> {
        case.iter().zip(&self.case).map(|(to, from)| to - from).collect()
    }
}

/// All that are known.
#[derive(Debug)]
pub(super) struct Centres<'a> {
    blocks: &'a BlockSet,
    space: BodySpace<'a>,
    /// The loads in the problem's terms, and each of them alone.
    loads: Vec<Vec<f64>>,
    alone: Vec<Assembly>,
    nearby: Nearby,
    known: Vec<Arc<Centre>>,
}

impl<'a> Centres<'a> {
    /// None if there is no memory for a factor.
    pub fn new(assembly: &'a Assembly, blocks: &'a BlockSet, pushes: &[Push], cone: FrictionCone) -> Option<Self> {
        let space = assembly.body_space(blocks, cone);
        let alone = pushes.iter().map(|push| assembly.only(push, 1.0)).collect();
        let nearby = Nearby::new(space.problem())?;
        let loads = pushes.iter().map(|push| space.load(push)).collect();
        Some(Self { blocks, loads, alone, nearby, known: Vec::new(), space })
    }

    /// Whether forces near those of a centre hold a case.
    pub fn hold(&self, case: &[f64]) -> bool {
        let weighing = self.space.assembly().weighing();
        self.known.iter().any(|centre| {
            let away = centre.away(case);
            let sum = |own: f64, k: usize, each: &[Vec<f64>]| -> f64 {
                own + away.iter().zip(each).map(|(factor, of)| factor * of[k]).sum::<f64>()
            };
            let moves = |(k, left): (usize, &f64)| {
                left + away.iter().zip(&centre.left_of).map(|(factor, of)| factor.abs() * of[k]).sum::<f64>()
            };
            let (mut first, mut own) = (0, Vec::with_capacity(8));
            let inside = self.space.problem().points.iter().all(|point| {
                own.clear();
                let range = first..first + point.cone.unknowns();
                first = range.end;
                own.extend(range.map(|k| sum(centre.forces[k], k, &centre.changes)));
                gaps_are(&point.cone, &own, |gap| gap >= 0.0)
            });
            inside && centre.left.iter().enumerate().map(moves).all(|speed| speed <= AT_REST * weighing)
        })
    }

    /// The centre whose forces, changed, hold the largest share of the way to a case, and that share. None without any.
    pub fn nearest(&self, case: &[f64]) -> Option<(f64, Arc<Centre>)> {
        let share = |centre: &Arc<Centre>| {
            let away = centre.away(case);
            let change = |k: usize| away.iter().zip(&centre.changes).map(|(x, of)| x * of[k]).sum();
            let change: Vec<f64> = (0..centre.forces.len()).map(change).collect();
            (share(self.space.problem(), &centre.forces, &change), Arc::clone(centre))
        };
        self.known.iter().map(share).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Keeps forces that hold a case, whose loads act on `pushed`, if they are inside the cones.
    pub fn keep(&mut self, pushed: &Assembly, case: Vec<f64>, forces: Vec<f64>) {
        let usable = inside(self.space.problem(), &forces) && self.known.len() < MOST;
        if !usable || !self.nearby.at(&forces) {
            return;
        }
        let nearby = &mut self.nearby;
        let changes: Vec<Vec<f64>> = self.loads.iter().map(|load| nearby.change(load)).collect();
        let left = |assembly: &Assembly, forces: &[f64]| -> Vec<f64> {
            let under = accelerations_under(assembly, self.blocks, &self.space.forces(forces));
            under.iter().map(|(block, a)| assembly.speed(*block, a)).collect()
        };
        let left_of = self.alone.iter().zip(&changes).map(|(alone, change)| left(alone, change)).collect();
        let left = left(pushed, &forces);
        self.known.push(Arc::new(Centre { case, forces, changes, left, left_of }));
    }
}

/// Whether what is left between forces and the borders of their cone, N, is as said.
fn gaps_are(cone: &Cone, f: &[f64], said: impl Fn(f64) -> bool) -> bool {
    match cone {
        Cone::Edges(_) => f.iter().all(|f| said(*f)),
        Cone::Round { friction } => said(friction * f[0] - f[1].hypot(f[2])),
    }
}

/// Whether all forces are inside their cones, not on a border.
fn inside(problem: &Gauss, forces: &[f64]) -> bool {
    let mut first = 0;
    problem.points.iter().all(|point| {
        let own = &forces[first..first + point.cone.unknowns()];
        first += own.len();
        gaps_are(&point.cone, own, |gap| gap > 0.0)
    })
}

/// How much of a change forces inside the cones can go along with.
fn share(problem: &Gauss, forces: &[f64], change: &[f64]) -> f64 {
    let (mut first, mut least) = (0, f64::INFINITY);
    for point in &problem.points {
        let own = first..first + point.cone.unknowns();
        first = own.end;
        let (f, df) = (&forces[own.clone()], &change[own]);
        least = match &point.cone {
            Cone::Edges(_) => {
                let to_border = |(f, df): (&f64, &f64)| if *df < 0.0 { -f / df } else { f64::INFINITY };
                f.iter().zip(df).map(to_border).fold(least, f64::min)
            }
            Cone::Round { friction } => least.min(to_round_border(*friction, f, df)),
        };
    }
    least
}

/// The least t > 0 with `f + t df` on the border of a round cone that f is inside of: a root of a quadratic.
fn to_round_border(friction: f64, f: &[f64], df: &[f64]) -> f64 {
    let (n, dn) = (friction * f[0], friction * df[0]);
    let a = dn * dn - df[1] * df[1] - df[2] * df[2];
    let b = n * dn - f[1] * df[1] - f[2] * df[2];
    let c = (n - f[1].hypot(f[2])) * (n + f[1].hypot(f[2]));
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    [q / a, c / q].into_iter().filter(|t| *t > 0.0).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::to_round_border;

    #[test]
    fn the_way_to_the_border_of_a_round_cone() {
        let near =
            |t: f64, expected: f64| assert!((t - expected).abs() < 1e-12 || t == expected, "{t}, not {expected}");
        near(to_round_border(0.5, &[2.0, 0.0, 0.0], &[0.0, 1.0, 0.0]), 1.0);
        near(to_round_border(0.5, &[2.0, 0.0, 0.0], &[-1.0, 0.0, 0.0]), 2.0);
        near(to_round_border(0.5, &[2.0, 0.0, 0.0], &[1.0, 0.0, 0.0]), f64::INFINITY);
        near(to_round_border(0.5, &[2.0, 0.5, 0.0], &[2.0, -1.5, 0.0]), 3.0);
        near(to_round_border(1.0, &[1.0, 0.0, 0.0], &[1.0, -1.0, 0.0]), f64::INFINITY);
    }
}
