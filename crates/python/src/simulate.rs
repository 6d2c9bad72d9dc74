//! `World` and `Run`: bodies in motion, one step or many.

use crate::{
    errors::{simulation_error, step_error},
    scene::{Scene, options},
    verdict::ContactForce,
};
use drystone::simulate::{self as core, Ending, Formulation, Inconsistent, Options, Reuse, StepRecord as CoreRecord};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::{
    exceptions::{PyKeyboardInterrupt, PyValueError},
    prelude::*,
    types::PyBytes,
};
use std::time::{Duration, Instant};

#[pyclass(module = "drystone._core")]
pub struct World {
    core: core::World,
}

/// What one step did.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct StepRecord {
    motionless: Py<PyArray1<bool>>,
    pivots: usize,
    major_cycles: usize,
    minor_cycles: usize,
    solves: usize,
    rows: usize,
    rows_reused: usize,
    solve_seconds: f64,
    seconds: f64,
    residual: f64,
    friction_error: f64,
    penetration: f64,
    projections: usize,
    collisions: usize,
    fallback: Option<&'static str>,
    /// Names of the two bodies, and what meets.
    inconsistent: Option<(String, String, String)>,
}

/// The records of a run as arrays, one entry a step; places and velocities have one more, the beginning.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Run {
    status: String,
    reason: Option<String>,
    poses: Py<PyArray3<f64>>,
    velocities: Py<PyArray3<f64>>,
    motionless: Py<PyArray2<bool>>,
    pivots: Py<PyArray1<i64>>,
    major_cycles: Py<PyArray1<i64>>,
    minor_cycles: Py<PyArray1<i64>>,
    solves: Py<PyArray1<i64>>,
    rows: Py<PyArray1<i64>>,
    rows_reused: Py<PyArray1<i64>>,
    projections: Py<PyArray1<i64>>,
    collisions: Py<PyArray1<i64>>,
    /// Indices of the two bodies where no forces were found; -1 elsewhere.
    inconsistent: Py<PyArray2<i64>>,
    solve_seconds: Py<PyArray1<f64>>,
    step_seconds: Py<PyArray1<f64>>,
    residual: Py<PyArray1<f64>>,
    friction_error: Py<PyArray1<f64>>,
    penetration: Py<PyArray1<f64>>,
    /// Forces, if they were asked for: those of step k are the rows force_starts[k] to force_starts[k + 1].
    force_starts: Py<PyArray1<i64>>,
    force_bodies: Py<PyArray2<i64>>,
    force_points: Py<PyArray2<f64>>,
    forces: Py<PyArray2<f64>>,
}

fn named_reuse(name: &str) -> PyResult<Reuse> {
    match name {
        "none" => Ok(Reuse::None),
        "motionless" => Ok(Reuse::Motionless),
        "full" => Ok(Reuse::Full),
        other => {
            Err(PyValueError::new_err(format!("unknown reuse \"{other}\": give \"full\", \"motionless\" or \"none\"")))
        }
    }
}

fn named_formulation(name: &str) -> PyResult<Formulation> {
    match name {
        "velocity" => Ok(Formulation::Velocity),
        "acceleration" => Ok(Formulation::Acceleration),
        other => Err(PyValueError::new_err(format!(
            "unknown formulation \"{other}\": give \"velocity\" or \"acceleration\""
        ))),
    }
}

fn raised<T>(result: Result<T, core::SimulationError>) -> PyResult<T> {
    result.map_err(|error| simulation_error(&error))
}

#[pymethods]
impl World {
    #[new]
    fn new(scene: &Scene, dt: f64, reuse: &str, restitution: f64, formulation: &str) -> PyResult<Self> {
        let (reuse, formulation) = (named_reuse(reuse)?, named_formulation(formulation)?);
        let options = Options { dt, reuse, restitution, formulation };
        Ok(Self { core: raised(core::World::new(scene.planar()?, options))? })
    }

    fn step(&mut self, py: Python<'_>) -> PyResult<StepRecord> {
        let core = &mut self.core;
        let record = py.detach(|| core.step()).map_err(|failure| step_error(&failure))?;
        Ok(StepRecord::new(py, record, core.scene().bodies()))
    }

    /// Makes steps; `progress` is called with (steps made, steps in all) a few times a second.
    #[pyo3(signature = (steps, forces=false, progress=None))]
    fn run(&mut self, py: Python<'_>, steps: usize, forces: bool, progress: Option<Py<PyAny>>) -> PyResult<Run> {
        let mut watch = Watch { progress, last: Instant::now(), error: None };
        let core = &mut self.core;
        let run = py.detach(|| core::run(core, steps, forces, |made| watch.go_on(made, steps)));
        match watch.error {
            Some(error) => Err(error),
            None => Run::new(py, &run, self.core.options().dt, self.core.scene().bodies().len()),
        }
    }

