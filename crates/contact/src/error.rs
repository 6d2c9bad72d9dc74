//! Bad input.

use thiserror::Error;

/// Why a contact problem is none.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ContactError {
    /// Bodies have 3 unknowns in the plane, 6 in space.
    #[error("a body has {size} unknowns: give 3 in the plane or 6 in space")]
    Size {
        /// As given.
        size: usize,
    },
    /// Contacts have 2 components in the plane, 3 in space.
    #[error("a contact has {dimension} components: give 2 in the plane or 3 in space")]
    Dimension {
        /// As given.
        dimension: usize,
    },
    /// A list of the wrong length.
    #[error("{what} has {found} entries, but {expected} are needed")]
    Length {
        /// Which list.
        what: &'static str,
        /// Its entries.
        found: usize,
        /// How many it needs.
        expected: usize,
    },
    /// An inverse mass that is not positive.
    #[error("inverse_mass[{place}] is not a positive number: leave fixed bodies out (a contact's body may be None)")]
    Mass {
        /// Where.
        place: usize,
    },
    /// A mass matrix that is not symmetric positive definite.
    #[error("M is not symmetric positive definite: {reason}")]
    MassMatrix {
        /// What was seen.
        reason: String,
    },
    /// A number that is NaN or infinite.
    #[error("{what} {place} is not finite")]
    NotFinite {
        /// Of which list.
        what: &'static str,
        /// Where in it.
        place: usize,
    },
    /// A coefficient of friction that is negative or no number.
    #[error("the friction of contact {contact} is {friction}: it must be zero or more, and finite")]
    Friction {
        /// Of which contact.
        contact: usize,
        /// As given.
        friction: f64,
    },
    /// A contact with a body that does not exist.
    #[error("contact {contact} names body {body}, but there are {bodies} bodies")]
    Body {
        /// Of which contact.
        contact: usize,
        /// As given.
        body: usize,
        /// How many there are.
        bodies: usize,
    },
    /// A start of other than as many impulses as the problem has.
    #[error("start has {found} impulses, but the problem has {expected}")]
    Start {
        /// Entries given.
        found: usize,
        /// Entries needed.
        expected: usize,
    },
}
