//! `limit` and its answer.

use crate::{
    arrays::{self, matrix},
    contact_forces::ContactForces,
    errors::scene_error,
    loads::vector,
    scene::{Scene, raised},
    watch::interruptible,
};
use drystone::{
    AnyScene, SceneError, SceneOf, Structure,
    formulate::{Assemble, Assembly, BlockSet, FrictionCone, Push, PushOf},
    geometry::Shape,
    limit::{self as core, blocks_named},
};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use std::time::{Duration, Instant};

/// Body, force and moment.
pub type Forces = Vec<(String, Vec<f64>, [f64; 3])>;

/// An end of the interval; see the stub.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct LimitEnd {
    factor: f64,
    names: Vec<String>,
    velocities: Py<PyArray2<f64>>,
    forces: Option<Py<ContactForces>>,
    imbalance: f64,
    closing: f64,
    bound: f64,
}

#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Limit {
    status: String,
    lower: Py<LimitEnd>,
    upper: Py<LimitEnd>,
    pivots: usize,
    iterations: usize,
    seconds: f64,
}

impl Limit {
    pub fn new(py: Python<'_>, assembly: &Assembly, limit: &core::Limit, time: Duration) -> PyResult<Self> {
        Ok(Self {
            status: limit.status.name().to_owned(),
            lower: LimitEnd::new(py, assembly, &limit.lower)?,
            upper: LimitEnd::new(py, assembly, &limit.upper)?,
            pivots: limit.counts.pivots,
            iterations: limit.iterations,
            seconds: time.as_secs_f64(),
        })
    }
}

impl LimitEnd {
    pub fn new(py: Python<'_>, assembly: &Assembly, end: &core::End) -> PyResult<Py<Self>> {
        let velocities = end.motion.iter().map(|(_, velocity)| velocity);
        let forces = (!end.forces.is_empty())
            .then(|| Py::new(py, ContactForces::new(assembly, end.forces.iter().map(|(_, force)| force))));
        let end = Self {
            factor: end.factor,
            names: end.motion.iter().map(|&(body, _)| assembly.bodies()[body].name.clone()).collect(),
            velocities: if assembly.in_plane() {
                matrix(py, &velocities.map(|v| v.in_plane()).collect::<Vec<_>>())?.unbind()
            } else {
                matrix(py, &velocities.map(|v| v.components()).collect::<Vec<_>>())?.unbind()
            },
            forces: forces.transpose()?,
            imbalance: end.imbalance,
            closing: end.closing,
            bound: end.bound,
        };
        Py::new(py, end)
    }
}

/// The push on the blocks of a scene.
pub fn push_of(
    assembly: &Assembly,
    scene: &AnyScene,
    blocks: &BlockSet,
    forces: &Forces,
    gravity: Option<&[f64]>,
) -> PyResult<Push> {
    fn of<S: Assemble + Shape>(
        assembly: &Assembly,
        scene: &SceneOf<S>,
        blocks: &BlockSet,
        forces: &Forces,
        gravity: Option<&[f64]>,
    ) -> PyResult<Push> {
        let force =
            |(name, force, moment): &(String, Vec<f64>, [f64; 3])| Ok((name.clone(), vector::<S>(force)?, *moment));
        let forces = forces.iter().map(force).collect::<PyResult<_>>()?;
        let of = PushOf { forces, gravity: gravity.map(vector::<S>).transpose()? };
        raised(Push::new(assembly, scene, blocks, &of))
    }
    match scene {
        AnyScene::Plane(scene) => of(assembly, scene, blocks, forces, gravity),
        AnyScene::Space(scene) => of(assembly, scene, blocks, forces, gravity),
    }
}

#[pyfunction]
#[pyo3(signature = (scene, forces, gravity=None, blocks=None, cones=None, round_cones=false))]
pub fn limit(
    py: Python<'_>,
    scene: &Scene,
    forces: Forces,
    gravity: Option<Vec<f64>>,
    blocks: Option<Vec<String>>,
    cones: Option<(usize, String)>,
    round_cones: bool,
) -> PyResult<Limit> {
    let cone = if round_cones { FrictionCone::Round } else { FrictionCone::Pyramid };
    let start = Instant::now();
    let (now, assembly) = (scene.now(), scene.assembly(py, cones)?);
    let named = |error: SceneError| scene_error(&error);
    let set = blocks_named(&assembly, blocks.as_deref()).map_err(named)?;
    let push = push_of(&assembly, &now, &set, &forces, gravity.as_deref())?;
    let found = interruptible(py, || core::limit(&assembly, &set, &push, cone))?;
    Limit::new(py, &assembly, &found, start.elapsed())
}

/// Of each case, a row of factors of the loads: 1 if it stands, 0 if it falls, -1 if neither is proved; how many took a computation
/// of their own, and seconds.
#[pyfunction]
#[pyo3(signature = (scene, loads, factors, blocks=None, cones=None, round_cones=false))]
#[allow(clippy::type_complexity)]
pub fn load_cases<'py>(
    py: Python<'py>,
    scene: &Scene,
    loads: Vec<(Forces, Option<Vec<f64>>)>,
    factors: Vec<Vec<f64>>,
    blocks: Option<Vec<String>>,
    cones: Option<(usize, String)>,
    round_cones: bool,
) -> PyResult<(Bound<'py, PyArray1<i8>>, usize, f64)> {
    let cone = if round_cones { FrictionCone::Round } else { FrictionCone::Pyramid };
    let start = Instant::now();
    let (now, assembly) = (scene.now(), scene.assembly(py, cones)?);
    let set = raised(blocks_named(&assembly, blocks.as_deref()))?;
    let push =
        |(forces, gravity): &(Forces, Option<Vec<f64>>)| push_of(&assembly, &now, &set, forces, gravity.as_deref());
    let loads = loads.iter().map(push).collect::<PyResult<Vec<_>>>()?;
    let found = interruptible(py, || core::cases(&assembly, &set, &loads, &factors, cone))?;
    let stands = found.stands.iter().map(|stands| stands.map_or(-1, i8::from)).collect();
    Ok((arrays::vector(py, stands), found.solved, start.elapsed().as_secs_f64()))
}

/// The limit of a structure as it is now.
pub fn of_structure(
    py: Python<'_>,
    structure: &mut Structure,
    scene: &Scene,
    forces: &Forces,
    gravity: Option<&[f64]>,
) -> PyResult<Limit> {
    let start = Instant::now();
    let push = push_of(structure.assembly(), &scene.now(), structure.blocks(), forces, gravity)?;
    let found = interruptible(py, || structure.limit(&push))?;
    Limit::new(py, structure.assembly(), &found, start.elapsed())
}
