//! How pairs of blocks touch, and the contacts of a scene from that, whatever the dimension.

use super::{Contact, ContactId, ContactSet, Feature, pair_tolerance};
use crate::error::SceneError;
use crate::geometry::Shape;
use crate::scene::SceneOf;

/// How two shapes touch.
pub(super) enum Touch<P> {
    /// Further apart than the tolerance.
    Apart,
    /// Only at borders, corners and in space edges too: such a touch has no normal of its own.
    AtBorders,
    /// Deeper into each other than the tolerance.
    Overlap {
        /// The shortest way out, metres.
        depth: f64,
    },
    /// At these points.
    At(Vec<P>),
}

/// A point where two blocks press on each other; see [`Contact`].
pub(super) struct Pressing {
    pub feature: Feature,
    pub point: [f64; 3],
    pub normal: [f64; 3],
    pub gap: f64,
}

/// The contacts of the candidate pairs of a scene; `touch` is given a pair and its tolerance, metres.
///
/// # Errors
/// [`SceneError::Overlap`]; the deepest is named.
pub(super) fn contacts_of<S: Shape>(
    scene: &SceneOf<S>,
    pairs: &[[usize; 2]],
    touch: impl Fn([usize; 2], f64) -> Touch<Pressing>,
) -> Result<ContactSet, SceneError> {
    let bodies = scene.bodies();
    let mut found = ContactSet { candidate_pairs: pairs.len(), ..ContactSet::default() };
    let mut deepest: Option<([usize; 2], f64)> = None;
    for &[a, b] in pairs {
        match touch([a, b], pair_tolerance(scene, &bodies[a], &bodies[b])) {
            Touch::Apart => {}
            Touch::AtBorders => found.corner_touches.push([a, b]),
            Touch::Overlap { depth } => {
                if deepest.is_none_or(|(_, most)| depth > most) {
                    deepest = Some(([a, b], depth));
                }
            }
            Touch::At(points) => found.contacts.extend(points.into_iter().map(|p| Contact {
                id: ContactId { bodies: [a, b], feature: p.feature },
                bodies: [a, b],
                point: p.point,
                normal: p.normal,
                gap: p.gap,
                friction: scene.pair_friction(a, b),
            })),
        }
    }
    match deepest {
        None => Ok(found),
        Some(([a, b], depth)) => Err(SceneError::Overlap {
            a: bodies[a].name.clone(),
            b: bodies[b].name.clone(),
            depth,
            tolerance: pair_tolerance(scene, &bodies[a], &bodies[b]),
        }),
    }
}

impl<P> Touch<P> {
    /// The same with every point put through a function.
    pub fn map<Q>(self, to: impl FnMut(P) -> Q) -> Touch<Q> {
        match self {
            Self::Apart => Touch::Apart,
            Self::AtBorders => Touch::AtBorders,
            Self::Overlap { depth } => Touch::Overlap { depth },
            Self::At(points) => Touch::At(points.into_iter().map(to).collect()),
        }
    }
}
