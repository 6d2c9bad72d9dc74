//! `Structure`: a live structure that blocks are put on and taken off.

use crate::{
    errors::{no_answer, no_structure},
    guard::Guarded,
    limit::{Forces, Limit, of_structure},
    scene::Scene,
    verdict::Verdict,
    watch::{briefly, interruptible},
};
use drystone::{Structure as Core, formulate::FrictionCone};
use pyo3::{prelude::*, types::PyBytes};
use std::time::Instant;

/// Blocks are indices among the movable bodies, in the order of `names`.
#[pyclass(frozen, module = "drystone._core")]
pub struct Structure {
    core: Guarded<Core>,
    /// Of the analysis of the complete assembly, once its contacts are known.
    #[pyo3(get)]
    set_up_seconds: f64,
}

impl Structure {
    fn of(core: Core, set_up_seconds: f64) -> Self {
        Self { core: Guarded::new("Structure", core), set_up_seconds }
    }
}

#[pymethods]
impl Structure {
    #[new]
    #[pyo3(signature = (scene, cones=None))]
    fn new(py: Python<'_>, scene: &Scene, cones: Option<(usize, String)>) -> PyResult<Self> {
        let assembly = scene.assembly(py, cones)?;
        let start = Instant::now();
        let core = Core::of(assembly);
        Ok(Self::of(core, start.elapsed().as_secs_f64()))
    }

    fn names(&self) -> PyResult<Vec<String>> {
        let core = self.core.read()?;
        let assembly = core.assembly();
        Ok((0..assembly.blocks()).map(|block| assembly.body(block).name.clone()).collect())
    }

    fn blocks(&self) -> PyResult<Vec<usize>> {
        Ok(self.core.read()?.blocks().iter().collect())
    }

    fn change(&self, removed: Vec<usize>, added: Vec<usize>) -> PyResult<()> {
        change(&mut *self.core.write()?, removed, added);
        Ok(())
    }

    /// Takes blocks off, puts blocks on, and says whether the rest stands: (stands, seconds, pivots). `stands` is
    /// None if that is borderline. The time is of everything that this asks for. If a signal stops it, the blocks are those
    /// from before.
    fn step(&self, py: Python<'_>, removed: Vec<usize>, added: Vec<usize>) -> PyResult<(Option<bool>, f64, usize)> {
        let mut guard = self.core.write()?;
        let core = &mut *guard;
        let start = Instant::now();
        let before = core.counts().pivots;
        let (removed, added) = change(core, removed, added);
        let stands =
            if core.pending() <= FEW { briefly(py, || core.stands()) } else { interruptible(py, || core.stands()) };
        let stands = stands.inspect_err(|_| {
            change(core, added, removed);
        })?;
        if stands.is_none() && !core.is_borderline() {
            return Err(no_answer(core.blocks().len()));
        }
        Ok((stands, start.elapsed().as_secs_f64(), core.counts().pivots - before))
    }

    fn check(&self, py: Python<'_>) -> PyResult<Verdict> {
        let mut guard = self.core.write()?;
        let core = &mut *guard;
        let start = Instant::now();
        let verdict = interruptible(py, || core.check())?;
        Verdict::new(py, core.shared_assembly(), FrictionCone::Pyramid, verdict, start.elapsed())
    }

    /// How much of a push the structure can bear.
    #[pyo3(signature = (scene, forces, gravity=None))]
    fn limit(&self, py: Python<'_>, scene: &Scene, forces: Forces, gravity: Option<Vec<f64>>) -> PyResult<Limit> {
        let mut guard = self.core.write()?;
        of_structure(py, &mut guard, scene, &forces, gravity.as_deref())
    }

    fn pivots(&self) -> PyResult<usize> {
        Ok(self.core.read()?.counts().pivots)
    }

    fn entries(&self) -> PyResult<usize> {
        Ok(self.core.read()?.entries())
    }

    fn copy(&self) -> PyResult<Self> {
        Ok(Self::of(self.core.read()?.clone(), self.set_up_seconds))
    }

    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.core.read()?.to_bytes()))
    }

    /// The structure that `to_bytes` was asked of, on the same scene with the same cones.
    #[staticmethod]
    fn from_bytes(py: Python<'_>, scene: &Scene, cones: Option<(usize, String)>, state: &[u8]) -> PyResult<Self> {
        let core = Core::from_bytes(scene.assembly(py, cones)?, state).map_err(no_structure)?;
        Ok(Self::of(core, 0.0))
    }
}

/// Blocks that came and went of which an answer is mostly short.
const FEW: usize = 8;

/// Takes blocks off and puts blocks on; hands back those that were there, and those that were not.
fn change(core: &mut Core, mut removed: Vec<usize>, mut added: Vec<usize>) -> (Vec<usize>, Vec<usize>) {
    removed.retain(|&block| core.blocks().contains(block));
    removed.iter().for_each(|&block| core.remove(block));
    added.retain(|&block| !core.blocks().contains(block));
    added.iter().for_each(|&block| core.add(block));
    (removed, added)
}
