//! `Structure`: a live structure that blocks are put on and taken off.

use crate::{errors::no_answer, scene::Scene, verdict::Verdict};
use drystone::Structure as Core;
use pyo3::prelude::*;
use std::time::Instant;

/// Blocks are indices among the movable bodies, in the order of `names`.
#[pyclass(module = "drystone._core")]
pub struct Structure {
    core: Core,
    /// Of the analysis of the complete assembly, once its contacts are known.
    #[pyo3(get)]
    set_up_seconds: f64,
}

#[pymethods]
impl Structure {
    #[new]
    #[pyo3(signature = (scene, cones=None))]
    fn new(py: Python<'_>, scene: &Scene, cones: Option<(usize, String)>) -> PyResult<Self> {
        let assembly = scene.assembly(py, cones)?;
        let start = Instant::now();
        let core = Core::of(assembly);
        Ok(Self { core, set_up_seconds: start.elapsed().as_secs_f64() })
    }

    fn names(&self) -> Vec<String> {
        let assembly = self.core.assembly();
        (0..assembly.blocks()).map(|block| assembly.body(block).name.clone()).collect()
    }

    fn blocks(&self) -> Vec<usize> {
        self.core.blocks().iter().collect()
    }

    fn change(&mut self, removed: Vec<usize>, added: Vec<usize>) {
        removed.into_iter().for_each(|block| self.core.remove(block));
        added.into_iter().for_each(|block| self.core.add(block));
    }

    /// Takes blocks off, puts blocks on, and says whether the rest stands: (stands, seconds, pivots). The time is of
    /// everything that this asks for.
    fn step(&mut self, removed: Vec<usize>, added: Vec<usize>) -> PyResult<(bool, f64, usize)> {
        let start = Instant::now();
        let before = self.core.counts().pivots;
        self.change(removed, added);
        let stands = self.core.stands().ok_or_else(|| no_answer(self.core.blocks().len()))?;
        Ok((stands, start.elapsed().as_secs_f64(), self.core.counts().pivots - before))
    }

    fn check(&mut self, py: Python<'_>) -> PyResult<Verdict> {
        let start = Instant::now();
        let verdict = py.detach(|| self.core.check());
        Verdict::new(py, self.core.assembly(), &verdict, start.elapsed())
    }

    fn pivots(&self) -> usize {
        self.core.counts().pivots
    }

    fn entries(&self) -> usize {
        self.core.entries()
    }
}
