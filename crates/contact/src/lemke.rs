//! Lemke's way to the answer, from nothing: contacts close one after the other; in the plane.
//!
//! All contacts are so far open at first that nothing bears: to the velocity u at each a speed r is added along its normal, of which `(1 - t) r` is left at t,
//!
//! ```text
//! p and  u + (1 - t) r n  obey the law,    t from 0 to 1
//! ```
//!
//! A way (`way.rs`) that comes from where only p = 0 obeys the law, as all `u_n + r > mu |u_t|`, and whose problems all have answers, for nothing overlaps, has no
//! other end than t = 1: it comes from where there is one way only, and contacts that give way bound the impulses. Lemke showed this for matrices that are copositive, as
//! those of contacts are; Anitescu and Potra, Formulating dynamic multi-rigid-body contact problems with friction as solvable linear complementarity
//! problems, 1997. So it arrives where ways that begin at an error are loops, but it takes one to ten changes a contact.

use crate::{
    best::{Best, Goal},
    newton::Newton,
    path,
    place::Place,
    system::System,
    way::Way,
};

/// eps, and that after a way that did not arrive, by rounding. With 1e-4 half as many changes are made, but what then is left of the error
/// is on a loop as often as it was at first.
const HARDNESS: [f64; 2] = [1e-6, 1e-4];
/// Contacts close one after the other: raised by so much more each, as a share, and moved so far along their tangents.
const APART: f64 = 0.1;
const ASIDE: f64 = 0.01;
/// Newton steps for what is left of the error, for each that is allowed: it is close, but hard.
const STEPS: usize = 5;

/// Solves from nothing, in so many changes a contact, then takes away what is left of the error. Keeps what is better. Returns the matrices that were factored or
/// updated.
pub(crate) fn solve<const B: usize, const D: usize>(
    system: &System<B, D>,
    newton: &mut Newton<B, D>,
    best: &mut Best<B, D>,
    (goal, newton_steps, changes): (Goal, usize, usize),
) -> usize {
    let mut steps = 0;
    for eps in HARDNESS {
        let mut state = system.state();
        let way = Way::new(system, newton, raised(system, eps), eps);
        if way.follow(&mut state, changes * system.len(), &mut steps) {
            best.keep(system, &state);
            return steps + path::solve(system, newton, &state, best, (goal, eps, STEPS * newton_steps));
        }
    }
    steps
}

/// All contacts where nothing bears.
fn raised<const B: usize, const D: usize>(system: &System<B, D>, eps: f64) -> Vec<Place<D>> {
    let free: Vec<[f64; D]> = (0..system.len()).map(|k| system.relative(k, &system.free)).collect();
    let open = |(k, u): (usize, &[f64; D])| system.contacts[k].friction * u[1].abs() - u[0];
    let height = free.iter().enumerate().map(open).fold(0.0, f64::max);
    let place = |(k, u): (usize, &[f64; D])| {
        let mut raised = [0.0; D];
        raised[0] = height * (1.0 + APART * spread(k, std::f64::consts::SQRT_2));
        raised[1] = height * ASIDE * (spread(k, std::f64::consts::PI) - 0.5);
        Place::raised(system.contacts[k].friction, u, &raised, eps)
    };
    free.iter().enumerate().map(place).collect()
}

/// Between 0 and 1, different for every k: multiples of an irrational number without their whole parts are spread evenly.
fn spread(k: usize, irrational: f64) -> f64 {
    (k as f64 * irrational).fract()
}
