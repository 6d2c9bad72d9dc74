//! From geometry to contacts: which blocks touch, where, and along which normal.
//!
//! A broad phase (bounding boxes in a tree) finds the pairs that may touch, a narrow phase
//! (separating axes and clipping) says how each of them does.
//!
//! **Tolerance.** Two blocks touch when the greatest separation over their faces lies within plus
//! or minus the contact tolerance, in metres. By default it is 1e-6 of the narrower block's width:
//! a millionth of a block is far above the rounding of coordinates (about 1e-13 of a scene some
//! hundred blocks wide) and far below any gap that is meant. It is taken pair by pair, so that the
//! contacts of two blocks depend on these two alone. [`Scene::with_contact_tolerance`] sets one
//! value for all instead, for scenes whose coordinates were rounded.

pub mod approach;
mod approach_in_plane;
mod approach_in_space;
mod borders;
mod broad_phase;
mod covered;
mod id;
mod narrow_phase;
mod placed;
mod rounding;
mod separation;
mod shared_face;
mod solids;
mod surfaces;
mod touch;

pub(crate) use broad_phase::pairs_within;
pub use id::{ContactId, Feature, SolidFeature, SolidPart};
pub(crate) use solids::overlapping_pieces;
pub use solids::{find_solid_contacts, find_solid_overlaps};
pub(crate) use surfaces::solid_distance;
pub use touch::Overlap;

use crate::error::SceneError;
use crate::geometry::{Shape, Vector};
use crate::scene::{Body, Scene, SceneOf};
use narrow_phase::Outline;
use touch::{Meetings, Pressing};

/// Default contact tolerance as a share of the narrower block's width.
pub const RELATIVE_TOLERANCE: f64 = 1e-6;

/// One point through which two blocks press on each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Which features of which blocks meet here.
    pub id: ContactId,
    /// Indices of the two blocks, the lower first.
    pub bodies: [usize; 2],
    /// Where they meet, world coordinates, metres: halfway across the gap. In the plane z is 0.
    pub point: [f64; 3],
    /// Unit vector from `bodies[0]` into `bodies[1]`. In the plane z is 0.
    pub normal: [f64; 3],
    /// Distance of the two surfaces here, metres: negative where they overlap within tolerance.
    pub gap: f64,
    /// Coefficient of friction of the pair.
    pub friction: f64,
}

/// Every contact of a scene, in the order of (body, body, feature); in space in that of the bodies and then round each
/// shared polygon, of which opposite corners bear in fewer pivots than neighbours.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactSet {
    /// Contact points. A face on a face has two, the ends of the shared segment; a corner on a
    /// face has one. Borders that meet, where no other body covers them, have one or two
    /// ([`Feature::at_borders`]).
    pub contacts: Vec<Contact>,
    /// Pairs that meet at borders and nowhere else, of which another body already parts the two along a plane
    /// (docs/theory/touching-at-borders.md). They bear nothing.
    pub corner_touches: Vec<[usize; 2]>,
    /// Pairs that the broad phase handed to the narrow phase: a measure of the work done.
    pub candidate_pairs: usize,
}

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

/// The contact tolerance of a pair, metres.
pub(crate) fn pair_tolerance<S: Shape>(scene: &SceneOf<S>, a: &Body<S>, b: &Body<S>) -> f64 {
    tolerance_of(scene, a).min(tolerance_of(scene, b))
}

/// The largest contact tolerance a block can have in any pair, metres.
pub(crate) fn tolerance_of<S: Shape>(scene: &SceneOf<S>, body: &Body<S>) -> f64 {
    let derived = RELATIVE_TOLERANCE * body.shape.width();
    scene.contact_tolerance().unwrap_or(derived)
}
