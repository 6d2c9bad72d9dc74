//! Forces well inside the friction cones, and the cases around that follow from them.

use crate::{
    formulate::{Assembly, BlockSet, BodySpace, Components, FrictionCone, Push},
    judgement::AT_REST,
    proof::accelerations_under,
};
use drystone_lcp::interior::{Barrier, Cone, Gauss, Walked};
use std::sync::{Arc, Mutex, PoisonError};

/// Most centres: each takes as much memory as forces for every load.
const MOST: usize = 128;

/// Forces at a case, and how they change with the factors.
#[derive(Debug)]
pub(super) struct Centre {
    case: Vec<f64>,
    forces: Vec<f64>,
    /// The cones, those first whose border is nearest.
    rows: Vec<Row>,
    /// Of each row the forces, and their change with each factor: for each unknown one number and as many as there are loads.
    numbers: Vec<f64>,
    /// What the forces leave of each block's loads, as the speed of its fastest point, m/s^2; and what the changes leave of a load.
    left: Vec<f64>,
    left_of: Vec<Vec<f64>>,
}

/// The forces of a cone: one edge, or all of a round one.
#[derive(Debug, Clone, Copy)]
struct Row {
    /// Its numbers begin here.
    first: u32,
    /// How far factors may change, at least, in the Euclidean norm, before the forces are on the border.
    reach: f64,
    /// Coefficient of a round cone; none of an edge.
    friction: Option<f64>,
}

impl Centre {
    fn new(
        problem: &Gauss,
        case: Vec<f64>,
        forces: Vec<f64>,
        changes: &[Vec<f64>],
        left: Vec<f64>,
        left_of: Vec<Vec<f64>>,
    ) -> Self {
        let (mut numbers, mut rows) = (Vec::new(), Vec::new());
        let mut unknown = 0..0;
        for point in &problem.points {
            let round = if let Cone::Round { friction } = point.cone { Some(friction) } else { None };
            let each = if round.is_some() { point.cone.unknowns() } else { 1 };
            let end = unknown.end + point.cone.unknowns();
            while unknown.end < end {
                unknown = unknown.end..unknown.end + each;
                rows.push(Row {
                    first: numbers.len() as u32,
                    reach: reach(round, &forces[unknown.clone()], changes.iter().map(|of| &of[unknown.clone()])),
                    friction: round,
                });
                for k in unknown.clone() {
                    numbers.push(forces[k]);
                    numbers.extend(changes.iter().map(|of| of[k]));
                }
            }
        }
        rows.sort_by(|a, b| a.reach.total_cmp(&b.reach));
        Self { case, forces, rows, numbers, left, left_of }
    }

    pub fn case(&self) -> &[f64] {
        &self.case
    }

    fn away(&self, case: &[f64]) -> Vec<f64> {
        case.iter().zip(&self.case).map(|(to, from)| to - from).collect()
    }

    /// How much of the way to a case the forces can go along with; not looked for below `least`.
    pub fn share(&self, case: &[f64], least: f64) -> f64 {
        let away = &self.away(case);
        let far = norm(away);
        let mut share = f64::INFINITY;
        for row in &self.rows {
            // All others go further.
            if share < least || share * far <= row.reach {
                break;
            }
            let of = |k: usize| {
                let own = &self.numbers[row.first as usize + k * (away.len() + 1)..][..=away.len()];
                (own[0], product(&own[1..], away))
            };
            let (f, df) = of(0);
            share = share.min(match row.friction {
                None if df < 0.0 => -f / df,
                None => f64::INFINITY,
                Some(friction) => {
                    let ((u, du), (v, dv)) = (of(1), of(2));
                    to_round_border(friction, &[f, u, v], &[df, du, dv])
                }
            });
        }
        share
    }

    /// Whether what its forces, changed, leave of each block's loads is at most so fast, m/s^2.
    fn leaves(&self, away: &[f64], most: f64) -> bool {
        self.left.iter().enumerate().all(|(block, left)| {
            let more: f64 = away.iter().zip(&self.left_of).map(|(factor, of)| factor.abs() * of[block]).sum();
            left + more <= most
        })
    }
}

/// The least change of the factors that could bring the forces of a cone to its border.
fn reach<'a>(round: Option<f64>, f: &[f64], changes: impl Iterator<Item = &'a [f64]>) -> f64 {
    let gap = |f: &[f64]| round.map_or(f[0], |friction| friction * f[0] - f[1].hypot(f[2]));
    let speed = |df: &[f64]| round.map_or(df[0].abs(), |friction| friction * df[0].abs() + df[1].hypot(df[2]));
    gap(f) / changes.map(|df| speed(df).powi(2)).sum::<f64>().sqrt()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    product(a, a).sqrt()
}

