//! What cannot be on the way to the whole, in a form that covers many sub-assemblies at once.
//!
//! Call a sub-assembly *lost* if it falls or cannot be grown, block by block, to the whole. A *nogood* (Q, A) says that every
//! sub-assembly with all of Q and none of A is lost. A collapse is one by Lemmas 1 and 4 (`collapse.rs`, `onward.rs`), with any share of the
//! driving blocks that does work against all others as its Q; Lemma 2 (`learned.rs`) makes new ones of those it has.

use super::collapse::Collapse;
use super::touching::Touching;
use crate::formulate::BlockSet;

/// A collapse is carried over while at least this share of its work is left: far above the rounding in it.
const WORK_LEFT: f64 = 1e-3;

/// A set of lost sub-assemblies.
#[derive(Debug)]
pub(crate) struct Nogood {
    /// Blocks with weights. Their sum over a sub-assembly must exceed `least` for it to be lost.
    weights: Vec<(usize, f64)>,
    least: f64,
    /// None of these is in a lost sub-assembly.
    absent: Vec<usize>,
}

/// Why a block cannot come next: every sub-assembly with it, all of `blame` and none of `absent` is lost.
#[derive(Debug, Clone, Default)]
pub(super) struct Reason {
    pub blame: Vec<usize>,
    pub absent: Vec<usize>,
}

impl Reason {
    /// All of these at once.
    pub fn of_all(reasons: impl Iterator<Item = Self>) -> Self {
        let mut all = Self::default();
        for Self { blame, absent } in reasons {
            all.blame.extend(blame);
            all.absent.extend(absent);
        }
        for list in [&mut all.blame, &mut all.absent] {
            list.sort_unstable();
            list.dedup();
        }
        all
    }
}

impl Nogood {
    /// `fallen` falls by `collapse` (Lemma 1, or Lemma 4 if it was carried on).
    pub fn of_collapse(collapse: &Collapse, fallen: &BlockSet, touching: &Touching) -> Self {
        let absent = collapse.props().map_or_else(|| around(collapse, fallen, touching), <[usize]>::to_vec);
        let there = collapse.moving().iter().filter(|(block, _)| fallen.contains(*block));
        let work: f64 = there.map(|(_, work)| work).sum();
        Self { weights: collapse.moving().to_vec(), least: WORK_LEFT * work, absent }
    }

    /// All of `blocks` and none of `absent`.
    pub fn of_sets(blocks: &[usize], absent: Vec<usize>) -> Self {
        let weights: Vec<(usize, f64)> = blocks.iter().map(|&block| (block, 1.0)).collect();
        Self { least: weights.len() as f64 - 0.5, weights, absent }
    }

    /// The blocks whose coming can make a sub-assembly lost.
    pub fn driving(&self) -> impl Iterator<Item = usize> + '_ {
        self.weights.iter().filter(|(_, weight)| *weight > 0.0).map(|(block, _)| *block)
    }

    /// Numbers stored.
    pub fn size(&self) -> usize {
        2 * self.weights.len() + self.absent.len()
    }

    /// Whether it covers a sub-assembly.
    pub fn covers(&self, set: &BlockSet) -> bool {
        let inside = self.weights.iter().filter(|(block, _)| set.contains(*block));
        !self.absent.iter().any(|&block| set.contains(block))
            && inside.map(|(_, weight)| weight).sum::<f64>() > self.least
    }

    /// Why `added` cannot come next on the others of `set`, which this nogood covers. Blame falls on few blocks, and on
    /// such as were put up early: the earlier the last of them, the further the search can step back.
    pub(super) fn reason(&self, added: usize, set: &BlockSet, position: &[usize]) -> Reason {
        let mut absent = self.absent.clone();
        let mut needed = self.least;
        let mut drivers: Vec<(usize, f64)> = Vec::new();
        for &(block, weight) in &self.weights {
            if !set.contains(block) {
                if weight < 0.0 {
                    absent.push(block);
                }
            } else if block == added || weight <= 0.0 {
                needed -= weight;
            } else {
                drivers.push((block, weight));
            }
        }
        drivers.sort_by_key(|&(block, _)| position[block]);
        drivers.truncate(enough(&drivers, needed));
        drivers.sort_by(|a, b| b.1.total_cmp(&a.1).then(position[a.0].cmp(&position[b.0])));
        drivers.truncate(enough(&drivers, needed));
        Reason { blame: drivers.into_iter().map(|(block, _)| block).collect(), absent }
    }
}

/// The blocks outside a sub-assembly that touch a moving one.
fn around(collapse: &Collapse, fallen: &BlockSet, touching: &Touching) -> Vec<usize> {
    let around = collapse.moving().iter().flat_map(|&(block, _)| touching.neighbours(block)).copied();
    let mut absent: Vec<usize> = around.filter(|&block| !fallen.contains(block)).collect();
    absent.sort_unstable();
    absent.dedup();
    absent
}

/// How many of the first blocks weigh more than what is needed; all, if rounding leaves them short.
fn enough(drivers: &[(usize, f64)], needed: f64) -> usize {
    let mut sum = 0.0;
    let taken = drivers.iter().take_while(|(_, weight)| {
        let short = sum <= needed;
        sum += weight;
        short
    });
    taken.count()
}
