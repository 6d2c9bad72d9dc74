//! Why blocks fall that bear on nothing: what they would have to reach, and how far it is.

use crate::{
    contact::{Contact, pair_tolerance, pairs_within, tolerance_of},
    error::SceneError,
    formulate::Assemble,
    geometry::{dot, length},
    interrupt::poll,
    scene::{Body, BodyOptions, SceneOf},
};

/// A falling block that nothing bears from below.
#[derive(Debug, Clone, PartialEq)]
pub struct Unsupported {
    /// Index of the block.
    pub body: usize,
    /// Indices of what it touches, from the side or from above.
    pub touches: Vec<usize>,
    /// The nearest of the bodies that do not touch it in a contact, and its distance, metres: zero where they meet at corners or
    /// edges only. Of equal ones the first.
    pub nearest: Option<(usize, f64)>,
}

/// Two bodies that do not touch, but would with a contact tolerance ten times larger.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearMiss {
    /// Indices of the two, the lower first.
    pub bodies: [usize; 2],
    /// The least gap at the contact points that they would have, metres.
    pub gap: f64,
    /// The contact tolerance with which they would touch, metres.
    pub tolerance: f64,
}

/// What [`explain`] finds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Explanation {
    /// In the order of the blocks.
    pub unsupported: Vec<Unsupported>,
    /// In the order of the pairs.
    pub near_misses: Vec<NearMiss>,
}

/// A normal that leans from the horizontal by less than this, radians, bears nothing from below.
const LEVEL: f64 = 1e-6;

/// How many times the contact tolerance makes a gap a near miss.
const NEAR: f64 = 10.0;

/// Operations to look at the box around a body, about.
const BOX: usize = 100;

/// Looks for the reasons in the geometry: `falling` are the bodies that fall, `present` those that are there with the fixed
/// ones, as indices.
///
/// # Errors
/// [`SceneError::Overlap`].
pub fn explain<S: Assemble>(
    scene: &SceneOf<S>,
    present: &[usize],
    falling: &[usize],
) -> Result<Explanation, SceneError> {
    let bodies = scene.bodies();
    let mut there: Vec<bool> = bodies.iter().map(|body| body.fixed).collect();
    present.iter().for_each(|&body| there[body] = true);
    let mut contacts = S::contacts(scene)?.contacts;
    contacts.retain(|contact| contact.bodies.iter().all(|&body| there[body]));
    let looking = Looking { scene, there, contacts: &contacts };
    let unsupported = falling.iter().filter_map(|&body| looking.unsupported(body)).collect();
    Ok(Explanation { unsupported, near_misses: looking.near_misses(falling) })
}

/// Every pair of bodies that do not touch, but would with a contact tolerance ten times larger, in the order of the pairs.
///
/// # Errors
/// [`SceneError::Overlap`].
pub fn near_misses<S: Assemble>(scene: &SceneOf<S>) -> Result<Vec<NearMiss>, SceneError> {
    let contacts = S::contacts(scene)?.contacts;
    let all: Vec<usize> = (0..scene.bodies().len()).collect();
    Ok(Looking { scene, there: vec![true; all.len()], contacts: &contacts }.near_misses(&all))
}

struct Looking<'a, S: Assemble> {
    scene: &'a SceneOf<S>,
    /// Whether each body is there.
    there: Vec<bool>,
    contacts: &'a [Contact],
}

