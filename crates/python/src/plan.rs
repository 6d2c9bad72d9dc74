//! `plan`, with the stability tests of the core or one from Python.

use crate::{
    errors::{plan_error, scene_error},
    scene::Scene,
    verdict::Verdict,
    watch::{Watch, in_python, interruptible},
};
use drystone::{
    AnyScene,
    formulate::{Assemble, Assembly, BlockSet, FrictionCone},
    geometry::Piece,
    plan::{self as core, ClearPath, Conditions, Limits, PlanError, StabilityTest, Test, TestOutcome},
    scene::SceneOf,
};
use numpy::PyArray1;
use pyo3::{
    exceptions::{PyKeyboardInterrupt, PyValueError},
    prelude::*,
};
use std::{
    sync::Arc,
    time::{Duration, Instant},
};

#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct TestRecord {
    size: usize,
    pivots: usize,
    seconds: f64,
    stable: bool,
}

/// A unit vector, z = 0 in the plane.
type Way = (f64, f64, f64);

/// A body that cannot leave; for each direction the bodies in the way.
type BlockedBy = (String, Vec<(Way, Vec<String>)>);

#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Plan {
    status: String,
    found: bool,
    order: Vec<String>,
    reached: Vec<String>,
    falls_next: Vec<String>,
    held: Vec<Vec<String>>,
    moves: Vec<Vec<(Way, f64)>>,
    groups: Vec<Vec<String>>,
    blocked: Vec<BlockedBy>,
    tests: usize,
    pivots: usize,
    test_seconds: f64,
    seconds: f64,
    records: Vec<Py<TestRecord>>,
    shortcuts: usize,
    whole: Option<Py<Verdict>>,
}

/// Equilibrium of the complete assembly: G f = -F with f >= 0; see the stub for the layout.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Generators {
    names: Vec<String>,
    indptr: Py<PyArray1<i64>>,
    indices: Py<PyArray1<i64>>,
    data: Py<PyArray1<f64>>,
    applied: Py<PyArray1<f64>>,
    inverse_mass: Py<PyArray1<f64>>,
    bodies: Py<numpy::PyArray2<i64>>,
    contact: Py<PyArray1<i64>>,
}

#[pyfunction]
#[pyo3(signature = (scene, cones=None))]
pub fn generators(py: Python<'_>, scene: &Scene, cones: Option<(usize, String)>) -> PyResult<Generators> {
    let assembly = scene.assembly(py, cones)?;
    let (mut indptr, mut indices, mut data) = (vec![0_i64], Vec::new(), Vec::new());
    let (mut bodies, components) = (Vec::new(), assembly.components());
    for generator in assembly.generators() {
        for wrench in assembly.wrenches(generator) {
            let first = components.len() * wrench.block;
            indices.extend((0..components.len()).map(|k| (first + k) as i64));
            data.extend(components.iter().map(|&k| wrench.value[k]));
        }
        indptr.push(indices.len() as i64);
        let mut blocks = generator.blocks().map(|block| block as i64);
        bodies.extend([blocks.next().unwrap_or(-1), blocks.next().unwrap_or(-1)]);
    }
    let blocks = 0..assembly.blocks();
    let bodies = numpy::PyArrayMethods::reshape(&own(py, bodies), [assembly.generators().len(), 2])?;
    Ok(Generators {
        names: blocks.clone().map(|block| assembly.body(block).name.clone()).collect(),
        indptr: own(py, indptr).unbind(),
        indices: own(py, indices).unbind(),
        data: own(py, data).unbind(),
        applied: own(py, blocks.clone().flat_map(|block| assembly.applied(block)).copied().collect()).unbind(),
        inverse_mass: own(py, blocks.flat_map(|block| assembly.inverse_mass(block)).copied().collect()).unbind(),
        bodies: bodies.unbind(),
        contact: own(py, assembly.generators().iter().map(|g| g.contact() as i64).collect()).unbind(),
    })
}

/// An array that is the caller's to change: some solvers refuse matrices on memory that is read-only.
fn own<T: numpy::Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    PyArray1::from_vec(py, values)
}

