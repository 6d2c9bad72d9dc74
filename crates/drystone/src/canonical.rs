//! The one answer to "which contact forces": those of least norm.
//!
//! Contact forces of a redundant structure are not unique; which ones a solver finds depends on its method and its past. Of all
//! forces within the friction cones that balance the blocks these are the ones with the least
//!
//! ```text
//! sum over faces of W' Q W
//! ```
//!
//! A *face* is all points in which two bodies touch on one plane, W the wrench there about the centroid of the points' outline, and
//! Q the compliance of an elastic layer on that outline, equally stiff along the normal and across it (Winkler's). Q is positive
//! definite, so W is unique. Within a face the forces at the corners of its outline are the least squares of those in the
//! cones that make up W; other points of it bear nothing. So whatever the structure and its loads are symmetric to, the
//! forces are. docs/theory/canonical-forces.md.

mod corners;
mod face;
mod section;

use crate::{
    check::Verdict,
    contact::Contact,
    formulate::{Assembly, BlockSet, BodySpace, Components, ContactForce, FrictionCone},
    geometry::length,
    proof::{accelerations_under, moving},
};
use corners::{Allowed, Rows, least_squares};
use drystone_lcp::interior::{Cone, Layers};
pub(crate) use face::{Face, faces};

/// Forces below this share of the largest are rounding: none.
const NONE: f64 = 1e-12;

/// The canonical forces of a structure that a verdict was given on, in the order of its own forces.
///
/// What stands has those within Coulomb's cones, whatever pyramids within them the verdict was found on; pyramids around the
/// cones are kept. Of what falls they are those of least norm, within `cone`, under which it falls with the accelerations that
/// the verdict's own forces give. None where these are not found to the accuracy that a verdict needs, which may be so where it
/// is borderline or nearly.
pub fn canonical_forces(assembly: &Assembly, cone: FrictionCone, verdict: &Verdict) -> Option<Vec<ContactForce>> {
    let (mut blocks, none) = (BlockSet::empty(assembly.blocks()), BlockSet::empty(assembly.blocks()));
    verdict.checked.iter().filter_map(|&body| assembly.block_of(body)).for_each(|block| blocks.insert(block));
    if verdict.stable {
        holding_up(assembly, &blocks, &none, cone)
    } else {
        let at = |(contact, force): &(Contact, ContactForce)| (contact.bodies, contact.point, force.force);
        as_strong_as(assembly, &blocks, cone, verdict.forces.iter().map(at))
    }
}

/// The canonical forces that hold blocks up of which some are held by hands, if there are any; within Coulomb's cones unless the
/// pyramids lie around these.
pub(crate) fn holding_up(
    assembly: &Assembly,
    blocks: &BlockSet,
    held: &BlockSet,
    cone: FrictionCone,
) -> Option<Vec<ContactForce>> {
    let found = least_norm(assembly, blocks, held, assembly.cone_of_rest(cone), None);
    let falling = moving(assembly, &accelerations_under(assembly, blocks, &found), &found);
    falling.iter().all(|(block, _)| held.contains(*block)).then_some(found)
}

/// A force on the second of two bodies at a point, and its opposite on the first.
pub(crate) type Between = ([usize; 2], [f64; 3], [f64; 3]);

/// The forces of least norm that do to every block what some forces within the cones do. None if rounding does not allow it.
pub(crate) fn as_strong_as(
    assembly: &Assembly,
    blocks: &BlockSet,
    cone: FrictionCone,
    forces: impl Iterator<Item = Between>,
) -> Option<Vec<ContactForce>> {
    let mut balanced = vec![[0.0; 6]; assembly.blocks()];
    for (bodies, point, force) in forces {
        for (body, sign) in bodies.into_iter().zip([1.0, -1.0]) {
            let Some(block) = assembly.block_of(body) else { continue };
            let wrench = assembly.bodies()[body].wrench(force.map(|f| sign * f), point);
            (0..6).for_each(|k| balanced[block][k] += wrench[k]);
        }
    }
    let found = least_norm(assembly, blocks, &BlockSet::empty(assembly.blocks()), cone, Some(&balanced));
    let mut left = accelerations_under(assembly, blocks, &found);
    for (block, left) in &mut left {
        let own = assembly.applied(*block).iter().zip(assembly.inverse_mass(*block));
        for (&k, (load, inverse)) in assembly.components().iter().zip(own) {
            left[k] -= (load - balanced[*block][k]) * inverse;
        }
    }
    moving(assembly, &left, &found).is_empty().then_some(found)
}

