//! A structure as bytes, and back: what goes on from them goes on bit for bit, the basis and its factor included.

use super::{History, Structure, hard::Hard};
use crate::formulate::{Assembly, BlockSet};
use drystone_lcp::{
    Counts,
    cone::ConeSolver,
    sealed::{Seal, SealError},
};
use serde::{Deserialize, Serialize};

const SEAL: Seal = Seal { kind: *b"DS-STRUC", version: 4 };

/// All but the assembly, which its scene gives again.
#[derive(Serialize, Deserialize)]
struct State {
    blocks: BlockSet,
    solver: ConeSolver,
    new: Vec<usize>,
    gone: Vec<usize>,
    history: History,
    hard: Option<Hard>,
    fell: bool,
    earlier: Counts,
}

impl Structure {
    /// The state, to go on from with [`Self::from_bytes`] and the same assembly.
    pub fn to_bytes(&self) -> Vec<u8> {
        let Self { blocks, solver, new, gone, history, hard, fell, earlier, .. } = self.clone();
        SEAL.close(&State { blocks, solver, new, gone, history, hard, fell, earlier })
    }

    /// The structure again. The bytes are trusted once their checksum is right.
    ///
    /// # Errors
    /// [`SealError`] for anything but what [`Self::to_bytes`] gave for a structure of this assembly.
    pub fn from_bytes(assembly: Assembly, bytes: &[u8]) -> Result<Self, SealError> {
        let State { blocks, solver, new, gone, history, hard, fell, earlier } = SEAL.open(bytes)?;
        let fresh = Self::of(assembly);
        let size = fresh.assembly.blocks();
        let known = |block: &usize| *block < size;
        let same = solver.same_problem(&fresh.solver)
            && blocks.fits(size)
            && new.iter().chain(&gone).all(known)
            && history.blocks().all(|block| known(&block))
            && hard.as_ref().is_none_or(|hard| hard.fits(&fresh.assembly));
        if !same {
            return Err(SealError::Content("it is one of another scene".into()));
        }
        Ok(Self { blocks, solver, new, gone, history, hard, fell, earlier, ..fresh })
    }
}
