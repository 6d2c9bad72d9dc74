//! When the factor is built again: it has lost digits, filled up, or made pivots dear.

use super::{ConeSolver, ENTRIES, REPLACEMENTS};

/// What the pivots of an answer have cost since the factor was built, or since the answer began. Costs are numbers read.
#[derive(Debug)]
pub(super) struct Wear {
    pivots: usize,
    /// Read before the first of them, and when it was last looked at.
    began: usize,
    last_look: usize,
    /// Of building the factor.
    building: usize,
    /// Fewest pivots that are worth a new factor.
    fewest: usize,
}

/// Pivots between two looks at what they cost.
const LOOK: usize = 8;
/// Pivots of an answer before its first new factor, which takes the values at all marks away: most answers end before.
const FEWEST: usize = 64;
/// Building a factor costs as much as reading each of its numbers about so many times.
const BUILDING: usize = 20;

impl ConeSolver {
    /// Begins to count what pivots cost.
    pub(super) fn fresh_wear(&self) -> Wear {
        let effort = self.basis.factor.effort();
        let building = BUILDING * self.basis.factor.stored();
        Wear { pivots: 0, began: effort, last_look: effort, building, fewest: FEWEST }
    }

    /// Whether a new factor pays: the last pivots cost more each than all since it was built on the average, building it
    /// included.
    fn is_dear(&self, wear: &mut Wear) -> bool {
        wear.pivots += 1;
        if !wear.pivots.is_multiple_of(LOOK) {
            return false;
        }
        let effort = self.basis.factor.effort();
        let recent = effort - std::mem::replace(&mut wear.last_look, effort);
        wear.pivots >= wear.fewest && recent * wear.pivots > LOOK * (wear.building + effort - wear.began)
    }

    /// Builds the factor again before a pivot, if that is called for. None if that fails.
    pub(super) fn rebuild_if_worn(&mut self, wear: &mut Wear) -> Option<()> {
        let full = self.basis.factor.stored() > self.basis.most_entries.max(ENTRIES * self.present.rows.len());
        let stale = self.basis.factor.left_behind() > REPLACEMENTS * self.basis.basic.len();
        let dear = self.is_dear(wear);
        if std::mem::take(&mut self.basis.shaky) || full || stale || dear {
            if !self.rebuild(&self.basis.set(&self.present.rows)) {
                return None;
            }
            self.recompute_values();
            self.basis.shaky = false;
            *wear = Wear { fewest: 2 * LOOK, ..self.fresh_wear() };
        }
        Some(())
    }
}
