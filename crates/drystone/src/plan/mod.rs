//! Stable disassembly planning: an order in which every intermediate structure stands.
//!
//! Loomis and Balkcom (2006), section V. The disassembly graph has a node for every sub-assembly; a path of standing
//! nodes from the bare supports to the whole, read backwards, is a stable disassembly order. The search is
//! depth first, from the supports upward, one block at a time, and tests proper sub-assemblies only.

mod collapse;
mod forces;
mod graph;
mod methods;
mod replay;
mod search;
mod stability;

pub use collapse::Collapse;
pub use forces::{StructureForces, forces_along};
pub use graph::{GraphNode, disassembly_graph};
pub use methods::{ByBlocks, ByLemke};
pub use replay::{Recorder, Replay, Step, replay};
pub use search::{Limits, Monitor, Outcome, Plan, Progress, Quiet, TestRecord, plan, plan_with};
pub use stability::{FromScratch, PlanError, Reuse, ReuseDantzig, StabilityTest, Test, TestOutcome};
