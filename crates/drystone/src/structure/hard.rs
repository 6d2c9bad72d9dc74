//! Structures that are too hard for pivots: what the interior-point method has found is kept in place of a basis.
//!
//! Its next answer begins at the forces of the last one (`nearby.rs`), which costs a factor or two, and never more than a verdict
//! from nothing. Since a structure may become easy again as blocks come and go, pivots from nothing get a chance now and then: with as
//! much effort as the answers since the last one took, so that no sequence takes more than twice as long as without them.

use super::putting_up::neighbours;
use crate::{
    equilibrium::with_work,
    formulate::{Assembly, BlockSet},
    nearby::{Nearby, Put, Solved, falls_nearby, solved},
};
use serde::{Deserialize, Serialize};

/// Factors after which pivots are tried again, at first: of two verdicts from nothing, or some ten from forces nearby.
const FIRST_CHANCE: usize = 24;
/// Each time that they fail they wait so many times longer.
const LONGER: usize = 2;
/// Blocks that came together of which each may fall by itself: of more it is quicker to ask about all at once.
const FEW: usize = 4;

/// What is known of a structure whose basis is not.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Hard {
    /// That held the last structure that stood, along all generators.
    forces: Option<Vec<f64>>,
    /// How the last one that fell does: blocks, ascending, with the work of their loads.
    falling: Vec<(usize, f64)>,
    /// Of the last one neither was proved.
    undecided: bool,
    /// Made since pivots were tried.
    factors: usize,
    /// After how many they are tried again.
    chance: usize,
}

impl Hard {
    /// Pivots have failed, for the first time or again.
    pub fn after(before: Option<Self>) -> Self {
        match before {
            Some(hard) => Self { factors: 0, chance: LONGER * hard.chance, ..hard },
            None => Self { forces: None, falling: Vec::new(), undecided: false, factors: 0, chance: FIRST_CHANCE },
        }
    }

    /// Whether pivots are to be tried again: for how many factors.
    pub fn chance(&self) -> Option<usize> {
        (self.factors >= self.chance).then_some(self.factors)
    }

    /// Whether these blocks stand, `new` of which came since the last answer. None if nothing is proved.
    pub fn stands(&mut self, assembly: &Assembly, blocks: &BlockSet, new: &[usize]) -> Option<bool> {
        let stands = self.found(assembly, blocks, new);
        self.undecided = stands.is_none();
        stands
    }

    /// Whether nothing was proved of the last structure.
    pub fn is_undecided(&self) -> bool {
        self.undecided
    }

    fn found(&mut self, assembly: &Assembly, blocks: &BlockSet, new: &[usize]) -> Option<bool> {
        if let Some(motion) = falls_by_itself(assembly, blocks, new) {
            self.falling = motion;
            return Some(false);
        }
        let Solved { found, factors } = solved(assembly, blocks, &[], self.forces.as_deref())?;
        self.factors += factors;
        Some(match found {
            Nearby::Stands(forces) => {
                self.forces = Some(forces);
                true
            }
            Nearby::Falls(motion) => {
                self.falling = with_work(assembly, motion);
                false
            }
        })
    }

    /// How the last structure that fell does.
    pub fn falling(&self) -> &[(usize, f64)] {
        &self.falling
    }

    /// Whether it can be of this assembly.
    pub fn fits(&self, assembly: &Assembly) -> bool {
        let forces = self.forces.as_ref().is_none_or(|forces| forces.len() == assembly.generators().len());
        forces && self.falling.iter().all(|&(block, _)| block < assembly.blocks())
    }

    /// Numbers kept.
    pub fn entries(&self) -> usize {
        self.forces.as_ref().map_or(0, Vec::len)
    }
}

/// How one of the blocks that came falls while what it does not touch stays where it is.
fn falls_by_itself(assembly: &Assembly, blocks: &BlockSet, new: &[usize]) -> Option<Vec<(usize, f64)>> {
    if new.len() > FEW {
        return None;
    }
    let touched = |block: usize| {
        let mut touched: Vec<usize> = neighbours(assembly, block).flatten().collect();
        touched.sort_unstable();
        touched.dedup();
        touched
    };
    let falls = |&added: &usize| falls_nearby(assembly, &touched, Put { blocks, held: &[], added });
    new.iter().find_map(falls).map(|motion| with_work(assembly, motion))
}
