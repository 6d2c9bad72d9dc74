//! Broad phase: pairs of blocks whose bounding boxes come within the contact tolerance.

use super::tolerance_of;
use crate::geometry::Vector3;
use crate::scene::{Body, Scene};
use parry2d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy};

/// Candidate pairs, the lower index first, sorted. Pairs of fixed blocks are left out.
///
/// Every box is loosened by its own block's tolerance, which is at least that of any of its
/// pairs, so that no touching pair is missed. Work: n log n for blocks of like size.
pub(super) fn candidate_pairs(scene: &Scene) -> Vec<[usize; 2]> {
    let bodies = scene.bodies();
    pairs_within(bodies, |i| tolerance_of(scene, &bodies[i]))
}

/// Pairs whose boxes meet when box i is loosened by `reach(i)` metres, in the same order.
pub(super) fn pairs_within(bodies: &[Body], reach: impl Fn(usize) -> f64) -> Vec<[usize; 2]> {
    let boxes: Vec<Aabb> = bodies.iter().enumerate().map(|(i, body)| bounding_box(body).loosened(reach(i))).collect();
    let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
    pairs(bodies.len(), |i| bodies[i].fixed, |i| tree.intersect_aabb(&boxes[i]))
}

/// The same for blocks in space; `corners(i)` are the lower and the upper corner of block i's box.
pub(super) fn pairs_in_space(
    count: usize,
    fixed: impl Fn(usize) -> bool,
    corners: impl Fn(usize) -> [Vector3; 2],
    reach: impl Fn(usize) -> f64,
) -> Vec<[usize; 2]> {
    use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
    use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
    let bounds = |i: usize| {
        let [low, high] = corners(i);
        Aabb::new(low, high).loosened(reach(i))
    };
    let boxes: Vec<Aabb> = (0..count).map(bounds).collect();
    let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
    pairs(count, fixed, |i| tree.intersect_aabb(&boxes[i]))
}

/// The pairs of blocks of which the one's box is `near` the other's.
fn pairs<N: Iterator<Item = u32>>(
    count: usize,
    fixed: impl Fn(usize) -> bool,
    near: impl Fn(usize) -> N,
) -> Vec<[usize; 2]> {
    let mut pairs = Vec::new();
    for i in (0..count).filter(|&i| !fixed(i)) {
        for j in near(i).map(|leaf| leaf as usize) {
            // A movable block meets a fixed one once, from its own side; two movable blocks from
            // the lower's side.
            if j != i && (fixed(j) || i < j) {
                pairs.push([i.min(j), i.max(j)]);
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

fn bounding_box(body: &Body) -> Aabb {
    Aabb::from_points(body.shape.vertices().iter().map(|&v| body.pose.transform(v)))
}