    #[getter]
    fn scene(&self) -> Scene {
        Scene { core: self.core.scene().clone().into() }
    }

    #[getter]
    fn names(&self) -> Vec<String> {
        self.core.scene().bodies().iter().map(|body| body.name.clone()).collect()
    }

    #[getter]
    fn dt(&self) -> f64 {
        self.core.options().dt
    }

    #[getter]
    fn reuse(&self) -> &'static str {
        self.core.options().reuse.name()
    }

    #[getter]
    fn restitution(&self) -> f64 {
        self.core.options().restitution
    }

    #[getter]
    fn formulation(&self) -> &'static str {
        self.core.options().formulation.name()
    }

    #[getter]
    fn steps(&self) -> u64 {
        self.core.steps()
    }

    #[getter]
    fn energy(&self) -> f64 {
        self.core.energy()
    }

    #[getter]
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        crate::arrays::matrix(py, &self.core.poses().collect::<Vec<_>>())
    }

    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        crate::arrays::matrix(py, self.core.velocities())
    }

    #[getter]
    fn motionless<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        crate::arrays::vector(py, self.core.motionless().to_vec())
    }

    /// Mean forces of the last step at the contacts that bear.
    fn forces(&self) -> Vec<ContactForce> {
        let dt = self.core.options().dt;
        let bodies = self.core.scene().bodies();
        let bearing = self.core.contact_impulses().into_iter().filter(|contact| contact.along_normal > 0.0);
        bearing.map(|contact| ContactForce::of_impulse(bodies, &contact, dt)).collect()
    }

    fn set_velocity(&mut self, name: &str, velocity: [f64; 3]) -> PyResult<()> {
        raised(self.core.set_velocity(name, velocity))
    }

    #[pyo3(signature = (name, force, at=None, moment=0.0))]
    fn apply_force(&mut self, name: &str, force: [f64; 2], at: Option<[f64; 2]>, moment: f64) -> PyResult<()> {
        raised(self.core.apply_force(name, force, at, moment))
    }

    #[pyo3(signature = (name, impulse, at=None, moment=0.0))]
    fn apply_impulse(&mut self, name: &str, impulse: [f64; 2], at: Option<[f64; 2]>, moment: f64) -> PyResult<()> {
        raised(self.core.apply_impulse(name, impulse, at, moment))
    }

    #[allow(clippy::too_many_arguments)]
    fn add_box(
        &mut self,
        center: [f64; 2],
        size: [f64; 2],
        angle: f64,
        name: Option<String>,
        density: f64,
        friction: Option<f64>,
        fixed: bool,
    ) -> PyResult<String> {
        let index = raised(self.core.add_box(center, size, angle, options(name, density, friction, fixed)))?;
        Ok(self.core.scene().bodies()[index].name.clone())
    }

    fn add_polygon(
        &mut self,
        vertices: Vec<[f64; 2]>,
        name: Option<String>,
        density: f64,
        friction: Option<f64>,
        fixed: bool,
    ) -> PyResult<String> {
        let index = raised(self.core.add_polygon(&vertices, options(name, density, friction, fixed)))?;
        Ok(self.core.scene().bodies()[index].name.clone())
    }

    fn remove(&mut self, name: &str) -> PyResult<()> {
        raised(self.core.remove(name))
    }

    fn snapshot<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.core.snapshot())
    }

    #[staticmethod]
    fn restore(snapshot: &[u8]) -> PyResult<Self> {
        Ok(Self { core: raised(core::World::restore(snapshot))? })
    }

    fn state_hash(&self) -> u64 {
        self.core.hash()
    }
}

impl StepRecord {
    fn new(py: Python<'_>, record: CoreRecord, bodies: &[drystone::Body]) -> Self {
        let place = |Inconsistent { contact, .. }: Inconsistent| {
            let [a, b] = contact.bodies.map(|body| bodies[body].name.clone());
            (a, b, contact.feature.to_string())
        };
        Self {
            motionless: crate::arrays::vector(py, record.motionless).unbind(),
            pivots: record.counts.pivots,
            major_cycles: record.counts.major_cycles,
            minor_cycles: record.counts.minor_cycles,
            solves: record.solves,
            rows: record.rows,
            rows_reused: record.rows_reused,
            solve_seconds: record.solve_time.as_secs_f64(),
            seconds: record.time.as_secs_f64(),
            residual: record.residual,
            friction_error: record.friction_error,
            penetration: record.penetration,
            projections: record.projections,
            collisions: record.collisions,
            fallback: record.inconsistent.map(|found| found.status),
            inconsistent: record.inconsistent.map(place),
        }
    }
}

