//! What is solved: rigid bodies, and contact points between two of them.

use crate::error::ContactError;

/// One step's contact problem of rigid bodies whose mass matrix is diagonal (their turning about principal axes).
#[derive(Debug, Clone, Default)]
pub struct Bodies {
    /// Unknowns of one body: 3 in the plane, 6 in space.
    pub size: usize,
    /// Diagonal of `M^-1`, body after body: 1/kg, 1/(kg m^2).
    pub inverse_mass: Vec<f64>,
    /// `v*`, the velocities without contacts, body after body: m/s, rad/s.
    pub free: Vec<f64>,
    /// Where bodies touch or may touch.
    pub contacts: Vec<Contact>,
}

/// A contact point between two bodies, of which one may be fixed.
#[derive(Debug, Clone)]
pub struct Contact {
    /// The bodies that move of the two.
    pub bodies: [Option<usize>; 2],
    /// For each of the two, rows of as many entries as a body has unknowns, along the normal first and then along one (in the
    /// plane) or two tangents square to it: the relative velocity along them is the sum of the rows times the bodies' velocities. 1 and m.
    pub jacobian: [[[f64; 6]; 3]; 2],
    /// mu, not negative; what is above [`MOST_FRICTION`](crate::MOST_FRICTION) counts as that.
    pub friction: f64,
    /// c: how fast the contact may close, m/s; gap / dt, or negative where it has to part.
    pub offset: f64,
}

impl Bodies {
    /// Components of a contact's impulse: 2 or 3.
    pub fn dimension(&self) -> usize {
        if self.size == 3 { 2 } else { 3 }
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.inverse_mass.len() / self.size.max(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(crate) fn check(&self) -> Result<(), ContactError> {
        if self.size != 3 && self.size != 6 {
            return Err(ContactError::Size { size: self.size });
        }
        if !self.inverse_mass.len().is_multiple_of(self.size) || self.inverse_mass.len() != self.free.len() {
            return Err(ContactError::Length {
                what: "free",
                found: self.free.len(),
                expected: self.inverse_mass.len(),
            });
        }
        if let Some(place) = self.inverse_mass.iter().position(|x| !(*x > 0.0 && x.is_finite())) {
            return Err(ContactError::Mass { place });
        }
        all_finite("free", &self.free)?;
        for (k, contact) in self.contacts.iter().enumerate() {
            check_law(k, contact.friction, contact.offset)?;
            for (side, body) in contact.bodies.iter().enumerate() {
                let Some(body) = *body else { continue };
                if body >= self.len() {
                    return Err(ContactError::Body { contact: k, body, bodies: self.len() });
                }
                if !contact.jacobian[side].iter().flatten().all(|x| x.is_finite()) {
                    return Err(ContactError::NotFinite { what: "jacobian of contact", place: k });
                }
            }
        }
        Ok(())
    }
}

pub(crate) fn all_finite(what: &'static str, values: &[f64]) -> Result<(), ContactError> {
    values.iter().position(|x| !x.is_finite()).map_or(Ok(()), |place| Err(ContactError::NotFinite { what, place }))
}

pub(crate) fn check_law(contact: usize, friction: f64, offset: f64) -> Result<(), ContactError> {
    if !(friction >= 0.0 && friction.is_finite()) {
        return Err(ContactError::Friction { contact, friction });
    }
    if !offset.is_finite() {
        return Err(ContactError::NotFinite { what: "offset", place: contact });
    }
    Ok(())
}
