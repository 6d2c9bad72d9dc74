//! What comes back.

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The error of Coulomb's law is at most the tolerance.
    Solved,
    /// It is not, after as many sweeps and Newton steps as the settings allow. The answer is the best that was found.
    Limit,
}

impl Status {
    /// As users of other languages write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solved => "solved",
            Self::Limit => "limit",
        }
    }
}

/// Work done: exact, the same on every machine.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Groups of bodies that contacts connect, which are solved one by one.
    pub islands: usize,
    /// Sweeps; of the island that took most.
    pub sweeps: usize,
    /// Solves of one contact.
    pub local_solves: usize,
    /// Matrices factored, or updated where one contact changed what it does.
    pub newton_steps: usize,
}

/// Impulses and velocities.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Contact after contact, along its normal and its tangents, on the second body: N s.
    pub impulses: Vec<f64>,
    /// At the end of the step, in the order of `free`: m/s, rad/s.
    pub velocities: Vec<f64>,
    /// Largest error of Coulomb's law over the contacts, m/s.
    pub error: f64,
    /// What it was compared with, m/s.
    pub tolerance: f64,
    /// How it ended.
    pub status: Status,
    /// Work done.
    pub counts: Counts,
}
