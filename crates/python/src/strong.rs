//! `strong` and its answer.

use crate::{arrays::matrix, contact_forces::ContactForces, errors::scene_error, scene::Scene, watch::Watch};
use drystone::{
    SceneError,
    formulate::Assembly,
    limit::blocks_named,
    strong::{self as core, Budget, Searched, strong as decide},
};
use numpy::PyArray2;
use pyo3::prelude::*;
use std::time::Instant;

/// Whether a structure must stand; see the stub.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Strong {
    must_stand: Option<bool>,
    nodes: usize,
    programs: usize,
    escape: Option<Py<Escape>>,
    seconds: f64,
}

/// How it can leave rest; see the stub.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Escape {
    names: Vec<String>,
    accelerations: Py<PyArray2<f64>>,
    forces: Py<ContactForces>,
    error: f64,
}

impl Escape {
    fn new(py: Python<'_>, assembly: &Assembly, escape: &core::Escape) -> PyResult<Py<Self>> {
        let accelerations = escape.accelerations.iter().map(|(_, a)| a);
        let escape = Self {
            names: escape.accelerations.iter().map(|&(body, _)| assembly.bodies()[body].name.clone()).collect(),
            accelerations: if assembly.in_plane() {
                matrix(py, &accelerations.map(|a| a.in_plane()).collect::<Vec<_>>())?.unbind()
            } else {
                matrix(py, &accelerations.map(|a| a.components()).collect::<Vec<_>>())?.unbind()
            },
            forces: Py::new(py, ContactForces::new(assembly, escape.forces.iter().map(|(_, force)| force)))?,
            error: escape.error,
        };
        Py::new(py, escape)
    }
}

#[pyfunction]
#[pyo3(signature = (scene, blocks=None, nodes=None, progress=None))]
pub fn strong(
    py: Python<'_>,
    scene: &Scene,
    blocks: Option<Vec<String>>,
    nodes: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Strong> {
    let start = Instant::now();
    let budget = nodes.map_or_else(Budget::default, Budget::Nodes);
    let assembly = scene.assembly(py, None)?;
    let set = blocks_named(&assembly, blocks.as_deref()).map_err(|error: SceneError| scene_error(&error))?;
    let mut watch = Watch::new(progress);
    let signals = watch.signals.clone();
    let mut go_on = |done: Searched| watch.go_on(|| (done.nodes, budget.share(done)));
    let found = signals.run(py, || decide(&assembly, &set, budget, &mut go_on)).flatten();
    let Some(found) = found else { return Err(watch.stopped()) };
    Ok(Strong {
        must_stand: found.must_stand,
        nodes: found.nodes,
        programs: found.programs,
        escape: found.escape.as_ref().map(|escape| Escape::new(py, &assembly, escape)).transpose()?,
        seconds: start.elapsed().as_secs_f64(),
    })
}
