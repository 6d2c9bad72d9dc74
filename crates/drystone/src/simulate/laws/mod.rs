//! The laws of motion that a step can be made by, behind one trait.

mod acceleration;
mod impact;
mod law;
mod velocity;

pub use acceleration::AccelerationLevel;
pub use law::Law;
pub use velocity::VelocityLevel;
