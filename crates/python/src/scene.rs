//! `Scene` and what it shows of itself.

use crate::{
    arrays::matrix,
    coordinates::Coordinates,
    errors::{scene_error, simulation_error},
    watch::{interruptible, look},
};
use drystone::{
    AnyScene, BodyOptions, MassProperties, SceneError, SceneOf,
    contact::{find_overlaps, find_solid_contacts, find_solid_overlaps},
    find_contacts,
    formulate::{self, Assembly, Cones},
    geometry::{PoseInSpace, Shape},
    io, scenes, simulate,
    unsupported::{explain, near_misses},
};
use numpy::{Element, PyArray2, PyReadonlyArray2};
use pyo3::{
    exceptions::{PyTypeError, PyValueError},
    prelude::*,
    types::PyDict,
};
use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

/// Who works with the bodies takes them as they are at that moment; a change meanwhile, by another thread too, makes others.
#[pyclass(frozen, module = "drystone._core")]
pub struct Scene {
    core: Mutex<Arc<AnyScene>>,
}

/// A snapshot of one body in the plane. `vertices` is (n, 2) in world coordinates, metres, counter-clockwise.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Body {
    name: String,
    fixed: bool,
    density: f64,
    friction: f64,
    mass: f64,
    inertia: f64,
    center_of_mass: (f64, f64),
    /// The centroid in the body's frame.
    offset: (f64, f64),
    angle: f64,
    vertices: Py<PyArray2<f64>>,
}

/// Corners of a convex piece, and the faces as lists of them.
type Piece = (Py<PyArray2<f64>>, Vec<Vec<usize>>);

/// Vertices and triangles of a closed surface.
type Surface = (Py<PyArray2<f64>>, Py<PyArray2<u32>>);

/// A snapshot of one body in space; see the stub.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Solid {
    name: String,
    fixed: bool,
    density: f64,
    friction: f64,
    mass: f64,
    inertia: Py<PyArray2<f64>>,
    center_of_mass: (f64, f64, f64),
    /// The centroid in the body's frame.
    offset: (f64, f64, f64),
    orientation: (f64, f64, f64, f64),
    box_size: Option<(f64, f64, f64)>,
    pieces: Vec<Piece>,
    surface: Option<Surface>,
    vertices: Py<PyArray2<f64>>,
}

/// One contact point. `normal` is a unit vector from body `a` into body `b`.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct Contact {
    a: String,
    b: String,
    feature: String,
    at_borders: bool,
    point: Coordinates,
    normal: Coordinates,
    gap: f64,
    friction: f64,
}

/// A body's own mass (kg), centre of mass (m) and inertia (kg m^2), as far as they are given.
type OwnInPlane = (Option<f64>, Option<[f64; 2]>, Option<f64>);
type OwnInSpace = (Option<f64>, Option<[f64; 3]>, Option<[[f64; 3]; 3]>);

fn own_in_plane((mass, center, inertia): OwnInPlane) -> MassProperties {
    MassProperties {
        mass,
        center_of_mass: center.map(|[x, y]| [x, y, 0.0]),
        inertia: inertia.map(|moment| [[0.0; 3], [0.0; 3], [0.0, 0.0, moment]]),
    }
}

fn own_in_space((mass, center_of_mass, inertia): OwnInSpace) -> MassProperties {
    MassProperties { mass, center_of_mass, inertia }
}

pub fn options(
    name: Option<String>,
    density: f64,
    friction: Option<f64>,
    fixed: bool,
    own: MassProperties,
) -> BodyOptions {
    BodyOptions { name, density, friction, fixed, own }
}

pub fn raised<T>(result: Result<T, SceneError>) -> PyResult<T> {
    result.map_err(|error| scene_error(&error))
}

/// Friction cones by the name of their bound; without a choice the default ones.
pub fn cones(choice: Option<(usize, String)>) -> PyResult<Cones> {
    let Some((facets, bound)) = choice else { return Ok(Cones::default()) };
    let bound = match bound.as_str() {
        "inscribed" => formulate::Bound::Inscribed,
        "circumscribed" => formulate::Bound::Circumscribed,
        other => {
            let message = format!("unknown cone \"{other}\": give \"inscribed\" or \"circumscribed\"");
            return Err(PyValueError::new_err(message));
        }
    };
    Ok(Cones { facets, bound })
}

