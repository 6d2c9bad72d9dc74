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
fn cone_edges(contact: &Contact) -> Vec<[f64; 2]> {
    let [nx, ny] = contact.normal;
    let mu = contact.friction;
    if mu == 0.0 {
        return vec![contact.normal];
    }
    let length = mu.hypot(1.0);
    [mu, -mu].map(|side| [(nx - side * ny) / length, (ny + side * nx) / length]).to_vec()
}

/// The generators of one contact. `movable` gives a body's index among the movable blocks.
pub(super) fn generators_of(
    index: usize,
    contact: &Contact,
    bodies: &[Body],
    movable: impl Fn(usize) -> Option<usize>,
) -> Vec<Generator> {
    let wrench = |body: usize, [dx, dy]: [f64; 2]| {
        let block = movable(body)?;
        let [cx, cy] = bodies[body].pose.position;
        let (rx, ry) = (contact.point[0] - cx, contact.point[1] - cy);
        Some(Wrench { block, value: [dx, dy, rx * dy - ry * dx] })
    };
    let [a, b] = contact.bodies;
    cone_edges(contact)
        .into_iter()
        .map(|direction| Generator {
            contact: index,
            direction,
            wrenches: [wrench(a, direction.map(|d| -d)), wrench(b, direction)].into_iter().flatten().collect(),
        })
        .collect()
}
