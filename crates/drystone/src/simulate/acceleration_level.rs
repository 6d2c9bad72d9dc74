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
//! `velocity_level.rs`, and the route of choice solves it, with all that it takes over. One in which something slides has not;
//! `sliding.rs` solves it by Lemke's method. Where that finds no forces (Painlevé), the island is left to the route too, as
//! impulses, which may stop what slides.
//!
//! D. Baraff, "Fast contact force computation for nonpenetrating rigid bodies", SIGGRAPH 1994; A. Loomis and D. Balkcom,
//! "Computation reuse for rigid-body dynamics", 2006, section IV.

use super::{
    coulomb,
    error::StepFailure,
    formulation::Law,
    friction::FRICTION_ACCEPTED,
    islands::Islands,
    reuse::Reuse,
    sliding::{Carried, Found, Island, Mode},
    solve::Motion,
    velocity_level::{Velocity, VelocityLevel, normal_and_tangential},
    world::World,
};
use crate::{
    contact::{ContactId, approach::shift},
    geometry::Polygon,
};
use drystone_lcp::Counts;
use std::{mem, time::Instant};

/// A contact at which no forces obey the conditions, so that the step went by impulses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Inconsistent {
    /// Which corner and which face.
    pub contact: ContactId,
    /// How the solve ended: "no_solution" is proved; after another word there may be forces that were not found.
    pub status: &'static str,
}

/// A contact slides if it is faster than this, m/s (above 1 m/s, than this share of the fastest body). Ten times what may be left of
/// the speed of one that rests. The choice does not show: what is taken for sliding and would reverse, rests.
pub(super) const SLIDES: f64 = 10.0 * super::FRICTION_ACCEPTED;

/// What closes more slowly is no collision, m/s, where gravity gives no measure.
const LEAST_COLLISION: f64 = 1e-9;

/// Forces and accelerations, after impulses where bodies collide.
#[derive(Debug)]
pub(super) struct AccelerationLevel;

/// Velocities after collisions, and what they took.
struct Collided {
    velocities: Vec<Velocity>,
    /// Impulse at every approach in world axes, N s.
    impulses: Vec<[f64; 2]>,
    contacts: usize,
    motion: Option<Motion>,
}

impl Law<Polygon> for AccelerationLevel {
    fn motion(&self, world: &mut World, contacts: &VelocityLevel, free: &[Velocity]) -> Result<Motion, StepFailure> {
        let islands = Islands::new(contacts, &world.inverse_mass);
        let collided = collide(world, contacts, &islands, free)?;
        let free = world.free_from(&collided.velocities);
        let dt = world.options.dt;
        let offsets: Vec<f64> = contacts.approaches().iter().map(|approach| approach.gap.max(0.0) / dt).collect();

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
                inverse_mass: &world.inverse_mass,
                carried: &world.carried,
                slow: world.resting_speed(),
            };
            match island.solve() {
                Ok(motion) => found.extend(motion),
                Err(contact) => inconsistent = inconsistent.or(Some(contact)),
            }
        }
        let time = begun.elapsed();
        world.carried = Carried::default();
        if world.options.reuse == Reuse::Full {
            world.carried.add(found.iter().flat_map(|island: &Found| island.active.iter().cloned()));
        }

        let mut motion = solve_others(world, contacts, &islands, (&free, &offsets), &found)?;
        motion.friction_error =
            coulomb::departure(contacts, &motion.velocities, &motion.impulses, &offsets, &world.inverse_mass);
        let speed = free.iter().fold(0.0_f64, |fastest, v| shift::<Polygon>(v).max(fastest));
        motion.exact = motion.friction_error <= FRICTION_ACCEPTED * speed.max(1.0);
        motion.inconsistent = inconsistent;
        motion.time += time;
        collided.add_to(&mut motion);
        Ok(motion)
    }
}

/// What every contact does.
fn modes(contacts: &VelocityLevel, velocities: &[Velocity]) -> Vec<Mode> {
    let fastest = velocities.iter().fold(1.0, |fastest: f64, [x, y, _]| fastest.max(x.hypot(*y)));
    let mode = |approach| {
        let [_, u_t] = normal_and_tangential(approach, velocities);
        if u_t.abs() > SLIDES * fastest { Mode::Slides(u_t.signum()) } else { Mode::Rests }
    };
    contacts.approaches().iter().map(mode).collect()
}

