//! What an answer must be, and how long it is looked for.

/// Tolerances and limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Largest error of Coulomb's law that counts as solved, m/s. None: `relative_tolerance` times the largest relative velocity
    /// that the contacts would have without impulses, or times `scale` if that is larger.
    pub tolerance: Option<f64>,
    /// See `tolerance`.
    pub relative_tolerance: f64,
    /// A speed that the caller thinks of as one, m/s: what gravity gives in a step, say.
    pub scale: f64,
    /// Most Newton steps in one island; in the plane also half of the changes of contacts on the way through all that they may do.
    pub newton_steps: usize,
    /// In the plane: most changes, for each contact of an island, on Lemke's way from nothing, which is taken where all else fails. None are allowed
    /// where a good answer soon is worth more than the exact one.
    pub changes: usize,
    /// That way is taken where the error is above so many tolerances.
    pub from_nothing: f64,
}

/// Walls that were hit and heaps of 800 boxes took one to ten, walls that were hit hard up to fifty.
const CHANGES: usize = 60;

/// A tenth of the digits of a double are lost in a well scaled problem, and as many again where friction decides: this
/// leaves four.
pub const RELATIVE_TOLERANCE: f64 = 1e-8;

/// A greater coefficient of friction counts as this one: nothing slides where its impulse leans by up to 89.4 degrees from the normal.
/// The error of Coulomb's law sees a contact that closes at `u_n` while it slides only as `u_n / mu`: with 1e6 a hundredth of the speed
/// passed for solved.
pub const MOST_FRICTION: f64 = 100.0;

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: None,
            relative_tolerance: RELATIVE_TOLERANCE,
            scale: 0.0,
            newton_steps: 400,
            changes: CHANGES,
            from_nothing: 1.0,
        }
    }
}
