//! Sets of blocks that meet every one of some collapses.
//!
//! A hold stops a collapse if and only if it holds a block that moves in it. What stops all collapses known so far is a
//! *hitting set* of the sets of blocks that move; if the structure still falls then, it does so by a collapse that is new.
//! So the holds under which a structure stands are found by turns of hitting sets and tests: R. Reiter, "A theory of
//! diagnosis from first principles", Artificial Intelligence 32, 1987.

use crate::formulate::BlockSet;

/// The first minimal hitting set of at most `most` blocks that is not among `known`, ascending; blocks that come first in
/// `preference` are chosen first. None if there is no other. What `may` does not allow is left out, with all that has more
/// blocks.
pub(super) fn next_hitting_set(
    family: &[&BlockSet],
    most: usize,
    preference: &[usize],
    known: &[Vec<usize>],
    may: &impl Fn(&[usize]) -> bool,
) -> Option<Vec<usize>> {
    fn extend(
        chosen: &mut Vec<usize>,
        family: &[&BlockSet],
        most: usize,
        preference: &[usize],
        known: &[Vec<usize>],
        may: &impl Fn(&[usize]) -> bool,
    ) -> Option<Vec<usize>> {
        if !may(chosen) {
            return None;
        }
        let Some(missed) = family.iter().find(|set| !chosen.iter().any(|&block| set.contains(block))) else {
            let mut sorted = chosen.clone();
            sorted.sort_unstable();
            return (is_minimal(chosen, family) && !known.contains(&sorted)).then_some(sorted);
        };
        if chosen.len() == most {
            return None;
        }
        for &block in preference.iter().filter(|&&block| missed.contains(block)) {
            chosen.push(block);
            let found = extend(chosen, family, most, preference, known, may);
            chosen.pop();
            if found.is_some() {
                return found;
            }
        }
        None
    }
    extend(&mut Vec::new(), family, most, preference, known, may)
}

/// Whether every block alone meets some set.
fn is_minimal(chosen: &[usize], family: &[&BlockSet]) -> bool {
    let meets = |block: usize, set: &BlockSet| {
        set.contains(block) && !chosen.iter().any(|&other| other != block && set.contains(other))
    };
    chosen.iter().all(|&block| family.iter().any(|set| meets(block, set)))
}

#[cfg(test)]
mod tests {
    use super::next_hitting_set;
    use crate::formulate::BlockSet;

    fn sets(lists: &[&[usize]]) -> Vec<BlockSet> {
        let set = |list: &&[usize]| {
            let mut set = BlockSet::empty(8);
            list.iter().for_each(|&block| set.insert(block));
            set
        };
        lists.iter().map(set).collect()
    }

    fn all(family: &[BlockSet], most: usize) -> Vec<Vec<usize>> {
        all_that(family, most, |_| true)
    }

    fn all_that(family: &[BlockSet], most: usize, may: impl Fn(&[usize]) -> bool) -> Vec<Vec<usize>> {
        let (mut known, family) = (Vec::new(), family.iter().collect::<Vec<_>>());
        while let Some(set) = next_hitting_set(&family, most, &[7, 6, 5, 4, 3, 2, 1, 0], &known, &may) {
            known.push(set);
        }
        known
    }

    #[test]
    fn they_are_those_that_brute_force_finds() {
        let family = sets(&[&[0, 1, 2], &[2, 3], &[1, 3, 4], &[0, 4, 5]]);
        for most in 0..=4 {
            let hits = |mask: usize| family.iter().all(|set| set.iter().any(|block| mask >> block & 1 == 1));
            let minimal = |mask: usize| (0..8).all(|block| mask >> block & 1 == 0 || !hits(mask & !(1 << block)));
            let expected: Vec<Vec<usize>> = (0..1usize << 8)
                .filter(|&mask| mask.count_ones() as usize <= most && hits(mask) && minimal(mask))
                .map(|mask| (0..8).filter(|block| mask >> block & 1 == 1).collect())
                .collect();
            let mut found = all(&family, most);
            found.sort();
            let mut expected = expected;
            expected.sort();
            assert_eq!(found, expected, "of at most {most}");
        }
    }

    #[test]
    fn what_is_not_allowed_is_left_out_and_nothing_else() {
        let family = sets(&[&[0, 1, 2], &[2, 3], &[1, 3, 4], &[0, 4, 5]]);
        let may = |chosen: &[usize]| chosen.iter().filter(|&&block| block > 2).count() <= 1;
        let mut expected = all(&family, 3);
        expected.retain(|set| may(set));
        let mut found = all_that(&family, 3, may);
        expected.sort();
        found.sort();
        assert!(!found.is_empty() && found.len() < all(&family, 3).len());
        assert_eq!(found, expected);
    }

    #[test]
    fn the_preferred_block_comes_first_and_nothing_hits_an_empty_set() {
        assert_eq!(all(&sets(&[&[0, 3], &[0, 3, 5]]), 1), [[3], [0]]);
        assert!(all(&sets(&[&[0], &[]]), 3).is_empty());
        assert_eq!(all(&[], 0), [Vec::<usize>::new()]);
    }
}
