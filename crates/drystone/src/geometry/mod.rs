//! Shapes and where they stand. No physics beyond area and its moments, no names of blocks.

mod polygon;
mod pose;
mod shape;

pub use parry2d_f64::math::Vector;
pub use polygon::{Polygon, ShapeFault};
pub use pose::Pose;
pub use shape::Shape;
