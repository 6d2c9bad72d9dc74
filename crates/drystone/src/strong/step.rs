//! The motion that a step of the contact solver begins with.
//!
//! Its sweeps start without any force, so that they find a motion that needs little of it rather than rest, where both obey the laws:
//! the quick way to an escape. What they find is verified; where they find rest, or nothing, nothing is said.

use super::escape::Escape;
use crate::formulate::{Assembly, BlockSet, FrictionCone};
use drystone_contact::{Bodies, Contact, Settings};

/// Newton steps in one island: an escape that takes more is left to the search.
const NEWTON_STEPS: usize = 50;

/// None where no other motion than rest is found.
pub(super) fn escape(assembly: &Assembly, blocks: &BlockSet) -> Option<Escape> {
    let space = assembly.body_space(blocks, FrictionCone::Pyramid);
    let problem = space.problem();
    let contacts = problem.points.iter().zip(space.contacts()).map(|(point, contact)| Contact {
        bodies: point.bodies,
        jacobian: point.jacobian,
        friction: contact.friction,
        offset: 0.0,
    });
    let bodies = Bodies {
        size: problem.size,
        inverse_mass: problem.inverse_mass.clone(),
        free: problem.load.iter().zip(&problem.inverse_mass).map(|(load, inverse)| load * inverse).collect(),
        contacts: contacts.collect(),
    };
    let settings = Settings { newton_steps: NEWTON_STEPS, ..Settings::default() };
    // A step of a second: impulses are forces then, and velocities accelerations.
    let found = bodies.solve(None, &settings).ok()?;
    let dimension = bodies.dimension();
    let force = |(point, local): (usize, &[f64])| {
        space.force(point, std::array::from_fn(|k| local.get(k).copied().unwrap_or(0.0)))
    };
    let forces = found.impulses.chunks_exact(dimension).enumerate().map(force).collect();
    Escape::verified(assembly, blocks, &space.motion(&found.velocities), forces)
}