/// The forces of least norm at every contact point of some blocks of which some are held, ascending by contact. They balance the
/// loads of the others, or other wrenches on them.
fn least_norm(
    assembly: &Assembly,
    blocks: &BlockSet,
    held: &BlockSet,
    cone: FrictionCone,
    balanced: Option<&[Components]>,
) -> Vec<ContactForce> {
    let mut space = assembly.held_body_space(blocks, held, cone);
    if let Some(wrenches) = balanced {
        space.balance(wrenches);
    }
    least_norm_of(assembly, space)
}

/// The forces of least norm at every point of a problem.
pub(crate) fn least_norm_of(assembly: &Assembly, space: BodySpace<'_>) -> Vec<ContactForce> {
    let contacts: Vec<&Contact> = space.contacts().collect();
    let faces = faces(assembly, &contacts);
    let (mut of, mut rows) = (vec![0; contacts.len()], vec![[[0.0; 6]; 3]; contacts.len()]);
    for (layer, face) in faces.iter().enumerate() {
        for &point in &face.points {
            of[point] = layer;
            rows[point] = space.directions(point).map(|direction| face.wrench(direction, contacts[point].point));
        }
    }
    let stiffness = faces.iter().flat_map(|face| face.stiffness.iter().copied()).collect();
    let layers = Layers { stiffness, of, jacobian: rows };
    let found = space.least_norm(&layers);
    let largest = found.iter().map(|force| length(*force)).fold(0.0, f64::max);
    let mut forces = vec![[0.0; 3]; contacts.len()];
    let shared = Shared { in_plane: assembly.in_plane(), rows: &layers.jacobian, found: &found, none: NONE * largest };
    for face in &faces {
        let first = face.points[0];
        if face.points.iter().any(|&point| space.slides(point)) {
            face.points.iter().for_each(|&point| forces[point] = found[point]);
            continue;
        }
        shared.among_corners(face, space.cone(first), contacts[first].friction, &mut forces);
    }
    forces.into_iter().enumerate().map(|(point, force)| space.force(point, force)).collect()
}

/// What faces bear by the forces at their points, along the points' directions.
struct Shared<'a> {
    in_plane: bool,
    /// Of each point on the wrench of its face.
    rows: &'a [Rows],
    found: &'a [[f64; 3]],
    /// Forces up to this are rounding.
    none: f64,
}

impl Shared<'_> {
    /// Shares what a face bears among its corners: their least squares within the cones; or of those that push aside as far as
    /// they can along what was found; or, where rounding allows neither, as it was found.
    fn among_corners(&self, face: &Face, cone: &Cone, friction: f64, forces: &mut [[f64; 3]]) {
        let size = face.stiffness.len();
        // Moments in units of the layer's radii of gyration.
        let unit = |k: usize| if k < size { (face.stiffness[0] / face.stiffness[k]).sqrt() } else { 0.0 };
        let unit = [0, 1, 2, 3, 4, 5].map(unit);
        let rows = |point: usize| self.rows[point].map(|row| [0, 1, 2, 3, 4, 5].map(|k| row[k] * unit[k]));
        let mut wrench = [0.0; 6];
        for &point in &face.points {
            for (row, f) in rows(point).iter().zip(&self.found[point]) {
                (0..6).for_each(|k| wrench[k] += row[k] * f);
            }
        }
        if wrench.iter().all(|w| w.abs() <= self.none) {
            return;
        }
        let directions = match size {
            _ if friction == 0.0 => 1,
            3 => 2,
            _ => 3,
        };
        let allowed = Allowed::of(cone, friction, self.in_plane);
        let corners: Vec<_> = face.corners.iter().map(|&point| (rows(point), allowed)).collect();
        let beside = |point: usize| (rows(point), allowed.beside(self.found[point]));
        let (points, shared) = match least_squares(&wrench, &corners, size, directions) {
            Some(shared) => (&face.corners, shared),
            None => {
                let every: Vec<_> = face.points.iter().map(|&point| beside(point)).collect();
                let as_found = || face.points.iter().map(|&point| self.found[point]).collect();
                (&face.points, least_squares(&wrench, &every, size, directions).unwrap_or_else(as_found))
            }
        };
        for (&point, force) in points.iter().zip(shared) {
            forces[point] = if length(force) > self.none { force } else { [0.0; 3] };
        }
    }
}