/// What centres are made with.
#[derive(Debug)]
pub(super) struct Centres<'a> {
    blocks: &'a BlockSet,
    space: BodySpace<'a>,
    /// The loads in the problem's terms.
    loads: Vec<Vec<f64>>,
    /// Those that nobody uses at the moment: as many as there were threads at once.
    barriers: Mutex<Vec<Barrier>>,
    kept: usize,
}

impl<'a> Centres<'a> {
    /// None if there is no memory for a factor.
    pub fn new(assembly: &'a Assembly, blocks: &'a BlockSet, pushes: &[Push], cone: FrictionCone) -> Option<Self> {
        let space = assembly.body_space(blocks, cone);
        let barriers = Mutex::new(vec![Barrier::new(space.problem())?]);
        let loads = pushes.iter().map(|push| space.load(push)).collect();
        Some(Self { blocks, loads, barriers, kept: 0, space })
    }

    /// The problem.
    pub fn space(&self) -> &BodySpace<'a> {
        &self.space
    }

    /// Follows the loads from a centre to a case, as far as they can be borne. None where that leads nowhere.
    pub fn walk(&self, from: &Centre, case: &[f64]) -> Option<Walked> {
        let sum = |own: &[f64], factors: &[f64]| -> Vec<f64> {
            let of = |k: usize| factors.iter().zip(&self.loads).map(|(factor, load)| factor * load[k]).sum::<f64>();
            own.iter().enumerate().map(|(k, own)| own + of(k)).collect()
        };
        let own = &self.space.problem().load;
        let (load, more) = (sum(own, &from.case), sum(&vec![0.0; own.len()], &from.away(case)));
        self.with_barrier(|barrier| barrier.walk(&from.forces, &load, &more))
    }

    /// What is found with one that nobody uses, or a new one. None if there is no memory for that, or nothing was found.
    fn with_barrier<T>(&self, find: impl FnOnce(&mut Barrier) -> Option<T>) -> Option<T> {
        let free = || self.barriers.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = free().pop();
        let mut barrier = match kept {
            Some(barrier) => barrier,
            None => Barrier::new(self.space.problem())?,
        };
        let found = find(&mut barrier);
        free().push(barrier);
        found
    }

    /// Whether the forces of a centre hold a case that they follow for such a share of the way.
    pub fn hold(&self, centre: &Centre, case: &[f64], share: f64) -> bool {
        share >= 1.0 && centre.leaves(&centre.away(case), AT_REST * self.space.assembly().weighing())
    }

    /// Whether forces are inside their cones, not on a border.
    pub fn inside(&self, forces: &[f64]) -> bool {
        inside(self.space.problem(), forces)
    }

    /// Keeps forces that hold a case, whose loads act on `pushed`, if they are inside the cones, as long as there is room.
    pub fn keep(&mut self, pushed: &Assembly, case: Vec<f64>, forces: Vec<f64>) -> Option<Arc<Centre>> {
        if !self.inside(&forces) || self.kept >= MOST {
            return None;
        }
        let changes = self.with_barrier(|barrier| barrier.changes(&forces, &self.loads))?;
        self.kept += 1;
        let speeds = |under: &[(usize, Components)]| -> Vec<f64> {
            under.iter().map(|(block, a)| pushed.speed(*block, a)).collect()
        };
        let of = |(load, change): (&Vec<f64>, &Vec<f64>)| speeds(&self.space.accelerations(load, change));
        let left_of = self.loads.iter().zip(&changes).map(of).collect();
        let left = speeds(&accelerations_under(pushed, self.blocks, &self.space.forces(&forces)));
        Some(Arc::new(Centre::new(self.space.problem(), case, forces, &changes, left, left_of)))
    }
}

/// Whether all forces are inside their cones, not on a border.
fn inside(problem: &Gauss, forces: &[f64]) -> bool {
    let mut first = 0;
    problem.points.iter().all(|point| {
        let own = &forces[first..first + point.cone.unknowns()];
        first += own.len();
        match point.cone {
            Cone::Edges(_) => own.iter().all(|f| *f > 0.0),
            Cone::Round { friction } => friction * own[0] > own[1].hypot(own[2]),
        }
    })
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
