//! The answer.

use super::escape::Escape;

/// Whether a structure must stand.
#[derive(Debug, Clone)]
pub struct Strong {
    /// Whether rest is the only motion; None if the search was not closed within its budget; in space, where nothing
    /// is searched, if the structure needs friction to stand and no other motion was found.
    pub must_stand: Option<bool>,
    /// Another motion, if there is one.
    pub escape: Option<Escape>,
    /// Nodes of the search: cases of what touches, slides and parts that were looked at. The same in every run.
    pub nodes: usize,
    /// Linear programs solved in them.
    pub programs: usize,
}
