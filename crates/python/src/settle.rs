//! Settlements of supports, and how blocks follow them.

use crate::{
    arrays::matrix,
    contact_forces::Forces,
    coordinates::{Coordinates, about_axes},
    loads::vector,
    scene::{Scene, raised},
    watch::interruptible,
};
use drystone::{
    AnyScene, SceneOf,
    formulate::{Assembly, FrictionCone},
    geometry::Shape,
    limit::blocks_named,
    settle::{Settled as Core, settle as follow},
};
use numpy::PyArray2;
use pyo3::prelude::*;
use std::{sync::Arc, time::Instant};

/// Body, displacement (m), rotation (rad): one number in the plane, three in space; about which point of the world (m).
type Listed = (String, Coordinates, Vec<f64>, Coordinates);

/// Two bodies, what their joint does, where, and how far it opens and slides (m).
type Joint = (String, String, String, Coordinates, f64, f64);

/// How blocks follow; see the stub.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Settled {
    status: String,
    names: Vec<String>,
    displacements: Py<PyArray2<f64>>,
    joints: Vec<Joint>,
    forces: Option<Py<Forces>>,
    work: f64,
    bound: f64,
    imbalance: f64,
    closing: f64,
    resolution: f64,
    squeezed: Vec<String>,
    iterations: usize,
    seconds: f64,
}

impl Settled {
    fn new(py: Python<'_>, assembly: Arc<Assembly>, cone: FrictionCone, found: Core, seconds: f64) -> PyResult<Self> {
        let name = |body: usize| assembly.bodies()[body].name.clone();
        let in_plane = assembly.in_plane();
        let joint = |joint: &drystone::settle::Joint| {
            let ([a, b], at) = (joint.bodies.map(name), Coordinates::of(joint.at, in_plane));
            (a, b, joint.opening.name().to_owned(), at, joint.opens, joint.slides)
        };
        let moved = found.displacements.iter().map(|(_, moved)| moved);
        Ok(Self {
            status: found.status.name().to_owned(),
            names: found.displacements.iter().map(|&(body, _)| name(body)).collect(),
            displacements: if in_plane {
                matrix(py, &moved.map(|u| u.in_plane()).collect::<Vec<_>>())?.unbind()
            } else {
                matrix(py, &moved.map(|u| u.components()).collect::<Vec<_>>())?.unbind()
            },
            joints: found.joints.iter().map(joint).collect(),
            work: found.work,
            bound: found.bound,
            imbalance: found.imbalance,
            closing: found.closing,
            resolution: found.resolution,
            squeezed: found.squeezed.iter().map(|&body| name(body)).collect(),
            iterations: found.iterations,
            seconds,
            forces: match found.forces.is_empty() {
                true => None,
                false => Some(Py::new(py, Forces::after(Arc::clone(&assembly), cone, found))?),
            },
        })
    }
}

#[pyfunction]
#[pyo3(signature = (scene, blocks=None, cones=None, round_cones=false))]
pub fn settle(
    py: Python<'_>,
    scene: &Scene,
    blocks: Option<Vec<String>>,
    cones: Option<(usize, String)>,
    round_cones: bool,
) -> PyResult<Settled> {
    let cone = if round_cones { FrictionCone::Round } else { FrictionCone::Pyramid };
    let start = Instant::now();
    let assembly = Arc::new(scene.assembly(py, cones)?);
    let set = raised(blocks_named(&assembly, blocks.as_deref()))?;
    let found = interruptible(py, || follow(&assembly, &set, cone))?;
    Settled::new(py, assembly, cone, found, start.elapsed().as_secs_f64())
}

/// Prescribes a displacement of a support.
#[pyfunction]
pub fn add_settlement(
    scene: &Scene,
    body: &str,
    displacement: Vec<f64>,
    rotation: [f64; 3],
    at: Option<Vec<f64>>,
) -> PyResult<()> {
    fn add<S: Shape>(
        scene: &mut SceneOf<S>,
        body: &str,
        displacement: &[f64],
        rotation: [f64; 3],
        at: Option<&[f64]>,
    ) -> PyResult<()> {
        let at = at.map(vector::<S>).transpose()?;
        raised(scene.add_settlement(body, vector::<S>(displacement)?, rotation, at))
    }
    match Arc::make_mut(&mut scene.lock()) {
        AnyScene::Plane(scene) => add(scene, body, &displacement, rotation, at.as_deref()),
        AnyScene::Space(scene) => add(scene, body, &displacement, rotation, at.as_deref()),
    }
}

/// The same scene with all supports where they are.
#[pyfunction]
pub fn without_settlements(scene: &Scene) -> Scene {
    Scene::of(match &*scene.now() {
        AnyScene::Plane(scene) => scene.clone().without_settlements().into(),
        AnyScene::Space(scene) => scene.clone().without_settlements().into(),
    })
}

/// Every settlement of a support.
#[pyfunction]
pub fn settlements(scene: &Scene) -> Vec<Listed> {
    match &*scene.now() {
        AnyScene::Plane(scene) => listed(scene),
        AnyScene::Space(scene) => listed(scene),
    }
}

fn listed<S: Shape>(scene: &SceneOf<S>) -> Vec<Listed>
where
    S::Vector: Into<Coordinates>,
{
    let mut all = Vec::new();
    for body in scene.bodies() {
        for settlement in body.settlements() {
            let rotation = about_axes(settlement.rotation, settlement.displacement.as_ref().len() == 2);
            let at = S::in_world(&body.pose, settlement.at).into();
            all.push((body.name.clone(), settlement.displacement.into(), rotation, at));
        }
    }
    all
}
