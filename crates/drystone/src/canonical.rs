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
    check::verdict::Verdict,
    contact::Contact,
    formulate::{Assembly, BlockSet, BodySpace, Components, ContactForce, FrictionCone},
    geometry::length,
    proof::{accelerations_under, moving},
};
use corners::{Allowed, Rows, least_squares};
use drystone_lcp::interior::Layers;
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
    if verdict.least_norm {
        return Some(verdict.forces.iter().map(|&(_, force)| force).collect());
    }
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
    let layered = Layered::new(assembly, space);
    let forces = layered.elastic().unwrap_or_else(|| layered.within_cones());
    layered.contact_forces(forces)
}

/// The same where they are found at once, without the cones; None where some face cannot bear what its layer does then. That they
/// balance the blocks is for the caller to judge.
pub(crate) fn elastic_forces(assembly: &Assembly, blocks: &BlockSet, cone: FrictionCone) -> Option<Vec<ContactForce>> {
    let layered = Layered::new(assembly, assembly.body_space(blocks, cone));
    Some(layered.contact_forces(layered.elastic()?))
}

/// A problem with layers in its faces. Forces are along the directions of its points.
struct Layered<'a> {
    in_plane: bool,
    space: BodySpace<'a>,
    contacts: Vec<&'a Contact>,
    faces: Vec<Face>,
    layers: Layers,
}

impl<'a> Layered<'a> {
    fn new(assembly: &'a Assembly, space: BodySpace<'a>) -> Self {
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
        Self { in_plane: assembly.in_plane(), space, contacts, faces, layers }
    }

    fn contact_forces(&self, forces: Vec<[f64; 3]>) -> Vec<ContactForce> {
        forces.into_iter().enumerate().map(|(point, force)| self.space.force(point, force)).collect()
    }

    /// Where no layer parts or slides. None where the points of some face cannot bear what its layer does then, or not all of its
    /// cones are left.
    fn elastic(&self) -> Option<Vec<[f64; 3]>> {
        if (0..self.contacts.len()).any(|point| self.space.slides(point)) {
            return None;
        }
        let mut wrenches = self.space.problem().elastic(&self.layers)?;
        for (wrench, face) in wrenches.iter_mut().zip(&self.faces) {
            wrench.iter_mut().zip(units(face)).for_each(|(w, unit)| *w *= unit);
        }
        let none = NONE * wrenches.iter().flatten().fold(0.0_f64, |largest, w| largest.max(w.abs()));
        let mut forces = vec![[0.0; 3]; self.contacts.len()];
        for (face, wrench) in self.faces.iter().zip(&wrenches) {
            if wrench.iter().any(|w| w.abs() > none) {
                set(&mut forces, &face.corners, self.among_corners(face, wrench)?, none);
            }
        }
        Some(forces)
    }

    /// In any case: the corners of a face make up what all its points bear; or all points do, of which those that push aside as far as
    /// they can do so along what was found; or, where rounding allows neither, as it was found.
    fn within_cones(&self) -> Vec<[f64; 3]> {
        let found = self.space.least_norm(&self.layers);
        let none = NONE * found.iter().map(|force| length(*force)).fold(0.0, f64::max);
        let mut forces = vec![[0.0; 3]; found.len()];
        for face in &self.faces {
            let as_found = || face.points.iter().map(|&point| found[point]).collect();
            if face.points.iter().any(|&point| self.space.slides(point)) {
                set(&mut forces, &face.points, as_found(), 0.0);
                continue;
            }
            let mut wrench = [0.0; 6];
            for &point in &face.points {
                for (row, f) in self.rows(face, point).iter().zip(&found[point]) {
                    (0..6).for_each(|k| wrench[k] += row[k] * f);
                }
            }
            if wrench.iter().all(|w| w.abs() <= none) {
                continue;
            }
            if let Some(shared) = self.among_corners(face, &wrench) {
                set(&mut forces, &face.corners, shared, none);
                continue;
            }
            let beside = |&point: &usize| (self.rows(face, point), self.allowed(face).beside(found[point]));
            let every: Vec<_> = face.points.iter().map(beside).collect();
            let shared = least_squares(&wrench, &every, face.stiffness.len(), self.directions(face));
            set(&mut forces, &face.points, shared.unwrap_or_else(as_found), none);
        }
        forces
    }

    /// The least squares of forces at the corners of a face, within their cones, that make up a wrench; None if none do.
    fn among_corners(&self, face: &Face, wrench: &[f64; 6]) -> Option<Vec<[f64; 3]>> {
        let allowed = self.allowed(face);
        let corners: Vec<_> = face.corners.iter().map(|&point| (self.rows(face, point), allowed)).collect();
        least_squares(wrench, &corners, face.stiffness.len(), self.directions(face))
    }

    /// Rows of a point on the wrench of its face, moments in units of the layer's radii of gyration.
    fn rows(&self, face: &Face, point: usize) -> Rows {
        let units = units(face);
        self.layers.jacobian[point].map(|row| [0, 1, 2, 3, 4, 5].map(|k| row[k] * units[k]))
    }

    fn allowed(&self, face: &Face) -> Allowed<'_> {
        let first = face.points[0];
        Allowed::of(self.space.cone(first), self.contacts[first].friction, self.in_plane)
    }

    /// Directions in which points of a face can push.
    fn directions(&self, face: &Face) -> usize {
        match face.stiffness.len() {
            _ if self.contacts[face.points[0]].friction == 0.0 => 1,
            3 => 2,
            _ => 3,
        }
    }
}

/// Reciprocals of the layer's radii of gyration beside its moments, 1/m; one beside its forces.
fn units(face: &Face) -> [f64; 6] {
    let size = face.stiffness.len();
    let unit = |k: usize| if k < size { (face.stiffness[0] / face.stiffness[k]).sqrt() } else { 0.0 };
    [0, 1, 2, 3, 4, 5].map(unit)
}

/// Forces at some points; those up to `none` are rounding.
fn set(forces: &mut [[f64; 3]], points: &[usize], shared: Vec<[f64; 3]>, none: f64) {
    for (&point, force) in points.iter().zip(shared) {
        forces[point] = if length(force) > none { force } else { [0.0; 3] };
    }
}