/// A stability test written in Python: called with (indices of the blocks, index of the one added last).
pub struct Callback {
    pub function: Py<PyAny>,
}

impl StabilityTest for Callback {
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        in_python(|py| {
            let answer = self.function.call1(py, (blocks.iter().collect::<Vec<_>>(), added));
            match answer.and_then(|answer| answer.extract::<(bool, usize)>(py)) {
                Ok((stands, pivots)) => Ok(TestOutcome { stands, borderline: false, pivots }),
                Err(error) if error.is_instance_of::<PyKeyboardInterrupt>(py) => Err(PlanError::Interrupted),
                Err(error) => Err(PlanError::External(Box::new(error))),
            }
        })
    }
}

#[pyfunction]
#[allow(clippy::too_many_arguments)] // those of the Python function
#[pyo3(signature = (scene, test, node_limit=None, time_limit=None, progress=None, shortcuts=true, threads=None, cones=None, hold=0, ways=None, obstacles=None, margin=0.0, strong=false))]
pub fn plan(
    py: Python<'_>,
    scene: &Scene,
    test: &Bound<'_, PyAny>,
    node_limit: Option<usize>,
    time_limit: Option<f64>,
    progress: Option<Py<PyAny>>,
    shortcuts: bool,
    threads: Option<usize>,
    cones: Option<(usize, String)>,
    hold: usize,
    ways: Option<(Vec<[f64; 3]>, usize, usize)>,
    obstacles: Option<PyRef<'_, Scene>>,
    margin: f64,
    strong: bool,
) -> PyResult<Plan> {
    let time = time_limit.map(Duration::try_from_secs_f64).transpose();
    let time = time.map_err(|_| PyValueError::new_err("time_limit must be a number of seconds, zero or more"))?;
    let limits = Limits { tests: node_limit, time, shortcuts, threads };
    let (pieces, obstacles) = obstacles.map(|scene| pieces_and_names(&scene.now())).unwrap_or_default();
    let clear = |(directions, moves, together)| ClearPath { directions, moves, together, obstacles: pieces };
    let conditions = Conditions { hold, clear_path: ways.map(clear), margin, strong };
    let mut watch = Watch::new(progress);
    let signals = watch.signals.clone();
    let start = Instant::now();
    let cones = crate::scene::cones(cones)?;
    // The time is the limit of all that this does.
    let scene = scene.now();
    let found = signals.run(py, || limits.interrupt(start).run(|| scene.assembly(cones)));
    let Some(assembly) = found.flatten() else {
        return match signals.raised() {
            Some(error) => Err(error),
            None => {
                let stopped = core::Plan::stopped(core::Outcome::TimeLimit, start.elapsed());
                to_python(py, None, &[], stopped, Duration::ZERO)
            }
        };
    };
    let assembly = assembly.map_err(|error| scene_error(&error))?;
    let (contacts, limits) = (start.elapsed(), limits.after(start));
    let asked = match test.is_callable() {
        true => Asked::Callback(Callback { function: test.clone().unbind() }),
        false => Asked::Named(named_test(&test.extract::<String>()?)?),
    };
    let planned = signals.run(py, || match &*scene {
        AnyScene::Plane(scene) => planned(scene, &assembly, asked, &conditions, limits, &mut watch),
        AnyScene::Space(scene) => planned(scene, &assembly, asked, &conditions, limits, &mut watch),
    });
    let planned = planned.ok_or_else(|| signals.error())?;
    match watch.error(py) {
        Some(error) => Err(error),
        None => to_python(py, Some(assembly), &obstacles, planned.map_err(plan_error)?, contacts),
    }
}

/// Of each body of a scene its convex pieces, or the triangles of its surface, and its name.
fn pieces_and_names(scene: &AnyScene) -> (Vec<Vec<Piece>>, Vec<String>) {
    fn of<S: Assemble>(scene: &SceneOf<S>) -> (Vec<Vec<Piece>>, Vec<String>) {
        scene.bodies().iter().map(|body| (S::pieces(body), body.name.clone())).unzip()
    }
    match scene {
        AnyScene::Plane(scene) => of(scene),
        AnyScene::Space(scene) => of(scene),
    }
}