/// Impulses, in no time, in every island with a contact that closes beyond its gap faster than resting ones do: the problem
/// of `velocity_level.rs` without applied forces. Nothing of it is taken over from step to step.
fn collide(
    world: &mut World,
    contacts: &VelocityLevel,
    islands: &Islands,
    free: &[Velocity],
) -> Result<Collided, StepFailure> {
    let dt = world.options.dt;
    let fast = world.resting_speed().max(LEAST_COLLISION);
    let collides = |&k: &usize| {
        let approach = &contacts.approaches()[k];
        let [arriving, _] = normal_and_tangential(approach, &world.velocities);
        arriving + approach.gap.max(0.0) / dt < -fast
    };
    let colliding: Vec<usize> = (0..contacts.approaches().len()).filter(collides).collect();
    let mut collided = Collided {
        velocities: world.velocities.clone(),
        impulses: vec![[0.0; 2]; contacts.approaches().len()],
        contacts: colliding.len(),
        motion: None,
    };
    if colliding.is_empty() {
        return Ok(collided);
    }
    let mut members: Vec<usize> = islands.with(contacts, |k| colliding.binary_search(&k).is_ok()).concat();
    members.sort_unstable();
    let part = world.problem_of(members.iter().map(|&k| contacts.approaches()[k]).collect());
    let gap = |k: usize| part.approaches()[k].gap.max(0.0);
    let offset = |k: usize| world.rebound(&part, k, free).unwrap_or(gap(k) / dt);
    let offsets: Vec<f64> = (0..members.len()).map(offset).collect();

    let route = mem::replace(&mut world.route, Reuse::None.route());
    let before = world.before.take();
    let motion = world.solve(&part, &collided.velocities, &offsets);
    let spent = mem::replace(&mut world.route, route).counts();
    world.before = before;
    let mut motion = motion?;
    motion.counts = spent;
    collided.velocities.clone_from(&motion.velocities);
    members.iter().zip(&motion.impulses).for_each(|(&k, impulse)| collided.impulses[k] = *impulse);
    collided.motion = Some(motion);
    Ok(collided)
}

impl Collided {
    fn add_to(self, motion: &mut Motion) {
        motion.collisions = self.contacts;
        for (all, own) in motion.impulses.iter_mut().zip(self.impulses) {
            (0..2).for_each(|k| all[k] += own[k]);
        }
        if let Some(collision) = self.motion {
            motion.add_work(collision.solves, collision.counts, collision.residual);
            motion.time += collision.time;
            motion.friction_error = motion.friction_error.max(collision.friction_error);
            motion.exact &= collision.exact;
        }
    }
}

/// Solves the islands that are not among the found ones by the route, and puts all together. To the route the found ones
/// are there as bodies that are at rest without forces, so that its rows stay the same from step to step.
fn solve_others(
    world: &mut World,
    contacts: &VelocityLevel,
    islands: &Islands,
    (free, offsets): (&[Velocity], &[f64]),
    found: &[Found],
) -> Result<Motion, StepFailure> {
    let mut island_of: Vec<Option<&Found>> = vec![None; free.len()];
    for island in found {
        let body = islands.of(&contacts.approaches()[island.members[0]]);
        island_of[body] = Some(island);
    }
    let of_body: Vec<Option<&Found>> = (0..free.len()).map(|body| island_of[islands.of_body(body)]).collect();
    let of_contact: Vec<bool> = contacts.approaches().iter().map(|a| island_of[islands.of(a)].is_some()).collect();
    let others: Vec<Velocity> = free.iter().zip(&of_body).map(|(v, of)| of.map_or(*v, |_| [0.0; 3])).collect();
    let open: Vec<f64> = offsets.iter().zip(&of_contact).map(|(&c, &of)| if of { 0.0 } else { c }).collect();

    let mut motion = world.solve(contacts, &others, &open)?;
    for (body, island) in of_body.iter().enumerate().filter_map(|(body, island)| Some((body, (*island)?))) {
        motion.velocities[body] = island.motion.velocities[body];
    }
    for island in found {
        for (&k, impulse) in island.members.iter().zip(&island.motion.impulses) {
            let ([p_n, p_t], [nx, ny]) = (*impulse, contacts.approaches()[k].normal);
            motion.impulses[k] = [p_n * nx - p_t * ny, p_n * ny + p_t * nx];
            motion.sliding[k] = normal_and_tangential(&contacts.approaches()[k], &motion.velocities)[1].abs();
        }
        motion.add_work(island.work.solves, island.work.counts, island.residual);
    }
    Ok(motion)
}

impl Motion {
    fn add_work(&mut self, solves: usize, counts: Counts, residual: f64) {
        self.solves += solves;
        self.counts = self.counts + counts;
        self.residual = self.residual.max(residual);
    }
}
