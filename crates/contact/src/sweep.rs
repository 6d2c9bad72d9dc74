//! Block Gauss-Seidel: every contact in turn gets the impulse that its law asks for while the others keep theirs.
//!
//! Jourdan, Alart and Jean, A Gauss-Seidel like algorithm to solve frictional contact problems, 1998 (NSGS).

use crate::system::{State, System};

/// One sweep, forward or backward. Returns the largest change of an impulse, as the speed that it gives at its own contact, m/s.
pub(crate) fn sweep<const B: usize, const D: usize>(
    system: &System<B, D>,
    state: &mut State<B, D>,
    backward: bool,
) -> f64 {
    let count = system.len();
    let mut largest = 0.0_f64;
    for step in 0..count {
        let k = if backward { count - 1 - step } else { step };
        let local = &system.contacts[k];
        let u = system.relative(k, &state.y);
        let own = local.times(&state.p[k]);
        let mut q = u;
        for i in 0..D {
            q[i] -= own[i];
        }
        let p = local.solve(&q, &mut state.alpha[k]);
        let mut change = p;
        let mut size = 0.0_f64;
        for i in 0..D {
            change[i] -= state.p[k][i];
            size = size.max(change[i].abs());
        }
        if size > 0.0 {
            system.give(k, &change, &mut state.y);
            state.p[k] = p;
            largest = largest.max(size * local.normal[0]);
        }
    }
    largest
}
