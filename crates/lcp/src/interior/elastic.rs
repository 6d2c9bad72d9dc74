//! Layers that neither part nor slide.
//!
//! Without the cones, (4) of `layers.rs` is a linear system. With the motion y of the bodies and E that of a layer in it,
//!
//! ```text
//! W = Q^-1 E y,   (sum E' Q^-1 E) y = -F                                              (1)
//! ```
//!
//! one block for each body and one for each pair: one factor, of a matrix much smaller than that of an iteration with cones. If forces in
//! the cones make up these W, they are those of least norm: no others within the cones, nor outside, have less.
//!
//! A layer bears only what forces at its points make up: no moment about a line on which all of them are. So E and W are taken
//! along a basis of what these forces do to the layer, orthonormal in the norm `W' Q W`; what each of its wrenches does to
//! the bodies is known from the same forces.

use super::{
    layers::Layers,
    matrix::BodyMatrix,
    problem::{Cone, Gauss},
    scaled::{ScaledPoint, largest, roots},
};

/// What points can bear beyond this share of what they bear most easily counts: forces of some digits less make it up.
const SPANNED: f64 = 1e-7;
/// Corrections of (1), each of which leaves rounding times the condition of the matrix; and what they may leave of the largest load:
/// where bodies are hardly held it is more.
const REFINEMENTS: usize = 2;
const BALANCED: f64 = 1e-10;

impl Gauss {
    /// The wrench that each layer bears where none parts or slides, in N and N m. Whether forces in the cones make it up is for the
    /// caller to judge. None if the loads are not balanced so.
    ///
    /// # Panics
    /// If bodies have neither 3 nor 6 unknowns.
    pub fn elastic(&self, layers: &Layers) -> Option<Vec<[f64; 6]>> {
        match self.size {
            3 => elastic::<3>(self, layers),
            6 => elastic::<6>(self, layers),
            size => panic!("a body has 3 or 6 unknowns, not {size}"),
        }
    }
}

fn elastic<const B: usize>(problem: &Gauss, layers: &Layers) -> Option<Vec<[f64; 6]>> {
    let root = roots::<B>(&problem.inverse_mass);
    let of = |(load, root): (&[f64], &[f64; B])| std::array::from_fn(|k| load[k] * root[k]);
    let load: Vec<[f64; B]> = problem.load.chunks_exact(B).zip(&root).map(of).collect();
    let (wrenches, joints): (Vec<_>, Vec<_>) = spans::<B>(problem, layers).iter().map(|span| span.joint(&root)).unzip();
    let mut matrix = BodyMatrix::between(load.len(), &joints)?;
    let unit = std::array::from_fn(|i| std::array::from_fn(|k| if i == k { 1.0 } else { 0.0 }));
    matrix.assemble(&joints, |_| 0.0, |_| unit);
    matrix.factor()?;
    let mut borne = vec![[0.0; B]; joints.len()];
    let mut left = unbalanced(&load, &joints, &borne);
    let enough = BALANCED * largest(&left);
    for _ in 0..=REFINEMENTS {
        matrix.solve(&mut left);
        for (joint, borne) in joints.iter().zip(&mut borne) {
            for (body, rows) in sides(joint) {
                let along = |row: &[f64; B]| (0..B).map(|k| row[k] * left[body][k]).sum::<f64>();
                rows.iter().zip(&mut *borne).for_each(|(row, w)| *w += along(row));
            }
        }
        left = unbalanced(&load, &joints, &borne);
    }
    if !(largest(&left) <= enough && borne.iter().flatten().all(|w| w.is_finite())) {
        return None;
    }
    let sum = |(wrenches, borne): (&[[f64; B]; B], &[f64; B])| {
        let mut sum = [0.0; 6];
        for (wrench, w) in wrenches.iter().zip(borne) {
            (0..B).for_each(|k| sum[k] += wrench[k] * w);
        }
        sum
    };
    Some(wrenches.iter().zip(&borne).map(sum).collect())
}

/// `-F - E' W`, in the units of the bodies.
fn unbalanced<const B: usize>(load: &[[f64; B]], joints: &[ScaledPoint<B, B, 2>], borne: &[[f64; B]]) -> Vec<[f64; B]> {
    let mut left: Vec<[f64; B]> = load.iter().map(|load| load.map(|load| -load)).collect();
    for (joint, borne) in joints.iter().zip(borne) {
        for (body, rows) in sides(joint) {
            for (row, w) in rows.iter().zip(borne) {
                (0..B).for_each(|k| left[body][k] -= row[k] * w);
            }
        }
    }
    left
}

