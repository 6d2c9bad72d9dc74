//! The problem in its own units: `M` becomes one, the largest load one, and a row of J has at most length one.

use super::{
    layers::Layers,
    problem::{Cone, Gauss},
};

/// A [`Gauss`] problem with `a~ = M^1/2 a / unit`, `f~` and `s~` in units of their rows; bodies of B unknowns, contacts of D
/// directions between N of them. Layers are bodies behind the others.
pub(super) struct Scaled<const B: usize, const D: usize, const N: usize> {
    /// `M^-1/2 F / unit`.
    pub load: Vec<[f64; B]>,
    /// `M^-1/2` times [`Gauss::push`], its largest entry one; may be empty.
    pub push: Vec<[f64; B]>,
    /// What a factor of one in the caller's unit is in that of `push`.
    pub push_unit: f64,
    pub points: Vec<ScaledPoint<B, D, N>>,
    /// Whether a cone is round.
    pub any_round: bool,
    /// What each unknown force is along the directions of its point: an edge, whose row of `J` has length one, or a component
    /// of a round cone, scaled so that the cone is the second-order one.
    pub edges: Vec<[f64; D]>,
    /// What the force of each edge was divided by.
    lengths: Vec<f64>,
    /// [`Gauss::offset`] in own units; may be empty.
    offset: Vec<f64>,
    /// Largest entry of `M^-1/2 F`.
    unit: f64,
    root: Vec<[f64; B]>,
}

/// A point, its rows multiplied by `M^-1/2`.
pub(super) struct ScaledPoint<const B: usize, const D: usize, const N: usize> {
    bodies: [u32; N],
    pub jacobian: [[[f64; B]; D]; N],
    /// Its forces, first and behind the last.
    first: u32,
    end: u32,
    /// Whether its cone is a second-order one.
    pub round: bool,
}

const NONE: u32 = u32::MAX;

impl<const B: usize, const D: usize, const N: usize> ScaledPoint<B, D, N> {
    /// Rows between bodies, and no cone.
    pub fn of_rows(bodies: [Option<usize>; N], jacobian: [[[f64; B]; D]; N]) -> Self {
        let bodies = bodies.map(|body| body.map_or(NONE, |body| body as u32));
        Self { bodies, jacobian, first: 0, end: 0, round: false }
    }

    /// Its forces.
    pub fn own(&self) -> std::ops::Range<usize> {
        self.first as usize..self.end as usize
    }

    /// A side's body, if that moves.
    pub fn body(&self, side: usize) -> Option<usize> {
        (self.bodies[side] != NONE).then_some(self.bodies[side] as usize)
    }
}

impl<const B: usize, const D: usize> Scaled<B, D, 2> {
    pub fn new(problem: &Gauss) -> Self {
        Self::with(problem, roots(&problem.inverse_mass), |index, side| {
            let point = &problem.points[index];
            point.bodies[side].map(|body| (body, &point.jacobian[side]))
        })
    }
}

impl<const B: usize, const D: usize> Scaled<B, D, 3> {
    /// With the layer of each point as its third body.
    pub fn with_layers(problem: &Gauss, layers: &Layers) -> Self {
        let (mut root, compliance) = (roots::<B>(&problem.inverse_mass), layers.compliance(problem));
        root.extend(roots::<B>(&compliance));
        let bodies = problem.load.len() / B;
        Self::with(problem, root, |index, side| {
            let point = &problem.points[index];
            match side {
                2 => Some((bodies + layers.of[index], &layers.jacobian[index])),
                _ => point.bodies[side].map(|body| (body, &point.jacobian[side])),
            }
        })
    }
}

/// `M^-1/2`.
pub(super) fn roots<const B: usize>(inverse: &[f64]) -> Vec<[f64; B]> {
    inverse.chunks_exact(B).map(|body| std::array::from_fn(|k: usize| body[k].sqrt())).collect()
}

