//! A rigid placement in the plane.

use super::Vector;

/// Where a body's frame stands in the world: a point x of the body is at `position + R(angle) x`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// World position of the frame's origin, metres.
    pub position: [f64; 2],
    /// Counter-clockwise turn, radians.
    pub angle: f64,
}

impl Pose {
    /// The turned vector `R(angle) x`, without the shift.
    pub fn rotate(&self, x: Vector) -> Vector {
        self.turn()(x)
    }

    /// [`Self::rotate`] for many vectors.
    pub fn turn(&self) -> impl Fn(Vector) -> Vector + use<> {
        let (sin, cos) = self.angle.sin_cos();
        move |x| Vector::new(cos * x.x - sin * x.y, sin * x.x + cos * x.y)
    }

    /// World position of the body's point `x`.
    pub fn transform(&self, x: Vector) -> Vector {
        Vector::from_array(self.position) + self.rotate(x)
    }
}