impl Scene {
    pub fn of(core: AnyScene) -> Self {
        Self { core: Mutex::new(Arc::new(core)) }
    }

    /// The bodies as they are now.
    pub fn now(&self) -> Arc<AnyScene> {
        Arc::clone(&self.lock())
    }

    /// A body is added whole or not at all: what a panic left behind is a scene.
    pub fn lock(&self) -> MutexGuard<'_, Arc<AnyScene>> {
        self.core.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The contacts and generators, found without holding Python's lock.
    pub fn assembly(&self, py: Python<'_>, friction_cones: Option<(usize, String)>) -> PyResult<Assembly> {
        let (cones, scene) = (cones(friction_cones)?, self.now());
        raised(interruptible(py, || scene.assembly(cones))?)
    }

    /// The scene, if it is in the plane.
    pub fn planar(&self) -> PyResult<drystone::Scene> {
        raised(AnyScene::clone(&self.now()).in_plane())
    }

    /// Adds a body by `place` and returns its name.
    fn add_in_plane(&self, place: impl FnOnce(&mut drystone::Scene) -> Result<usize, SceneError>) -> PyResult<String> {
        match Arc::make_mut(&mut self.lock()) {
            AnyScene::Plane(scene) => {
                let added = place(scene);
                name_of(scene, added)
            }
            AnyScene::Space(_) => raised(Err(SceneError::NotInPlane)),
        }
    }

    /// The same in space.
    fn add_in_space(
        &self,
        place: impl FnOnce(&mut drystone::SceneInSpace) -> Result<usize, SceneError>,
    ) -> PyResult<String> {
        match Arc::make_mut(&mut self.lock()) {
            AnyScene::Space(scene) => {
                let added = place(scene);
                name_of(scene, added)
            }
            AnyScene::Plane(_) => raised(Err(SceneError::NotInSpace)),
        }
    }
}

fn body_at(py: Python<'_>, scene: &AnyScene, index: usize) -> PyResult<Py<PyAny>> {
    match scene {
        AnyScene::Plane(scene) => Ok(Py::new(py, Body::of(py, scene, index)?)?.into_any()),
        AnyScene::Space(scene) => Ok(Py::new(py, Solid::of(py, scene, index)?)?.into_any()),
    }
}

fn found(py: Python<'_>, scene: &AnyScene) -> PyResult<drystone::ContactSet> {
    raised(interruptible(py, || match scene {
        AnyScene::Plane(scene) => find_contacts(scene),
        AnyScene::Space(scene) => find_solid_contacts(scene),
    })?)
}

impl Body {
    fn of(py: Python<'_>, scene: &drystone::Scene, index: usize) -> PyResult<Self> {
        let body = &scene.bodies()[index];
        Ok(Self {
            name: body.name.clone(),
            fixed: body.fixed,
            density: body.density,
            friction: body.friction.unwrap_or(scene.friction()),
            mass: body.mass(),
            inertia: body.inertia(),
            center_of_mass: body.pose.position.into(),
            offset: body.shape.centroid().into(),
            angle: body.pose.angle,
            vertices: matrix(py, &body.vertices())?.unbind(),
        })
    }
}

impl Solid {
    fn of(py: Python<'_>, scene: &drystone::SceneInSpace, index: usize) -> PyResult<Self> {
        let body = &scene.bodies()[index];
        let axes = body.principal_axes().map(|axis| body.pose.rotate(axis));
        let entry = |i: usize, j: usize| (0..3).map(|k| body.moments()[k] * axes[k][i] * axes[k][j]).sum();
        let inertia: [[f64; 3]; 3] = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
        let piece = |piece: &drystone::geometry::Polyhedron| -> PyResult<Piece> {
            let vertices: Vec<[f64; 3]> = piece.vertices().iter().map(|v| v.to_array()).collect();
            Ok((matrix(py, &vertices)?.unbind(), piece.faces().to_vec()))
        };
        Ok(Self {
            name: body.name.clone(),
            fixed: body.fixed,
            density: body.density,
            friction: body.friction.unwrap_or(scene.friction()),
            mass: body.mass(),
            inertia: matrix(py, &inertia)?.unbind(),
            center_of_mass: body.pose.position.into(),
            offset: body.shape.centroid().into(),
            orientation: body.pose.orientation.into(),
            box_size: body.box_size.map(Into::into),
            pieces: body.shape.pieces().iter().map(piece).collect::<PyResult<_>>()?,
            surface: body.shape.surface().map(|surface| surface_of(py, surface)).transpose()?,
            vertices: matrix(py, &body.corners())?.unbind(),
        })
    }
}

