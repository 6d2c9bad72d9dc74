//! How a structure falls whose fall only multipliers prove: a virtual motion.

use super::verdict::Verdict;
use crate::{
    equilibrium::{accelerations_along, collapse_motion},
    formulate::{Acceleration, Assembly, BlockSet, Components, FrictionCone},
    judgement::CLOSING,
};
use drystone_lcp::{Status, cone::ConeSolver};

/// The verdict on what an equilibrium solver has found to fall, where the complementarity problem does not tell how: `found`, with
/// the solver's own motion.
pub(super) fn verdict(assembly: &Assembly, blocks: &BlockSet, found: Verdict, equilibrium: &ConeSolver) -> Verdict {
    let accelerations = virtual_motion(assembly, blocks, equilibrium);
    let of = |&body: &usize| {
        let moving = accelerations.iter().find(|(block, _)| assembly.body_index(*block) == body);
        moving.map_or(Acceleration::default(), |&(block, value)| assembly.in_world(block, value))
    };
    Verdict {
        status: Status::Solved,
        stable: false,
        accelerations: found.checked.iter().map(of).collect(),
        falling: accelerations.iter().map(|&(block, _)| assembly.body_index(block)).collect(),
        virtual_motion: true,
        ..found
    }
}

/// The motion that the multipliers are. Columns that depend on the basis but for rounding may close in it by far more, where loads
/// differ by 1e10 and more; then the nearest motion in which nothing closes. Blocks ascending, those at rest left out.
fn virtual_motion(assembly: &Assembly, blocks: &BlockSet, equilibrium: &ConeSolver) -> Vec<(usize, Components)> {
    let collapse = accelerations_along(assembly, &collapse_motion(assembly, equilibrium));
    let closing = closing_share(assembly, blocks, &collapse);
    if closing <= CLOSING {
        return collapse;
    }
    let space = assembly.body_space(blocks, FrictionCone::Pyramid);
    let nearest = accelerations_along(assembly, &space.nearest(&collapse));
    if closing_share(assembly, blocks, &nearest) < closing { nearest } else { collapse }
}

/// How fast generators close in a motion at most, as a share of the fastest point.
fn closing_share(assembly: &Assembly, blocks: &BlockSet, motion: &[(usize, Components)]) -> f64 {
    let opening = |j: usize| assembly.opening(&assembly.generators()[j], motion).0;
    assembly.rows(blocks).into_iter().map(opening).fold(0.0_f64, |closing, opening| closing.max(-opening))
        / assembly.fastest(motion)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::column;

    #[test]
    fn the_nearest_motion_closes_nothing_and_is_the_same_where_nothing_closes() {
        let scene = column(3, 0.5).expect("a scene");
        let assembly = Assembly::new(&scene).expect("nothing overlaps");
        let blocks = BlockSet::full(assembly.blocks());
        let nearest =
            |motion: &[(usize, Components)]| assembly.body_space(&blocks, FrictionCone::Pyramid).nearest(motion);
        let up = [(0, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]), (1, [0.0, 2.0, 0.0, 0.0, 0.0, 0.0])];
        assert_near(&nearest(&up), &up);
        let down = [(0, [0.0, -1.0, 0.0, 0.0, 0.0, 0.0]), (1, [0.0, -2.0, 0.0, 0.0, 0.0, 0.0])];
        assert_near(&nearest(&down), &[(0, [0.0; 6]), (1, [0.0; 6])]);
        // The lower goes down, the upper up: only the lower one is in the way of something.
        let apart = [(0, [0.0, -1.0, 0.0, 0.0, 0.0, 0.0]), (1, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0])];
        assert_near(&nearest(&apart), &[(0, [0.0; 6]), apart[1]]);
    }

    fn assert_near(found: &[(usize, Components)], expected: &[(usize, Components)]) {
        assert_eq!(found.len(), expected.len());
        for ((block, a), (other, b)) in found.iter().zip(expected) {
            assert_eq!(block, other);
            (0..6).for_each(|k| assert!((a[k] - b[k]).abs() < 1e-8, "{block}: {a:?} {b:?}"));
        }
    }
}
