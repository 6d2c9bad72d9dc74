//! What the bodies would do without contacts.

use crate::simulate::{
    kinematics::{Kinematics, add, is_zero, masses, permanent, split, split_mut},
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

/// What the bodies gain of kinetic energy, and of the potential energy of gravity and of their loads, in a step that ends with these
/// velocities, J; and what of that rounding is.
pub fn energy_gained<S: Kinematics>(state: &State<S>, velocities: &[S::Velocity]) -> [f64; 2] {
    let [mut gained, mut rounding] = kinetic_energy_gained(state, velocities);
    for (i, velocity) in velocities.iter().enumerate().filter(|(i, _)| !is_zero(&state.inverse_mass[*i])) {
        let fall = product_of(split::<S>(velocity).0, state.scene.gravity().as_ref());
        let pushed = product_of(velocity.as_ref(), wrench_on(state, i).as_ref());
        let work = state.options.dt * (state.scene.bodies()[i].mass() * fall + pushed);
        gained -= work;
        rounding += ROUNDING * work.abs();
    }
    [gained, rounding]
}

/// The same of kinetic energy alone.
pub fn kinetic_energy_gained<S: Kinematics>(state: &State<S>, velocities: &[S::Velocity]) -> [f64; 2] {
    let (mut gained, mut all) = (0.0, 0.0);
    for (i, velocity) in velocities.iter().enumerate().filter(|(i, _)| !is_zero(&state.inverse_mass[*i])) {
        let masses = masses(&state.scene.bodies()[i]);
        let of = |velocity: &S::Velocity| {
            velocity.as_ref().iter().zip(masses.as_ref()).map(|(v, m)| 0.5 * m * v * v).sum::<f64>()
        };
        let [before, after] = [of(&state.velocities[i]), of(velocity)];
        gained += after - before;
        all += before + after;
    }
    [gained, ROUNDING * all]
}

/// Share of the energies that may be rounding of their sums.
const ROUNDING: f64 = 1e-14;

fn product_of(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
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
