//! `World`: bodies in motion, one step or many.

use crate::{
    arrays::rows,
    contact_forces::ContactForce,
    errors::{scene_error, simulation_error, step_error},
    guard::Guarded,
    run::{Run, StepRecord},
    scene::{Scene, cones},
    watch::{Watch, interruptible},
};
use drystone::{
    AnyScene,
    geometry::{Numbers, Polygon, Solid},
    simulate::{self as core, Formulation, Kept, Moving, Options, Reuse, SimulationError, snapshot_dimension},
};
use numpy::{PyArray1, PyArray2};
use pyo3::{
    exceptions::{PyTypeError, PyValueError},
    prelude::*,
    types::PyBytes,
};

#[pyclass(frozen, module = "drystone._core")]
pub struct World {
    core: Guarded<AnyWorld>,
}

/// In the plane or in space.
#[allow(clippy::large_enum_variant)]
enum AnyWorld {
    Plane(core::World<Polygon>),
    Space(core::World<Solid>),
}

/// Does the same with either.
macro_rules! with_world {
    ($any:expr, $world:ident => $answer:expr) => {
        match $any {
            AnyWorld::Plane($world) => $answer,
            AnyWorld::Space($world) => $answer,
        }
    };
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

fn raised<T>(result: Result<T, SimulationError>) -> PyResult<T> {
    result.map_err(|error| simulation_error(&error))
}

/// As many numbers as a velocity, or a vector, has.
fn fixed<V: Numbers>(values: &[f64], what: &str) -> PyResult<V> {
    let mut fixed = V::default();
    let wanted = fixed.as_ref().len();
    if values.len() != wanted {
        return Err(PyTypeError::new_err(format!("{what} has {wanted} numbers here, not {}", values.len())));
    }
    fixed.as_mut().copy_from_slice(values);
    Ok(fixed)
}

/// A wrench and where it acts.
fn push<S: Moving>(wrench: &[f64], at: Option<&[f64]>) -> PyResult<(S::Velocity, Option<S::Vector>)> {
    Ok((fixed(wrench, "a wrench")?, at.map(|at| fixed(at, "a point")).transpose()?))
}

#[pymethods]
impl World {
    #[allow(clippy::too_many_arguments)] // they are Python's
    #[new]
    #[pyo3(signature = (scene, dt, reuse, restitution, formulation, coulomb_tolerance, friction_cones=None))]
    fn new(
        py: Python<'_>,
        scene: &Scene,
        dt: f64,
        reuse: &str,
        restitution: f64,
        formulation: &str,
        coulomb_tolerance: f64,
        friction_cones: Option<(usize, String)>,
    ) -> PyResult<Self> {
        let (reuse, formulation) = (named_reuse(reuse)?, named_formulation(formulation)?);
        let cones = cones(friction_cones)?;
        let options = Options { dt, reuse, restitution, formulation, cones, coulomb_tolerance };
        let scene = scene.now();
        let made = interruptible(py, || {
            Ok(match AnyScene::clone(&scene) {
                AnyScene::Plane(scene) => AnyWorld::Plane(core::World::new(scene, options)?),
                AnyScene::Space(scene) => AnyWorld::Space(core::World::new(scene, options)?),
            })
        })?;
        Ok(Self::of(raised(made)?))
    }

    fn step(&self, py: Python<'_>) -> PyResult<StepRecord> {
        with_world!(&mut *self.core.write()?, world => {
            let record = interruptible(py, || world.step())?.map_err(|failure| step_error(&failure))?;
            Ok(StepRecord::new(py, record, &world.names().collect::<Vec<_>>()))
        })
    }

    /// Makes steps; `progress` is called with (steps made, steps in all) a few times a second.
    #[pyo3(signature = (steps, forces=false, progress=None, every=1))]
    fn run(
        &self,
        py: Python<'_>,
        steps: usize,
        forces: bool,
        progress: Option<Py<PyAny>>,
        every: usize,
    ) -> PyResult<Run> {
        let kept = Kept { every, forces };
        let mut watch = Watch::new(progress);
        let signals = watch.signals.clone();
        with_world!(&mut *self.core.write()?, world => {
            let run = signals.run(py, || core::run(world, steps, kept, |made| watch.go_on(|| (made, steps))));
            let run = run.ok_or_else(|| signals.error())?;
            match watch.error(py) {
                Some(error) => Err(error),
                None => Run::new(py, run, world.options().dt, world.names().count()),
            }
        })
    }

    #[getter]
    fn scene(&self) -> PyResult<Scene> {
        Ok(Scene::of(with_world!(&*self.core.read()?, world => world.scene().into_owned().into())))
    }

    #[getter]
    fn dimension(&self) -> PyResult<usize> {
        Ok(match *self.core.read()? {
            AnyWorld::Plane(_) => 2,
            AnyWorld::Space(_) => 3,
        })
    }

    #[getter]
    fn names(&self) -> PyResult<Vec<String>> {
        Ok(with_world!(&*self.core.read()?, world => world.names().map(str::to_owned).collect()))
    }

    #[getter]
    fn dt(&self) -> PyResult<f64> {
        Ok(self.options()?.dt)
    }

    #[getter]
    fn reuse(&self) -> PyResult<&'static str> {
        Ok(self.options()?.reuse.name())
    }

    #[getter]
    fn restitution(&self) -> PyResult<f64> {
        Ok(self.options()?.restitution)
    }

    #[getter]
    fn coulomb_tolerance(&self) -> PyResult<f64> {
        Ok(self.options()?.coulomb_tolerance)
    }

    #[getter]
    fn formulation(&self) -> PyResult<&'static str> {
        Ok(self.options()?.formulation.name())
    }

    #[getter]
    fn steps(&self) -> PyResult<u64> {
        Ok(with_world!(&*self.core.read()?, world => world.steps()))
    }

    #[getter]
    fn energy(&self) -> PyResult<f64> {
        Ok(with_world!(&*self.core.read()?, world => world.energy()))
    }

    #[getter]
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        with_world!(&*self.core.read()?, world => rows(py, &world.poses().collect::<Vec<_>>()))
    }

    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        with_world!(&*self.core.read()?, world => rows(py, &world.velocities()))
    }

    #[getter]
    fn motionless<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        Ok(with_world!(&*self.core.read()?, world => crate::arrays::vector(py, world.motionless().to_vec())))
    }

    /// Mean forces of the last step at the contacts that bear: the canonical ones if nothing moved in it.
    fn forces(&self, py: Python<'_>) -> PyResult<Vec<ContactForce>> {
        let forces = with_world!(&*self.core.read()?, world => {
            let dt = world.options().dt;
            let bearing = interruptible(py, || world.bearing_impulses())?;
            let names: Vec<&str> = world.names().collect();
            bearing.into_iter().map(|contact| ContactForce::of_impulse(&names, &contact, dt)).collect()
        });
        Ok(forces)
    }

    fn set_velocity(&self, name: &str, velocity: Vec<f64>) -> PyResult<()> {
        with_world!(&mut *self.core.write()?, world => raised(world.set_velocity(name, fixed(&velocity, "a velocity")?)))
    }

    /// `wrench`: force and moment.
    #[pyo3(signature = (name, wrench, at=None))]
    fn apply_force(&self, name: &str, wrench: Vec<f64>, at: Option<Vec<f64>>) -> PyResult<()> {
        match &mut *self.core.write()? {
            AnyWorld::Plane(world) => {
                let (wrench, at) = push::<Polygon>(&wrench, at.as_deref())?;
                raised(world.apply_force(name, wrench, at))
            }
            AnyWorld::Space(world) => {
                let (wrench, at) = push::<Solid>(&wrench, at.as_deref())?;
                raised(world.apply_force(name, wrench, at))
            }
        }
    }

    /// `wrench`: impulse and impulsive moment.
    #[pyo3(signature = (name, wrench, at=None))]
    fn apply_impulse(&self, name: &str, wrench: Vec<f64>, at: Option<Vec<f64>>) -> PyResult<()> {
        match &mut *self.core.write()? {
            AnyWorld::Plane(world) => {
                let (wrench, at) = push::<Polygon>(&wrench, at.as_deref())?;
                raised(world.apply_impulse(name, wrench, at))
            }
            AnyWorld::Space(world) => {
                let (wrench, at) = push::<Solid>(&wrench, at.as_deref())?;
                raised(world.apply_impulse(name, wrench, at))
            }
        }
    }

    /// Takes up the bodies that this scene has beyond the world's.
    fn extend(&self, py: Python<'_>, scene: &Scene) -> PyResult<()> {
        let scene = AnyScene::clone(&scene.now());
        match &mut *self.core.write()? {
            AnyWorld::Plane(world) => {
                let scene = scene.in_plane().map_err(|error| scene_error(&error))?;
                raised(interruptible(py, || world.extend(scene))?)
            }
            AnyWorld::Space(world) => {
                let scene = scene.in_space().map_err(|error| scene_error(&error))?;
                raised(interruptible(py, || world.extend(scene))?)
            }
        }
    }

    fn remove(&self, name: &str) -> PyResult<()> {
        with_world!(&mut *self.core.write()?, world => raised(world.remove(name)))
    }

    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(with_world!(&*self.core.read()?, world => PyBytes::new(py, &world.snapshot())))
    }

    #[staticmethod]
    fn restore(snapshot: &[u8]) -> PyResult<Self> {
        let core = match raised(snapshot_dimension(snapshot))? {
            2 => AnyWorld::Plane(raised(core::World::restore(snapshot))?),
            _ => AnyWorld::Space(raised(core::World::restore(snapshot))?),
        };
        Ok(Self::of(core))
    }

    fn state_hash(&self) -> PyResult<u64> {
        Ok(with_world!(&*self.core.read()?, world => world.hash()))
    }
}

impl World {
    fn of(core: AnyWorld) -> Self {
        Self { core: Guarded::new("World", core) }
    }

    fn options(&self) -> PyResult<Options> {
        Ok(with_world!(&*self.core.read()?, world => world.options()))
    }
}
