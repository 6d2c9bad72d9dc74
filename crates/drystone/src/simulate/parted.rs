//! Blocks that overlap, moved apart.

use super::{
    error::SimulationError,
    integrate::project,
    kinematics::Kinematics,
    options::Options,
    origin::{moved, origin_of},
    state::State,
};
use crate::{contact::candidates::CandidateFinder, scene::SceneOf};

/// Rounds of ten, each of which linearises the overlaps ten times anew. The hardest scene seen needs three.
const MOST: usize = 20;

/// The same scene with overlaps taken back: blocks move apart by the least motion in the metric of their masses, to first order in each
/// of several rounds, as a step does with what its turns leave. Fixed blocks stay. Where nothing overlaps by more than the contact
/// tolerance the scene comes back as it is, to the bit.
///
/// # Errors
/// [`SceneError::Overlap`](crate::SceneError::Overlap) for blocks that cannot part, such as one that is jammed between fixed ones;
/// [`SimulationError::Surface`] for bodies that cannot be moved in a simulation either.
pub fn parted<S: Kinematics>(scene: SceneOf<S>) -> Result<SceneOf<S>, SimulationError> {
    let origin = origin_of(&scene);
    let near = moved(scene.clone(), -1.0, &origin);
    if S::contacts(&near).is_ok() {
        return Ok(scene);
    }
    if let Some(body) = S::immovable(&near) {
        return Err(SimulationError::Surface { body });
    }
    let mut state = State::at_rest(near, Options::default());
    let mut finder = CandidateFinder::default();
    for _ in 0..MOST {
        if project(&mut state, &mut finder).rounds == 0 {
            break;
        }
    }
    S::contacts(&state.scene)?;
    Ok(moved(state.scene, 1.0, &origin))
}
