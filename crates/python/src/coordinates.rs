//! Points and vectors as tuples.

use pyo3::prelude::*;

/// A moment or a turn: one number in the plane, about z; three in space.
pub fn about_axes(value: [f64; 3], in_plane: bool) -> Vec<f64> {
    if in_plane { vec![value[2]] } else { value.to_vec() }
}

/// Two numbers in the plane, three in space.
#[derive(Clone, Copy, IntoPyObject)]
pub enum Coordinates {
    Plane((f64, f64)),
    Space((f64, f64, f64)),
}

impl Coordinates {
    /// Without z in the plane.
    pub fn of([x, y, z]: [f64; 3], in_plane: bool) -> Self {
        if in_plane { Self::Plane((x, y)) } else { Self::Space((x, y, z)) }
    }
}

impl From<[f64; 2]> for Coordinates {
    fn from([x, y]: [f64; 2]) -> Self {
        Self::Plane((x, y))
    }
}

impl From<[f64; 3]> for Coordinates {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self::Space((x, y, z))
    }
}
