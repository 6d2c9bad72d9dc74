//! The contact forces of the intermediate structures of an order.

use crate::{
    arrays::{matrix, vector},
    errors::plan_error,
    scene::Scene,
};
use drystone::{SceneError, formulate::Assembly, plan as core};
use numpy::{PyArray1, PyArray2};
use pyo3::{exceptions::PyValueError, prelude::*};
use std::time::{Duration, Instant};

/// Forces of some structures, one after another; see the stub for the layout.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct StructureForces {
    blocks: Py<PyArray1<i64>>,
    stands: Py<PyArray1<bool>>,
    offsets: Py<PyArray1<i64>>,
    contact: Py<PyArray1<i64>>,
    force: Py<PyArray2<f64>>,
}

/// What `StructureForces` is made of, as it grows.
#[derive(Default)]
struct Gathered {
    blocks: Vec<i64>,
    stands: Vec<bool>,
    offsets: Vec<i64>,
    contact: Vec<i64>,
    force: Vec<[f64; 2]>,
}

impl Gathered {
    fn add(&mut self, structure: core::StructureForces) {
        self.blocks.push(structure.blocks as i64);
        self.stands.push(structure.forces.is_some());
        for force in structure.forces.into_iter().flatten() {
            self.contact.push(force.contact as i64);
            self.force.push(force.force);
        }
        self.offsets.push(self.contact.len() as i64);
    }
}

const PERIOD: Duration = Duration::from_millis(100);

#[pyfunction]
#[pyo3(signature = (scene, order, every=1, progress=None))]
pub fn forces_along(
    py: Python<'_>,
    scene: &Scene,
    order: Vec<String>,
    every: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<StructureForces> {
    if every == 0 {
        return Err(PyValueError::new_err("every must be one or more"));
    }
    let mut gathered = Gathered { offsets: vec![0], ..Gathered::default() };
    let (mut last, mut stopped) = (Instant::now(), None);
    py.detach(|| {
        let assembly = Assembly::new(&scene.core)?;
        let blocks = blocks_of(scene, &assembly, &order)?;
        let wanted = |placed: usize| (blocks.len() - placed).is_multiple_of(every);
        core::forces_along(&assembly, &blocks, wanted, |structure| {
            let placed = structure.blocks;
            gathered.add(structure);
            if last.elapsed() >= PERIOD {
                last = Instant::now();
                stopped = tell(progress.as_ref(), placed, blocks.len()).err();
            }
            stopped.is_none()
        })
    })
    .map_err(plan_error)?;
    if let Some(error) = stopped {
        return Err(error);
    }
    Ok(StructureForces {
        blocks: vector(py, gathered.blocks).unbind(),
        stands: vector(py, gathered.stands).unbind(),
        offsets: vector(py, gathered.offsets).unbind(),
        contact: vector(py, gathered.contact).unbind(),
        force: matrix(py, &gathered.force)?.unbind(),
    })
}

/// The movable blocks that names name, in their order; a fixed body is always there.
fn blocks_of(scene: &Scene, assembly: &Assembly, names: &[String]) -> Result<Vec<usize>, SceneError> {
    let mut block_at = vec![None; scene.core.bodies().len()];
    (0..assembly.blocks()).for_each(|block| block_at[assembly.body_index(block)] = Some(block));
    let bodies = names.iter().map(|name| scene.core.index_of(name)).collect::<Result<Vec<_>, _>>()?;
    Ok(bodies.into_iter().filter_map(|body| block_at[body]).collect())
}

/// Looks for Ctrl-C and reports progress.
fn tell(progress: Option<&Py<PyAny>>, placed: usize, blocks: usize) -> PyResult<()> {
    Python::attach(|py| {
        py.check_signals()?;
        progress.map_or(Ok(()), |function| function.call1(py, (placed, blocks)).map(drop))
    })
}
