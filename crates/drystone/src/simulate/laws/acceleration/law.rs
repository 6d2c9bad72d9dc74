//! One time step by forces and accelerations, as Baraff's simulator makes it.
//!
//! ```text
//! collisions:    v' = v + M^-1 G p    (impulses, in no time, where bodies close too fast for forces)
//! accelerations: M a = F + (forces of the contacts),    v+ = v' + h a,    x+ = x + h v+
//! normal:        f_n >= 0  complementary to  a_n + (u_n' + gap / h) / h >= 0
//! resting:       |f_t| <= mu f_n,    a_t f_t <= 0,    a_t (mu f_n - |f_t|) = 0
//! sliding:       f_t = -mu f_n sign(u_t')
//! ```
//!
//! `u'` are the velocities at the contacts after the collisions. At a closed contact that keeps closed the second term of the normal
//! condition is what turning bodies add to the relative acceleration, for the last step left it in `u_n'`.
//!
//! An island of bodies in which nothing slides has a symmetric A: in impulses `p = h f` it is the problem of
//! `contact_problem.rs`, and pivots solve it, with all that they take over. One in which something slides has not;
//! `lemke.rs` solves it by Lemke's method. Where that finds no forces (Painlevé), the island is left to pivots too, as
//! impulses, which may stop what slides.
//!
//! D. Baraff, "Fast contact force computation for nonpenetrating rigid bodies", SIGGRAPH 1994; A. Loomis and D. Balkcom,
//! "Computation reuse for rigid-body dynamics", 2006, section IV.

use super::{
    collisions::collide,
    law_error,
    lemke::{Found, Island, Mode, SLIDES},
};
use crate::{
    contact::candidates::shift,
    geometry::Polygon,
    simulate::{
        error::StepFailure,
        formulate::{
            contact_problem::{ContactProblem, Velocity, normal_and_tangential},
            free_motion::free_from,
            islands::Islands,
            restitution::resting_speed,
        },
        laws::law::Law,
        options::Reuse,
        solve::{ActiveRows, Effort, FRICTION_ACCEPTED, Motion, PreviousStep, StepProblem, solve},
        state::State,
    },
};
use std::time::Instant;

/// Forces and accelerations, after impulses where bodies collide.
#[derive(Debug)]
pub struct AccelerationLevel;

impl Law<Polygon> for AccelerationLevel {
    fn motion(
        &self,
        state: &State<Polygon>,
        previous: &mut PreviousStep<Polygon>,
        contacts: &ContactProblem,
        free: &[Velocity],
        _: Effort,
    ) -> Result<Motion, StepFailure> {
        let islands = Islands::new(contacts, &state.inverse_mass);
        let collided = collide(state, contacts, &islands, free)?;
        let free = free_from(state, &collided.velocities);
        let dt = state.options.dt;
        let offsets: Vec<f64> = contacts.candidates().iter().map(|candidate| candidate.gap.max(0.0) / dt).collect();

        let begun = Instant::now();
        let modes = modes(contacts, &collided.velocities);
        let sliding = islands.with(contacts, |k| modes[k] != Mode::Rests);
        let (mut found, mut inconsistent) = (Vec::new(), None);
        for members in sliding {
            let island = Island {
                contacts,
                modes: members.iter().map(|&k| modes[k]).collect(),
                members,
                started: &collided.velocities,
                free: &free,
                offsets: &offsets,
                inverse_mass: &state.inverse_mass,
                previous: &previous.active_rows,
                slow: resting_speed(state),
            };
            match island.solve() {
                Ok(motion) => found.extend(motion),
                Err(contact) => inconsistent = inconsistent.or(Some(contact)),
            }
        }
        let time = begun.elapsed();
        previous.active_rows = ActiveRows::default();
        if state.options.reuse == Reuse::Full {
            previous.active_rows.add(found.iter().flat_map(|island: &Found| island.active.iter().cloned()));
        }

        let mut motion = solve_others((state, previous), contacts, &islands, (&free, &offsets), &found)?;
        motion.friction_error =
            law_error::largest(contacts, &motion.velocities, &motion.impulses, &offsets, &state.inverse_mass);
        let speed = free.iter().fold(0.0_f64, |fastest, v| shift::<Polygon>(v).max(fastest));
        let tolerance =
            StepProblem { contacts, free: &free, offsets: &offsets, effort: Effort::Full }.coulomb_tolerance(state);
        motion.exact = motion.friction_error <= tolerance.max(FRICTION_ACCEPTED * speed.max(1.0));
        motion.inconsistent = inconsistent;
        motion.time += time;
        collided.add_to(&mut motion);
        Ok(motion)
    }
}

/// What every contact does.
fn modes(contacts: &ContactProblem, velocities: &[Velocity]) -> Vec<Mode> {
    let fastest = velocities.iter().fold(1.0, |fastest: f64, [x, y, _]| fastest.max(x.hypot(*y)));
    let mode = |candidate| {
        let [_, u_t] = normal_and_tangential(candidate, velocities);
        if u_t.abs() > SLIDES * fastest { Mode::Slides(u_t.signum()) } else { Mode::Rests }
    };
    contacts.candidates().iter().map(mode).collect()
}

/// Solves the islands that are not among the found ones by pivots, and puts all together. To their solver the found ones
/// are there as bodies that are at rest without forces, so that its rows stay the same from step to step.
fn solve_others(
    (state, previous): (&State<Polygon>, &mut PreviousStep<Polygon>),
    contacts: &ContactProblem,
    islands: &Islands,
    (free, offsets): (&[Velocity], &[f64]),
    found: &[Found],
) -> Result<Motion, StepFailure> {
    let mut island_of: Vec<Option<&Found>> = vec![None; free.len()];
    for island in found {
        let body = islands.of(contacts.candidates()[island.members[0]].id.bodies);
        island_of[body] = Some(island);
    }
    let of_body: Vec<Option<&Found>> = (0..free.len()).map(|body| island_of[islands.of_body(body)]).collect();
    let of_contact: Vec<bool> =
        contacts.candidates().iter().map(|a| island_of[islands.of(a.id.bodies)].is_some()).collect();
    let others: Vec<Velocity> = free.iter().zip(&of_body).map(|(v, of)| of.map_or(*v, |_| [0.0; 3])).collect();
    let open: Vec<f64> = offsets.iter().zip(&of_contact).map(|(&c, &of)| if of { 0.0 } else { c }).collect();

    let mut motion =
        solve(state, previous, &StepProblem { contacts, free: &others, offsets: &open, effort: Effort::Full })?;
    for (body, island) in of_body.iter().enumerate().filter_map(|(body, island)| Some((body, (*island)?))) {
        motion.velocities[body] = island.motion.velocities[body];
    }
    for island in found {
        for (&k, impulse) in island.members.iter().zip(&island.motion.impulses) {
            let ([p_n, p_t], [nx, ny]) = (*impulse, contacts.candidates()[k].normal);
            motion.impulses[k] = [p_n * nx - p_t * ny, p_n * ny + p_t * nx];
            motion.sliding[k] = normal_and_tangential(&contacts.candidates()[k], &motion.velocities)[1].abs();
        }
        motion.add_part(island.work.solves, island.work.counts, island.residual);
    }
    Ok(motion)
}
