//! What the bodies would do without contacts.

use crate::simulate::{
    kinematics::{Kinematics, add, is_zero, permanent, split_mut},
    state::State,
};

/// `v* = v + h M^-1 F`: what the velocities would be without contacts.
pub fn free_velocities<S: Kinematics>(state: &State<S>) -> Vec<S::Velocity> {
    free_from(state, &state.velocities)
}

/// The same from other velocities.
pub fn free_from<S: Kinematics>(state: &State<S>, velocities: &[S::Velocity]) -> Vec<S::Velocity> {
    let (gravity, dt) = (state.scene.gravity(), state.options.dt);
    let free = |i: usize| {
        let (inverse, force) = (&state.inverse_mass[i], wrench_on(state, i));
        if is_zero(inverse) {
            return velocities[i];
        }
        let mut free = S::undisturbed(&state.scene.bodies()[i], &velocities[i], dt);
        let pushed = inverse.as_ref().iter().zip(force.as_ref()).map(|(inverse, f)| inverse * f);
        let mut fall = S::Velocity::default();
        split_mut::<S>(&mut fall).0.copy_from_slice(gravity.as_ref());
        let gains = fall.as_ref().iter().zip(pushed);
        free.as_mut().iter_mut().zip(gains).for_each(|(v, (fall, pushed))| *v += dt * (fall + pushed));
        free
    };
    (0..velocities.len()).map(free).collect()
}

/// Pushes of the step and permanent loads on a body, about its own axes.
fn wrench_on<S: Kinematics>(state: &State<S>, i: usize) -> S::Velocity {
    let body = &state.scene.bodies()[i];
    let mut total = state.forces[i];
    if !body.loads().is_empty() {
        add(&mut total, &permanent::<S>(body));
    }
    total
}
