//! A step on Coulomb's round cones: `drystone_contact` finds impulses and velocities at once, from the impulses of the step before.
//!
//! In space pivots need pyramids, on which a plate thrown along a floor curves, and solve 13 to 23 problems a step where blocks
//! tumble. Here all that counts is how far the answer is from Coulomb's law; docs/theory/step-solver.md has what was measured.

use super::{
    choice,
    previous_step::PreviousStep,
    step_problem::{Effort, Motion, StepProblem},
};
use crate::{
    contact::candidates::CandidateOf,
    geometry::{Shape, norm, product},
    simulate::{
        formulate::contact_problem::{ContactProblem, relative_velocity, wrench},
        kinematics::{Kinematics, axes, components, is_zero},
        options::Reuse,
        state::State,
    },
};
use drystone_contact::{Bodies, Contact, Settings};
use drystone_lcp::Counts;
use std::time::Instant;

/// An answer further from Coulomb's law than this share of the speeds is left to pivots. Their pyramids are off the cone by
/// up to 7.6 % of the friction: what is nearer is the better answer, though it is not exact.
const COARSE: f64 = 1e-4;

/// The same where pivots are too hard, or there are [`MANY_ROWS`](choice::MANY_ROWS), and they do not come to the law either. On 158 stones that fall at once and meet
/// one another they end at 0.4 % of the speeds, this at 1 %; on a wall of 100 bricks in space that is hit at 20 m/s they end at 0.7 % after
/// half a minute, this at 0.013 %. The next step is exact.
const COARSE_OF_MANY: f64 = 0.02;

/// The same in space where pivots have become too hard: by so much the friction of their pyramids is off, and so was what they found in half a minute.
const COARSE_AS_PYRAMIDS: f64 = 0.076;

/// By how much a body's speed may be further off than the law at its contacts: errors add up over a tower, and with its height. Seen: 13, at five
/// blocks.
const AMPLIFIED: f64 = 100.0;

/// Share of the tolerance that is aimed at in the plane, where pivots end so near to the law; not by what takes long.
const IN_PLANE: f64 = 0.1;

/// Newton steps in one island, at most; in the plane, where there are other ways too. Of 360 steps of a cube thrown at a wall in space one is not exact with 600,
/// with 400 seven are not.
const NEWTON_STEPS: usize = 600;
const STEPS_IN_PLANE: usize = 200;

/// Changes of each contact on the way from nothing, at most: a wall of 200 bricks that is hit takes a second then. What needs more is not exact.
const CHANGES: usize = 12;

/// The same where only who meets is asked, and the share of the speeds that is aimed at. Of 158 stones that fall at once and meet others in
/// 14 rounds the step takes half a second so, 1.15 s with all of them solved.
const NEARLY_STEPS: usize = 20;
const NEARLY: f64 = 1e-4;

/// In the plane, with so many contacts, without the way from nothing, which takes long, while it is looked for who meets.
const SOON_STEPS: usize = 100;
const LARGE: usize = 400;

/// What round cones make of a step.
pub enum Round<S: Kinematics> {
    Solved(Motion<S>),
    /// An answer that is not near enough: pivots are to be tried.
    Coarse(Motion<S>),
    /// It is left to pivots, or nothing was found.
    Left,
}

/// Solves a step on round cones.
pub fn solve_on_round_cones<S: Kinematics>(
    state: &State<S>,
    previous: &mut PreviousStep<S>,
    step: &StepProblem<'_, S>,
) -> Round<S> {
    if !choice::on_round_cones(state, previous, step) {
        return Round::Left;
    }
    let soon = step.effort == Effort::Soon && axes::<S>() == 2 && step.contacts.candidates().len() >= LARGE;
    let at_law = Aim::at_law(state);
    let aim = if soon { Aim { newton_steps: SOON_STEPS, changes: 0, ..at_law } } else { at_law };
    let many = axes::<S>() == 3 && step.contacts.len() >= choice::MANY_ROWS;
    let enough = |motion: &Motion<S>| {
        soon || is_within(motion, COARSE) || (many && gives_no_energy(step, motion, COARSE_OF_MANY))
    };
    match from_impulses(state, step, &impulses_before(previous, step.contacts), aim) {
        Some(motion) if enough(&motion) => {
            previous.forget_pivots();
            Round::Solved(Motion { unfinished: soon && !motion.exact, ..motion })
        }
        Some(motion) => Round::Coarse(motion),
        None => Round::Left,
    }
}

