//! Which holds to take on the way: as few as possible.
//!
//! Every structure on the way stands under each of its minimal holds, and under whatever holds more. A hold that is kept, even
//! where it is not needed, saves taking it anew. The ways through the structures are followed all at once, and of
//! those that come to the same hold the one with the fewest is kept: the shortest path, as long as there are not more
//! holds on the way than are followed. At the end every hold is let go after the last structure that needs it.

use super::holding::hands_needed;
use std::collections::HashMap;

/// Most holds followed from one structure to the next.
const MOST: usize = 256;

/// A hold of one structure, and how it was come by.
#[derive(Debug, Clone)]
struct Held {
    /// What has to be held here, and that together with what is kept; ascending.
    needed: Vec<usize>,
    all: Vec<usize>,
    /// Blocks taken hold of so far.
    grips: usize,
    /// Place in the structure before.
    from: usize,
}

/// For every structure on the way, given by the block put up and its minimal holds, the blocks held. The last structure,
/// the `way`'s end, may be the complete one.
pub(super) fn fewest_grips<'a>(way: impl Iterator<Item = (usize, &'a [Vec<usize>])>, hands: usize) -> Vec<Vec<usize>> {
    let mut steps: Vec<Vec<Held>> = vec![vec![Held { needed: Vec::new(), all: Vec::new(), grips: 0, from: 0 }]];
    for (added, holds) in way {
        let before = &steps[steps.len() - 1];
        let mut best: HashMap<(Vec<usize>, Vec<usize>), Held> = HashMap::new();
        for (from, held) in before.iter().enumerate() {
            let followers = holds.iter().flat_map(|needed| followers(held, needed, added, hands));
            for (needed, all) in followers {
                let new = all.iter().filter(|block| !held.all.contains(block)).count();
                let next = Held { needed, all, grips: held.grips + new, from };
                let known = best.entry((next.all.clone(), next.needed.clone())).or_insert_with(|| next.clone());
                if next.grips < known.grips {
                    *known = next;
                }
            }
        }
        let mut next: Vec<Held> = best.into_values().collect();
        next.sort_by(|a, b| (a.grips, &a.needed, &a.all).cmp(&(b.grips, &b.needed, &b.all)));
        next.truncate(MOST);
        steps.push(next);
    }
    let mut chosen = Vec::new();
    let mut place = 0;
    for step in steps.iter().skip(1).rev() {
        let held = &step[place];
        chosen.push(held);
        place = held.from;
    }
    let mut later: Vec<usize> = Vec::new();
    let mut holds: Vec<Vec<usize>> = chosen
        .into_iter()
        .map(|held| {
            let wanted = |block: &&usize| held.needed.contains(block) || later.contains(block);
            later = held.all.iter().filter(wanted).copied().collect();
            later.clone()
        })
        .collect();
    holds.reverse();
    holds
}

/// The ways to come to hold `needed` when `added` is put up: with as much kept of what was held as the hands allow.
fn followers(held: &Held, needed: &[usize], added: usize, hands: usize) -> Vec<(Vec<usize>, Vec<usize>)> {
    let idle: Vec<usize> = held.all.iter().filter(|block| !needed.contains(block)).copied().collect();
    let fitting = |mask: &usize| {
        let mut all: Vec<usize> = needed.to_vec();
        all.extend(idle.iter().enumerate().filter(|(k, _)| mask >> k & 1 == 1).map(|(_, &block)| block));
        all.sort_unstable();
        let fits = all.len() <= hands && hands_needed(&held.needed, &all, added) <= hands;
        fits.then_some((*mask, all))
    };
    let fitting: Vec<(usize, Vec<usize>)> = (0..1usize << idle.len()).filter_map(|mask| fitting(&mask)).collect();
    let largest = |mask: usize| !fitting.iter().any(|&(other, _)| other != mask && other & mask == mask);
    fitting.iter().filter(|(mask, _)| largest(*mask)).map(|(_, all)| (needed.to_vec(), all.clone())).collect()
}

#[cfg(test)]
mod tests {
    use super::fewest_grips;

    fn of(way: &[(usize, &[&[usize]])], hands: usize) -> Vec<Vec<usize>> {
        let way: Vec<(usize, Vec<Vec<usize>>)> =
            way.iter().map(|(added, holds)| (*added, holds.iter().map(|hold| hold.to_vec()).collect())).collect();
        fewest_grips(way.iter().map(|(added, holds)| (*added, holds.as_slice())), hands)
    }

    #[test]
    fn the_hold_that_serves_longest_is_taken() {
        let way: &[(usize, &[&[usize]])] = &[(0, &[&[]]), (1, &[&[1], &[0]]), (2, &[&[2], &[0]]), (3, &[&[]])];
        assert_eq!(of(way, 1), [vec![], vec![0], vec![0], vec![]]);
    }

    #[test]
    fn a_hold_is_kept_where_it_is_needed_again_and_let_go_where_it_is_not() {
        let way: &[(usize, &[&[usize]])] =
            &[(0, &[&[0]]), (1, &[&[]]), (2, &[&[]]), (3, &[&[0]]), (4, &[&[]]), (5, &[&[]])];
        assert_eq!(of(way, 1), [vec![0], vec![0], vec![0], vec![0], vec![], vec![]]);
    }

    #[test]
    fn a_hand_that_is_needed_elsewhere_lets_go() {
        let way: &[(usize, &[&[usize]])] = &[(0, &[&[0]]), (1, &[&[]]), (2, &[&[2]]), (3, &[&[0]]), (4, &[&[]])];
        assert_eq!(of(&way[..3], 1), [vec![0], vec![], vec![2]]);
        assert_eq!(of(way, 2), [vec![0], vec![0], vec![0, 2], vec![0], vec![]]);
    }
}
