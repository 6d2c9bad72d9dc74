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
