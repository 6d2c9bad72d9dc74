//! What may be done to bodies between two steps: velocities, forces and impulses.

use super::{
    error::SimulationError, formulate::contact_problem::wrench, kinematics::split, moving::Moving, world::World,
};
use crate::{
    bounds::{Bounds, COORDINATE, PUSH, VELOCITY},
    geometry::minus_of,
};

impl<S: Moving> World<S> {
    /// Sets a block's velocity in world axes: m/s, then rad/s.
    ///
    /// # Errors
    /// [`SimulationError::Fixed`], [`SimulationError::NotFinite`], [`SimulationError::OutOfBounds`],
    /// [`SceneError::UnknownName`](crate::SceneError::UnknownName).
    pub fn set_velocity(&mut self, name: &str, velocity: S::Velocity) -> Result<(), SimulationError> {
        let i = self.movable(name, "velocity", velocity.as_ref(), VELOCITY)?;
        self.state.velocities[i] = S::to_own_axes(&self.state.scene.bodies()[i], &velocity);
        Ok(())
    }

    /// Pushes a block during the next step with a force (N) at a point (world coordinates, metres; the centre of mass without
    /// one) and a moment: `wrench` has both, in world axes, as velocities have. Pushes add up, and end with the step.
    ///
    /// # Errors
    /// As [`Self::set_velocity`].
    pub fn apply_force(
        &mut self,
        name: &str,
        wrench: S::Velocity,
        at: Option<S::Vector>,
    ) -> Result<(), SimulationError> {
        let (i, wrench) = self.about_center(name, "force", wrench, at)?;
        self.state.forces[i].as_mut().iter_mut().zip(wrench.as_ref()).for_each(|(sum, f)| *sum += f);
        Ok(())
    }

    /// Changes a block's velocity at once by an impulse (N s) at a point and an impulsive moment (N m s); see
    /// [`Self::apply_force`].
    ///
    /// # Errors
    /// As [`Self::set_velocity`].
    pub fn apply_impulse(
        &mut self,
        name: &str,
        wrench: S::Velocity,
        at: Option<S::Vector>,
    ) -> Result<(), SimulationError> {
        let (i, wrench) = self.about_center(name, "impulse", wrench, at)?;
        let change = self.state.inverse_mass[i].as_ref().iter().zip(wrench.as_ref());
        self.state.velocities[i].as_mut().iter_mut().zip(change).for_each(|(v, (inverse, p))| *v += inverse * p);
        Ok(())
    }

    /// A wrench at a point as one at the centre of mass, its moment about the body's own axes.
    fn about_center(
        &self,
        name: &str,
        quantity: &'static str,
        wrench_there: S::Velocity,
        at: Option<S::Vector>,
    ) -> Result<(usize, S::Velocity), SimulationError> {
        let i = self.movable(name, quantity, wrench_there.as_ref(), PUSH)?;
        let body = &self.state.scene.bodies()[i];
        let mut total = S::to_own_axes(body, &wrench_there);
        if let Some(at) = at {
            self.movable(name, "at", at.as_ref(), COORDINATE)?;
            let mut force = S::Vector::default();
            force.as_mut().copy_from_slice(split::<S>(&wrench_there).0);
            let levers = S::levers(&S::outline(body), minus_of(minus_of(at, &self.origin), &S::place(&body.pose)));
            let moment = wrench::<S>(&levers, &force, 1.0);
            let axes = force.as_ref().len();
            total.as_mut()[axes..].iter_mut().zip(&moment.as_ref()[axes..]).for_each(|(sum, m)| *sum += m);
        }
        Ok((i, total))
    }

    fn movable(
        &self,
        name: &str,
        quantity: &'static str,
        values: &[f64],
        bounds: Bounds,
    ) -> Result<usize, SimulationError> {
        let i = self.state.scene.index_of(name)?;
        let body = || name.to_owned();
        if self.state.scene.bodies()[i].fixed {
            return Err(SimulationError::Fixed { body: body(), quantity });
        }
        match values.iter().find(|&&value| !bounds.hold(value)) {
            Some(&value) if value.is_finite() => {
                Err(SimulationError::OutOfBounds { body: body(), quantity, value, bounds })
            }
            Some(&value) => Err(SimulationError::NotFinite { body: body(), quantity, value }),
            None => Ok(i),
        }
    }
}
