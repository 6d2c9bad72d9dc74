//! What is read back from the magnitudes of the generators: forces and accelerations.

use crate::geometry::{dot, length};

/// The force that the first body of a contact exerts on the second, newtons.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// Index of the contact in [`Assembly::contacts`](super::Assembly::contacts).
    pub contact: usize,
    /// Along the contact normal (first body into second): not negative.
    pub normal: f64,
    /// In the plane along the normal turned 90 degrees counter-clockwise; in space its size, which is not negative.
    pub tangential: f64,
    /// In world axes.
    pub force: [f64; 3],
}

/// Takes a force at a contact apart along its normal and across.
pub(crate) fn force_at(contact: usize, normal: [f64; 3], in_plane: bool, force: [f64; 3]) -> ContactForce {
    let along = dot(force, normal);
    let tangential = if in_plane {
        force[1] * normal[0] - force[0] * normal[1]
    } else {
        length([0, 1, 2].map(|k| force[k] - along * normal[k]))
    };
    ContactForce { contact, normal: along, tangential, force }
}

/// Acceleration of a block in world axes; in the plane x, y and the turn about z are in use.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Acceleration {
    /// Of the centre of mass, m/s^2.
    pub linear: [f64; 3],
    /// rad/s^2.
    pub angular: [f64; 3],
}

impl Acceleration {
    /// x, y and the turn: all there is in the plane.
    pub fn in_plane(self) -> [f64; 3] {
        [self.linear[0], self.linear[1], self.angular[2]]
    }

    /// All six in one.
    pub fn components(self) -> [f64; 6] {
        let ([x, y, z], [a, b, c]) = (self.linear, self.angular);
        [x, y, z, a, b, c]
    }
}
