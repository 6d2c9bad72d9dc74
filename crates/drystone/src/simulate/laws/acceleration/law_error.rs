//! How far a motion is from Coulomb's law, computed from the motion alone, whatever it was found by.

use crate::{
    contact::candidates::CandidateContact,
    geometry::Polygon,
    simulate::formulate::contact_problem::{ContactProblem, Velocity, in_frame, normal_and_tangential, wrench},
};

/// Largest error over the contacts, m/s. `impulses`: in world axes, N s; `offsets`: how
/// fast each may close, m/s. An impulse counts with the speed that it gives at its own contact.
pub fn largest(
    contacts: &ContactProblem,
    velocities: &[Velocity],
    impulses: &[[f64; 2]],
    offsets: &[f64],
    inverse_mass: &[[f64; 3]],
) -> f64 {
    let of = |(k, candidate): (usize, &CandidateContact)| {
        let motion = normal_and_tangential(candidate, velocities);
        let [nx, ny] = candidate.normal;
        let given = [[nx, ny], [-ny, nx]].map(|direction| yielding(candidate, direction, inverse_mass));
        at_contact(candidate.friction, motion, in_frame(candidate, impulses[k]), offsets[k], given)
    };
    contacts.candidates().iter().enumerate().map(of).fold(0.0, f64::max)
}

/// The natural residual of: `0 <= p_n` complementary to `u_n + c >= 0`; `|p_t| <= mu p_n`; and either the contact does not
/// slide, or `p_t = -mu p_n sign(u_t)`.
fn at_contact(friction: f64, [u_n, u_t]: [f64; 2], [p_n, p_t]: [f64; 2], offset: f64, [a_n, a_t]: [f64; 2]) -> f64 {
    let normal = (a_n * p_n).min(u_n + offset).abs();
    let limit = friction * p_n;
    let outside = a_t * (p_t.abs() - limit).max(0.0);
    let sliding = u_t.abs().min(a_t * (p_t + limit * u_t.signum()).abs());
    normal.max(outside).max(sliding)
}

/// Relative speed along a direction that a unit impulse along it gives: `d' J M^-1 J' d`, 1/kg.
fn yielding(candidate: &CandidateContact, direction: [f64; 2], inverse_mass: &[[f64; 3]]) -> f64 {
    let of = |side: usize| {
        let wrench = wrench::<Polygon>(&candidate.levers[side], &direction, 1.0);
        let mass = inverse_mass[candidate.id.bodies[side]];
        (0..3).map(|axis| mass[axis] * wrench[axis] * wrench[axis]).sum::<f64>()
    };
    of(0) + of(1)
}

#[cfg(test)]
mod tests {
    use super::at_contact;

    #[test]
    fn each_condition_is_noticed() {
        let unit = [1.0, 1.0];
        for kept in [
            ([0.0, 0.0], [2.0, 0.9]),  // sticks within the cone
            ([0.0, 3.0], [2.0, -1.0]), // slides, friction on the opposing edge
            ([0.5, -3.0], [0.0, 0.0]), // parts
        ] {
            assert_eq!(at_contact(0.5, kept.0, kept.1, 0.0, unit), 0.0, "{kept:?}");
        }
        for broken in [
            ([-0.1, 0.0], [0.0, 0.0]), // sinks in
            ([0.1, 0.0], [0.1, 0.0]),  // pushes while it parts
            ([0.0, 0.0], [2.0, 1.1]),  // outside the cone
            ([0.0, 0.1], [2.0, 1.0]),  // friction helps the sliding
            ([0.0, 0.1], [2.0, -0.9]), // slides within the cone
            ([0.0, 0.0], [-0.1, 0.0]), // pulls
        ] {
            let found = at_contact(0.5, broken.0, broken.1, 0.0, unit);
            assert!(found >= 0.1 - 1e-12, "{broken:?}: {found}");
        }
    }
}
