//! The blocks that were put up last, each with the state that the solver was in before it.
//!
//! Who takes blocks off in the opposite order, as after one with which something fell, gets that state back: no pivot, and no
//! rounding.

use crate::formulate::BlockSet;
use drystone_lcp::cone::{ConeSolver, Mark};
use serde::{Deserialize, Serialize};

/// Going back to a state whose factor has to be built again pays if at least this many pivots were made since.
const PIVOTS_WORTH_A_FACTOR: usize = 64;

/// Blocks in the order in which they came, the newest last, with the state before each.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct History {
    states: Vec<(usize, Mark)>,
}

impl History {
    /// A block is about to come.
    pub fn push(&mut self, block: usize, solver: &mut ConeSolver) {
        self.states.push((block, solver.mark()));
    }

    /// The blocks, the newest last.
    pub fn blocks(&self) -> impl Iterator<Item = usize> {
        self.states.iter().map(|&(block, _)| block)
    }

    /// Goes back to before the newest block.
    pub fn undo(&mut self, solver: &mut ConeSolver) {
        if let Some((_, state)) = self.states.pop() {
            solver.roll_back(state);
        }
    }

    /// Goes back to before the newest blocks, as far as they are not in `present` any more, and says which these were. What
    /// remains of `gone` went in another order, and ends the history.
    pub fn go_back(&mut self, gone: &mut Vec<usize>, present: &BlockSet, solver: &mut ConeSolver) {
        let stay = self.states.iter().rposition(|&(block, _)| present.contains(block)).map_or(0, |last| last + 1);
        if let Some(&(_, state)) = self.states.get(stay)
            && (solver.remembers(state) || solver.pivots_since(state) >= PIVOTS_WORTH_A_FACTOR)
        {
            solver.roll_back(state);
            let undone = self.states.drain(stay..); // all of them are gone
            if undone.len() == gone.len() {
                gone.clear();
            } else {
                let mut settled = present.clone();
                undone.for_each(|(block, _)| settled.insert(block));
                gone.retain(|&block| !settled.contains(block));
            }
        }
        if !gone.is_empty() {
            self.states.clear();
            solver.forget();
        }
    }
}
