//! Tests by the interior-point method: where pivots from the sub-assembly before take longer.
//!
//! Rings of a dome are such structures: a voussoir more changes how all the others are held, and a ring that is not closed rests on
//! friction and on one hand. The method's iterations are as many there as anywhere (`nearby.rs`).

use super::collapse::Collapse;
use super::stability::{TestOutcome, Tested, collapse_of};
use super::touching::Touching;
use crate::{
    formulate::Assembly,
    nearby::{self, Nearby, Put},
};
use std::rc::Rc;

/// Forces along all generators, positive where they are known.
pub(super) type Forces = Rc<[f64]>;

/// What was found, and forces that hold it if it stands.
pub(super) struct Answer {
    pub tested: Tested,
    pub forces: Option<Forces>,
}

/// What the interior-point method proves of a sub-assembly, first of the new block and what it touches, then by forces near those
/// of the one before. None if it proves neither that it stands nor that it falls.
pub(super) fn by_interior_point(
    assembly: &Assembly,
    touching: &Touching,
    put: Put<'_>,
    before: Option<&Forces>,
) -> Option<Answer> {
    let falling = |motion| Answer { tested: Tested::falling(collapse_of(assembly, motion)), forces: None };
    if let Some(motion) = nearby::falls_nearby(assembly, &|block| touching.neighbours(block).to_vec(), put) {
        return Some(falling(motion));
    }
    Some(match nearby::solved(assembly, put.blocks, put.held, before.map(|forces| &forces[..]))?.found {
        Nearby::Falls(motion) => falling(motion),
        Nearby::Stands(forces) => {
            let outcome = TestOutcome { stands: true, borderline: false, pivots: 0 };
            Answer { tested: Tested { outcome, collapse: None }, forces: Some(forces.into()) }
        }
    })
}

/// How some blocks fall, those that are held left out, while all others stay where they are.
pub(super) fn falls_among(assembly: &Assembly, touching: &Touching, put: Put<'_>, some: &[usize]) -> Option<Collapse> {
    let motion = nearby::falls_among(assembly, &|block| touching.neighbours(block).to_vec(), put, some)?;
    Some(collapse_of(assembly, motion))
}
