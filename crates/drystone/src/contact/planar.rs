//! Contacts and overlaps of polygons.

use super::{
    broad_phase,
    narrow_phase::{self, Outline},
    set::ContactSet,
    touch::{Meetings, Overlap, Pressing},
};
use crate::{error::SceneError, geometry::Vector, scene::Scene};

/// Finds all contacts between the blocks of a scene.
///
/// Two fixed blocks are never in contact and may overlap: a ground may be built of several pieces.
/// Any other overlap by more than the tolerance is [`SceneError::Overlap`]; the deepest is named.
pub fn find_contacts(scene: &Scene) -> Result<ContactSet, SceneError> {
    meetings(scene).contacts(scene)
}

/// Every pair of blocks that overlap by more than the tolerance, in the order of their indices.
pub fn find_overlaps(scene: &Scene) -> Vec<Overlap> {
    meetings(scene).overlaps
}

fn meetings(scene: &Scene) -> Meetings {
    let bodies = scene.bodies();
    let outlines: Vec<Outline> = bodies.iter().map(Outline::of).collect();
    Meetings::of(scene, &broad_phase::candidate_pairs(scene), |[a, b], tolerance| {
        let origin = Vector::from_array(bodies[a].pose.position);
        let offset = Vector::from_array(bodies[b].pose.position) - origin;
        narrow_phase::touch(&outlines[a], &outlines[b], offset, tolerance).map(|p| Pressing {
            feature: p.feature,
            point: in_space(origin + p.point),
            normal: in_space(p.normal),
            gap: p.gap,
        })
    })
}

/// A planar vector as one in space.
fn in_space(v: Vector) -> [f64; 3] {
    [v.x, v.y, 0.0]
}
