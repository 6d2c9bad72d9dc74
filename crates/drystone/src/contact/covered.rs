//! Touches at borders that bear, and those that others cover.
//!
//! The normal of slightly rounded corners is right where these come to lie against one another on their own. Four cubes meet in
//! a point: rounded ones that face each other across it stay apart, because the two between hold them so. A block that
//! slides over the seam of two level slabs does not see the corner of the second. In both cases another body already parts the two
//! along a plane with one of the normals at the touch. Then the touch bears nothing, and the bodies may slide along
//! that plane. It is so
//!
//! - if a third body presses on either of the two, right where these touch, along such a normal;
//! - if one of the two and the third are fixed, and the other rests on the third anywhere on such a plane through the touch: the two
//!   are level parts of one ground.

use super::{Contact, ContactSet, rounding::Parting};
use crate::geometry::{dot, length, minus};
use std::collections::BTreeSet;

/// Borders of two bodies that meet, with the contacts that they would be.
pub(super) struct MetBorder {
    pub bodies: [usize; 2],
    /// One, or two at the ends of a segment.
    pub contacts: Vec<Contact>,
    pub parting: Parting,
    /// Of the pair, metres.
    pub tolerance: f64,
}

/// The touch and the contact are each where they are to within a pair's tolerance on either side.
const NEAR: f64 = 3.0;

impl MetBorder {
    /// Whether a contact, which is not of this pair, parts the two bodies.
    fn covered_by(&self, contact: &Contact, fixed: &impl Fn(usize) -> bool) -> bool {
        let [a, b] = self.bodies;
        // Out of a or into b, and the body of the two that has no part in it.
        let (sign, spared) = match contact.bodies {
            [first, _] if first == a => (1.0, b),
            [_, second] if second == a => (-1.0, b),
            [_, second] if second == b => (1.0, a),
            _ => (-1.0, a),
        };
        let third = contact.bodies.into_iter().find(|body| !self.bodies.contains(body));
        let Some(third) = third.filter(|_| self.parting.holds(scaled(contact.normal, sign).into())) else {
            return false;
        };
        let reach = NEAR * self.tolerance;
        let level = |at: &Contact| dot(contact.normal, minus(contact.point, at.point)).abs() <= reach;
        let same_ground = fixed(third) && fixed(spared) && self.contacts.iter().all(level);
        same_ground || self.distance(contact.point) <= reach
    }

    /// Of a point from the segment in which the two meet, metres.
    fn distance(&self, point: [f64; 3]) -> f64 {
        let (Some(first), Some(last)) = (self.contacts.first(), self.contacts.last()) else { return f64::INFINITY };
        let (along, to) = (minus(last.point, first.point), minus(point, first.point));
        let square = dot(along, along);
        let share = if square > 0.0 { (dot(to, along) / square).clamp(0.0, 1.0) } else { 0.0 };
        length(minus(to, scaled(along, share)))
    }
}

impl ContactSet {
    /// Takes in what bears of what meets at borders, each at the place in the contacts that comes with it; its pairs are no longer
    /// mere [`ContactSet::corner_touches`].
    pub(super) fn take_in(&mut self, borders: Vec<(usize, MetBorder)>, fixed: impl Fn(usize) -> bool) {
        if borders.is_empty() {
            return;
        }
        let bodies = self.contacts.iter().flat_map(|contact| contact.bodies).max().map_or(0, |most| most + 1);
        let mut of_body: Vec<Vec<usize>> = vec![Vec::new(); bodies];
        for (k, contact) in self.contacts.iter().enumerate() {
            contact.bodies.into_iter().for_each(|body| of_body[body].push(k));
        }
        let known = |body: usize| of_body.get(body).into_iter().flatten().map(|&k| &self.contacts[k]);
        let covered = |border: &MetBorder| {
            border.bodies.into_iter().flat_map(known).any(|contact| border.covered_by(contact, &fixed))
        };
        let bearing: Vec<_> = borders.into_iter().filter(|(_, border)| !covered(border)).collect();
        let pairs: BTreeSet<[usize; 2]> = bearing.iter().map(|(_, border)| border.bodies).collect();
        self.corner_touches.retain(|pair| !pairs.contains(pair));
        let mut before = std::mem::take(&mut self.contacts).into_iter().enumerate().peekable();
        for (place, border) in bearing {
            self.contacts
                .extend(std::iter::from_fn(|| before.next_if(|(k, _)| *k < place)).map(|(_, contact)| contact));
            self.contacts.extend(border.contacts);
        }
        self.contacts.extend(before.map(|(_, contact)| contact));
    }
}

fn scaled(v: [f64; 3], by: f64) -> [f64; 3] {
    v.map(|x| by * x)
}