/// A motion near the law, in few Newton steps; None where a step is left to pivots.
pub fn solve_nearly<S: Kinematics>(
    state: &State<S>,
    previous: &PreviousStep<S>,
    step: &StepProblem<'_, S>,
) -> Option<Motion<S>> {
    if !choice::on_round_cones(state, previous, step) {
        return None;
    }
    let impulses = impulses_before(previous, step.contacts);
    from_impulses(state, step, &impulses, Aim { share: NEARLY, newton_steps: NEARLY_STEPS, changes: 0 })
}

/// Whether it is near enough to take the place of pivots that are too hard.
pub fn may_replace_pivots<S: Kinematics>(step: &StepProblem<'_, S>, motion: &Motion<S>) -> bool {
    gives_no_energy(step, motion, if axes::<S>() == 3 { COARSE_AS_PYRAMIDS } else { COARSE_OF_MANY })
}

/// Whether it is within this share of the speeds, and its impulses give no energy but what rebounds have: with the velocities at the end of the step they
/// have no power. (So what they do from its beginning to its end takes energy, for W is positive.)
fn gives_no_energy<S: Kinematics>(step: &StepProblem<'_, S>, motion: &Motion<S>, share: f64) -> bool {
    let power = |(k, impulse): (usize, &S::Vector)| {
        let candidate = &step.contacts.candidates()[k];
        let rebound = step.offsets[k].min(0.0) * product(impulse, &candidate.normal);
        product(impulse, &relative_velocity::<S>(candidate, &motion.velocities)) + rebound
    };
    is_within(motion, share) && (motion.exact || motion.impulses.iter().enumerate().map(power).sum::<f64>() <= 0.0)
}

/// From the impulses of the step before.
pub fn from_impulses_before<S: Kinematics>(
    state: &State<S>,
    previous: &PreviousStep<S>,
    step: &StepProblem<'_, S>,
) -> Option<Motion<S>> {
    from_impulses(state, step, &impulses_before(previous, step.contacts), Aim::at_law(state))
}

/// Whether it is exact, or its error is within this share of the speeds; where there are none, that is no error.
fn is_within<S: Kinematics>(motion: &Motion<S>, share: f64) -> bool {
    motion.exact || (motion.residual > 0.0 && motion.residual <= share)
}

/// Solves a step from where pivots ended that did not come to the law. None where what they found is as near, or nothing near the law was
/// found: theirs lets nothing through. They keep what they take over.
pub fn solve_after_pivots<S: Kinematics>(
    state: &State<S>,
    step: &StepProblem<'_, S>,
    pivots: &Motion<S>,
) -> Option<Motion<S>> {
    if state.options.reuse != Reuse::Full {
        return None;
    }
    let nearer = |motion: &Motion<S>| motion.friction_error < pivots.friction_error && is_within(motion, COARSE);
    from_impulses(state, step, &pivots.impulses, Aim::at_law(state)).filter(nearer)
}

/// From impulses in world axes, contact after contact, or from none. None without friction: cones are lines then, and pivots exact.
fn from_impulses<S: Kinematics>(
    state: &State<S>,
    step: &StepProblem<'_, S>,
    impulses: &[S::Vector],
    aim: Aim,
) -> Option<Motion<S>> {
    let candidates = step.contacts.candidates();
    if candidates.iter().all(|candidate| candidate.friction == 0.0) {
        return None;
    }
    let begun = Instant::now();
    let mut place = vec![None; state.inverse_mass.len()];
    let (size, axes) = (components::<S>(), axes::<S>());
    let mut bodies = Bodies { size, ..Bodies::default() };
    for (i, (inverse, free)) in state.inverse_mass.iter().zip(step.free).enumerate() {
        if !is_zero(inverse) {
            place[i] = Some(bodies.len());
            bodies.inverse_mass.extend(inverse.as_ref());
            bodies.free.extend(free.as_ref());
        }
    }
    let frames: Vec<Frame<S>> = candidates.iter().map(|candidate| frame::<S>(&candidate.normal)).collect();
    bodies.contacts =
        (0..candidates.len()).map(|k| contact::<S>(&candidates[k], step.offsets[k], &frames[k], &place)).collect();
    let along = |(frame, impulse): (&Frame<S>, &S::Vector)| {
        let impulse = *impulse;
        frame.map(|axis| product(&impulse, &axis)).into_iter().take(axes)
    };
    let start: Vec<f64> = frames.iter().zip(impulses).flat_map(along).collect();
    let start = Some(start.as_slice()).filter(|start| !start.is_empty());
    let scale = norm(state.scene.gravity().as_ref()) * state.options.dt;
    let tolerance = state.options.coulomb_tolerance;
    let Aim { share, newton_steps, changes } = aim;
    let settings = Settings {
        scale,
        relative_tolerance: share,
        newton_steps,
        changes,
        from_nothing: 1.0 / IN_PLANE,
        tolerance: None,
    };
    let solution = bodies.solve(start, &settings).ok()?;
    let speed = solution.tolerance / share;
    let mut velocities = step.free.to_vec();
    for (velocity, place) in velocities.iter_mut().zip(&place) {
        if let Some(place) = place {
            velocity.as_mut().copy_from_slice(&solution.velocities[size * place..][..size]);
        }
    }
    let sliding = candidates.iter().zip(&frames).map(|(candidate, [_, one, two])| {
        let u = relative_velocity::<S>(candidate, &velocities);
        product(&u, one).hypot(product(&u, two))
    });
    Some(Motion {
        sliding: sliding.collect(),
        impulses: frames
            .iter()
            .zip(solution.impulses.chunks_exact(axes))
            .map(|(frame, p)| sum::<S>(frame, p))
            .collect(),
        velocities,
        friction_error: solution.error,
        exact: solution.error <= tolerance * speed,
        unseen: (AMPLIFIED * solution.error).min(tolerance * speed),
        residual: if speed > 0.0 { solution.error / speed } else { 0.0 },
        solves: 1,
        rows_reused: 0,
        time: begun.elapsed(),
        counts: Counts::default(),
        collisions: 0,
        inconsistent: None,
        unfinished: false,
    })
}

