//! From geometry to contacts: which blocks touch, where, and along which normal.
//!
//! A broad phase (bounding boxes in a tree) finds the pairs that may touch, a narrow phase
//! (separating axes and clipping) says how each of them does.
//!
//! **Tolerance.** Two blocks touch when the greatest separation over their faces lies within plus
//! or minus the contact tolerance, in metres. By default it is 1e-6 of the narrower block's width:
//! a millionth of a block is far above the rounding of coordinates (about 1e-13 of a scene some
//! hundred blocks wide) and far below any gap that is meant. It is taken pair by pair, so that the
//! contacts of two blocks depend on these two alone. [`Scene::with_contact_tolerance`](crate::Scene::with_contact_tolerance) sets one
//! value for all instead, for scenes whose coordinates were rounded.

mod borders;
mod broad_phase;
pub mod candidates;
mod candidates_in_plane;
mod candidates_in_space;
mod covered;
mod id;
mod narrow_phase;
mod placed;
mod planar;
mod rounding;
mod separation;
mod set;
mod shared_face;
mod solids;
mod surfaces;
mod tolerance;
mod touch;

pub(crate) use broad_phase::pairs_within;
pub use id::{ContactId, Feature, SolidFeature, SolidPart};
pub use planar::{find_contacts, find_overlaps};
pub use set::{Contact, ContactSet};
pub(crate) use solids::overlapping_pieces;
pub use solids::{find_solid_contacts, find_solid_overlaps};
pub(crate) use surfaces::solid_distance;
pub use tolerance::RELATIVE_TOLERANCE;
pub(crate) use tolerance::{pair_tolerance, tolerance_of};
pub use touch::Overlap;
