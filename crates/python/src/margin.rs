//! `margin` and its answer.

use crate::{
    arrays::matrix,
    coordinates::Coordinates,
    limit::LimitEnd,
    scene::{Scene, raised},
    watch::interruptible,
};
use drystone::{
    AnyScene,
    formulate::FrictionCone,
    limit::{self as core, Asked, Loads, blocks_named},
};
use numpy::PyArray2;
use pyo3::prelude::*;

/// How far a structure is from falling; see the stub.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Margin {
    status: String,
    acceleration: f64,
    direction: Coordinates,
    tilt: Option<f64>,
    end: Py<LimitEnd>,
    axes: (Coordinates, Coordinates),
    boundary: Py<PyArray2<f64>>,
    questions: usize,
}

fn cone(round: bool) -> FrictionCone {
    if round { FrictionCone::Round } else { FrictionCone::Pyramid }
}

#[pyfunction]
#[pyo3(signature = (scene, blocks, turn, tolerance, cones, round_cones))]
pub fn margin(
    py: Python<'_>,
    scene: &Scene,
    blocks: Option<Vec<String>>,
    turn: bool,
    tolerance: f64,
    cones: Option<(usize, String)>,
    round_cones: bool,
) -> PyResult<Margin> {
    let (now, assembly) = (scene.now(), scene.assembly(py, cones)?);
    let set = raised(blocks_named(&assembly, blocks.as_deref()))?;
    let asked = Asked { cone: cone(round_cones), loads: if turn { Loads::Turn } else { Loads::Stay }, tolerance };
    let found = raised(interruptible(py, || match &*now {
        AnyScene::Plane(scene) => core::margin(&assembly, scene, &set, asked),
        AnyScene::Space(scene) => core::margin(&assembly, scene, &set, asked),
    })?)?;
    let shown = |v: [f64; 3]| Coordinates::of(v, assembly.in_plane());
    Ok(Margin {
        status: found.status.name().to_owned(),
        acceleration: found.acceleration,
        direction: shown(found.direction),
        tilt: found.tilt,
        end: LimitEnd::new(py, &assembly, &found.end)?,
        axes: (shown(found.axes[0]), shown(found.axes[1])),
        boundary: matrix(py, &found.boundary)?.unbind(),
        questions: found.questions,
    })
}

/// The least multiple of every coefficient of friction with which it stands.
#[pyfunction]
#[pyo3(signature = (scene, blocks, cones, round_cones))]
pub fn least_friction(
    py: Python<'_>,
    scene: &Scene,
    blocks: Option<Vec<String>>,
    cones: Option<(usize, String)>,
    round_cones: bool,
) -> PyResult<f64> {
    let assembly = scene.assembly(py, cones)?;
    let set = raised(blocks_named(&assembly, blocks.as_deref()))?;
    interruptible(py, || core::least_friction(&assembly, &set, cone(round_cones)))
}
