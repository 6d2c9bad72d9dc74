//! Where blocks turn.

/// The factor of turned loads (l in `turned.rs`), and what turning costs.
pub(super) struct Turned {
    pub factor: f64,
    pub hinges: Vec<Hinge>,
}

/// A face on which a block can turn, with nothing or fewer blocks between it and what is fixed than with the block.
pub(super) struct Hinge {
    pub block: usize,
    /// What it turns on, if that moves, and how much of the block's turning one of its is, each in its own unit.
    pub below: Option<(usize, f64)>,
    /// The points that part where it turns counter-clockwise, and clockwise.
    pub ends: [usize; 2],
    /// By how much more the first of them parts where the block turns by one.
    pub width: f64,
}
