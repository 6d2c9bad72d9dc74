//! Stable disassembly planning: an order in which every intermediate structure stands.
//!
//! Loomis and Balkcom (2006), section V. The disassembly graph has a node for every sub-assembly; a path of standing
//! nodes from the bare supports to the whole, read backwards, is a stable disassembly order. The search is
//! depth first, from the supports upward, one block at a time, and tests proper sub-assemblies only.

mod ahead;
mod balanced;
#[cfg(test)]
mod balanced_tests;
mod by_interior;
#[cfg(test)]
mod by_interior_tests;
mod candidates;
mod clear_path;
mod collapse;
mod dead_end;
mod directions;
mod forces;
mod found;
mod graph;
mod grips;
mod hitting;
mod holding;
mod in_turn;
mod learned;
#[cfg(test)]
mod lemma_tests;
mod memory;
mod methods;
mod must_stand;
mod nogood;
mod onward;
mod outcome;
mod planning;
mod replay;
mod reuse;
mod search;
mod stability;
#[cfg(test)]
mod takedown_tests;
mod together;
mod touching;
mod under_each;
mod visited;
mod whole;
mod with_hands;

pub use ahead::Ahead;
pub use clear_path::{Blocked, ClearPath, Moves};
pub use collapse::Collapse;
pub use forces::{Course, StructureForces, WhichForces, forces_along};
pub use graph::{GraphNode, disassembly_graph};
pub use methods::{ByBlocks, ByLemke};
pub use outcome::{Conditions, Limits, MOST_HANDS, Monitor, Outcome, Plan, Progress, Quiet, Stage, TestRecord};
pub use planning::{plan, plan_assembly, plan_assembly_under, plan_under, plan_with, plan_with_under};
pub use replay::{Recorder, Replay, Step, replay};
pub use reuse::Reuse;
pub use stability::{FromScratch, PlanError, ReuseDantzig, StabilityTest, Test, TestOutcome};