/// A stability test of the core, or one from Python.
enum Asked {
    Named(Test),
    Callback(Callback),
}

fn planned<S: Assemble>(
    scene: &SceneOf<S>,
    assembly: &Assembly,
    asked: Asked,
    conditions: &Conditions,
    limits: Limits,
    watch: &mut Watch,
) -> Result<core::Plan, PlanError> {
    match asked {
        Asked::Named(test) => core::plan_assembly_under(scene, assembly, test, conditions, limits, watch),
        Asked::Callback(mut test) => core::plan_with_under(scene, assembly, &mut test, conditions, limits, watch),
    }
}

fn named_test(name: &str) -> PyResult<Test> {
    match name {
        "lcp" => Ok(Test::Lcp),
        "reuse" => Ok(Test::Reuse),
        "reuse-dantzig" => Ok(Test::ReuseDantzig),
        other => Err(PyValueError::new_err(format!(
            "unknown stability test \"{other}\": give \"reuse\", \"reuse-dantzig\" or \"lcp\""
        ))),
    }
}

/// Without minus zeros.
fn clean(&[x, y, z]: &[f64; 3]) -> Way {
    (x + 0.0, y + 0.0, z + 0.0)
}

/// Without an assembly for a plan that names nothing. Obstacles have their numbers after the bodies.
fn to_python(
    py: Python<'_>,
    assembly: Option<Assembly>,
    obstacles: &[String],
    mut plan: core::Plan,
    contacts: Duration,
) -> PyResult<Plan> {
    let assembly = assembly.map(Arc::new);
    let name = |index: usize| {
        let bodies = assembly.as_ref().map_or(&[][..], |assembly| assembly.bodies());
        bodies.get(index).map_or_else(|| obstacles[index - bodies.len()].clone(), |body| body.name.clone())
    };
    let names = |bodies: &[usize]| -> Vec<String> { bodies.iter().map(|&index| name(index)).collect() };
    let way = |(direction, bodies): &([f64; 3], Vec<usize>)| (clean(direction), names(bodies));
    let record = |record: &core::TestRecord| {
        let (TestOutcome { stands, pivots, .. }, seconds) = (record.outcome, record.time.as_secs_f64());
        Py::new(py, TestRecord { size: record.size, pivots, seconds, stable: stands })
    };
    let verdict = |(assembly, whole): (&Arc<Assembly>, _)| {
        Py::new(py, Verdict::new(py, Arc::clone(assembly), FrictionCone::Pyramid, whole, plan.whole_time)?)
    };
    let whole = assembly.as_ref().zip(plan.whole.take()).map(verdict);
    Ok(Plan {
        status: plan.outcome.name().to_owned(),
        found: plan.outcome == core::Outcome::Found,
        order: names(&plan.order),
        reached: names(&plan.reached),
        falls_next: names(&plan.falls_next),
        held: plan.held.iter().map(|held| names(held)).collect(),
        moves: plan
            .moves
            .iter()
            .map(|moves| moves.iter().map(|(way, length)| (clean(way), *length)).collect())
            .collect(),
        groups: plan.groups.iter().map(|group| names(group)).collect(),
        blocked: plan.blocked.iter().map(|b| (name(b.body), b.ways.iter().map(way).collect())).collect(),
        tests: plan.records.len(),
        pivots: plan.pivots(),
        test_seconds: plan.test_time().as_secs_f64(),
        seconds: (contacts + plan.total).as_secs_f64(),
        records: plan.records.iter().map(record).collect::<PyResult<_>>()?,
        shortcuts: plan.shortcuts,
        whole: whole.transpose()?,
    })
}

/// Every sub-assembly of a small scene with the verdict on it.
#[pyfunction]
pub fn disassembly_graph(py: Python<'_>, scene: &Scene) -> PyResult<Vec<(Vec<String>, bool)>> {
    let assembly = scene.assembly(py, None)?;
    let nodes = interruptible(py, || core::disassembly_graph(&assembly))?.map_err(plan_error)?;
    let name = |&index: &usize| assembly.bodies()[index].name.clone();
    Ok(nodes.iter().map(|node| (node.bodies.iter().map(name).collect(), node.stands)).collect())
}
