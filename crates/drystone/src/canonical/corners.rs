//! What a face bears, shared among its corners: the least squares of their forces within their cones.

use crate::geometry::{cross, dot, minus, unit};
use drystone_lcp::interior::Cone;

/// Rows of a point's three directions on the wrench of its face.
pub(super) type Rows = [[f64; 6]; 3];

/// The forces that a corner may bear.
#[derive(Debug, Clone, Copy)]
pub(super) enum Allowed<'a> {
    /// `hypot(f_1, f_2) <= friction f_0`.
    Round(f64),
    /// Sums of edges that follow one another round the first axis.
    Pyramid(&'a [[f64; 3]]),
    /// Multiples of a unit vector.
    Ray([f64; 3]),
}

impl<'a> Allowed<'a> {
    /// What a cone allows; in the plane two edges are all there is of a round one.
    pub fn of(cone: &'a Cone, friction: f64, in_plane: bool) -> Self {
        match cone {
            Cone::Edges(edges) if !in_plane && friction > 0.0 => match &edges[..] {
                [round @ .., [_, 0.0, 0.0]] => Self::Pyramid(round), // a steep cone's normal
                all => Self::Pyramid(all),
            },
            _ => Self::Round(friction),
        }
    }

    /// The same for forces that push as far aside as they can: along a given one.
    pub fn beside(self, force: [f64; 3]) -> Self {
        /// What is nearer to the border of a round cone, as a share of the way to it, is on it.
        const BORDER: f64 = 1e-6;
        let size = force.iter().map(|f| f * f).sum::<f64>().sqrt();
        match self {
            Self::Round(friction) if force[1].hypot(force[2]) < (1.0 - BORDER) * friction * force[0] => self,
            _ if size > 0.0 => Self::Ray(force.map(|f| f / size)),
            _ => Self::Ray([0.0; 3]),
        }
    }

    /// The force allowed that is nearest to one, and how it changes with that one.
    fn nearest(self, force: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        match self {
            Self::Round(friction) => in_round_cone(force, friction),
            Self::Pyramid(edges) => in_pyramid(force, edges),
            Self::Ray(direction) => on_plane(force, &[direction]).unwrap_or(NOTHING),
        }
    }
}

/// Weight that makes the normal equations regular where corners lie on a line, relative to their trace, and how often what it
/// changes is put right: each time it shrinks by about the weight.
const PROXIMAL: f64 = 1e-9;
const REFINEMENTS: usize = 3;
/// Most steps of Newton's method; where no corner ends at its cone it is one, else a few.
const STEPS: usize = 30;
/// Rounding of some ten terms, relative to the largest.
const ROUNDING: f64 = 3e-14;

