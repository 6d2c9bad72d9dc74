//! How pairs of blocks touch, and the contacts of a scene from that, whatever the dimension.

use super::{Contact, ContactId, ContactSet, Feature, covered::MetBorder, pair_tolerance, rounding::Parting};
use crate::error::SceneError;
use crate::geometry::Shape;
use crate::interrupt::poll;
use crate::scene::SceneOf;

/// How two shapes touch.
pub(super) enum Touch<P> {
    /// Further apart than the tolerance.
    Apart,
    /// Only at borders, corners and in space edges too: such a touch has no normal but that of slightly rounded ones.
    AtBorders(Vec<Border<P>>),
    /// Deeper into each other than the tolerance.
    Overlap {
        /// The shortest way out, metres.
        depth: f64,
    },
    /// At these points.
    At(Vec<P>),
}

/// Borders that meet.
pub(super) struct Border<P> {
    /// One, or the two ends of what edges share; all with the same normal.
    pub points: Vec<P>,
    pub parting: Parting,
}

/// A point where two blocks press on each other; see [`Contact`].
pub(super) struct Pressing {
    pub feature: Feature,
    pub point: [f64; 3],
    pub normal: [f64; 3],
    pub gap: f64,
}

/// Operations to look at a pair of blocks, about.
const PAIR: usize = 1000;

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
    let mut borders: Vec<(usize, MetBorder)> = Vec::new();
    let mut deepest: Option<([usize; 2], f64)> = None;
    for &[a, b] in pairs {
        poll(PAIR);
        let tolerance = pair_tolerance(scene, &bodies[a], &bodies[b]);
        let contact = |p: Pressing| Contact {
            id: ContactId { bodies: [a, b], feature: p.feature },
            bodies: [a, b],
            point: p.point,
            normal: p.normal,
            gap: p.gap,
            friction: scene.pair_friction(a, b),
        };
        match touch([a, b], tolerance) {
            Touch::Apart => {}
            Touch::AtBorders(met) => {
                found.corner_touches.push([a, b]);
                borders.extend(met.into_iter().map(|Border { points, parting }| {
                    let contacts = points.into_iter().map(contact).collect();
                    (found.contacts.len(), MetBorder { bodies: [a, b], contacts, parting, tolerance })
                }));
            }
            Touch::Overlap { depth } => {
                if deepest.is_none_or(|(_, most)| depth > most) {
                    deepest = Some(([a, b], depth));
                }
            }
            Touch::At(points) => found.contacts.extend(points.into_iter().map(contact)),
        }
    }
    found.take_in(borders, |i| bodies[i].fixed);
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
    pub fn map<Q>(self, mut to: impl FnMut(P) -> Q) -> Touch<Q> {
        match self {
            Self::Apart => Touch::Apart,
            Self::AtBorders(met) => Touch::AtBorders(met.into_iter().map(|border| border.map(&mut to)).collect()),
            Self::Overlap { depth } => Touch::Overlap { depth },
            Self::At(points) => Touch::At(points.into_iter().map(to).collect()),
        }
    }
}

impl<P> Border<P> {
    fn map<Q>(self, to: impl FnMut(P) -> Q) -> Border<Q> {
        Border { points: self.points.into_iter().map(to).collect(), parting: self.parting }
    }
}
