//! Shapes and where they stand. No physics beyond measure and moments, no names of blocks.

mod closed;
mod crossing;
mod distance;
mod hull;
mod polygon;
mod polyhedron;
mod pose;
mod pose_in_space;
mod principal;
mod shape;
mod solid;
mod solid_fault;
mod surface;
mod sweep;
mod vectors;

pub use closed::SurfaceEdge;
pub(crate) use distance::distance;
pub(crate) use hull::convex_outline;
pub use parry2d_f64::math::Vector;
pub use parry3d_f64::math::Vector as Vector3;
pub use polygon::{Polygon, ShapeFault};
pub use polyhedron::{Edge, Polyhedron};
pub use pose::Pose;
pub use pose_in_space::PoseInSpace;
pub(crate) use principal::{OWN_AXES, principal};
pub use shape::{Face, Shape};
pub use solid::Solid;
pub use solid_fault::{MOST_POINTS, SolidFault};
pub use surface::Surface;
pub use sweep::{Piece, Sweeping};
pub use vectors::Numbers;
pub(crate) use vectors::{cross, dot, length, minus, minus_of, norm, plus_times, product, unit};
