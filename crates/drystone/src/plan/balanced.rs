//! The sequence that keeps away from every collapse known.
//!
//! A collapse that nothing props is a balance `sum W_b <= 0` that every structure must keep (Lemma 4, `onward.rs`), W being
//! the work of the blocks' loads in it. Loads with W > 0 drive it, those with W < 0 are the counterweights. What a
//! structure T may still take is its slack `s_k(T) = -sum W_kb`. The complete assembly keeps all balances, and so it does with
//! any share of its weight, by which a structure could grow from nothing to the whole. An order is such a way in steps of
//! whole blocks. To stay inside, the block comes next that raises the least, or lowers the most,
//!
//! ```text
//! phi(T) = - sum over k of log(EPSILON + s_k(T)),    by    d phi = sum over k of W_kb / (EPSILON + s_k(T))
//! ```
//!
//! the barrier of an interior-point method (Boyd and Vandenberghe, Convex Optimization, 2004, section 11.2). So counterweights come
//! early, and what leans on them no sooner than need be.
//!
//! The first choices are made knowing nothing, and a search that goes depth first comes back to them last. So it begins
//! anew from time to time, with all it has learned (Gomes, Selman and Kautz, Boosting combinatorial search through
//! randomization, 1998; here nothing is random).

use super::candidates::Candidates;
use super::collapse::Collapse;
use super::touching::Touching;
use crate::formulate::BlockSet;

/// Of a balance's drivers, in their sum: slack that makes a balance half as urgent as none. 0.005 and 0.1 serve as well.
const EPSILON: f64 = 0.02;

/// Most balances kept to choose by; the memory of the search learns from later ones as well.
const MOST: usize = 4096;

/// Steps back until the search first begins anew, and how many times more of them until the next time.
const FIRST: usize = 3;
const GROWTH: f64 = 1.5;

#[derive(Debug)]
pub(super) struct Balanced<'a> {
    touching: &'a Touching,
    /// Sum of each balance over the current sub-assembly: minus its slack.
    sums: Vec<f64>,
    /// For each block the balances that it is in, with its work; drivers of a balance are one in all.
    balances: Vec<Vec<(usize, f64)>>,
    /// What each sub-assembly on the way has tried.
    tried: Vec<Vec<usize>>,
    steps_back: usize,
    allowed: usize,
}

impl<'a> Balanced<'a> {
    pub fn new(touching: &'a Touching) -> Self {
        Self {
            touching,
            sums: Vec::new(),
            balances: vec![Vec::new(); touching.blocks()],
            tried: vec![Vec::new()],
            steps_back: 0,
            allowed: FIRST,
        }
    }

    fn shift(&mut self, block: usize, sign: f64) {
        self.balances[block].iter().for_each(|&(k, work)| self.sums[k] += sign * work);
    }

    /// What a block adds to the barrier.
    fn rise(&self, block: usize) -> f64 {
        self.balances[block].iter().map(|&(k, work)| work / (EPSILON - self.sums[k].min(0.0))).sum()
    }
}

impl Candidates for Balanced<'_> {
    fn next(&mut self, current: &BlockSet) -> Option<usize> {
        let tried = self.tried.last()?;
        let (mut best, mut from): (Option<(f64, usize)>, usize) = (None, 0);
        while let Some((place, block)) = self.touching.candidate(current, from) {
            from = place + 1;
            if tried.contains(&block) {
                continue;
            }
            let rise = self.rise(block);
            if best.is_none_or(|(least, _)| rise < least) {
                best = Some((rise, block));
            }
        }
        let (_, block) = best?;
        self.tried.last_mut()?.push(block);
        Some(block)
    }

    fn put_back(&mut self) {
        self.tried.iter_mut().last().and_then(Vec::pop);
    }

    fn came(&mut self, block: usize) {
        self.shift(block, 1.0);
        self.tried.push(Vec::new());
    }

    fn went(&mut self, keep: usize, gone: &[usize]) {
        gone.iter().for_each(|&block| self.shift(block, -1.0));
        if keep == 0 {
            self.sums.fill(0.0); // without what rounding has left
        }
        self.tried.truncate(keep + 1);
    }

    fn fell(&mut self, fallen: &BlockSet, added: usize, collapse: &Collapse) {
        if collapse.props() != Some(&[]) || self.sums.len() == MOST {
            return;
        }
        let drivers: f64 = collapse.moving().iter().map(|(_, work)| work.max(0.0)).sum();
        let mut sum = 0.0;
        for &(block, work) in collapse.moving() {
            self.balances[block].push((self.sums.len(), work / drivers));
            if block != added && fallen.contains(block) {
                sum += work / drivers;
            }
        }
        self.sums.push(sum);
    }

    fn begins_anew(&mut self) -> bool {
        self.steps_back += 1;
        let anew = self.steps_back >= self.allowed;
        if anew {
            self.steps_back = 0;
            self.allowed = (GROWTH * self.allowed as f64) as usize + 1;
            self.tried = vec![Vec::new(); self.tried.len()];
        }
        anew
    }
}