fn surface_of(py: Python<'_>, surface: &drystone::geometry::Surface) -> PyResult<Surface> {
    let vertices: Vec<[f64; 3]> = surface.vertices().iter().map(|v| v.to_array()).collect();
    Ok((matrix(py, &vertices)?.unbind(), matrix(py, surface.triangles())?.unbind()))
}

/// The rows of an array of three columns.
fn triples<T: Element + Copy>(array: &PyReadonlyArray2<'_, T>) -> PyResult<Vec<[T; 3]>> {
    let rows = array.as_array();
    if rows.ncols() != 3 {
        return Err(PyValueError::new_err("vertices and triangles have three numbers each"));
    }
    Ok(rows.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect())
}

/// The name of the body that was added.
fn name_of<S: Shape>(scene: &SceneOf<S>, added: Result<usize, SceneError>) -> PyResult<String> {
    raised(added.map(|index| scene.bodies()[index].name.clone()))
}

/// An empty scene with or without a tolerance of its own.
fn empty<S: Shape>(gravity: S::Vector, friction: f64, tolerance: Option<f64>) -> Result<SceneOf<S>, SceneError> {
    let scene = SceneOf::new(gravity, friction)?;
    match tolerance {
        Some(tolerance) => scene.with_contact_tolerance(tolerance),
        None => Ok(scene),
    }
}

#[pymethods]
impl Scene {
    /// `gravity` has two numbers in the plane, three in space.
    #[new]
    #[pyo3(signature = (gravity, friction, contact_tolerance=None))]
    fn new(gravity: Vec<f64>, friction: f64, contact_tolerance: Option<f64>) -> PyResult<Self> {
        let core = match gravity[..] {
            [x, y] => raised(empty([x, y], friction, contact_tolerance).map(AnyScene::Plane)),
            [x, y, z] => raised(empty([x, y, z], friction, contact_tolerance).map(AnyScene::Space)),
            _ => Err(PyTypeError::new_err("gravity has two numbers in the plane, three in space")),
        };
        Ok(Self::of(core?))
    }

    #[getter]
    fn dimension(&self) -> usize {
        self.now().dimension()
    }

    #[getter]
    fn gravity(&self) -> Coordinates {
        match &*self.now() {
            AnyScene::Plane(scene) => scene.gravity().into(),
            AnyScene::Space(scene) => Coordinates::of(scene.gravity(), false),
        }
    }

    #[getter]
    fn friction(&self) -> f64 {
        self.now().friction()
    }

    fn largest_friction(&self) -> f64 {
        self.now().largest_friction()
    }

    #[getter]
    fn contact_tolerance(&self) -> Option<f64> {
        self.now().contact_tolerance()
    }

    #[allow(clippy::too_many_arguments)]
    fn add_box(
        &self,
        center: [f64; 2],
        size: [f64; 2],
        angle: f64,
        name: Option<String>,
        density: f64,
        friction: Option<f64>,
        fixed: bool,
        own: OwnInPlane,
    ) -> PyResult<String> {
        let options = options(name, density, friction, fixed, own_in_plane(own));
        self.add_in_plane(|scene| scene.add_box(center, size, angle, options))
    }

    #[allow(clippy::too_many_arguments)]
    fn add_polygon(
        &self,
        vertices: Vec<[f64; 2]>,
        name: Option<String>,
        density: f64,
        friction: Option<f64>,
        fixed: bool,
        own: OwnInPlane,
    ) -> PyResult<String> {
        let options = options(name, density, friction, fixed, own_in_plane(own));
        self.add_in_plane(|scene| scene.add_polygon(&vertices, options))
    }

