//! Why a sub-assembly falls, and which others fall for the same reason.
//!
//! If no contact forces hold a sub-assembly U, there is a virtual motion y that opens every contact or keeps it closed
//! (`G' v >= 0` with v = -y) and in which the loads do work (`F' v > 0`): Farkas' lemma. Let K be the blocks that move
//! in it, and A those that touch a block of K without being in U.
//!
//! *Lemma 1 (the collapse carries over).* Every sub-assembly T without a block of A in which the loads of K still do work
//! falls. *Proof.* Let the blocks of K in T move as they did in U and the others rest. Every contact of T on a block
//! of K is one of U, for only blocks of A bring others; all other contacts are at rest.

/// A collapse motion: which blocks move, and the work of each one's load.
#[derive(Debug, Clone, PartialEq)]
pub struct Collapse {
    moving: Vec<(usize, f64)>,
    /// Absent blocks that may stop it, if the motion was carried on to the others (Lemma 4).
    props: Option<Vec<usize>>,
}

impl Collapse {
    /// Takes the moving blocks with the work of their loads.
    pub fn new(moving: Vec<(usize, f64)>) -> Self {
        Self { moving, props: None }
    }

    /// Takes a motion of blocks there and not that no absent block but `props` is in the way of (Lemma 4, `plan/onward.rs`).
    pub fn carried_on(moving: Vec<(usize, f64)>, props: Vec<usize>) -> Self {
        Self { moving, props: Some(props) }
    }

    /// The blocks that move, with the work of each one's load.
    pub fn moving(&self) -> &[(usize, f64)] {
        &self.moving
    }

    /// If the motion was carried on to the blocks that were not there: those of them that may stop it.
    pub fn props(&self) -> Option<&[usize]> {
        self.props.as_deref()
    }

    /// The blocks whose loads drive the collapse.
    pub fn driving(&self) -> impl Iterator<Item = usize> + '_ {
        self.moving.iter().filter(|(_, work)| *work > 0.0).map(|(block, _)| *block)
    }
}