impl<const B: usize, const D: usize, const N: usize> Scaled<B, D, N> {
    /// `side` tells which bodies that move a point is between, and their rows; bodies beyond those of the problem have no load.
    fn with<'a>(
        problem: &'a Gauss,
        root: Vec<[f64; B]>,
        side: impl Fn(usize, usize) -> Option<(usize, &'a [[f64; 6]; 3])>,
    ) -> Self {
        let of = |(load, root): (&[f64], &[f64; B])| std::array::from_fn(|k| load[k] * root[k]);
        let mut load: Vec<[f64; B]> = problem.load.chunks_exact(B).zip(&root).map(of).collect();
        load.resize(root.len(), [0.0; B]);
        let unit = largest(&load);
        let unit = if unit > 0.0 { unit } else { 1.0 };
        load.iter_mut().flatten().for_each(|load| *load /= unit);
        let mut push: Vec<[f64; B]> = problem.push.chunks_exact(B).zip(&root).map(of).collect();
        let strongest = largest(&push);
        push.iter_mut().flatten().for_each(|push| *push /= strongest);
        let push_unit = strongest / unit;
        let (mut edges, mut lengths) = (Vec::new(), Vec::new());
        let mut points = Vec::with_capacity(problem.points.len());
        for (index, point) in problem.points.iter().enumerate() {
            let sides: [_; N] = std::array::from_fn(|k| side(index, k));
            let jacobian = sides.map(|side| {
                let Some((body, rows)) = side else { return [[0.0; B]; D] };
                std::array::from_fn(|row| std::array::from_fn(|k| rows[row][k] * root[body][k]))
            });
            let first = edges.len();
            span(&point.cone, &jacobian, &mut edges, &mut lengths);
            points.push(ScaledPoint {
                bodies: sides.map(|side| side.map_or(NONE, |(body, _)| body as u32)),
                jacobian,
                first: first as u32,
                end: edges.len() as u32,
                round: matches!(point.cone, Cone::Round { .. }),
            });
        }
        let offset = problem.offset.iter().zip(&lengths).map(|(offset, length)| offset / length / unit).collect();
        let any_round = points.iter().any(|point| point.round);
        Self { load, push, push_unit, points, any_round, edges, lengths, offset, unit, root }
    }

    /// Number of unknown forces.
    pub fn forces(&self) -> usize {
        self.edges.len()
    }

    /// Whether nothing is added to `J a`.
    pub fn has_no_offset(&self) -> bool {
        self.offset.iter().all(|offset| *offset == 0.0)
    }

    /// What is added to `J a`.
    pub fn offset(&self) -> Vec<f64> {
        if self.offset.is_empty() { vec![0.0; self.forces()] } else { self.offset.clone() }
    }

    /// `J a`.
    pub fn motion(&self, a: &[[f64; B]], s: &mut [f64]) {
        for joint in joints(&self.points) {
            let moves: [_; N] = std::array::from_fn(|side| joint[0].body(side).map_or([0.0; B], |body| a[body]));
            for point in joint {
                let mut u = [0.0; D];
                for (jacobian, a) in point.jacobian.iter().zip(&moves) {
                    for (u, row) in u.iter_mut().zip(jacobian) {
                        *u += dot(row, a);
                    }
                }
                for (edge, s) in self.edges[point.own()].iter().zip(&mut s[point.own()]) {
                    *s = dot(edge, &u);
                }
            }
        }
    }

    /// Adds `J' f` times a factor.
    pub fn add_wrenches(&self, f: &[f64], factor: f64, out: &mut [[f64; B]]) {
        for joint in joints(&self.points) {
            let mut wrenches = [[0.0; B]; N];
            for point in joint {
                let mut force = [0.0; D];
                for (edge, f) in self.edges[point.own()].iter().zip(&f[point.own()]) {
                    (0..D).for_each(|k| force[k] += edge[k] * f * factor);
                }
                for (jacobian, wrench) in point.jacobian.iter().zip(&mut wrenches) {
                    for (force, row) in force.iter().zip(jacobian) {
                        wrench.iter_mut().zip(row).for_each(|(wrench, row)| *wrench += row * force);
                    }
                }
            }
            for (side, wrench) in wrenches.iter().enumerate() {
                if let Some(body) = joint[0].body(side) {
                    out[body].iter_mut().zip(wrench).for_each(|(out, wrench)| *out += wrench);
                }
            }
        }
    }

