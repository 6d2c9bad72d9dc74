//! A moment or a turn in a scene file: a number in the plane, in space three about the axes of the world.

use super::{fields::Fields, shapes::Stored};
use crate::error::FileError;
use serde::Serialize;

/// As it is written.
#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum Turning {
    /// Counter-clockwise.
    Plane(f64),
    /// About x, y and z.
    Space([f64; 3]),
}

impl Turning {
    /// What is written of it; nothing of none.
    pub fn of(value: [f64; 3], dimension: usize) -> Option<Self> {
        match dimension {
            _ if value == [0.0; 3] => None,
            2 => Some(Self::Plane(value[2])),
            _ => Some(Self::Space(value)),
        }
    }
}

/// What a field says of it: three numbers, of which the plane uses the last; zeros if it is not there.
pub(super) fn turning<S: Stored>(fields: &Fields, field: &str) -> Result<[f64; 3], FileError> {
    match S::DIMENSION {
        2 => Ok([0.0, 0.0, fields.number(field)?.unwrap_or_default()]),
        _ => Ok(fields.numbers(field)?.unwrap_or_default()),
    }
}
