//! Contacts: where blocks press on each other.

use super::id::ContactId;

/// One point through which two blocks press on each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Which features of which blocks meet here.
    pub id: ContactId,
    /// Indices of the two blocks, the lower first.
    pub bodies: [usize; 2],
    /// Where they meet, world coordinates, metres: halfway across the gap. In the plane z is 0.
    pub point: [f64; 3],
    /// Unit vector from `bodies[0]` into `bodies[1]`. In the plane z is 0.
    pub normal: [f64; 3],
    /// Distance of the two surfaces here, metres: negative where they overlap within tolerance.
    pub gap: f64,
    /// Coefficient of friction of the pair.
    pub friction: f64,
}

/// Every contact of a scene, in the order of (body, body, feature); in space in that of the bodies and then round each
/// shared polygon, of which opposite corners bear in fewer pivots than neighbours.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactSet {
    /// Contact points. A face on a face has two, the ends of the shared segment; a corner on a
    /// face has one. Borders that meet, where no other body covers them, have one or two
    /// ([`Feature::at_borders`](super::Feature::at_borders)).
    pub contacts: Vec<Contact>,
    /// Pairs that meet at borders and nowhere else, of which another body already parts the two along a plane
    /// (docs/theory/touching-at-borders.md). They bear nothing.
    pub corner_touches: Vec<[usize; 2]>,
    /// Pairs that the broad phase handed to the narrow phase: a measure of the work done.
    pub candidate_pairs: usize,
}
