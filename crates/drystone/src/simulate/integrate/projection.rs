//! Overlaps that are left at the end of a step are taken back in the places alone, not in the velocities, if they are deeper than
//! the contact tolerance. What is within it touches; to lift a block over the seam of a tile that is higher by less would cost a
//! slow one its speed.
//!
//! The step's problem is linear in the turn of the bodies, so a corner on a turning face may end the step within the other
//! block by about (turn in one step)^2 of its arm. The shortest way out, in the metric of the masses, is a complementarity problem
//! of its own:
//!
//! ```text
//! w = N' M^-1 N l + gap,    0 <= l  complementary to  w >= 0,    x <- x + M^-1 N l
//! ```
//!
//! over the normals N of all contacts of bodies that moved; motionless ones are held. What a body gains in height by it is
//! taken from its kinetic energy, so that a step never adds energy.

use crate::{
    contact::{
        candidates::{CandidateFinder, CandidateOf},
        pair_tolerance,
    },
    geometry::product,
    scene::SceneOf,
    simulate::{
        contacts::find,
        formulate::{
            contact_problem::{relative_velocity, wrench},
            free_motion::free_velocities,
        },
        kinematics::{Kinematics, components, is_zero, masses, permanent, split},
        state::State,
    },
};
use drystone_lcp::{Counts, Problem, Settings, Solver, Status, cone::Columns};

/// Times the problem is linearised anew. Each leaves a square of what the last one moved, so two are the rule.
const ROUNDS: usize = 10;

/// Normals of one pair that look the same way: cosine of the angle between them at least.
const ALIKE: f64 = 0.7;

/// Share of its own entry of the matrix by which each contact gives way where bodies are jammed.
const COMPLIANCE: f64 = 1e-3;

/// Pivots for each contact. A limit that is set also ends the solver's doubts: whether bodies are jammed is not worth what a proof of it takes,
/// of which one was seen that took a second and a half.
const PIVOTS: usize = 50;

/// What was taken back.
#[derive(Debug, Default)]
pub struct Projected {
    pub rounds: usize,
    pub counts: Counts,
}

/// Takes overlaps back until none is deeper than the contact tolerance, or nothing helps. Finds the contacts of the next step.
pub fn project<S: Kinematics>(state: &mut State<S>, finder: &mut CandidateFinder<S>) -> Projected {
    let mut projected = Projected::default();
    let mut earlier: Vec<CandidateOf<S>> = Vec::new();
    loop {
        find(finder, state, &free_velocities(state));
        let deep = deep_pairs(state, finder);
        if projected.rounds == ROUNDS || deep.is_empty() {
            return projected;
        }
        let held = |(mass, still): (&S::Velocity, &bool)| if *still { S::Velocity::default() } else { *mass };
        let inverse_mass: Vec<_> = state.inverse_mass.iter().zip(&state.motionless).map(held).collect();
        let free = |candidate: &&CandidateOf<S>| candidate.id.bodies.iter().any(|&i| !is_zero(&inverse_mass[i]));
        let mut candidates: Vec<CandidateOf<S>> = finder.candidates().filter(free).copied().collect();
        add_earlier::<S>(&mut candidates, earlier);
        let Some(change) = way_out::<S>(&candidates, &inverse_mass, &mut projected.counts) else {
            return projected;
        };
        shift(&mut state.scene, &mut state.velocities, &change);
        candidates.retain(|candidate| deep.binary_search(&candidate.id.bodies).is_ok());
        for candidate in &mut candidates {
            candidate.gap += product(&candidate.normal, &relative_velocity::<S>(candidate, &change));
        }
        earlier = candidates;
        projected.rounds += 1;
    }
}

/// Pairs that are deeper in one another than their contact tolerance, unless both are held; in order.
fn deep_pairs<S: Kinematics>(state: &State<S>, finder: &CandidateFinder<S>) -> Vec<[usize; 2]> {
    let bodies = state.scene.bodies();
    let deep = |&([a, b], depth): &([usize; 2], f64)| {
        let held = state.motionless[a] && state.motionless[b];
        !held && depth > pair_tolerance(&state.scene, &bodies[a], &bodies[b])
    };
    finder.overlaps().filter(deep).map(|(pair, _)| pair).collect()
}

