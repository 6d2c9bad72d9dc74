//! Supports that settle: how blocks follow, which joints open, and the contact forces after it.
//!
//! ```text
//! max u' F   over   G' u + c >= 0                                                     (1)
//! min c' f   over   G f = -F,   f >= 0                                                (2)
//! ```
//!
//! u are small displacements of the blocks, `c = G_s' u_s` is what the prescribed displacements u_s of the supports open of every
//! contact, along the edges of its cone. (1): of all displacements in which no contact closes the blocks take one of least potential
//! energy. (2), its dual: of all forces that hold the blocks those are left that do least work on the supports. Where a joint opens no
//! force is left. docs/theory/settlements.md.

mod after;
mod joints;
mod least;
mod settled;

pub use after::canonical_forces_after;
pub use joints::{Joint, Opening};
pub use settled::Settled;

use crate::formulate::{Assembly, BlockSet, Constrained, FrictionCone};
use drystone_lcp::{
    Status,
    cone::{ConeSolver, Membership},
};

/// A force below this share of the largest is none.
const NONE: f64 = 1e-6;

/// How the blocks of a structure that stands follow the settlements of its scene.
pub fn settle(assembly: &Assembly, blocks: &BlockSet, cone: FrictionCone) -> Settled {
    let space = assembly.body_space(blocks, cone).of_moving();
    let Constrained { motion, forces, found } = least::displacement(&space);
    let settled = settled::judged(assembly, blocks, cone, &motion, forces, found.iterations);
    if settled.status == Status::Solved {
        return settled;
    }
    match assembly.squeeze(blocks) {
        (Membership::Inside, solver) => {
            let squeezed = squeezed(assembly, blocks, &solver);
            Settled { status: Status::NoSolution, squeezed, ..settled.without_answer() }
        }
        _ => settled.without_answer(),
    }
}

/// The bodies in forces of their own against the settlements.
fn squeezed(assembly: &Assembly, blocks: &BlockSet, solver: &ConeSolver) -> Vec<usize> {
    let rows = assembly.rows(blocks);
    let most = rows.iter().map(|&j| solver.f(j)).fold(0.0, f64::max);
    let pressed = rows.into_iter().filter(|&j| solver.f(j) > NONE * most);
    let contacts = pressed.map(|j| assembly.generators()[j].contact());
    let mut bodies: Vec<usize> = contacts.flat_map(|contact| assembly.contacts()[contact].bodies).collect();
    bodies.sort_unstable();
    bodies.dedup();
    bodies
}
