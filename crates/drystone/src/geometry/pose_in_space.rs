//! A rigid placement in space.

use super::Vector3;

/// Where a body's frame stands in the world: a point x of the body is at `position + R(orientation) x`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseInSpace {
    /// World position of the frame's origin, metres.
    pub position: [f64; 3],
    /// Unit quaternion (w, x, y, z).
    pub orientation: [f64; 4],
}

impl PoseInSpace {
    /// The world's own frame.
    pub const WORLD: Self = Self { position: [0.0; 3], orientation: [1.0, 0.0, 0.0, 0.0] };

    /// The columns of `R`: the frame's axes in the world.
    pub fn axes(&self) -> [Vector3; 3] {
        let [w, x, y, z] = self.orientation;
        [
            Vector3::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
            Vector3::new(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
            Vector3::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
        ]
    }

    /// The turned vector `R x`, without the shift.
    pub fn rotate(&self, v: Vector3) -> Vector3 {
        let [x, y, z] = self.axes();
        v.x * x + v.y * y + v.z * z
    }

    /// World position of the body's point `x`.
    pub fn transform(&self, v: Vector3) -> Vector3 {
        Vector3::from_array(self.position) + self.rotate(v)
    }

    /// The frame after a turn about an axis of its own: along `turn`, by its length in radians.
    pub fn turned(&self, turn: Vector3) -> Self {
        let angle = turn.length();
        if angle == 0.0 {
            return *self;
        }
        let (sin, cos) = (0.5 * angle).sin_cos();
        let v = turn * (sin / angle);
        let ([w, x, y, z], [b, c, d]) = (self.orientation, v.to_array());
        let product = [
            w * cos - x * b - y * c - z * d,
            w * b + x * cos + y * d - z * c,
            w * c - x * d + y * cos + z * b,
            w * d + x * c - y * b + z * cos,
        ];
        let length = product.iter().map(|q| q * q).sum::<f64>().sqrt();
        Self { orientation: product.map(|q| q / length), ..*self }
    }
}
