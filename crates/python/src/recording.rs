//! `Recording`: the stability tests of one search, to put to other methods.

use crate::{errors::plan_error, plan::Callback, scene::Scene, watch::interruptible};
use drystone::{
    formulate::Assembly,
    plan::{
        self as core, ByBlocks, ByLemke, FromScratch, Limits, PlanError, Quiet, Recorder, Reuse, ReuseDantzig,
        StabilityTest, Step,
    },
};
use pyo3::{
    exceptions::{PyKeyboardInterrupt, PyValueError},
    prelude::*,
};
use std::time::Instant;

#[pyclass(frozen, module = "drystone._core")]
pub struct Recording {
    assembly: Assembly,
    steps: Vec<Step>,
}

#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Replay {
    tests: usize,
    pivots: usize,
    wrong: usize,
    unanswered: usize,
    seconds: f64,
}

fn raised(error: PlanError) -> PyErr {
    match error {
        PlanError::Interrupted => PyKeyboardInterrupt::new_err(()),
        other => plan_error(other),
    }
}

#[pymethods]
impl Recording {
    /// `test` is a callable as in `plan`.
    #[new]
    fn new(py: Python<'_>, scene: &Scene, test: Py<PyAny>) -> PyResult<Self> {
        let assembly = scene.assembly(py, None)?;
        let limits = Limits { shortcuts: false, ..Limits::default() };
        let mut test = Recorder::new(Callback { function: test });
        interruptible(py, || core::plan_with(&assembly, &mut test, limits, &mut Quiet))?.map_err(raised)?;
        Ok(Self { assembly, steps: test.into_steps() })
    }

    fn replay(&self, py: Python<'_>, test: &Bound<'_, PyAny>) -> PyResult<Replay> {
        let asked = if test.is_callable() {
            Asked::Python(test.clone().unbind())
        } else {
            Asked::Named(test.extract::<String>()?)
        };
        interruptible(py, || {
            let begun = Instant::now();
            let mut test = asked.test(&self.assembly)?;
            let setup = begun.elapsed();
            let core::Replay { tests, pivots, wrong, unanswered, time } =
                core::replay(&self.steps, test.as_mut()).map_err(raised)?;
            Ok(Replay { tests, pivots, wrong, unanswered, seconds: (setup + time).as_secs_f64() })
        })?
    }
}

/// The test that a replay is for.
enum Asked {
    Named(String),
    Python(Py<PyAny>),
}

impl Asked {
    fn test<'a>(self, assembly: &'a Assembly) -> PyResult<Box<dyn StabilityTest + 'a>> {
        let name = match self {
            Self::Python(function) => return Ok(Box::new(Callback { function })),
            Self::Named(name) => name,
        };
        Ok(match name.as_str() {
            "lcp" => Box::new(FromScratch::new(assembly)),
            "reuse-dantzig" => Box::new(ReuseDantzig::new(assembly)),
            "reuse" => Box::new(Reuse::new(assembly)),
            "block" => Box::new(ByBlocks::new(assembly, false)),
            "reuse-block" => Box::new(ByBlocks::new(assembly, true)),
            "lemke" => Box::new(ByLemke::new(assembly, false)),
            "reuse-lemke" => Box::new(ByLemke::new(assembly, true)),
            other => return Err(PyValueError::new_err(format!("unknown method \"{other}\""))),
        })
    }
}
