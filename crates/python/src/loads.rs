//! Loads, gravity and the friction of pairs of a `Scene`.

use crate::{
    coordinates::{Coordinates, about_axes},
    scene::{Scene, raised},
};
use drystone::{
    AnyScene, LoadOptions, SceneError, SceneOf,
    geometry::{Polygon, Shape, Solid},
};
use pyo3::{exceptions::PyTypeError, prelude::*};
use std::sync::Arc;

/// Name, body, force (N), where in the world (m), moment (N m): one number in the plane, three in space.
type Listed = (String, String, Coordinates, Coordinates, Vec<f64>);

/// A vector of a scene's dimension, which Python has checked.
pub fn vector<S: Shape>(values: &[f64]) -> PyResult<S::Vector> {
    let mut vector = S::Vector::default();
    if vector.as_ref().len() != values.len() {
        return Err(PyTypeError::new_err("a vector has as many numbers as the scene has dimensions"));
    }
    vector.as_mut().copy_from_slice(values);
    Ok(vector)
}

/// Adds a permanent load, and says its name.
#[pyfunction]
pub fn add_load(
    scene: &Scene,
    body: &str,
    force: Vec<f64>,
    at: Option<Vec<f64>>,
    moment: [f64; 3],
    name: Option<String>,
) -> PyResult<String> {
    fn add<S: Shape>(
        scene: &mut SceneOf<S>,
        body: &str,
        force: &[f64],
        at: Option<&[f64]>,
        moment: [f64; 3],
        name: Option<String>,
    ) -> PyResult<String> {
        let at = at.map(vector::<S>).transpose()?;
        raised(scene.add_load(body, LoadOptions { name, force: vector::<S>(force)?, at, moment }))
    }
    match Arc::make_mut(&mut scene.lock()) {
        AnyScene::Plane(scene) => add(scene, body, &force, at.as_deref(), moment, name),
        AnyScene::Space(scene) => add(scene, body, &force, at.as_deref(), moment, name),
    }
}

/// Adds the resultant of a pressure on a face, and says its name.
#[pyfunction]
pub fn add_pressure(
    scene: &Scene,
    body: &str,
    direction: Vec<f64>,
    pressure: f64,
    name: Option<String>,
) -> PyResult<String> {
    raised(match Arc::make_mut(&mut scene.lock()) {
        AnyScene::Plane(scene) => scene.add_pressure(body, vector::<Polygon>(&direction)?, pressure, name),
        AnyScene::Space(scene) => scene.add_pressure(body, vector::<Solid>(&direction)?, pressure, name),
    })
}

/// Gives a pair of bodies a coefficient of friction of its own.
#[pyfunction]
pub fn set_friction(scene: &Scene, a: &str, b: &str, friction: f64) -> PyResult<()> {
    raised(match Arc::make_mut(&mut scene.lock()) {
        AnyScene::Plane(scene) => scene.set_friction(a, b, friction),
        AnyScene::Space(scene) => scene.set_friction(a, b, friction),
    })
}

/// The same scene under another gravity.
#[pyfunction]
pub fn with_gravity(scene: &Scene, gravity: Vec<f64>) -> PyResult<Scene> {
    fn under<S: Shape>(scene: &SceneOf<S>, gravity: &[f64]) -> PyResult<Result<SceneOf<S>, SceneError>> {
        Ok(scene.clone().with_gravity(vector::<S>(gravity)?))
    }
    Ok(Scene::of(match &*scene.now() {
        AnyScene::Plane(scene) => raised(under(scene, &gravity)?)?.into(),
        AnyScene::Space(scene) => raised(under(scene, &gravity)?)?.into(),
    }))
}

/// Every permanent load.
#[pyfunction]
pub fn loads(scene: &Scene) -> Vec<Listed> {
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
        for load in body.loads() {
            let moment = about_axes(load.moment, load.force.as_ref().len() == 2);
            let at = S::in_world(&body.pose, load.at).into();
            all.push((load.name.clone(), body.name.clone(), load.force.into(), at, moment));
        }
    }
    all
}

/// Pairs of bodies that have a coefficient of friction of their own, with it.
#[pyfunction]
pub fn pair_frictions(scene: &Scene) -> Vec<(String, String, f64)> {
    let scene = scene.now();
    let pairs: Vec<([usize; 2], f64)> = match &*scene {
        AnyScene::Plane(scene) => scene.pair_frictions().collect(),
        AnyScene::Space(scene) => scene.pair_frictions().collect(),
    };
    let name = |index: usize| scene.name(index).to_owned();
    pairs.into_iter().map(|([a, b], friction)| (name(a), name(b), friction)).collect()
}
