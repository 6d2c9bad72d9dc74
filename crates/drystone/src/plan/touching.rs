//! Who touches whom in the complete assembly.

use crate::formulate::{Assembly, BlockSet};

/// Neighbours of every movable block, and the blocks that rest against a fixed body.
#[derive(Debug)]
pub(crate) struct Touching {
    /// Blocks from the supports upward: the order in which they are tried.
    upward: Vec<usize>,
    neighbours: Vec<Vec<usize>>,
    on_support: Vec<bool>,
}

impl Touching {
    pub fn new(assembly: &Assembly) -> Self {
        let blocks = assembly.blocks();
        let mut neighbours = vec![Vec::new(); blocks];
        let mut on_support = vec![false; blocks];
        for generator in assembly.generators() {
            let mut touched = generator.blocks();
            match (touched.next(), touched.next()) {
                (Some(one), None) => on_support[one] = true,
                (Some(a), Some(b)) => {
                    neighbours[a].push(b);
                    neighbours[b].push(a);
                }
                _ => {}
            }
        }
        for list in &mut neighbours {
            list.sort_unstable();
            list.dedup();
        }
        Self { upward: assembly.upward(), neighbours, on_support }
    }

    /// Those of units of blocks that come together; each is tried where its lowest block is.
    pub fn of_units(assembly: &Assembly, units: &[Vec<usize>]) -> Self {
        let of_blocks = Self::new(assembly);
        let mut unit = vec![0; of_blocks.blocks()];
        units.iter().enumerate().for_each(|(k, blocks)| blocks.iter().for_each(|&block| unit[block] = k));
        let neighbours = units.iter().enumerate().map(|(k, blocks)| {
            let touched = blocks.iter().flat_map(|&block| of_blocks.neighbours(block));
            let mut list: Vec<usize> = touched.map(|&other| unit[other]).filter(|&other| other != k).collect();
            list.sort_unstable();
            list.dedup();
            list
        });
        let on_support = units.iter().map(|blocks| blocks.iter().any(|&block| of_blocks.on_support[block]));
        let mut upward: Vec<usize> = Vec::new();
        for &block in &of_blocks.upward {
            if !upward.contains(&unit[block]) {
                upward.push(unit[block]);
            }
        }
        Self { neighbours: neighbours.collect(), on_support: on_support.collect(), upward }
    }

    /// Number of movable blocks.
    pub fn blocks(&self) -> usize {
        self.upward.len()
    }

    /// Movable blocks that touch `block`, ascending.
    pub fn neighbours(&self, block: usize) -> &[usize] {
        &self.neighbours[block]
    }

    /// Whether a block touches a sub-assembly or a fixed body. One that touches neither falls freely, so its test would
    /// be a waste.
    pub fn touches(&self, block: usize, set: &BlockSet) -> bool {
        self.on_support[block] || self.neighbours[block].iter().any(|&other| set.contains(other))
    }

    /// The first place of the upward order, from `from` on, whose block is not in a sub-assembly.
    pub fn full(&self, set: &BlockSet, from: usize) -> usize {
        (from..self.blocks()).find(|&place| !set.contains(self.upward[place])).unwrap_or(self.blocks())
    }

    /// The next block, from place `from` of the upward order on, that can be put on a sub-assembly; and its place.
    pub fn candidate(&self, set: &BlockSet, from: usize) -> Option<(usize, usize)> {
        (from..self.blocks())
            .map(|place| (place, self.upward[place]))
            .find(|&(_, block)| !set.contains(block) && self.touches(block, set))
    }
}
