//! Broad phase: pairs of blocks whose bounding boxes come within the contact tolerance.
//!
//! Sort and sweep: boxes in the order of their lower ends along the axis on which they are spread out most; each
//! is compared with those that begin before it ends.

use super::tolerance_of;
use crate::{
    geometry::{Numbers, Shape},
    interrupt::poll,
    scene::{Body, SceneOf},
};

/// Lower and upper corner, world coordinates, metres.
type Bounds<V> = [V; 2];

/// Operations to compare two boxes, about.
const COMPARISON: usize = 8;

/// Candidate pairs, the lower index first, sorted. Pairs of fixed blocks are left out.
///
/// Every box is loosened by its own block's tolerance, which is at least that of any of its
/// pairs, so that no touching pair is missed. Work: n log n for a row or a column of n blocks of like size, n^1.5 for a
/// square field of them.
pub(super) fn candidate_pairs<S: Shape>(scene: &SceneOf<S>) -> Vec<[usize; 2]> {
    let bodies = scene.bodies();
    pairs_within(bodies, |i| tolerance_of(scene, &bodies[i]))
}

/// Pairs whose boxes meet when box i is loosened by `reach(i)` metres, in the same order.
pub(crate) fn pairs_within<S: Shape>(bodies: &[Body<S>], reach: impl Fn(usize) -> f64) -> Vec<[usize; 2]> {
    let of = |(i, body): (usize, &Body<S>)| loosened(body.shape.bounds(&body.pose), reach(i));
    let boxes: Vec<_> = bodies.iter().enumerate().map(of).collect();
    sweep(&boxes, |i| bodies[i].fixed)
}

fn sweep<V: Numbers>(boxes: &[Bounds<V>], fixed: impl Fn(usize) -> bool) -> Vec<[usize; 2]> {
    let along = widest_axis(boxes, &fixed);
    let low = |i: usize| boxes[i][0].as_ref();
    let high = |i: usize| boxes[i][1].as_ref();
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_unstable_by(|&i, &j| low(i)[along].total_cmp(&low(j)[along]).then(i.cmp(&j)));
    let mut pairs = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        let mut compared = 1;
        for &j in &order[place + 1..] {
            compared += 1;
            if low(j)[along] > high(i)[along] {
                break;
            }
            let reaches = |a: usize, b: usize| low(a).iter().zip(high(b)).all(|(low, high)| low <= high);
            if reaches(i, j) && reaches(j, i) && !(fixed(i) && fixed(j)) {
                pairs.push([i.min(j), i.max(j)]);
            }
        }
        poll(COMPARISON * compared);
    }
    pairs.sort_unstable();
    pairs
}

/// The axis on which the blocks that move are spread out most: a ground says nothing about that.
fn widest_axis<V: Numbers>(boxes: &[Bounds<V>], fixed: impl Fn(usize) -> bool) -> usize {
    let axes = V::default().as_ref().len();
    let spread = |axis: usize| {
        let movable = boxes.iter().enumerate().filter(|(i, _)| !fixed(*i)).map(|(_, [low, _])| low.as_ref()[axis]);
        let [least, most] =
            movable.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| [least.min(x), most.max(x)]);
        most - least
    };
    (1..axes).fold(0, |widest, axis| if spread(axis) > spread(widest) { axis } else { widest })
}

fn loosened<V: Numbers>([mut low, mut high]: Bounds<V>, reach: f64) -> Bounds<V> {
    low.as_mut().iter_mut().for_each(|x| *x -= reach);
    high.as_mut().iter_mut().for_each(|x| *x += reach);
    [low, high]
}
