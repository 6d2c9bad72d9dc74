//! The ratio test: how far the driving variable can go, and what stops it.

/// What blocks a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Blocker {
    /// `w` of the driving row reaches zero: the major cycle ends.
    Driving,
    /// `z` of an active row reaches zero: it leaves.
    Leaves(usize),
    /// `w` of a considered row reaches zero: it enters.
    Enters(usize),
}

/// A quantity that falls towards zero along the direction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Candidate {
    pub blocker: Blocker,
    /// Its value now, not negative.
    pub value: f64,
    /// How fast it falls, positive.
    pub rate: f64,
}

impl Candidate {
    fn ratio(&self) -> f64 {
        self.value / self.rate
    }

    fn index(&self) -> usize {
        match self.blocker {
            Blocker::Driving => 0,
            Blocker::Leaves(i) | Blocker::Enters(i) => i,
        }
    }
}

/// How ties are broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TieRule {
    /// The largest rate among those that block within `slack`: accurate, but it may cycle.
    LargestRate,
    /// The least index among exact ties: never cycles for sufficient matrices, which contain the positive
    /// semidefinite ones (Cottle and Chang, Least-index resolution of degeneracy in LCPs with sufficient
    /// matrices, 1992). The driving row comes first, because it ends the major cycle.
    LeastIndex,
}

/// The candidate that stops the step, and the length of the step (not negative). `slack` is how far below zero a
/// quantity may go so that a better pivot can be taken (Harris 1973).
pub(crate) fn ratio_test(candidates: &[Candidate], slack: f64, rule: TieRule) -> Option<(f64, Blocker)> {
    let slack = if rule == TieRule::LeastIndex { 0.0 } else { slack };
    let bound = candidates.iter().map(|c| (c.value + slack) / c.rate).reduce(f64::min)?;
    let within = || candidates.iter().filter(|c| c.ratio() <= bound);
    let chosen = within().find(|c| c.blocker == Blocker::Driving).or_else(|| match rule {
        TieRule::LeastIndex => within().min_by_key(|c| c.index()),
        TieRule::LargestRate => within().max_by(|a, b| a.rate.total_cmp(&b.rate).then(b.index().cmp(&a.index()))),
    })?;
    Some((chosen.ratio(), chosen.blocker))
}

#[cfg(test)]
mod tests {
    use super::{Blocker, Candidate, TieRule, ratio_test};

    fn candidate(blocker: Blocker, value: f64, rate: f64) -> Candidate {
        Candidate { blocker, value, rate }
    }

    #[test]
    fn nothing_falling_blocks_nothing() {
        assert_eq!(ratio_test(&[], 1e-12, TieRule::LargestRate), None);
    }

    #[test]
    fn the_first_to_reach_zero_blocks() {
        let candidates = [candidate(Blocker::Leaves(0), 3.0, 1.0), candidate(Blocker::Enters(1), 4.0, 2.0)];
        for rule in [TieRule::LargestRate, TieRule::LeastIndex] {
            assert_eq!(ratio_test(&candidates, 1e-12, rule), Some((2.0, Blocker::Enters(1))));
        }
    }

    #[test]
    fn ties_go_by_rate_or_by_index_and_to_the_driving_row_first() {
        let (late, early) = (candidate(Blocker::Enters(7), 2.0, 2.0), candidate(Blocker::Leaves(3), 1.0, 1.0));
        assert_eq!(ratio_test(&[early, late], 0.0, TieRule::LargestRate), Some((1.0, Blocker::Enters(7))));
        assert_eq!(ratio_test(&[late, early], 0.0, TieRule::LeastIndex), Some((1.0, Blocker::Leaves(3))));
        let driving = candidate(Blocker::Driving, 0.5, 0.5);
        for rule in [TieRule::LargestRate, TieRule::LeastIndex] {
            assert_eq!(ratio_test(&[early, late, driving], 0.0, rule), Some((1.0, Blocker::Driving)));
        }
    }

    /// Within the slack the better pivot is taken; the least-index rule knows no slack.
    #[test]
    fn a_tiny_rate_yields_to_a_large_one_within_the_slack() {
        let candidates = [candidate(Blocker::Leaves(0), 0.0, 1e-9), candidate(Blocker::Leaves(1), 1e-13, 1.0)];
        assert_eq!(ratio_test(&candidates, 1e-12, TieRule::LargestRate), Some((1e-13, Blocker::Leaves(1))));
        assert_eq!(ratio_test(&candidates, 1e-12, TieRule::LeastIndex), Some((0.0, Blocker::Leaves(0))));
    }
}
