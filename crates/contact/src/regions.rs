//! Where the error is, alone: Lemke's way for the contacts near the largest errors, while all others keep their impulses; in the plane.
//!
//! A few contacts of a heap are hard, and Lemke's way through all takes a change for each. A region takes a few hundred, and where it then is in error is elsewhere: from there
//! the way (`path.rs`) arrives that was a loop before.

use crate::{
    best::{Best, Goal},
    lemke,
    newton::Newton,
    path,
    system::{State, System},
};

/// Regions in turns, each a contact wider than the one before: so many contacts round the errors at first.
const TURNS: usize = 4;
const WIDTH: usize = 3;
/// Errors of at least this share of the largest are what a region is made round.
const LARGE: f64 = 0.3;
/// A region of more than this share of the bodies is no smaller problem.
const MOST: f64 = 0.5;
/// Newton steps on the way after each.
const STEPS: usize = 100;

/// Solves regions, and goes on from there. Keeps what is better. Returns the matrices that were factored or updated.
pub(crate) fn solve<const B: usize, const D: usize>(
    system: &System<B, D>,
    newton: &mut Newton<B, D>,
    best: &mut Best<B, D>,
    (goal, changes): (Goal, usize),
) -> usize {
    let mut steps = 0;
    for turn in 0..TURNS {
        let Some(region) = Region::new(system, best, goal, WIDTH + turn) else { break };
        let Some(state) = region.solve(system, best, (goal, changes), &mut steps) else { break };
        steps += path::solve(system, newton, &state, best, (goal, path::FIRST, STEPS));
        if best.error <= goal.tolerance {
            break;
        }
    }
    steps
}

/// Some chunks, and the contacts that touch no other.
struct Region {
    chunks: Vec<usize>,
    contacts: Vec<usize>,
}

impl Region {
    /// Within so many contacts of the large errors. None if that is most of the whole.
    fn new<const B: usize, const D: usize>(
        system: &System<B, D>,
        best: &Best<B, D>,
        goal: Goal,
        width: usize,
    ) -> Option<Self> {
        let least = goal.tolerance.max(LARGE * best.error);
        let mut within = vec![false; system.free.len()];
        let touched = |k: usize| system.sides(k).map(|side| system.chunks[side] as usize);
        for k in (0..system.len()).filter(|&k| system.error_at(k, &best.state) > least) {
            touched(k).for_each(|chunk| within[chunk] = true);
        }
        for _ in 0..width {
            let before = within.clone();
            for k in (0..system.len()).filter(|&k| touched(k).any(|chunk| before[chunk])) {
                touched(k).for_each(|chunk| within[chunk] = true);
            }
        }
        let chunks: Vec<usize> = (0..within.len()).filter(|&chunk| within[chunk]).collect();
        if chunks.len() as f64 > MOST * within.len() as f64 {
            return None;
        }
        let contacts = (0..system.len()).filter(|&k| touched(k).all(|chunk| within[chunk])).collect();
        Some(Self { chunks, contacts })
    }

    /// The best state with this region solved from nothing, while what is outside keeps its impulses. None if there is not enough memory.
    fn solve<const B: usize, const D: usize>(
        &self,
        system: &System<B, D>,
        best: &Best<B, D>,
        (goal, changes): (Goal, usize),
        steps: &mut usize,
    ) -> Option<State<B, D>> {
        let mut state = best.state.clone();
        let mut place = vec![0; system.free.len()];
        self.chunks.iter().enumerate().for_each(|(at, &chunk)| place[chunk] = at as u32);
        let mut part = system.part(&self.contacts, &self.chunks, &place);
        // Without the impulses within.
        for &k in &self.contacts {
            system.give(k, &state.p[k].map(|p| -p), &mut state.y);
        }
        part.free = self.chunks.iter().map(|&chunk| state.y[chunk]).collect();
        let mut found = Best::new(&part, &part.state());
        *steps += lemke::solve(&part, &mut Newton::new(&part)?, &mut found, (goal, STEPS, changes));
        self.contacts.iter().zip(&found.state.p).for_each(|(&k, p)| state.p[k] = *p);
        system.move_by(&mut state);
        Some(state)
    }
}
