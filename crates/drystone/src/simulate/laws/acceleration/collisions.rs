//! Impulses, in no time, where bodies close too fast for forces.

use crate::{
    geometry::Polygon,
    simulate::{
        error::StepFailure,
        formulate::{
            contact_problem::{ContactProblem, Velocity, normal_and_tangential},
            free_motion::kinetic_energy_gained,
            islands::Islands,
            restitution::{Offsets, resting_speed},
        },
        laws::impact::solve_with_rebounds,
        options::Reuse,
        solve::{Effort, Motion, PreviousStep},
        state::State,
    },
};

/// What closes more slowly is no collision, m/s, where gravity gives no measure.
const LEAST_COLLISION: f64 = 1e-9;

/// Velocities after collisions, and what they took.
pub struct Collided {
    pub velocities: Vec<Velocity>,
    /// Impulse at every contact in world axes, N s.
    impulses: Vec<[f64; 2]>,
    contacts: usize,
    motion: Option<Motion>,
}

/// Impulses in every island with a contact that closes beyond its gap faster than resting ones do: the problem of
/// `contact_problem.rs` without applied forces. Nothing of it is taken over from step to step.
pub fn collide(
    state: &State<Polygon>,
    contacts: &ContactProblem,
    islands: &Islands,
    free: &[Velocity],
) -> Result<Collided, StepFailure> {
    let fast = resting_speed(state).max(LEAST_COLLISION);
    let collides = |&k: &usize| {
        let candidate = &contacts.candidates()[k];
        let [arriving, _] = normal_and_tangential(candidate, &state.velocities);
        arriving + candidate.gap.max(0.0) / state.options.dt < -fast
    };
    let colliding: Vec<usize> = (0..contacts.candidates().len()).filter(collides).collect();
    let mut collided = Collided {
        velocities: state.velocities.clone(),
        impulses: vec![[0.0; 2]; contacts.candidates().len()],
        contacts: colliding.len(),
        motion: None,
    };
    if colliding.is_empty() {
        return Ok(collided);
    }
    let mut members: Vec<usize> = islands.with(contacts, |k| colliding.binary_search(&k).is_ok()).concat();
    members.sort_unstable();
    let mut from_nothing = PreviousStep::none(Reuse::None);
    let candidates = members.iter().map(|&k| contacts.candidates()[k]).collect();
    let part = ContactProblem::after(Some(contacts), candidates, state.options.cones, state.scene.gravity());
    let offsets = Offsets::new(state, &part, free);

    let started = (&collided.velocities[..], &offsets, Effort::Full);
    let gained = |ends: &[Velocity]| kinetic_energy_gained(state, ends);
    let mut motion = solve_with_rebounds(state, &mut from_nothing, &part, started, gained)?;
    motion.counts = from_nothing.solver.counts();
    collided.velocities.clone_from(&motion.velocities);
    members.iter().zip(&motion.impulses).for_each(|(&k, impulse)| collided.impulses[k] = *impulse);
    collided.motion = Some(motion);
    Ok(collided)
}

impl Collided {
    /// Adds the impulses and the work to those of the forces.
    pub fn add_to(self, motion: &mut Motion) {
        motion.collisions = self.contacts;
        for (all, own) in motion.impulses.iter_mut().zip(self.impulses) {
            (0..2).for_each(|k| all[k] += own[k]);
        }
        if let Some(collision) = self.motion {
            motion.add_part(collision.solves, collision.counts, collision.residual);
            motion.time += collision.time;
            motion.friction_error = motion.friction_error.max(collision.friction_error);
            motion.exact &= collision.exact;
        }
    }
}
