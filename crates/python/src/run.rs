//! What steps leave behind: `StepRecord` of one, `Run` of many.

use crate::arrays::{read_only, vector};
use drystone::{
    geometry::Numbers,
    simulate::{ContactImpulse, Ending, Inconsistent, Moving, Run as CoreRun, StepRecord as CoreRecord},
};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

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
    exact: bool,
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
    exact: Py<PyArray1<bool>>,
    penetration: Py<PyArray1<f64>>,
    /// Forces, if they were asked for: those of step k are the rows force_starts[k] to force_starts[k + 1].
    force_starts: Py<PyArray1<i64>>,
    force_bodies: Py<PyArray2<i64>>,
    force_points: Py<PyArray2<f64>>,
    forces: Py<PyArray2<f64>>,
}

impl StepRecord {
    pub fn new(py: Python<'_>, record: CoreRecord, names: &[&str]) -> Self {
        let place = |Inconsistent { contact, .. }: Inconsistent| {
            let [a, b] = contact.bodies.map(|body| names[body].to_owned());
            (a, b, contact.feature.to_string())
        };
        Self {
            motionless: vector(py, record.motionless).unbind(),
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
            exact: record.exact,
            penetration: record.penetration,
            projections: record.projections,
            collisions: record.collisions,
            fallback: record.inconsistent.map(|found| found.status),
            inconsistent: record.inconsistent.map(place),
        }
    }
}

impl Run {
    pub fn new<S: Moving>(py: Python<'_>, run: CoreRun<S>, dt: f64, bodies: usize) -> PyResult<Self> {
        let numbers =
            |of: &dyn Fn(&CoreRecord) -> f64| vector(py, run.records.iter().map(of).collect::<Vec<f64>>()).unbind();
        let counts = |of: &dyn Fn(&CoreRecord) -> usize| {
            vector(py, run.records.iter().map(|record| of(record) as i64).collect::<Vec<_>>()).unbind()
        };
        let mut still = Vec::with_capacity(run.records.len() * bodies);
        run.records.iter().for_each(|record| still.extend_from_slice(&record.motionless));
        let places = run.records.iter().flat_map(|record| match record.inconsistent {
            Some(Inconsistent { contact, .. }) => contact.bodies.map(|body| body as i64),
            None => [-1; 2],
        });
        let forces = Forces::of(&run.contacts, dt);
        let axes = S::Vector::default().as_ref().len();
        let reason = match &run.ending {
            Ending::Failed(failure) => Some(failure.to_string()),
            _ => None,
        };
        Ok(Self {
            status: run.ending.name().to_owned(),
            reason,
            poses: moments::<S::Place>(py, run.poses, run.moments, bodies)?,
            velocities: moments::<S::Velocity>(py, run.velocities, run.moments, bodies)?,
            motionless: read_only(PyArray1::from_vec(py, still).reshape([run.records.len(), bodies])?).unbind(),
            pivots: counts(&|r| r.counts.pivots),
            major_cycles: counts(&|r| r.counts.major_cycles),
            minor_cycles: counts(&|r| r.counts.minor_cycles),
            solves: counts(&|r| r.solves),
            rows: counts(&|r| r.rows),
            rows_reused: counts(&|r| r.rows_reused),
            projections: counts(&|r| r.projections),
            collisions: counts(&|r| r.collisions),
            inconsistent: read_only(PyArray1::from_iter(py, places).reshape([run.records.len(), 2])?).unbind(),
            solve_seconds: numbers(&|r| r.solve_time.as_secs_f64()),
            step_seconds: numbers(&|r| r.time.as_secs_f64()),
            residual: numbers(&|r| r.residual),
            friction_error: numbers(&|r| r.friction_error),
            exact: vector(py, run.records.iter().map(|r| r.exact).collect()).unbind(),
            penetration: numbers(&|r| r.penetration),
            force_starts: vector(py, forces.starts).unbind(),
            force_bodies: read_only(PyArray1::from_vec(py, forces.bodies).reshape([forces.count, 2])?).unbind(),
            force_points: read_only(PyArray1::from_vec(py, forces.points).reshape([forces.count, axes])?).unbind(),
            forces: read_only(PyArray1::from_vec(py, forces.forces).reshape([forces.count, axes])?).unbind(),
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
    fn of<V: Numbers>(steps: &[Vec<ContactImpulse<V>>], dt: f64) -> Self {
        let mut all = Self { starts: vec![0], ..Self::default() };
        for step in steps {
            for contact in step {
                all.bodies.extend(contact.id.bodies.map(|body| body as i64));
                all.points.extend(contact.point.as_ref());
                all.forces.extend(contact.impulse.as_ref().iter().map(|p| p / dt));
                all.count += 1;
            }
            all.starts.push(all.count as i64);
        }
        all
    }
}

/// An array (moments, bodies, numbers of each).
fn moments<V: Numbers>(py: Python<'_>, values: Vec<f64>, moments: usize, bodies: usize) -> PyResult<Py<PyArray3<f64>>> {
    let numbers = V::default().as_ref().len();
    Ok(read_only(PyArray1::from_vec(py, values).reshape([moments, bodies, numbers])?).unbind())
}
