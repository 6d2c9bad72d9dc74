//! How far a search goes, and how far it has come.

/// Effort of a search unless another budget is given: some twenty seconds at 4e8 a second (docs/theory/strong-stability.md).
pub const EFFORT: u64 = 8_000_000_000;

/// What ends a search that has not decided. Counted, never timed: it ends at the same place in every run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Budget {
    /// So many nodes, however long they take.
    Nodes(usize),
    /// So much effort of its linear programs: numbers written and read. A node of a large structure may end within.
    Effort(u64),
}

impl Default for Budget {
    fn default() -> Self {
        Self::Effort(EFFORT)
    }
}

/// How far a search has come.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Searched {
    /// Nodes begun.
    pub nodes: usize,
    /// Effort so far.
    pub effort: u64,
}

impl Budget {
    /// The share that is used.
    pub fn share(self, done: Searched) -> f64 {
        let share = match self {
            Self::Nodes(most) => done.nodes.saturating_sub(1) as f64 / most.max(1) as f64,
            Self::Effort(most) => done.effort as f64 / most.max(1) as f64,
        };
        share.min(1.0)
    }

    /// Effort that is left.
    pub(super) fn effort_left(self, done: Searched) -> usize {
        match self {
            Self::Nodes(_) => usize::MAX,
            Self::Effort(most) => usize::try_from(most.saturating_sub(done.effort)).unwrap_or(usize::MAX),
        }
    }

    /// Whether another node may be looked at.
    pub(super) fn allows_another(self, done: Searched) -> bool {
        match self {
            Self::Nodes(most) => done.nodes < most,
            Self::Effort(most) => done.effort < most,
        }
    }
}

/// Asked at every program whether to go on.
pub type Monitor<'a> = dyn FnMut(Searched) -> bool + 'a;