/// The bodies of a joint that move, with their rows.
fn sides<const B: usize>(joint: &ScaledPoint<B, B, 2>) -> impl Iterator<Item = (usize, &[[f64; B]; B])> {
    joint.jacobian.iter().enumerate().filter_map(|(side, rows)| Some((joint.body(side)?, rows)))
}

/// What forces do: to a layer, in the units in which its norm is the sum of squares, and to the two bodies.
#[derive(Debug, Clone, Copy)]
struct Done<const B: usize> {
    layer: [f64; B],
    bodies: [[f64; B]; 2],
}

impl<const B: usize> Done<B> {
    fn size(&self) -> f64 {
        self.layer.iter().map(|x| x * x).sum()
    }

    fn scale(&mut self, factor: f64) {
        self.layer.iter_mut().chain(self.bodies.iter_mut().flatten()).for_each(|x| *x *= factor);
    }

    /// Takes away what it has along another one of length one.
    fn beside(&mut self, other: &Self) {
        let along: f64 = (0..B).map(|k| self.layer[k] * other.layer[k]).sum();
        let others = other.layer.iter().chain(other.bodies.iter().flatten());
        self.layer.iter_mut().chain(self.bodies.iter_mut().flatten()).zip(others).for_each(|(x, o)| *x -= along * o);
    }
}

/// What the points of a layer can bear.
struct Span<const B: usize> {
    bodies: [Option<usize>; 2],
    /// `Q^-1/2`.
    unit: [f64; B],
    /// Of unit forces along the directions of its points; from these an orthonormal basis.
    done: Vec<Done<B>>,
}

fn spans<const B: usize>(problem: &Gauss, layers: &Layers) -> Vec<Span<B>> {
    let of = |stiffness: &[f64]| Span {
        bodies: [None; 2],
        unit: std::array::from_fn(|k: usize| stiffness[k].sqrt()),
        done: Vec::new(),
    };
    let mut spans: Vec<Span<B>> = layers.stiffness.chunks_exact(B).map(of).collect();
    for (index, point) in problem.points.iter().enumerate() {
        let span = &mut spans[layers.of[index]];
        span.bodies = point.bodies;
        let mut add = |force: [f64; 3]| {
            let sum =
                |rows: &[[f64; 6]; 3], k: usize| -> f64 { rows.iter().zip(force).map(|(row, f)| row[k] * f).sum() };
            span.done.push(Done {
                layer: std::array::from_fn(|k| sum(&layers.jacobian[index], k) / span.unit[k]),
                bodies: [0, 1].map(|side| std::array::from_fn(|k| sum(&point.jacobian[side], k))),
            });
        };
        match &point.cone {
            Cone::Round { .. } => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().for_each(add),
            Cone::Edges(edges) => edges.iter().for_each(|&edge| add(edge)),
        }
    }
    spans.iter_mut().for_each(Span::make_orthonormal);
    spans
}

impl<const B: usize> Span<B> {
    /// Gram and Schmidt's method, the largest first.
    fn make_orthonormal(&mut self) {
        let size = |done: &[Done<B>]| done.iter().map(Done::size).enumerate().fold((0, 0.0), larger);
        let (_, enough) = size(&self.done);
        for rank in 0..B {
            let (place, most) = size(&self.done[rank.min(self.done.len())..]);
            if most <= SPANNED * SPANNED * enough {
                self.done.truncate(rank);
                return;
            }
            self.done.swap(rank, rank + place);
            let (known, rest) = self.done.split_at_mut(rank + 1);
            let (known, own) = known.split_at_mut(rank);
            // Twice is enough: what the first time leaves of the others is rounding of what was there.
            known.iter().for_each(|known| own[0].beside(known));
            own[0].scale(own[0].size().sqrt().recip());
            rest.iter_mut().for_each(|rest| rest.beside(&own[0]));
        }
        self.done.truncate(B);
    }

    /// The basis as wrenches on the layer, and as rows between the bodies in the units of their own.
    fn joint(&self, root: &[[f64; B]]) -> ([[f64; B]; B], ScaledPoint<B, B, 2>) {
        let (mut wrenches, mut jacobian) = ([[0.0; B]; B], [[[0.0; B]; B]; 2]);
        for (row, done) in self.done.iter().enumerate() {
            wrenches[row] = std::array::from_fn(|k| done.layer[k] * self.unit[k]);
            for (side, body) in self.bodies.iter().enumerate() {
                let Some(body) = body else { continue };
                jacobian[side][row] = std::array::from_fn(|k| done.bodies[side][k] * root[*body][k]);
            }
        }
        (wrenches, ScaledPoint::of_rows(self.bodies, jacobian))
    }
}

fn larger(best: (usize, f64), (place, size): (usize, f64)) -> (usize, f64) {
    if size > best.1 { (place, size) } else { best }
}
