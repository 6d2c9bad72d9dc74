//! How near to Coulomb's law a step by pivots is solved.

/// What is aimed at: a contact that bears parts, or one that does not closes beyond its gap, at no more than this speed, m/s.
/// Speeds above 1 m/s are known to a share of themselves, so there it is this share.
pub const FRICTION_TOLERANCE: f64 = 1e-10;

/// What is accepted after `PATIENCE` solves: where many contacts are about to slide, rounding is felt before
/// [`FRICTION_TOLERANCE`] is reached. A contact that parts at this speed has opened by a nanometre after a second.
pub const FRICTION_ACCEPTED: f64 = 1e-9;

/// Solves with the tighter tolerance. Scenes that settle take one or two, sliding blocks three to six.
const PATIENCE: usize = 12;

/// Solves in one step at most. Where contacts change between sliding and sticking in turns the iteration may not
/// converge; with full reuse Newton's method goes on from its best iterate, which lets nothing through and loses energy. With the other modes, or
/// where that fails too, the step is made with it, and says how far it is off.
pub(super) const MOST_SOLVES: usize = 60;

/// The same with full reuse. Measured on dominoes that fall: of steps that are not solved so far one in eight is by the sixtieth.
pub(super) const BEFORE_NEWTON: usize = 24;

/// Whether an error of Coulomb's law (m/s) may stand after so many solves, where bodies move at `speed`.
pub(super) fn acceptable(error: f64, solves: usize, speed: f64) -> bool {
    let tolerance = if solves <= PATIENCE { FRICTION_TOLERANCE } else { FRICTION_ACCEPTED };
    error <= tolerance * speed.max(1.0)
}
