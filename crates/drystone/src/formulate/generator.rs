//! Generators: unit force directions that span each contact's friction cone, as sparse wrench columns.

use super::part::{Components, Part};
use crate::contact::Contact;

/// Force and moment of a unit generator on one movable block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench {
    /// Index among the movable blocks.
    pub block: usize,
    /// N and N m for a generator of 1 N.
    pub value: Components,
}

/// One unit direction of one contact's friction cone.
#[derive(Debug, Clone, PartialEq)]
pub struct Generator {
    /// Index of the contact.
    pub contact: usize,
    /// Unit direction of the force on the second body; the first body feels its opposite.
    pub direction: [f64; 3],
    /// One wrench for each movable body of the contact.
    pub wrenches: Vec<Wrench>,
}

/// Bodies of a scene, and which of them move.
pub(super) struct Bodies<'a, F: Fn(usize) -> Option<usize>> {
    pub bodies: &'a [Part],
    /// A body's index among the movable blocks.
    pub movable: F,
}

impl<F: Fn(usize) -> Option<usize>> Bodies<'_, F> {
    /// The generator of a contact along a direction.
    pub fn generator(&self, index: usize, contact: &Contact, direction: [f64; 3]) -> Generator {
        let [a, b] = contact.bodies;
        let parts = [self.wrench(contact, a, direction.map(|d| -d)), self.wrench(contact, b, direction)];
        Generator { contact: index, direction, wrenches: parts.into_iter().flatten().collect() }
    }

    fn wrench(&self, contact: &Contact, body: usize, direction: [f64; 3]) -> Option<Wrench> {
        let block = (self.movable)(body)?;
        Some(Wrench { block, value: self.bodies[body].wrench(direction, contact.point) })
    }
}
