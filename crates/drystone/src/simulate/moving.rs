//! Shapes whose motion can be simulated, each with its laws.

use super::{
    kinematics::Kinematics,
    laws::{AccelerationLevel, Law, VelocityLevel},
    options::Formulation,
};
use crate::geometry::{Polygon, Solid};

/// Shapes whose motion can be simulated.
pub trait Moving: Kinematics {
    /// The law of motion of a formulation, if there is one for such shapes.
    fn law(formulation: Formulation) -> Option<&'static dyn Law<Self>>;
}

impl Moving for Polygon {
    fn law(formulation: Formulation) -> Option<&'static dyn Law<Self>> {
        Some(match formulation {
            Formulation::Velocity => &VelocityLevel,
            Formulation::Acceleration => &AccelerationLevel,
        })
    }
}

impl Moving for Solid {
    fn law(formulation: Formulation) -> Option<&'static dyn Law<Self>> {
        match formulation {
            Formulation::Velocity => Some(&VelocityLevel),
            Formulation::Acceleration => None,
        }
    }
}