    /// Accelerations in the caller's units.
    pub fn accelerations(&self, a: &[[f64; B]]) -> Vec<f64> {
        a.iter().flatten().zip(self.root.iter().flatten()).map(|(a, root)| a * root * self.unit).collect()
    }

    /// A load in own units, from the caller's.
    pub fn load_in_own_units(&self, load: &[f64]) -> Vec<[f64; B]> {
        let of = |(load, root): (&[f64], &[f64; B])| std::array::from_fn(|k| load[k] * root[k] / self.unit);
        load.chunks_exact(B).zip(&self.root).map(of).collect()
    }

    /// The other way round of [`Self::in_newtons`].
    pub fn in_own_units(&self, forces: &[f64]) -> Vec<f64> {
        forces.iter().zip(&self.lengths).map(|(force, length)| force * length / self.unit).collect()
    }

    /// Forces in the caller's units: magnitudes along edges, or components.
    pub fn in_newtons(&self, f: &[f64]) -> Vec<f64> {
        f.iter().zip(&self.lengths).map(|(f, length)| f / length * self.unit).collect()
    }
}

/// Points one after the other that are between the same bodies.
pub(super) fn joints<const B: usize, const D: usize, const N: usize>(
    points: &[ScaledPoint<B, D, N>],
) -> impl Iterator<Item = &[ScaledPoint<B, D, N>]> {
    points.chunk_by(|one, next| one.bodies == next.bodies)
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    (0..N).map(|k| a[k] * b[k]).sum()
}

/// The largest magnitude.
pub(super) fn largest<const N: usize>(x: &[[f64; N]]) -> f64 {
    largest_of([x.as_flattened()], |[x]| x.abs())
}

/// The largest of some values and zero, each of one entry of every slice; eight at once, since each comparison waits for the one before.
pub(super) fn largest_of<const K: usize>(slices: [&[f64]; K], value: impl Fn([f64; K]) -> f64) -> f64 {
    let mut most = [0.0_f64; 8];
    for start in (0..slices[0].len()).step_by(most.len()) {
        let eight = slices.map(|slice| &slice[start..slice.len().min(start + 8)]);
        for (k, most) in most.iter_mut().enumerate().take(eight[0].len()) {
            *most = most.max(value(eight.map(|slice| slice[k])));
        }
    }
    most.into_iter().fold(0.0, f64::max)
}

/// The rows of a cone, so that the longest has length one.
fn span<const B: usize, const D: usize, const N: usize>(
    cone: &Cone,
    jacobian: &[[[f64; B]; D]; N],
    edges: &mut Vec<[f64; D]>,
    lengths: &mut Vec<f64>,
) {
    let length = |direction: &[f64; D]| -> f64 {
        let along = |rows: &[[f64; B]; D], k: usize| (0..D).map(|row| direction[row] * rows[row][k]).sum::<f64>();
        jacobian.iter().flat_map(|rows| (0..B).map(|k| along(rows, k).powi(2))).sum::<f64>().sqrt()
    };
    match cone {
        Cone::Edges(directions) => {
            for direction in directions {
                let edge = std::array::from_fn(|k| direction[k]);
                let length = length(&edge);
                edges.push(edge.map(|k| k / length));
                lengths.push(length);
            }
        }
        Cone::Round { friction } => {
            let diagonal = [friction.recip(), 1.0, 1.0];
            let axis = |k: usize| std::array::from_fn(|row| if row == k { diagonal[k] } else { 0.0 });
            let axes: Vec<[f64; D]> = (0..D).map(axis).collect();
            let longest = axes.iter().map(length).fold(0.0, f64::max);
            edges.extend(axes.iter().map(|axis| axis.map(|x| x / longest)));
            lengths.extend(diagonal.map(|x| longest / x));
        }
    }
}
