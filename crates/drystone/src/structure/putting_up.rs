//! Blocks come one by one, those that stand before those that fall.

use super::history::History;
use crate::{
    equilibrium::put_up,
    formulate::{Assembly, BlockRows, BlockSet},
};
use drystone_lcp::cone::{ConeSolver, Membership};

/// Blocks that fell one after the other until no more are tried: what is there may fall already. A try costs a pass over
/// what is there. Of 84 random blocks 8 are better than 2 (0.35 ms in place of 0.52 until all are there and gone again),
/// of 1000 with friction 2 better than 8 (140 ms in place of 300).
fn patience(blocks: usize) -> usize {
    (640 / blocks.max(1)).clamp(2, 8)
}

/// A solver on the way up.
#[derive(Debug)]
pub(super) struct PuttingUp<'a> {
    pub assembly: &'a Assembly,
    pub rows: &'a BlockRows,
    pub solver: &'a mut ConeSolver,
    pub history: &'a mut History,
}

impl PuttingUp<'_> {
    /// Puts up all of these blocks, and empties the list; `with` holds them and what is there. The solver has not answered then.
    pub fn put_up(mut self, blocks: &mut Vec<usize>, with: &BlockSet) {
        if blocks.len() > 1 {
            self.put_up_what_stands(blocks, with);
        }
        let Self { rows, solver, history, .. } = self;
        put_up(solver, rows, blocks.drain(..), |solver, block| {
            history.push(block, solver);
            true
        });
    }

    /// As long as there is one among these blocks that stands on what is there, the first such one comes. The others are
    /// left, at least one of them: the last block is not asked about.
    fn put_up_what_stands(&mut self, waiting: &mut Vec<usize>, with: &BlockSet) {
        let mut there = with.clone();
        waiting.iter().for_each(|&block| there.remove(block));
        let (mut place, mut fell) = (0, Vec::new());
        while waiting.len() > 1
            && fell.len() < patience(self.rows.blocks())
            && let Some(&block) = waiting.get(place)
        {
            if fell.contains(&block) || !self.touches(block, &there) {
                place += 1;
            } else if self.stands_with(block) {
                waiting.remove(place);
                there.insert(block);
                fell.clear(); // under this block or against it they may stand
                place = 0;
            } else {
                self.history.undo(self.solver);
                fell.push(block);
            }
        }
    }

    fn stands_with(&mut self, block: usize) -> bool {
        self.history.push(block, self.solver);
        self.solver.add_rows(self.rows.of(block));
        self.solver.decide() == Membership::Inside
    }

    /// Whether a block touches a fixed body or one of these. One that touches neither falls freely.
    fn touches(&self, block: usize, there: &BlockSet) -> bool {
        neighbours(self.assembly, block).any(|other| other.is_none_or(|other| there.contains(other)))
    }
}

/// For every generator of a block the other block, None for a fixed body.
pub(super) fn neighbours(assembly: &Assembly, block: usize) -> impl Iterator<Item = Option<usize>> {
    assembly.generators_on(block).iter().map(move |&j| assembly.generators()[j].blocks().find(|&other| other != block))
}
