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

/// Two bodies that occupy the same place by more than the contact tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Indices of the two, the lower first.
    pub bodies: [usize; 2],
    /// The shortest way to part them, metres; of bodies of several pieces, that of the deepest two pieces.
    pub depth: f64,
    /// The pair's contact tolerance, metres.
    pub tolerance: f64,
}

/// How all candidate pairs of a scene meet.
#[derive(Default)]
pub(super) struct Meetings {
    contacts: ContactSet,
    /// In the order of the pairs.
    pub overlaps: Vec<Overlap>,
}

impl Meetings {
    /// `touch` is given a pair and its tolerance, metres.
    pub fn of<S: Shape>(
        scene: &SceneOf<S>,
        pairs: &[[usize; 2]],
        touch: impl Fn([usize; 2], f64) -> Touch<Pressing>,
    ) -> Self {
        let bodies = scene.bodies();
        let mut found = ContactSet { candidate_pairs: pairs.len(), ..ContactSet::default() };
        let mut borders: Vec<(usize, MetBorder)> = Vec::new();
        let mut overlaps = Vec::new();
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
                Touch::Overlap { depth } => overlaps.push(Overlap { bodies: [a, b], depth, tolerance }),
                Touch::At(points) => found.contacts.extend(points.into_iter().map(contact)),
            }
        }
        found.take_in(borders, |i| bodies[i].fixed);
        Self { contacts: found, overlaps }
    }

    /// The contacts, if nothing overlaps.
    ///
    /// # Errors
    /// [`SceneError::Overlap`]; the deepest is named, of equal ones the first.
    pub fn contacts<S: Shape>(self, scene: &SceneOf<S>) -> Result<ContactSet, SceneError> {
        let deeper = |deepest: Overlap, other: Overlap| if other.depth > deepest.depth { other } else { deepest };
        let Some(Overlap { bodies, depth, tolerance }) = self.overlaps.into_iter().reduce(deeper) else {
            return Ok(self.contacts);
        };
        let [a, b] = bodies.map(|body| scene.bodies()[body].name.clone());
        Err(SceneError::Overlap { a, b, depth, tolerance })
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
