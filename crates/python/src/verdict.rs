//! `check` and its answer.

use crate::{arrays::matrix, contact_forces::Forces, errors::scene_error, scene::Scene, watch::interruptible};
use drystone::{
    check::{Route, check_while},
    formulate::{Assembly, FrictionCone},
};
use numpy::PyArray2;
use pyo3::{exceptions::PyValueError, prelude::*};
use std::{
    sync::Arc,
    time::{Duration, Instant},
};

#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Verdict {
    status: String,
    stable: bool,
    forces: Py<Forces>,
    names: Vec<String>,
    accelerations: Py<PyArray2<f64>>,
    falling: Vec<String>,
    pivots: usize,
    major_cycles: usize,
    minor_cycles: usize,
    iterations: usize,
    residual: f64,
    virtual_motion: bool,
    /// Of a borderline verdict: the least imbalance in a block's own load, and the power of the fall as a multiple of
    /// what rounding could make of the forces.
    doubt: Option<(f64, f64)>,
    seconds: f64,
}

impl Verdict {
    /// Of a check with these friction cones.
    pub fn new(
        py: Python<'_>,
        assembly: Arc<Assembly>,
        cone: FrictionCone,
        verdict: drystone::Verdict,
        time: Duration,
    ) -> PyResult<Self> {
        let name = |&index: &usize| assembly.bodies()[index].name.clone();
        let accelerations = verdict.accelerations.iter();
        Ok(Self {
            status: verdict.status.name().to_owned(),
            stable: verdict.stable,
            names: verdict.checked.iter().map(name).collect(),
            accelerations: if assembly.in_plane() {
                matrix(py, &accelerations.map(|a| a.in_plane()).collect::<Vec<_>>())?.unbind()
            } else {
                matrix(py, &accelerations.map(|a| a.components()).collect::<Vec<_>>())?.unbind()
            },
            falling: verdict.falling.iter().map(name).collect(),
            pivots: verdict.counts.pivots,
            major_cycles: verdict.counts.major_cycles,
            minor_cycles: verdict.counts.minor_cycles,
            iterations: verdict.iterations,
            residual: verdict.residual,
            virtual_motion: verdict.virtual_motion,
            doubt: verdict.doubt.map(|doubt| (doubt.imbalance, doubt.power)),
            seconds: time.as_secs_f64(),
            forces: Py::new(py, Forces::new(Arc::clone(&assembly), cone, verdict))?,
        })
    }
}

#[pyfunction]
#[pyo3(signature = (scene, blocks=None, method="equilibrium", cones=None, round_cones=false))]
pub fn check(
    py: Python<'_>,
    scene: &Scene,
    blocks: Option<Vec<String>>,
    method: &str,
    cones: Option<(usize, String)>,
    round_cones: bool,
) -> PyResult<Verdict> {
    let route = match method {
        "equilibrium" => Route::Equilibrium,
        "lcp" => Route::Complementarity,
        "interior" => Route::InteriorPoint,
        other => {
            let message = format!("unknown method \"{other}\": give \"equilibrium\", \"lcp\" or \"interior\"");
            return Err(PyValueError::new_err(message));
        }
    };
    let cone = if round_cones { FrictionCone::Round } else { FrictionCone::Pyramid };
    let start = Instant::now();
    let assembly = Arc::new(scene.assembly(py, cones)?);
    let checked = interruptible(py, || check_while(&assembly, blocks.as_deref(), route, cone, &mut |_| true))?;
    let verdict = checked.map_err(|error| scene_error(&error))?.expect("nobody says stop");
    // The complementarity problem knows pyramids only.
    let cone = if route == Route::Complementarity { FrictionCone::Pyramid } else { cone };
    Verdict::new(py, assembly, cone, verdict, start.elapsed())
}
