//! `Scene` and what it shows of itself.

use crate::{arrays::matrix, coordinates::Coordinates, errors::scene_error};
use drystone::{BodyOptions, Scene as CoreScene, find_contacts, io, scenes};
use numpy::PyArray2;
use pyo3::{exceptions::PyTypeError, prelude::*, types::PyDict};
use std::collections::BTreeMap;

#[pyclass(module = "drystone._core")]
pub struct Scene {
    pub core: CoreScene,
}

/// A snapshot of one body. `vertices` is (n, 2) in world coordinates, metres, counter-clockwise.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Body {
    name: String,
    fixed: bool,
    density: f64,
    friction: f64,
    mass: f64,
    inertia: f64,
    centroid: (f64, f64),
    angle: f64,
    vertices: Py<PyArray2<f64>>,
}

/// One contact point. `normal` is a unit vector from body `a` into body `b`.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Contact {
    a: String,
    b: String,
    feature: String,
    point: Coordinates,
    normal: Coordinates,
    gap: f64,
    friction: f64,
}

pub fn options(name: Option<String>, density: f64, friction: Option<f64>, fixed: bool) -> BodyOptions {
    BodyOptions { name, density, friction, fixed }
}

impl Scene {
    fn name_of(&self, index: usize) -> String {
        self.core.bodies()[index].name.clone()
    }

    fn body_at(&self, py: Python<'_>, index: usize) -> PyResult<Body> {
        let body = &self.core.bodies()[index];
        Ok(Body {
            name: body.name.clone(),
            fixed: body.fixed,
            density: body.density,
            friction: body.friction.unwrap_or(self.core.friction()),
            mass: body.mass(),
            inertia: body.inertia(),
            centroid: body.pose.position.into(),
            angle: body.pose.angle,
            vertices: matrix(py, &body.vertices())?.unbind(),
        })
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (gravity, friction, contact_tolerance=None))]
    fn new(gravity: [f64; 2], friction: f64, contact_tolerance: Option<f64>) -> PyResult<Self> {
        let scene = CoreScene::new(gravity, friction);
        let scene = match contact_tolerance {
            Some(tolerance) => scene.and_then(|scene| scene.with_contact_tolerance(tolerance)),
            None => scene,
        };
        Ok(Self { core: scene.map_err(|error| scene_error(&error))? })
    }

    #[getter]
    fn gravity(&self) -> (f64, f64) {
        self.core.gravity().into()
    }

    #[getter]
    fn friction(&self) -> f64 {
        self.core.friction()
    }

    #[getter]
    fn contact_tolerance(&self) -> Option<f64> {
        self.core.contact_tolerance()
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
        let added = self.core.add_box(center, size, angle, options(name, density, friction, fixed));
        added.map(|index| self.name_of(index)).map_err(|error| scene_error(&error))
    }

    fn add_polygon(
        &mut self,
        vertices: Vec<[f64; 2]>,
        name: Option<String>,
        density: f64,
        friction: Option<f64>,
        fixed: bool,
    ) -> PyResult<String> {
        let added = self.core.add_polygon(&vertices, options(name, density, friction, fixed));
        added.map(|index| self.name_of(index)).map_err(|error| scene_error(&error))
    }

    fn __len__(&self) -> usize {
        self.core.bodies().len()
    }

    fn names(&self) -> Vec<String> {
        self.core.bodies().iter().map(|body| body.name.clone()).collect()
    }

    fn body(&self, py: Python<'_>, name: &str) -> PyResult<Body> {
        let index = self.core.index_of(name).map_err(|error| scene_error(&error))?;
        self.body_at(py, index)
    }

    fn bodies(&self, py: Python<'_>) -> PyResult<Vec<Body>> {
        (0..self.core.bodies().len()).map(|index| self.body_at(py, index)).collect()
    }

    fn contacts(&self) -> PyResult<Vec<Contact>> {
        let found = find_contacts(&self.core).map_err(|error| scene_error(&error))?;
        let contact = |c: drystone::Contact| Contact {
            a: self.name_of(c.bodies[0]),
            b: self.name_of(c.bodies[1]),
            feature: c.id.feature.to_string(),
            point: Coordinates::of(c.point, true),
            normal: Coordinates::of(c.normal, true),
            gap: c.gap,
            friction: c.friction,
        };
        Ok(found.contacts.into_iter().map(contact).collect())
    }

    fn corner_touches(&self) -> PyResult<Vec<(String, String)>> {
        let found = find_contacts(&self.core).map_err(|error| scene_error(&error))?;
        Ok(found.corner_touches.into_iter().map(|[a, b]| (self.name_of(a), self.name_of(b))).collect())
    }

    fn to_json(&self) -> String {
        io::to_json(&self.core)
    }

    fn save(&self, path: &str) -> PyResult<()> {
        io::save(&self.core, path).map_err(|error| scene_error(&error))
    }

    #[staticmethod]
    #[pyo3(signature = (text, source="scene"))]
    fn from_json(text: &str, source: &str) -> PyResult<Self> {
        io::from_json(text, source).map(|core| Self { core }).map_err(|error| scene_error(&error))
    }

    #[staticmethod]
    fn load(path: &str) -> PyResult<Self> {
        io::load(path).map(|core| Self { core }).map_err(|error| scene_error(&error))
    }

    #[staticmethod]
    fn built_in(name: &str, parameters: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut values = BTreeMap::new();
        for (key, value) in parameters {
            values.insert(key.extract::<String>()?, json_value(&value)?);
        }
        scenes::build(name, &values).map(|core| Self { core }).map_err(|error| scene_error(&error))
    }
}

fn json_value(value: &Bound<'_, PyAny>) -> PyResult<serde_json::Value> {
    if let Ok(flag) = value.extract::<bool>() {
        Ok(flag.into())
    } else if let Ok(integer) = value.extract::<i64>() {
        Ok(integer.into())
    } else if let Ok(number) = value.extract::<f64>() {
        // JSON has no infinities: as text they are refused with the parameter's name.
        let json = serde_json::Number::from_f64(number);
        Ok(json.map_or_else(|| number.to_string().into(), serde_json::Value::Number))
    } else if let Ok(text) = value.extract::<String>() {
        Ok(text.into())
    } else {
        Err(PyTypeError::new_err(format!("a scene's parameters are numbers, not {}", value.get_type())))
    }
}

/// Built-in scenes: (name, summary, [(parameter, summary, whether it is a whole number, default)]).
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn catalogue() -> Vec<(String, String, Vec<(String, String, bool, f64)>)> {
    let parameter = |p: &scenes::Parameter| {
        (p.name.to_owned(), p.summary.to_owned(), p.kind == scenes::ParameterKind::Integer, p.default)
    };
    let entry = |scene: &scenes::SceneEntry| {
        (scene.name.to_owned(), scene.summary.to_owned(), scene.parameters.iter().map(parameter).collect())
    };
    scenes::catalogue().iter().map(entry).collect()
}
