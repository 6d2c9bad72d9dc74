//! What one solve takes over from those before it: nothing, the motionless part, or all that has not moved.

mod cold;
mod counted_solver;
mod from_motionless;
mod from_previous;
mod start;

pub use start::{NextProblem, SavedStart, WarmStart};

use crate::simulate::{kinematics::Kinematics, options::Reuse};

/// The start of a mode of reuse.
pub fn warm_start<S: Kinematics>(reuse: Reuse) -> Box<dyn WarmStart<S>> {
    match reuse {
        Reuse::None => Box::new(cold::Cold::default()),
        Reuse::Motionless => Box::new(from_motionless::FromMotionless::<S>::default()),
        Reuse::Full => Box::new(from_previous::FromPrevious::default()),
    }
}
