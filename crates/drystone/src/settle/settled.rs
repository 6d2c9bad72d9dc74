//! What is known of blocks that follow supports, computed anew from bodies and contact points.

use super::joints::{self, Joint};
use crate::{
    contact::Contact,
    formulate::{Acceleration, Assembly, BlockSet, Components, ContactForce, FrictionCone},
    geometry::dot,
    proof::{imbalance, opening, relative_motion},
};
use drystone_lcp::Status;

/// How blocks follow supports that settle.
#[derive(Debug, Clone)]
pub struct Settled {
    /// Solved; no solution if the supports squeeze blocks, so that no small displacement of rigid blocks goes with theirs;
    /// numerical trouble if neither is proved.
    pub status: Status,
    /// Small displacement of every block, by its body: metres and radians; no numbers without an answer.
    pub displacements: Vec<(usize, Acceleration)>,
    /// The joints that open or slide.
    pub joints: Vec<Joint>,
    /// Displacement of the second body relative to the first, metres, at every contact that has a force.
    pub relative: Vec<[f64; 3]>,
    /// Contact forces after the settlement, ascending by contact.
    pub forces: Vec<(Contact, ContactForce)>,
    /// Work of the loads, J.
    pub work: f64,
    /// The most that it can be for any displacement, by the forces: `c' f`.
    pub bound: f64,
    /// Largest imbalance that the forces leave of a block, as a share of its own load or of the largest force on it.
    pub imbalance: f64,
    /// How far a contact closes, of the largest displacement.
    pub closing: f64,
    /// Displacements up to this are none, metres.
    pub resolution: f64,
    /// Where there is no solution, the bodies in forces that squeeze them: these balance without any load, and the supports do work
    /// against them.
    pub squeezed: Vec<usize>,
    /// Matrices factored by the interior-point method.
    pub iterations: usize,
}

/// Displacements below this share of the largest are rounding: between blocks that neither bear nor part the method leaves 1e-6, on
/// round cones 1e-5.
const NONE: f64 = 1e-4;
/// What is not known of a displacement.
const NOWHERE: Acceleration = Acceleration { linear: [f64::NAN; 3], angular: [f64::NAN; 3] };
/// What the forces may leave of a load, and how far a contact may close, of the largest displacement.
const IMBALANCE: f64 = 1e-7;
const CLOSING: f64 = 1e-7;
/// How far work and bound may be apart: of the work of the loads one by one, and of all loads times the largest displacement.
const APART: f64 = 1e-7;
const ROUNDING: f64 = 1e-12;

impl Settled {
    /// The same without what was found, but for the bodies that were asked about.
    pub(super) fn without_answer(self) -> Self {
        let displacements = self.displacements.iter().map(|&(body, _)| (body, NOWHERE)).collect();
        let (joints, relative, forces) = (Vec::new(), Vec::new(), Vec::new());
        let [work, bound, imbalance, closing] = [f64::NAN; 4];
        Self { displacements, joints, relative, forces, work, bound, imbalance, closing, ..self }
    }
}

/// What a motion and forces prove.
pub(super) fn judged(
    assembly: &Assembly,
    blocks: &BlockSet,
    cone: FrictionCone,
    motion: &[(usize, Components)],
    forces: Vec<ContactForce>,
    iterations: usize,
) -> Settled {
    let mut of: Vec<Option<&Components>> = vec![None; assembly.bodies().len()];
    motion.iter().for_each(|(block, u)| of[assembly.body_index(*block)] = Some(u));
    let supports = |body: usize| Some(&assembly.bodies()[body]).filter(|part| part.fixed).map(|part| &part.settlement);
    let contact = |force: &ContactForce| &assembly.contacts()[force.contact];
    let all = |body: usize| of[body].or(supports(body));
    let relative: Vec<[f64; 3]> = forces.iter().map(|f| relative_motion(assembly, contact(f), all).0).collect();
    let bound = forces.iter().map(|f| dot(f.force, relative_motion(assembly, contact(f), supports).0)).sum();
    let largest = relative.iter().flatten().fold(assembly.fastest(motion), |most, u| most.max(u.abs()));
    let opened = forces.iter().zip(&relative).map(|(f, u)| opening(assembly, contact(f), *u, cone));
    let closes = opened.fold(0.0_f64, |most, opening| most.max(-opening));
    let closing = if largest > 0.0 { closes / largest } else { 0.0 };
    let (work, size) = work_of_loads(assembly, motion);
    let loads: f64 = blocks.iter().flat_map(|block| assembly.applied(block)).map(|load| load.abs()).sum();
    let left = imbalance(assembly, blocks, &forces);
    let solved =
        left <= IMBALANCE && closing <= CLOSING && f64::abs(bound - work) <= APART * size + ROUNDING * loads * largest;
    let resolution = NONE * largest;
    let shown = |(block, u): &(usize, Components)| (assembly.body_index(*block), assembly.in_world(*block, *u));
    Settled {
        status: if solved { Status::Solved } else { Status::NumericalTrouble },
        displacements: motion.iter().map(shown).collect(),
        joints: joints::opened(assembly, &forces, &relative, resolution),
        relative,
        forces: forces.into_iter().map(|f| (assembly.contacts()[f.contact].clone(), f)).collect(),
        work,
        bound,
        imbalance: left,
        closing,
        resolution,
        squeezed: Vec::new(),
        iterations,
    }
}

/// Work of the loads in a displacement, and the sum of the sizes of its terms, J.
fn work_of_loads(assembly: &Assembly, motion: &[(usize, Components)]) -> (f64, f64) {
    let (mut work, mut size) = (0.0, 0.0);
    for (block, u) in motion {
        for (&k, load) in assembly.components().iter().zip(assembly.applied(*block)) {
            work += u[k] * load;
            size += (u[k] * load).abs();
        }
    }
    (work, size)
}
