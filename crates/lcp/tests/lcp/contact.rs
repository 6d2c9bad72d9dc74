//! Contact problems built by hand: stacked boxes, whose face contacts make M singular and every force tie.

use crate::{problems::problem, verify::solve_by_all};
use drystone_lcp::{Problem, Status, cone::Columns};

/// A unit generator of one contact point: the planar wrench (x, y, torque) on the upper block; the lower block gets its
/// reaction.
pub struct Generator {
    upper: usize,
    lower: Option<usize>,
    on_upper: [f64; 3],
    on_lower: [f64; 3],
}

impl Generator {
    /// The block that the contact carries.
    pub fn upper(&self) -> usize {
        self.upper
    }
}

/// Unit squares of unit mass (inertia 1/6) under gravity 1 at given centres, lowest first; every pair one apart in height
/// that overlaps sideways touches at both ends of the shared face, as does the ground at height 0.
pub struct Wall {
    pub centres: Vec<(f64, f64)>,
    pub friction: Option<f64>,
}

impl Wall {
    pub fn column(blocks: usize, friction: Option<f64>) -> Self {
        Self { centres: (0..blocks).map(|k| (0.0, k as f64 + 0.5)).collect(), friction }
    }

    /// Rows of `rows`, `rows - 1`, ..., 1 squares, each row half a square further in.
    pub fn pyramid(rows: usize, friction: Option<f64>) -> Self {
        let row = |level: usize| (0..rows - level).map(move |k| (k as f64 + level as f64 / 2.0, level as f64 + 0.5));
        Self { centres: (0..rows).flat_map(row).collect(), friction }
    }

    pub fn generators(&self) -> Vec<Generator> {
        let mut generators = Vec::new();
        for (upper, &(x, y)) in self.centres.iter().enumerate() {
            if y == 0.5 {
                self.face(&mut generators, upper, None, (x - 0.5, x + 0.5));
            }
            for (lower, &(below, height)) in self.centres.iter().enumerate() {
                if y - height == 1.0 && (x - below).abs() < 1.0 {
                    self.face(&mut generators, upper, Some(lower), (x.max(below) - 0.5, x.min(below) + 0.5));
                }
            }
        }
        generators
    }

    fn face(&self, generators: &mut Vec<Generator>, upper: usize, lower: Option<usize>, (from, to): (f64, f64)) {
        for at in [from, to] {
            let slopes = self.friction.map_or(vec![0.0], |mu| vec![-mu, mu]);
            for slope in slopes {
                // The force (slope, 1) acts half a block below the upper centre, half a block above the lower one.
                let arm = at - self.centres[upper].0;
                let on_upper = [slope, 1.0, arm + 0.5 * slope];
                let on_lower = lower.map_or([0.0; 3], |l| [-slope, -1.0, -(at - self.centres[l].0) + 0.5 * slope]);
                generators.push(Generator { upper, lower, on_upper, on_lower });
            }
        }
    }

    /// G, W and h of the same problem: three rows a block.
    pub fn columns(&self) -> (Columns, Vec<f64>, Vec<f64>) {
        let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
        for generator in self.generators() {
            let lower = generator.lower.map(|block| (block, generator.on_lower));
            for (block, wrench) in [(generator.upper, generator.on_upper)].into_iter().chain(lower) {
                indices.extend((0..3).map(|k| 3 * block + k));
                data.extend(wrench);
            }
            indptr.push(indices.len());
        }
        let blocks = self.centres.len();
        let g = Columns::new(3 * blocks, &indptr, &indices, &data).expect("test data is valid");
        (g, [1.0, 1.0, 6.0].repeat(blocks), [0.0, 1.0, 0.0].repeat(blocks))
    }

    /// `M = G' W G` and `q = G' W F`, W the inverse masses (1, 1, 6), F gravity.
    pub fn problem(&self) -> Problem {
        let generators = self.generators();
        let on = |g: &Generator, block: usize| {
            if g.upper == block {
                g.on_upper
            } else if g.lower == Some(block) {
                g.on_lower
            } else {
                [0.0; 3]
            }
        };
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + 6.0 * a[2] * b[2];
        let coupling = |a: &Generator, b: &Generator| {
            let lower = a.lower.map_or(0.0, |block| dot(a.on_lower, on(b, block)));
            dot(a.on_upper, on(b, a.upper)) + lower
        };
        let m: Vec<f64> = generators.iter().flat_map(|a| generators.iter().map(move |b| coupling(a, b))).collect();
        let q = generators.iter().map(|g| -g.on_upper[1] - g.on_lower[1]).collect();
        problem(&m, q)
    }
}

/// A standing wall: no block accelerates, so w = 0 on every generator, with and without friction.
#[test]
fn columns_and_pyramids_stand() {
    for friction in [None, Some(0.5)] {
        for size in 1..=7 {
            for wall in [Wall::column(3 * size, friction), Wall::pyramid(size, friction)] {
                let problem = wall.problem();
                let context = format!("{} blocks, friction {friction:?}", wall.centres.len());
                let solution = solve_by_all(&problem, &context);
                assert_eq!(solution.status, Status::Solved, "{context}");
                assert!(solution.w.iter().all(|w| w.abs() < 1e-10), "{context}: {:?}", solution.w);
            }
        }
    }
}

/// The weight of the wall reaches the ground: its forces add up to the number of blocks.
#[test]
fn the_ground_carries_the_weight() {
    let wall = Wall::pyramid(6, Some(0.7));
    let solution = solve_by_all(&wall.problem(), "pyramid");
    let ground: f64 =
        wall.generators().iter().zip(&solution.z).filter(|(g, _)| g.lower.is_none()).map(|(_, z)| z).sum();
    assert!((ground - wall.centres.len() as f64).abs() < 1e-9, "{ground}");
}

/// A block whose centre lies beyond the one below topples: by hand, about the edge at distance a inside its centre it
/// accelerates downwards; the contact at the far end opens.
#[test]
fn an_overhanging_block_topples() {
    for overhang in [0.4, 0.6] {
        let wall = Wall { centres: vec![(0.0, 0.5), (overhang, 1.5)], friction: None };
        let solution = solve_by_all(&wall.problem(), "overhang");
        assert_eq!(solution.status, Status::Solved);
        let moves = solution.w.iter().any(|w| *w > 1e-6);
        assert_eq!(moves, overhang > 0.5, "overhang {overhang}: {:?}", solution.w);
    }
}

/// Pyramids on which ties misjudged by rounding led Lemke's path back to the ray where it began, which was reported as a ray
/// that proves nothing. It is trouble, and a covering vector without ties finds the way.
#[test]
fn lemkes_path_does_not_run_back() {
    for blocks in 50..=55 {
        let mut wall = Wall::pyramid(13, None);
        wall.centres.truncate(blocks);
        let solution = solve_by_all(&wall.problem(), &format!("{blocks} blocks"));
        assert!(solution.w.iter().all(|w| w.abs() < 1e-10), "{blocks} blocks: {:?}", solution.w);
    }
}