/// Adds the contacts of earlier rounds that their pair does not have any more, where they look the same way as those it has. Of solids that cross
/// there is one where they do so most; taken back alone it only makes another deeper, and so on in turns.
fn add_earlier<S: Kinematics>(candidates: &mut Vec<CandidateOf<S>>, earlier: Vec<CandidateOf<S>>) {
    let now = candidates.len();
    for old in earlier {
        let mut own = candidates[..now].iter().filter(|candidate| candidate.id.bodies == old.id.bodies).peekable();
        let looks_alike = |candidate: &CandidateOf<S>| product(&candidate.normal, &old.normal) > ALIKE;
        if own.peek().is_some() && own.all(|candidate| candidate.id != old.id && looks_alike(candidate)) {
            candidates.push(old);
        }
    }
}

/// Moves bodies apart so that no gap of the contacts is negative, to first order. `inverse_mass` is zero for what is
/// held. Where bodies are jammed between others there may be no such motion; each contact then gives way a little, which
/// leaves a share of the overlap. Returns the change of every place.
fn way_out<S: Kinematics>(
    candidates: &[CandidateOf<S>],
    inverse_mass: &[S::Velocity],
    counts: &mut Counts,
) -> Option<Vec<S::Velocity>> {
    part::<S>(candidates, inverse_mass, 0.0, counts).or_else(|| part::<S>(candidates, inverse_mass, COMPLIANCE, counts))
}

fn part<S: Kinematics>(
    candidates: &[CandidateOf<S>],
    inverse_mass: &[S::Velocity],
    compliance: f64,
    counts: &mut Counts,
) -> Option<Vec<S::Velocity>> {
    let size = components::<S>();
    let mut weights: Vec<f64> = inverse_mass.iter().flat_map(|mass| mass.as_ref()).copied().collect();
    let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
    for candidate in candidates {
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            let body = candidate.id.bodies[side];
            if !is_zero(&inverse_mass[body]) {
                indices.extend(size * body..size * (body + 1));
                data.extend(wrench::<S>(&candidate.levers[side], &candidate.normal, sign).as_ref());
            }
        }
        if compliance > 0.0 {
            // A coordinate of the contact's own, as if something soft were in between.
            let own: f64 =
                (indptr[indptr.len() - 1]..data.len()).map(|p| data[p] * data[p] * weights[indices[p]]).sum();
            indices.push(weights.len());
            data.push(1.0);
            weights.push(compliance * own);
        }
        indptr.push(indices.len());
    }
    let gaps = candidates.iter().map(|candidate| candidate.gap).collect();
    let g = Columns::new(weights.len(), &indptr, &indices, &data).ok()?;
    let problem = Problem::from_generators_and_q(&g, &weights, gaps).ok()?;
    let settings = Settings { pivot_limit: Some(PIVOTS * candidates.len()), ..Settings::default() };
    let mut solver = Solver::new(problem, settings).ok()?;
    solver.add_rows(&(0..candidates.len()).collect::<Vec<_>>()).ok()?;
    let status = solver.solve();
    *counts = *counts + solver.counts();
    if status != Ok(Status::Solved) {
        return None;
    }
    let mut change = vec![S::Velocity::default(); inverse_mass.len()];
    for row in 0..candidates.len() {
        for p in (indptr[row]..indptr[row + 1]).filter(|&p| indices[p] < size * inverse_mass.len()) {
            let (body, axis) = (indices[p] / size, indices[p] % size);
            change[body].as_mut()[axis] += inverse_mass[body].as_ref()[axis] * data[p] * solver.z(row);
        }
    }
    Some(change)
}

/// Changes the places, and takes the potential energy gained from the motion of the bodies that were moved.
fn shift<S: Kinematics>(scene: &mut SceneOf<S>, velocities: &mut [S::Velocity], change: &[S::Velocity]) {
    let gravity = scene.gravity();
    let (mut gained, mut kinetic) = (0.0, 0.0);
    let moved: Vec<usize> = (0..change.len()).filter(|&i| !is_zero(&change[i])).collect();
    for &i in &moved {
        let body = &scene.bodies()[i];
        let (along, _) = split::<S>(&change[i]);
        let raised = gravity.as_ref().iter().zip(along).map(|(g, x)| g * x).sum::<f64>();
        gained -= body.mass() * raised;
        if !body.loads().is_empty() {
            gained -= product(&permanent::<S>(body), &change[i]);
        }
        let masses = masses(body);
        kinetic += 0.5 * velocities[i].as_ref().iter().zip(masses.as_ref()).map(|(v, m)| m * v * v).sum::<f64>();
        scene.set_pose(i, S::advanced(body, &change[i], 1.0));
    }
    if gained > 0.0 && kinetic > 0.0 {
        let left = (1.0 - gained / kinetic).max(0.0).sqrt();
        moved.iter().for_each(|&i| velocities[i].as_mut().iter_mut().for_each(|v| *v *= left));
    }
}