impl<S: Assemble> Looking<'_, S> {
    /// What is to be said of a block, unless something bears it from below.
    fn unsupported(&self, body: usize) -> Option<Unsupported> {
        let own = || self.contacts.iter().filter(|contact| contact.bodies.contains(&body));
        if own().any(|contact| self.bears(contact, body)) {
            return None;
        }
        let mut touches: Vec<usize> = own().flat_map(|contact| contact.bodies).filter(|&other| other != body).collect();
        touches.sort_unstable();
        touches.dedup();
        let nearest = self.nearest(body, &touches);
        Some(Unsupported { body, touches, nearest })
    }

    /// Whether a contact can push a body against gravity by its normal.
    fn bears(&self, contact: &Contact, body: usize) -> bool {
        let gravity = S::in_space(self.scene.gravity());
        let upward = -dot(contact.normal, gravity);
        (if contact.bodies[1] == body { upward } else { -upward }) > LEVEL * length(gravity)
    }

    /// Boxes say which bodies can be nearest.
    fn nearest(&self, body: usize, touches: &[usize]) -> Option<(usize, f64)> {
        let bodies = self.scene.bodies();
        poll(BOX * bodies.len());
        let own = &bodies[body];
        let other = |&i: &usize| i != body && self.there[i] && !touches.contains(&i);
        let candidates = (0..bodies.len()).filter(other);
        let mut candidates: Vec<(f64, usize)> = candidates.map(|i| (box_distance(own, &bodies[i]), i)).collect();
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut best: Option<(usize, f64)> = None;
        for (least, i) in candidates {
            if best.is_some_and(|(_, distance)| least > distance) {
                break;
            }
            // What meets within tolerance and is no contact has corners or edges there, which bear nothing.
            let apart = S::distance(own, &bodies[i]);
            let distance = if apart <= pair_tolerance(self.scene, own, &bodies[i]) { 0.0 } else { apart };
            if best.is_none_or(|(known, least)| (distance, i) < (least, known)) {
                best = Some((i, distance));
            }
        }
        best
    }

    fn near_misses(&self, falling: &[usize]) -> Vec<NearMiss> {
        let bodies = self.scene.bodies();
        let mut falls = vec![false; bodies.len()];
        falling.iter().for_each(|&body| falls[body] = true);
        let pairs = pairs_within(bodies, |i| NEAR * tolerance_of(self.scene, &bodies[i]));
        let concerned =
            |&[a, b]: &[usize; 2]| self.there[a] && self.there[b] && (falls[a] || falls[b]) && !self.touch([a, b]);
        pairs.into_iter().filter(concerned).filter_map(|pair| self.near_miss(pair)).collect()
    }

    fn touch(&self, pair: [usize; 2]) -> bool {
        self.contacts.binary_search_by_key(&pair, |contact| contact.bodies).is_ok()
    }

    /// The two alone, with more tolerance.
    fn near_miss(&self, pair: [usize; 2]) -> Option<NearMiss> {
        let [a, b] = pair.map(|i| &self.scene.bodies()[i]);
        let tolerance = NEAR * pair_tolerance(self.scene, a, b);
        let mut alone = SceneOf::new(self.scene.gravity(), 0.0).ok()?.with_contact_tolerance(tolerance).ok()?;
        for body in [a, b] {
            let (name, friction) = (None, None);
            let options = BodyOptions { name, density: body.density, friction, fixed: body.fixed, own: body.own };
            alone.push(body.name.clone(), body.shape.clone(), body.box_size, body.pose, options).ok()?;
        }
        let gaps = S::contacts(&alone).ok()?.contacts.into_iter().map(|contact| contact.gap);
        gaps.reduce(f64::min).map(|gap| NearMiss { bodies: pair, gap, tolerance })
    }
}

/// Distance of the boxes around two bodies, metres: at most that of the bodies, but for rounding.
fn box_distance<S: Assemble>(a: &Body<S>, b: &Body<S>) -> f64 {
    let ([low, high], [other_low, other_high]) = (a.shape.bounds(&a.pose), b.shape.bounds(&b.pose));
    let ends = low.as_ref().iter().zip(high.as_ref()).zip(other_low.as_ref().iter().zip(other_high.as_ref()));
    let apart = ends.map(|((low, high), (other_low, other_high))| (other_low - high).max(low - other_high).max(0.0));
    apart.fold(0.0, |all: f64, along| all.hypot(along))
}