    #[allow(clippy::too_many_arguments)]
    fn add_cuboid(
        &self,
        center: [f64; 3],
        size: [f64; 3],
        orientation: [f64; 4],
        name: Option<String>,
        density: f64,
        friction: Option<f64>,
        fixed: bool,
        own: OwnInSpace,
    ) -> PyResult<String> {
        let (options, pose) =
            (options(name, density, friction, fixed, own_in_space(own)), PoseInSpace { position: center, orientation });
        self.add_in_space(|scene| scene.add_cuboid(pose, size, options))
    }

    #[allow(clippy::too_many_arguments)]
    fn add_solid(
        &self,
        pieces: Vec<Vec<[f64; 3]>>,
        position: [f64; 3],
        orientation: [f64; 4],
        name: Option<String>,
        density: f64,
        friction: Option<f64>,
        fixed: bool,
        own: OwnInSpace,
    ) -> PyResult<String> {
        let (options, pose) =
            (options(name, density, friction, fixed, own_in_space(own)), PoseInSpace { position, orientation });
        self.add_in_space(|scene| scene.add_solid(&pieces, pose, options))
    }

    /// Adds a body within a closed surface: `vertices` (k, 3), `triangles` (n, 3).
    #[allow(clippy::too_many_arguments)]
    fn add_surface(
        &self,
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        position: [f64; 3],
        orientation: [f64; 4],
        name: Option<String>,
        density: f64,
        friction: Option<f64>,
        fixed: bool,
        own: OwnInSpace,
    ) -> PyResult<String> {
        let (options, pose) =
            (options(name, density, friction, fixed, own_in_space(own)), PoseInSpace { position, orientation });
        let (vertices, triangles) = (triples(&vertices)?, triples(&triangles)?);
        // Made apart, so that other threads go on meanwhile.
        let scene = self.now();
        let AnyScene::Space(space) = &*scene else { return raised(Err(SceneError::NotInSpace)) };
        let (solid, center) = raised(interruptible(py, || space.enclosed(&vertices, &triangles, &options))?)?;
        self.add_in_space(|scene| scene.add_enclosed(solid, center, pose, options))
    }

    /// The same scene in space, every block with this thickness.
    fn extruded(&self, py: Python<'_>, depth: f64) -> PyResult<Self> {
        let planar = self.planar()?;
        let solid = raised(interruptible(py, || scenes::extruded(&planar, depth))?)?;
        Ok(Self::of(solid.into()))
    }

    /// The same scene with overlaps taken back.
    fn parted(&self, py: Python<'_>) -> PyResult<Self> {
        let scene = self.now();
        let parted = interruptible(py, || match (*scene).clone() {
            AnyScene::Plane(scene) => simulate::parted(scene).map(AnyScene::from),
            AnyScene::Space(scene) => simulate::parted(scene).map(AnyScene::from),
        })?
        .map_err(|error| simulation_error(&error))?;
        Ok(Self::of(parted))
    }

    /// The same scene once more; one that shares its bodies until either changes.
    fn copy(&self) -> Self {
        Self { core: Mutex::new(self.now()) }
    }

    fn __len__(&self) -> usize {
        self.now().len()
    }

    fn names(&self) -> Vec<String> {
        let scene = self.now();
        (0..scene.len()).map(|index| scene.name(index).to_owned()).collect()
    }

