//! Forces and accelerations, after impulses where bodies collide: docs/theory/acceleration-level.md.

mod collisions;
mod law;
mod law_error;
mod lemke;

pub use law::AccelerationLevel;
