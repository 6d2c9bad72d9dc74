//! Surfaces that go through themselves: what they enclose twice would weigh twice.

use super::{Surface, Vector3, surface::extent};
use crate::interrupt::poll;
use parry3d_f64::partitioning::BvhWorkspace;

/// An edge goes through a triangle if it reaches this share of the largest extent beyond it on both sides, and as far into it. A
/// scan's folds are often smaller; what they add to the volume is too.
const THROUGH: f64 = 1e-5;

/// Operations to look at a pair of triangles, about.
const LOOK: usize = 60;

/// Where a surface goes through itself, if it does: of all places that of the least triangles.
pub(super) fn crossing(surface: &Surface) -> Option<Vector3> {
    let least = THROUGH * extent(surface.vertices());
    let mut pairs: Vec<[u32; 2]> = Vec::new();
    let mut look = |s: u32, t: u32| {
        poll(LOOK);
        if pierced(surface, s, t, least).is_some() || pierced(surface, t, s, least).is_some() {
            pairs.push([s.min(t), s.max(t)]);
        }
    };
    surface.tree().traverse_bvtt_single_tree::<false>(&mut BvhWorkspace::default(), &mut look);
    let [s, t] = pairs.into_iter().min()?;
    pierced(surface, s, t, least).or_else(|| pierced(surface, t, s, least))
}

/// Where an edge of one triangle goes through another.
fn pierced(surface: &Surface, by: u32, triangle: u32, least: f64) -> Option<Vector3> {
    let corners = surface.corners(triangle);
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
    let ends = surface.corners(by);
    let heights = ends.map(|p| normal.dot(p - corners[0]));
    (0..3).find_map(|k| {
        let (p, q) = (ends[k], ends[(k + 1) % 3]);
        let (high, low) = (heights[k], heights[(k + 1) % 3]);
        if high.min(low) >= -least || high.max(low) <= least {
            return None;
        }
        let at = p + high / (high - low) * (q - p);
        let inside = |i: usize| {
            let along = corners[(i + 1) % 3] - corners[i];
            normal.cross(along).normalize_or_zero().dot(at - corners[i]) > least
        };
        (0..3).all(inside).then_some(at)
    })
}
