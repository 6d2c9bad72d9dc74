//! What is shown of the contact forces of a step: where nothing moved in it the canonical ones, which do to every body what
//! the step's own impulses do. Nothing of this is carried: the impulses of a world stay what they are.

use super::{
    formulate::contact_problem::ContactProblem,
    moving::Moving,
    origin::in_scene,
    world::{ContactImpulse, World},
};
use crate::{
    canonical::{Between, as_strong_as},
    formulate::{Assembly, ContactForce, FrictionCone},
};

impl<S: Moving> World<S> {
    /// The impulses of the last step at the contacts that bore: of all that hold the bodies the canonical ones
    /// ([`canonical`](crate::canonical)) if nothing moved in it, else those of the step.
    pub fn bearing_impulses(&self) -> Vec<ContactImpulse<S::Vector>> {
        let still = self.state.motionless.iter().all(|&still| still);
        let canonical = if still { self.canonical_impulses() } else { None };
        let every = canonical.unwrap_or_else(|| self.contact_impulses());
        every.into_iter().filter(|contact| contact.along_normal > 0.0).collect()
    }

    /// None if contacts of bodies where they are do not bear what those of the step did.
    fn canonical_impulses(&self) -> Option<Vec<ContactImpulse<S::Vector>>> {
        let dt = self.state.options.dt;
        let candidates = self.previous.problem.iter().flat_map(ContactProblem::candidates);
        let forces: Vec<Between> = candidates
            .zip(&self.previous.impulses)
            .map(|(candidate, impulse)| {
                let force = S::in_space(*impulse).map(|p| p / dt);
                (candidate.id.bodies, S::in_space(candidate.point), force)
            })
            .collect();
        if forces.is_empty() {
            return None;
        }
        let assembly = Assembly::with_cones(&self.state.scene, self.state.options.cones).ok()?;
        let cone = assembly.cone_of_rest(FrictionCone::Pyramid);
        let found = as_strong_as(&assembly, &assembly.every_block(), cone, forces.into_iter())?;
        let impulse = |force: &ContactForce| {
            let contact = &assembly.contacts()[force.contact];
            ContactImpulse {
                id: contact.id,
                point: in_scene(of_space(contact.point), &self.origin),
                normal: of_space(contact.normal),
                impulse: of_space(force.force.map(|f| f * dt)),
                along_normal: force.normal * dt,
            }
        };
        Some(found.iter().map(impulse).collect())
    }
}

/// A vector of the world; in the plane its first two numbers.
fn of_space<V: crate::geometry::Numbers>(vector: [f64; 3]) -> V {
    let mut own = V::default();
    own.as_mut().iter_mut().zip(vector).for_each(|(own, x)| *own = x);
    own
}
