//! Generators: unit force directions that span each contact's friction cone, as sparse wrench columns.

use crate::{contact::Contact, scene::Body};

/// Force and moment of a unit generator on one movable block: (x force, y force, moment about the centroid).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench {
    /// Index among the movable blocks.
    pub block: usize,
    /// N, N, N m for a generator of 1 N.
    pub value: [f64; 3],
}

/// One unit direction of one contact's friction cone.
#[derive(Debug, Clone, PartialEq)]
pub struct Generator {
    /// Index of the contact.
    pub contact: usize,
    /// Unit direction of the force on the second body; the first body feels its opposite.
    pub direction: [f64; 2],
    /// One wrench for each movable body of the contact.
    pub wrenches: Vec<Wrench>,
}

/// The edges of a contact's friction cone: the normal alone without friction, else the two directions at the
/// angle of friction on either side of it.
pub(crate) fn cone_edges([nx, ny]: [f64; 2], mu: f64) -> Vec<[f64; 2]> {
    if mu == 0.0 {
        return vec![[nx, ny]];
    }
    let length = mu.hypot(1.0);
    [mu, -mu].map(|side| [(nx - side * ny) / length, (ny + side * nx) / length]).to_vec()
}

/// Bodies of a scene, and which of them move.
pub(super) struct Bodies<'a, F: Fn(usize) -> Option<usize>> {
    pub bodies: &'a [Body],
    /// A body's index among the movable blocks.
    pub movable: F,
}

impl<F: Fn(usize) -> Option<usize>> Bodies<'_, F> {
    /// The generators of one contact.
    pub fn generators(&self, index: usize, contact: &Contact) -> Vec<Generator> {
        cone_edges(contact.normal, contact.friction)
            .into_iter()
            .map(|direction| self.generator(index, contact, direction))
            .collect()
    }

    /// The axis of a contact's cone, where that is not its only generator. It adds no force that the edges do not have,
    /// but one number instead of two says that a contact is pressed straight.
    pub fn axis(&self, index: usize, contact: &Contact) -> Option<Generator> {
        (contact.friction > 0.0).then(|| self.generator(index, contact, contact.normal))
    }

    fn generator(&self, index: usize, contact: &Contact, direction: [f64; 2]) -> Generator {
        let [a, b] = contact.bodies;
        let parts = [self.wrench(contact, a, direction.map(|d| -d)), self.wrench(contact, b, direction)];
        Generator { contact: index, direction, wrenches: parts.into_iter().flatten().collect() }
    }

    fn wrench(&self, contact: &Contact, body: usize, [dx, dy]: [f64; 2]) -> Option<Wrench> {
        let block = (self.movable)(body)?;
        let [cx, cy] = self.bodies[body].pose.position;
        let (rx, ry) = (contact.point[0] - cx, contact.point[1] - cy);
        Some(Wrench { block, value: [dx, dy, rx * dy - ry * dx] })
    }
}

/// What a force of one newton along a contact's axis is in each of its two edges, newtons.
pub(super) fn axis_share(contact: &Contact) -> f64 {
    0.5 * contact.friction.hypot(1.0)
}
