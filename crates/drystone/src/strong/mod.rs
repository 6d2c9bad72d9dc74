//! Strong stability: is rest the only motion that the contact laws allow?
//!
//! ```text
//! M a = F + J' f,     0 <= a_n  complementary to  f_n >= 0,
//! |f_t| <= mu f_n,    f_t = -mu f_n a_t / |a_t|  where a_t != 0                        (1)
//! ```
//!
//! for blocks at rest. [`mod@crate::check`] asks whether a = 0 solves (1) with some forces: then the structure *can* stand. It *must*
//! stand if no other a does (strong stability: Pang and Trinkle 2000). A block between two leaning walls may hang there or
//! fall freely: both obey (1).
//!
//! Every solution has `a' M a = a' F - sum mu f_n |a_t|`: what the loads do beyond friction's loss moves the blocks. The search
//! (`search.rs`) makes that power as large as it can be over a linear relaxation of (1) (`program.rs`), in which each contact may
//! part, slide either way or rest, bounds from below what a contact bears where it slides, and splits where the relaxation breaks a
//! law. Where it never exceeds zero the structure must stand. See docs/theory/strong-stability.md.

mod answer;
mod branch;
mod budget;
mod chains;
mod escape;
mod hinges;
mod laws;
mod program;
mod search;
mod step;
mod turned;

pub use answer::Strong;
pub use budget::{Budget, EFFORT, Monitor, Searched};
pub use escape::Escape;

use crate::{
    check::check_blocks_while,
    formulate::{Assembly, BlockSet, FrictionCone},
};

/// Decides it for a sub-assembly, within a budget: by forces without friction, by a motion that a step finds, by the search. None if
/// stopped.
pub fn strong(assembly: &Assembly, blocks: &BlockSet, budget: Budget, monitor: &mut Monitor<'_>) -> Option<Strong> {
    if held_without_friction(assembly, blocks, monitor)? {
        return Some(Strong { must_stand: Some(true), escape: None, nodes: 1, programs: 1 });
    }
    if let Some(escape) = step::escape(assembly, blocks) {
        return Some(Strong { must_stand: Some(false), escape: Some(escape), nodes: 1, programs: 0 });
    }
    if !assembly.in_plane() {
        return Some(Strong { must_stand: None, escape: None, nodes: 1, programs: 0 });
    }
    search::search(assembly, blocks, budget, monitor)
}

/// Whether forces along the normals alone hold it: then the loads do no work in any motion that closes no contact.
fn held_without_friction(assembly: &Assembly, blocks: &BlockSet, monitor: &mut Monitor<'_>) -> Option<bool> {
    let mut go_on = |_| monitor(Searched::default());
    let verdict = check_blocks_while(&assembly.with_friction(0.0), blocks, FrictionCone::Pyramid, &mut go_on)?;
    Some(verdict.stable)
}