/// The forces of least squares with a wrench, `sum B f`, by Newton's method for its multipliers x: each corner bears what is
/// nearest to `B' x` of what it may. Of a wrench the first `size` entries count, of a corner's directions the first `directions`.
/// None if it does not end in some steps.
pub(super) fn least_squares(
    wrench: &[f64; 6],
    corners: &[(Rows, Allowed<'_>)],
    size: usize,
    directions: usize,
) -> Option<Vec<[f64; 3]>> {
    let (mut x, mut forces) = ([0.0; 6], vec![[0.0; 3]; corners.len()]);
    let mut slopes = vec![IDENTITY; corners.len()];
    for _ in 0..STEPS {
        let left = left(wrench, corners, &forces);
        if !left.iter().all(|x| x.is_finite()) {
            return None; // where all corners were asked to pull, none gave way
        }
        if largest(&left) <= ROUNDING * largest(wrench) {
            return Some(forces);
        }
        let step = step(corners, &slopes, left, size, directions);
        (0..size).for_each(|k| x[k] += step[k]);
        for ((force, slope), (rows, allowed)) in forces.iter_mut().zip(&mut slopes).zip(corners) {
            let mut asked = rows.map(|row| (0..size).map(|k| row[k] * x[k]).sum::<f64>());
            asked[directions..].fill(0.0);
            (*force, *slope) = allowed.nearest(asked);
        }
    }
    None
}

/// What of a wrench some forces leave.
fn left(wrench: &[f64; 6], corners: &[(Rows, Allowed<'_>)], forces: &[[f64; 3]]) -> [f64; 6] {
    let mut left = *wrench;
    for ((rows, _), force) in corners.iter().zip(forces) {
        for (row, f) in rows.iter().zip(force) {
            (0..6).for_each(|k| left[k] -= row[k] * f);
        }
    }
    left
}

/// The change of the multipliers that takes up what is left, where each corner gives way by its slope.
fn step(
    corners: &[(Rows, Allowed<'_>)],
    slopes: &[[[f64; 3]; 3]],
    left: [f64; 6],
    size: usize,
    directions: usize,
) -> [f64; 6] {
    let mut normal = [[0.0; 6]; 6];
    for ((rows, _), slope) in corners.iter().zip(slopes) {
        for (row, slope) in rows[..directions].iter().zip(slope) {
            for (other, slope) in rows[..directions].iter().zip(slope) {
                for p in 0..size {
                    (0..size).for_each(|q| normal[p][q] += row[p] * slope * other[q]);
                }
            }
        }
    }
    let trace: f64 = (0..size).map(|k| normal[k][k]).sum();
    let mut factor = normal;
    (0..size).for_each(|k| factor[k][k] += PROXIMAL * trace);
    factorise(&mut factor, size);
    let (mut x, mut rest) = ([0.0; 6], left);
    for _ in 0..=REFINEMENTS {
        solve(&factor, size, &mut rest);
        (0..size).for_each(|k| x[k] += rest[k]);
        rest = [0, 1, 2, 3, 4, 5].map(|i| left[i] - (0..size).map(|k| normal[i][k] * x[k]).sum::<f64>());
    }
    x
}

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const NOTHING: ([f64; 3], [[f64; 3]; 3]) = ([0.0; 3], [[0.0; 3]; 3]);

fn largest(x: &[f64; 6]) -> f64 {
    x.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()))
}

fn in_round_cone(force: [f64; 3], friction: f64) -> ([f64; 3], [[f64; 3]; 3]) {
    let [normal, first, second] = force;
    let across = first.hypot(second);
    if normal >= 0.0 && across <= friction * normal {
        return (force, IDENTITY);
    }
    if friction * across <= -normal {
        return NOTHING;
    }
    // On the edge of the cone next to it; about the cone it shrinks as circles do.
    let (c, s) = if across > 0.0 { (first / across, second / across) } else { (0.0, 0.0) };
    let edge = [1.0, friction * c, friction * s].map(|x| x / friction.hypot(1.0));
    let size = edge[0] * normal + edge[1] * first + edge[2] * second;
    let about = if across > 0.0 { size * friction / friction.hypot(1.0) / across } else { 0.0 };
    let tangent = [0.0, -s, c];
    let slope = [0, 1, 2].map(|i| [0, 1, 2].map(|k| edge[i] * edge[k] + about * tangent[i] * tangent[k]));
    (edge.map(|x| size * x), slope)
}

/// Of the force itself and what is nearest to it on the sides and edges of a pyramid, whichever is allowed and nearest.
fn in_pyramid(force: [f64; 3], edges: &[[f64; 3]]) -> ([f64; 3], [[f64; 3]; 3]) {
    let sides = || edges.iter().zip(edges.iter().cycle().skip(1)).map(|(a, b)| [*a, *b]);
    if sides().any(|[a, b]| in_hull(force, [IDENTITY[0], a, b])) {
        return (force, IDENTITY);
    }
    let distance = |(point, _): &([f64; 3], _)| {
        let apart = minus(*point, force);
        dot(apart, apart)
    };
    let on_sides = sides().filter_map(|side| on_plane(force, &side));
    let on_edges = edges.iter().filter_map(|edge| on_plane(force, &[*edge]));
    let found = on_sides.chain(on_edges);
    found.fold(NOTHING, |best, other| if distance(&other) < distance(&best) { other } else { best })
}

/// What is nearest to a force among the sums of one or two unit vectors, and how it changes; None if one of these would pull.
fn on_plane(force: [f64; 3], spanning: &[[f64; 3]]) -> Option<([f64; 3], [[f64; 3]; 3])> {
    let axes = match *spanning {
        [a, b] => {
            let cosine = dot(a, b);
            let across = unit(minus(b, a.map(|x| x * cosine)))?;
            let second = dot(across, force) / dot(across, b);
            if second < 0.0 || dot(a, force) < second * cosine {
                return None;
            }
            [a, across]
        }
        [a, ..] if dot(a, force) > 0.0 => [a, [0.0; 3]],
        _ => return None,
    };
    let slope = [0, 1, 2].map(|i| [0, 1, 2].map(|k| axes[0][i] * axes[0][k] + axes[1][i] * axes[1][k]));
    Some((slope.map(|row| dot(row, force)), slope))
}

/// Whether a vector is a sum of three others, none of them negative.
fn in_hull(vector: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> bool {
    let volume = dot(a, cross(b, c));
    let shares = [cross(b, c), cross(c, a), cross(a, b)].map(|normal| dot(normal, vector) * volume);
    volume != 0.0 && shares.iter().all(|&share| share >= 0.0)
}

/// Cholesky's factor of a small matrix, in its lower half.
fn factorise(matrix: &mut [[f64; 6]; 6], size: usize) {
    for k in 0..size {
        let pivot = matrix[k][k] - (0..k).map(|j| matrix[k][j] * matrix[k][j]).sum::<f64>();
        matrix[k][k] = pivot.max(f64::MIN_POSITIVE).sqrt();
        for i in k + 1..size {
            let inner: f64 = (0..k).map(|j| matrix[i][j] * matrix[k][j]).sum();
            matrix[i][k] = (matrix[i][k] - inner) / matrix[k][k];
        }
    }
}

fn solve(factor: &[[f64; 6]; 6], size: usize, x: &mut [f64; 6]) {
    for i in 0..size {
        let inner: f64 = (0..i).map(|k| factor[i][k] * x[k]).sum();
        x[i] = (x[i] - inner) / factor[i][i];
    }
    for i in (0..size).rev() {
        let inner: f64 = (i + 1..size).map(|k| factor[k][i] * x[k]).sum();
        x[i] = (x[i] - inner) / factor[i][i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a corner of a face in the plane z = 0 about the origin: the normal z, then x and y.
    fn corner([x, y]: [f64; 2], friction: f64) -> (Rows, Allowed<'static>) {
        let rows = [[1.0, 0.0, 0.0, 0.0, y, -x], [0.0, 1.0, 0.0, -y, 0.0, 0.0], [0.0, 0.0, 1.0, x, 0.0, 0.0]];
        (rows, Allowed::Round(friction))
    }

    fn square(friction: f64) -> Vec<(Rows, Allowed<'static>)> {
        [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|at| corner(at, friction)).to_vec()
    }

    #[test]
    fn four_corners_bear_alike_what_presses_in_the_middle() {
        let found = least_squares(&[4.0, 0.4, 0.0, 0.0, 0.0, 0.0], &square(0.5), 6, 3).unwrap();
        for force in found {
            (0..3).for_each(|k| assert!((force[k] - [1.0, 0.1, 0.0][k]).abs() < 1e-13));
        }
    }

    #[test]
    fn corners_bear_no_pull_nor_more_aside_than_friction_allows() {
        for wrench in
            [[-1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [-0.2, 0.0, 0.0, 0.0, 0.0, 0.03], [1.0, 0.6, 0.0, 0.0, 0.0, 0.0]]
        {
            assert_eq!(least_squares(&wrench, &square(0.5), 6, 3), None, "{wrench:?}");
        }
    }
}
