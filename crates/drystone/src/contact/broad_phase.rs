//! Broad phase: pairs of blocks whose bounding boxes come within the contact tolerance.
//!
//! Sort and sweep: boxes in the order of their lower ends along the axis on which they are spread out most; each
//! is compared with those that begin before it ends.

use super::tolerance_of;
use crate::geometry::{Vector, Vector3};
use crate::scene::{Body, Scene};

/// Lower and upper corner, world coordinates, metres.
type Bounds<const N: usize> = [[f64; N]; 2];

/// Candidate pairs, the lower index first, sorted. Pairs of fixed blocks are left out.
///
/// Every box is loosened by its own block's tolerance, which is at least that of any of its
/// pairs, so that no touching pair is missed. Work: n log n for a row or a column of n blocks of like size, n^1.5 for a
/// square field of them.
pub(super) fn candidate_pairs(scene: &Scene) -> Vec<[usize; 2]> {
    let bodies = scene.bodies();
    pairs_within(bodies, |i| tolerance_of(scene, &bodies[i]))
}

/// Pairs whose boxes meet when box i is loosened by `reach(i)` metres, in the same order.
pub(super) fn pairs_within(bodies: &[Body], reach: impl Fn(usize) -> f64) -> Vec<[usize; 2]> {
    let boxes: Vec<_> = bodies.iter().enumerate().map(|(i, body)| loosened(bounds(body), reach(i))).collect();
    sweep(&boxes, |i| bodies[i].fixed)
}

/// The same for blocks in space; `corners(i)` are the lower and the upper corner of block i's box.
pub(super) fn pairs_in_space(
    count: usize,
    fixed: impl Fn(usize) -> bool,
    corners: impl Fn(usize) -> [Vector3; 2],
    reach: impl Fn(usize) -> f64,
) -> Vec<[usize; 2]> {
    let bounds = |i: usize| corners(i).map(|corner| corner.to_array());
    let boxes: Vec<_> = (0..count).map(|i| loosened(bounds(i), reach(i))).collect();
    sweep(&boxes, fixed)
}

fn sweep<const N: usize>(boxes: &[Bounds<N>], fixed: impl Fn(usize) -> bool) -> Vec<[usize; 2]> {
    let along = widest_axis(boxes, &fixed);
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_unstable_by(|&i, &j| boxes[i][0][along].total_cmp(&boxes[j][0][along]).then(i.cmp(&j)));
    let mut pairs = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        let [own_low, own_high] = &boxes[i];
        for &j in &order[place + 1..] {
            let [low, high] = &boxes[j];
            if low[along] > own_high[along] {
                break;
            }
            let meet = (0..N).all(|axis| low[axis] <= own_high[axis] && own_low[axis] <= high[axis]);
            if meet && !(fixed(i) && fixed(j)) {
                pairs.push([i.min(j), i.max(j)]);
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

/// The axis on which the blocks that move are spread out most: a ground says nothing about that.
fn widest_axis<const N: usize>(boxes: &[Bounds<N>], fixed: impl Fn(usize) -> bool) -> usize {
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; N];
    for (_, [low, _]) in boxes.iter().enumerate().filter(|(i, _)| !fixed(*i)) {
        for (end, &x) in ends.iter_mut().zip(low) {
            *end = [end[0].min(x), end[1].max(x)];
        }
    }
    let spread = |axis: usize| ends[axis][1] - ends[axis][0];
    (1..N).fold(0, |widest, axis| if spread(axis) > spread(widest) { axis } else { widest })
}

fn loosened<const N: usize>([low, high]: Bounds<N>, reach: f64) -> Bounds<N> {
    [low.map(|x| x - reach), high.map(|x| x + reach)]
}

fn bounds(body: &Body) -> Bounds<2> {
    let (place, turn) = (Vector::from_array(body.pose.position), body.pose.turn());
    let corners = || body.shape.vertices().iter().map(|&v| turn(v) + place);
    let least = corners().fold(Vector::INFINITY, Vector::min);
    let most = corners().fold(Vector::NEG_INFINITY, Vector::max);
    [least.to_array(), most.to_array()]
}