/// What is aimed at: a share of the speeds, in so many Newton steps, and changes of each contact.
struct Aim {
    share: f64,
    newton_steps: usize,
    changes: usize,
}

impl Aim {
    /// At Coulomb's law.
    fn at_law<S: Kinematics>(state: &State<S>) -> Self {
        let tolerance = state.options.coulomb_tolerance;
        let (share, newton_steps) =
            if axes::<S>() == 3 { (tolerance, NEWTON_STEPS) } else { (IN_PLANE * tolerance, STEPS_IN_PLANE) };
        Self { share, newton_steps, changes: CHANGES }
    }
}

/// The impulses of the step before at the contacts that are still there, in world axes; empty if there was none.
fn impulses_before<S: Kinematics>(previous: &PreviousStep<S>, problem: &ContactProblem<S>) -> Vec<S::Vector> {
    let Some(before) = &previous.problem else { return Vec::new() };
    let of = |old: Option<usize>| old.and_then(|old| previous.impulses.get(old)).copied().unwrap_or_default();
    problem.matches(before).map(|(_, old)| of(old)).collect()
}

/// The normal and two tangents, of which the second is zero in the plane.
type Frame<S> = [<S as Shape>::Vector; 3];

fn frame<S: Kinematics>(normal: &S::Vector) -> Frame<S> {
    let vector = |x: [f64; 3]| {
        let mut made = S::Vector::default();
        made.as_mut().iter_mut().zip(x).for_each(|(made, x)| *made = x);
        made
    };
    let tangents = match *normal.as_ref() {
        [x, y, z] => crate::formulate::tangents([x, y, z], [0.0; 3]).map(vector),
        [x, y] => [vector([-y, x, 0.0]), S::Vector::default()],
        _ => [S::Vector::default(); 2],
    };
    [*normal, tangents[0], tangents[1]]
}

fn contact<S: Kinematics>(
    candidate: &CandidateOf<S>,
    offset: f64,
    frame: &Frame<S>,
    place: &[Option<usize>],
) -> Contact {
    let rows = |side: usize| {
        frame.each_ref().map(|axis| {
            let mut row = [0.0; 6];
            row[..components::<S>()]
                .copy_from_slice(wrench::<S>(&candidate.levers[side], axis, [-1.0, 1.0][side]).as_ref());
            row
        })
    };
    Contact {
        bodies: candidate.id.bodies.map(|body| place[body]),
        jacobian: [rows(0), rows(1)],
        friction: candidate.friction,
        offset,
    }
}

/// An impulse in world axes.
fn sum<S: Kinematics>(frame: &Frame<S>, p: &[f64]) -> S::Vector {
    let mut sum = S::Vector::default();
    for (axis, p) in frame.iter().zip(p) {
        sum.as_mut().iter_mut().zip(axis.as_ref()).for_each(|(sum, axis)| *sum += p * axis);
    }
    sum
}
