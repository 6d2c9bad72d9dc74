//! Broad phase: pairs of blocks whose bounding boxes come within the contact tolerance.

use super::tolerance_of;
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
    let mut pairs = Vec::new();
    for (i, own) in boxes.iter().enumerate() {
        if bodies[i].fixed {
            continue;
        }
        for j in tree.intersect_aabb(own).map(|leaf| leaf as usize) {
            // A movable block meets a fixed one once, from its own side; two movable blocks from
            // the lower's side.
            if j != i && (bodies[j].fixed || i < j) {
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
