//! Numbers checked where they enter: finite, positive, within their bounds.

use crate::{bounds::Bounds, error::SceneError};
use std::fmt::Display;

/// # Errors
/// [`SceneError::NotFinite`]; `place` names the block and the quantity.
pub(crate) fn finite(place: impl Display, value: f64) -> Result<(), SceneError> {
    if value.is_finite() { Ok(()) } else { Err(SceneError::NotFinite { place: place.to_string(), value }) }
}

/// # Errors
/// [`SceneError::NotPositive`] too.
pub(crate) fn positive(place: impl Display + Copy, value: f64) -> Result<(), SceneError> {
    finite(place, value)?;
    if value > 0.0 { Ok(()) } else { Err(SceneError::NotPositive { place: place.to_string(), value }) }
}

impl Bounds {
    /// # Errors
    /// [`SceneError::NotFinite`], [`SceneError::OutOfBounds`]; `place` names the block and the quantity.
    pub(crate) fn check(self, place: impl Display, value: f64) -> Result<(), SceneError> {
        if self.hold(value) {
            Ok(())
        } else if value.is_finite() {
            Err(SceneError::OutOfBounds { place: place.to_string(), value, bounds: self })
        } else {
            Err(SceneError::NotFinite { place: place.to_string(), value })
        }
    }

    /// The same of what must be above zero.
    ///
    /// # Errors
    /// [`SceneError::NotPositive`] too.
    pub(crate) fn check_positive(self, place: impl Display, value: f64) -> Result<(), SceneError> {
        if value <= 0.0 {
            return Err(SceneError::NotPositive { place: place.to_string(), value });
        }
        self.check(place, value)
    }
}
