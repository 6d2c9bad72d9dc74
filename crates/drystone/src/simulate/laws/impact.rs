//! Restitution that never gives energy.
//!
//! Newton's law of impact says of every contact that collides `u_n+ = -e u_n-`. Where several do so at once with friction, or one of a
//! body that turns, that may take more energy than the impact has (Kane's pendulum): friction's impulse may work with the motion. So
//! the energy is computed, and where it grew the coefficient of this step is lowered until no more comes back than Stronge's law
//! allows, the share e^2 of what the same impact takes without restitution. So it is where there is no solution: what is jammed between
//! others cannot part from all of them. With e = 0 no energy comes from any impact
//! (docs/theory/velocity-level.md), so there is such a coefficient.
//!
//! W. Stronge, "Rigid body collisions with friction", 1990, and "Impact Mechanics", 2000; T. Kane and D. Levinson, "Dynamics: Theory and
//! Applications", 1985 (the pendulum); C. Glocker, "Energetic consistency conditions for standard impacts", 2013 and 2014.

use crate::simulate::{
    error::StepFailure,
    formulate::{contact_problem::ContactProblem, restitution::Offsets},
    kinematics::Kinematics,
    solve::{Effort, Motion, PreviousStep, StepProblem, solve},
    state::State,
};

/// The coefficient is looked for in so many solves at most. Three or four are the rule.
const TRIES: usize = 10;
/// The least share of the coefficient that is tried, before none, where contacts cannot all part as fast as they have to.
const JAMMED: f64 = 0.1;
/// It is known where the energy is within this share, of what an impact without restitution takes, of what is allowed.
const KNOWN: f64 = 1e-6;

/// Solves a step whose contacts may rebound. `free` are the velocities without contacts; `gained` says how much energy the bodies have
/// gained (J) when these are their velocities at the end, and how much of that is rounding.
///
/// # Errors
/// [`StepFailure::Unsolved`].
pub fn solve_with_rebounds<S: Kinematics>(
    state: &State<S>,
    previous: &mut PreviousStep<S>,
    contacts: &ContactProblem<S>,
    (free, offsets, effort): (&[S::Velocity], &Offsets, Effort),
    gained: impl Fn(&[S::Velocity]) -> [f64; 2],
) -> Result<Motion<S>, StepFailure> {
    let restitution = state.options.restitution;
    // The energy is that of the end.
    let effort = if offsets.rebound() { Effort::Full } else { effort };
    let solved = |previous: &mut PreviousStep<S>, restitution: f64| {
        let offsets = offsets.with(restitution);
        solve(state, previous, &StepProblem { contacts, free, offsets: &offsets, effort })
    };
    // What is jammed cannot part everywhere: then with less.
    let mut most_tried = restitution;
    let newton = loop {
        match solved(previous, most_tried) {
            Err(_) if offsets.rebound() && most_tried > 0.0 => {
                most_tried = if most_tried > JAMMED * restitution { 0.5 * most_tried } else { 0.0 };
            }
            made => break made?,
        }
    };
    if !offsets.rebound() {
        return Ok(newton);
    }
    let [gain, rounding] = gained(&newton.velocities);
    if gain <= rounding || most_tried == 0.0 {
        return Ok(newton);
    }
    let mut again = |last: &Motion<S>, restitution: f64| {
        previous.take(contacts, last);
        let mut motion = solved(previous, restitution)?;
        motion.add_earlier(last);
        Ok(motion)
    };
    let mut best = again(&newton, 0.0)?;
    let [taken, _] = gained(&best.velocities);
    let most = (1.0 - restitution * restitution) * taken.min(0.0);
    // Regula falsi (Illinois): while the contacts that bear stay the same the gain is a square in e.
    let [mut less, mut more] = [(0.0, taken - most), (most_tried, gain - most)];
    for _ in 0..TRIES {
        let middle = less.0 - less.1 * (more.0 - less.0) / (more.1 - less.1);
        let motion: Motion<S> = match again(&best, middle) {
            Err(StepFailure::Unsolved { .. }) => break,
            made => made?,
        };
        let beyond = gained(&motion.velocities)[0] - most;
        if beyond > 0.0 {
            (more, less.1) = ((middle, beyond), 0.5 * less.1);
            best.count(&motion);
            continue;
        }
        (less, more.1) = ((middle, beyond), 0.5 * more.1);
        best = motion;
        if beyond >= KNOWN * taken {
            break;
        }
    }
    Ok(best)
}