impl Run {
    fn new(py: Python<'_>, run: &core::Run, dt: f64, bodies: usize) -> PyResult<Self> {
        let numbers = |of: &dyn Fn(&CoreRecord) -> f64| {
            PyArray1::from_iter(py, run.records.iter().map(of).collect::<Vec<_>>()).unbind()
        };
        let counts = |of: &dyn Fn(&CoreRecord) -> usize| {
            PyArray1::from_iter(py, run.records.iter().map(|record| of(record) as i64).collect::<Vec<_>>()).unbind()
        };
        let moments = |values: &[Vec<[f64; 3]>]| -> PyResult<Py<PyArray3<f64>>> {
            let flat: Vec<f64> = values.iter().flatten().flatten().copied().collect();
            Ok(PyArray1::from_vec(py, flat).reshape([values.len(), bodies, 3])?.unbind())
        };
        let still: Vec<bool> = run.records.iter().flat_map(|record| record.motionless.iter().copied()).collect();
        let places = run.records.iter().flat_map(|record| match record.inconsistent {
            Some(Inconsistent { contact, .. }) => contact.bodies.map(|body| body as i64),
            None => [-1; 2],
        });
        let forces = Forces::of(&run.contacts, dt);
        let reason = match &run.ending {
            Ending::Failed(failure) => Some(failure.to_string()),
            _ => None,
        };
        Ok(Self {
            status: run.ending.name().to_owned(),
            reason,
            poses: moments(&run.poses)?,
            velocities: moments(&run.velocities)?,
            motionless: PyArray1::from_vec(py, still).reshape([run.records.len(), bodies])?.unbind(),
            pivots: counts(&|r| r.counts.pivots),
            major_cycles: counts(&|r| r.counts.major_cycles),
            minor_cycles: counts(&|r| r.counts.minor_cycles),
            solves: counts(&|r| r.solves),
            rows: counts(&|r| r.rows),
            rows_reused: counts(&|r| r.rows_reused),
            projections: counts(&|r| r.projections),
            collisions: counts(&|r| r.collisions),
            inconsistent: PyArray1::from_iter(py, places).reshape([run.records.len(), 2])?.unbind(),
            solve_seconds: numbers(&|r| r.solve_time.as_secs_f64()),
            step_seconds: numbers(&|r| r.time.as_secs_f64()),
            residual: numbers(&|r| r.residual),
            friction_error: numbers(&|r| r.friction_error),
            penetration: numbers(&|r| r.penetration),
            force_starts: PyArray1::from_vec(py, forces.starts).unbind(),
            force_bodies: PyArray1::from_vec(py, forces.bodies).reshape([forces.count, 2])?.unbind(),
            force_points: PyArray1::from_vec(py, forces.points).reshape([forces.count, 2])?.unbind(),
            forces: PyArray1::from_vec(py, forces.forces).reshape([forces.count, 2])?.unbind(),
        })
    }
}

/// The forces of all steps, one after the other.
#[derive(Default)]
struct Forces {
    starts: Vec<i64>,
    bodies: Vec<i64>,
    points: Vec<f64>,
    forces: Vec<f64>,
    count: usize,
}

impl Forces {
    fn of(steps: &[Vec<core::ContactImpulse>], dt: f64) -> Self {
        let mut all = Self { starts: vec![0], ..Self::default() };
        for step in steps {
            for contact in step {
                all.bodies.extend(contact.id.bodies.map(|body| body as i64));
                all.points.extend(contact.point);
                all.forces.extend(contact.impulse().map(|p| p / dt));
                all.count += 1;
            }
            all.starts.push(all.count as i64);
        }
        all
    }
}

/// Looks for Ctrl-C and reports progress, a few times a second.
struct Watch {
    progress: Option<Py<PyAny>>,
    last: Instant,
    error: Option<PyErr>,
}

const PERIOD: Duration = Duration::from_millis(100);

impl Watch {
    fn go_on(&mut self, made: usize, steps: usize) -> bool {
        if self.last.elapsed() < PERIOD {
            return true;
        }
        self.last = Instant::now();
        Python::attach(|py| {
            if py.check_signals().is_err() {
                return false; // Ctrl-C: what is done is the answer
            }
            let Some(function) = &self.progress else { return true };
            let error = match function.call1(py, (made, steps)) {
                Ok(_) => return true,
                Err(error) => error,
            };
            // Ctrl-C within the callback: what is done is the answer, as above.
            self.error = Some(error).filter(|error| !error.is_instance_of::<PyKeyboardInterrupt>(py));
            false
        })
    }
}
