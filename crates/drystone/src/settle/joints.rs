//! Joints that open or slide.

use crate::{
    canonical::faces,
    contact::Contact,
    formulate::{Assembly, ContactForce},
    geometry::{dot, length, minus},
};

/// What a joint does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Opening {
    /// It opens about a point, or in space an edge, that stays where it is.
    Hinge,
    /// It slides, and opens by the angle of friction, which is the flow rule; it can still bear there.
    Slides,
    /// It opens all over.
    Parts,
}

impl Opening {
    /// "hinge", "slides" or "parts".
    pub fn name(self) -> &'static str {
        match self {
            Self::Hinge => "hinge",
            Self::Slides => "slides",
            Self::Parts => "parts",
        }
    }
}

/// A face between two bodies that opens or slides.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The lower index first.
    pub bodies: [usize; 2],
    /// What it does.
    pub opening: Opening,
    /// Where it stays closed: the hinge, or the middle of what slides; of what parts where it opens least. World, metres.
    pub at: [f64; 3],
    /// Largest displacement of the second body relative to the first along the normal, metres.
    pub opens: f64,
    /// The same across the normal.
    pub slides: f64,
}

/// The joints in which bodies move relative to one another by more than `resolution`.
pub(super) fn opened(
    assembly: &Assembly,
    forces: &[ContactForce],
    relative: &[[f64; 3]],
    resolution: f64,
) -> Vec<Joint> {
    let contacts: Vec<&Contact> = forces.iter().map(|force| &assembly.contacts()[force.contact]).collect();
    let joint = |points: Vec<usize>| {
        let moved = points.iter().map(|&point| Moved::of(contacts[point], relative[point])).collect();
        of_face(contacts[points[0]].bodies, moved, resolution)
    };
    faces(assembly, &contacts).into_iter().filter_map(|face| joint(face.points)).collect()
}

/// A point of a joint.
struct Moved {
    point: [f64; 3],
    opens: f64,
    slides: f64,
    /// How far it is from where it can bear.
    apart: f64,
}

impl Moved {
    fn of(contact: &Contact, relative: [f64; 3]) -> Self {
        let opens = dot(contact.normal, relative);
        let slides = length(minus(relative, contact.normal.map(|n| n * opens)));
        Self { point: contact.point, opens, slides, apart: opens - contact.friction * slides }
    }
}

fn of_face(bodies: [usize; 2], points: Vec<Moved>, resolution: f64) -> Option<Joint> {
    let most = |of: fn(&Moved) -> f64| points.iter().map(of).fold(0.0, f64::max);
    let (opens, slides) = (most(|point| point.opens), most(|point| point.slides));
    if opens.max(slides) <= resolution {
        return None;
    }
    let least = points.iter().map(|point| point.opens).fold(f64::INFINITY, f64::min);
    let middle = |of: &dyn Fn(&Moved) -> bool| {
        let some: Vec<[f64; 3]> = points.iter().filter(|point| of(point)).map(|point| point.point).collect();
        let sum = |k: usize| some.iter().map(|point| point[k]).sum::<f64>() / some.len() as f64;
        (!some.is_empty()).then(|| [0, 1, 2].map(sum))
    };
    let still = middle(&|point| point.opens.max(point.slides) <= resolution).map(|at| (Opening::Hinge, at));
    let slid = || middle(&|point| point.apart <= resolution).map(|at| (Opening::Slides, at));
    let parted = || middle(&|point| point.opens <= least + resolution).map(|at| (Opening::Parts, at));
    let (opening, at) = still.or_else(slid).or_else(parted)?;
    Some(Joint { bodies, opening, at, opens, slides })
}