    fn body(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyAny>> {
        let scene = self.now();
        body_at(py, &scene, raised(scene.index_of(name))?)
    }

    fn bodies(&self, py: Python<'_>) -> PyResult<Vec<Py<PyAny>>> {
        let scene = self.now();
        let body = |index: usize| {
            look(py, index)?;
            body_at(py, &scene, index)
        };
        (0..scene.len()).map(body).collect()
    }

    fn contacts(&self, py: Python<'_>) -> PyResult<Vec<Py<Contact>>> {
        let scene = self.now();
        let in_plane = scene.dimension() == 2;
        let contact = |c: drystone::Contact| Contact {
            a: scene.name(c.bodies[0]).to_owned(),
            b: scene.name(c.bodies[1]).to_owned(),
            feature: c.id.feature.to_string(),
            at_borders: c.id.feature.at_borders(),
            point: Coordinates::of(c.point, in_plane),
            normal: Coordinates::of(c.normal, in_plane),
            gap: c.gap,
            friction: c.friction,
        };
        let made = |(k, found): (usize, drystone::Contact)| {
            look(py, k)?;
            Py::new(py, contact(found))
        };
        found(py, &scene)?.contacts.into_iter().enumerate().map(made).collect()
    }

    fn corner_touches(&self, py: Python<'_>) -> PyResult<Vec<(String, String)>> {
        let scene = self.now();
        let name = |index: usize| scene.name(index).to_owned();
        Ok(found(py, &scene)?.corner_touches.into_iter().map(|[a, b]| (name(a), name(b))).collect())
    }

    /// Every pair of bodies that overlap: (a, b, depth, contact tolerance), metres.
    fn overlaps(&self, py: Python<'_>) -> PyResult<Vec<(String, String, f64, f64)>> {
        let scene = self.now();
        let found = interruptible(py, || match &*scene {
            AnyScene::Plane(plane) => find_overlaps(plane),
            AnyScene::Space(space) => find_solid_overlaps(space),
        })?;
        let name = |index: usize| scene.name(index).to_owned();
        Ok(found.into_iter().map(|o| (name(o.bodies[0]), name(o.bodies[1]), o.depth, o.tolerance)).collect())
    }

    /// Pairs that do not touch, but would with ten times the contact tolerance: (a, b, gap, that tolerance), metres.
    fn near_misses(&self, py: Python<'_>) -> PyResult<Vec<(String, String, f64, f64)>> {
        let scene = self.now();
        let found = raised(interruptible(py, || match &*scene {
            AnyScene::Plane(plane) => near_misses(plane),
            AnyScene::Space(space) => near_misses(space),
        })?)?;
        let name = |index: usize| scene.name(index).to_owned();
        Ok(found.into_iter().map(|m| (name(m.bodies[0]), name(m.bodies[1]), m.gap, m.tolerance)).collect())
    }

    /// Why blocks fall that bear on nothing: ([(name, touches, nearest, distance)], [(a, b, gap, contact tolerance)]).
    #[allow(clippy::type_complexity)]
    fn explain_fall(
        &self,
        py: Python<'_>,
        checked: Vec<String>,
        falling: Vec<String>,
    ) -> PyResult<(Vec<(String, Vec<String>, Option<(String, f64)>)>, Vec<(String, String, f64, f64)>)> {
        let scene = self.now();
        let index = |names: Vec<String>| -> Result<Vec<usize>, SceneError> {
            names.iter().map(|name| scene.index_of(name)).collect()
        };
        let (checked, falling) = (raised(index(checked))?, raised(index(falling))?);
        let found = raised(interruptible(py, || match &*scene {
            AnyScene::Plane(plane) => explain(plane, &checked, &falling),
            AnyScene::Space(space) => explain(space, &checked, &falling),
        })?)?;
        let name = |index: usize| scene.name(index).to_owned();
        let unsupported = found.unsupported.into_iter().map(|block| {
            let nearest = block.nearest.map(|(body, distance)| (name(body), distance));
            (name(block.body), block.touches.into_iter().map(name).collect(), nearest)
        });
        let misses = found.near_misses.into_iter().map(|miss| {
            let [a, b] = miss.bodies.map(name);
            (a, b, miss.gap, miss.tolerance)
        });
        Ok((unsupported.collect(), misses.collect()))
    }

    fn to_json(&self, py: Python<'_>) -> PyResult<String> {
        let scene = self.now();
        interruptible(py, || scene.to_json())
    }

    fn save(&self, py: Python<'_>, path: &str) -> PyResult<()> {
        let scene = self.now();
        raised(interruptible(py, || io::save(&scene, path))?)
    }

    #[staticmethod]
    #[pyo3(signature = (text, source="scene"))]
    fn from_json(py: Python<'_>, text: &str, source: &str) -> PyResult<Self> {
        raised(interruptible(py, || io::from_json(text, source))?).map(Self::of)
    }

    #[staticmethod]
    fn load(py: Python<'_>, path: &str) -> PyResult<Self> {
        raised(interruptible(py, || io::load(path))?).map(Self::of)
    }

    #[staticmethod]
    fn built_in(py: Python<'_>, name: &str, parameters: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut values = BTreeMap::new();
        for (key, value) in parameters {
            values.insert(key.extract::<String>()?, json_value(&value)?);
        }
        raised(interruptible(py, || scenes::build(name, &values))?).map(Self::of)
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
