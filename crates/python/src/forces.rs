//! The contact forces of the intermediate structures of an order.

use crate::{
    arrays::{matrix, vector},
    errors::plan_error,
    scene::Scene,
    watch::{in_python, interruptible},
};
use drystone::plan::{self as core, Course, WhichForces};
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
    hands: Vec<Vec<(String, Vec<f64>)>>,
}

/// What `StructureForces` is made of, as it grows.
#[derive(Default)]
struct Gathered {
    blocks: Vec<i64>,
    stands: Vec<bool>,
    offsets: Vec<i64>,
    contact: Vec<i64>,
    force: Vec<[f64; 3]>,
    hands: Vec<Vec<(usize, [f64; 6])>>,
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
        self.hands.push(structure.hands);
    }
}

const PERIOD: Duration = Duration::from_millis(100);

#[pyfunction]
#[pyo3(signature = (scene, order, every=1, progress=None, cones=None, held=None, any_forces=false))]
#[allow(clippy::too_many_arguments)]
pub fn forces_along(
    py: Python<'_>,
    scene: &Scene,
    order: Vec<String>,
    every: usize,
    progress: Option<Py<PyAny>>,
    cones: Option<(usize, String)>,
    held: Option<Vec<Vec<String>>>,
    any_forces: bool,
) -> PyResult<StructureForces> {
    if every == 0 {
        return Err(PyValueError::new_err("every must be one or more"));
    }
    let mut gathered = Gathered { offsets: vec![0], ..Gathered::default() };
    let (mut last, mut stopped) = (Instant::now(), None);
    let assembly = scene.assembly(py, cones)?;
    interruptible(py, || {
        let blocks = assembly.named(&order)?;
        let wanted = |placed: usize| (blocks.len() - placed).is_multiple_of(every);
        let held = held.iter().flatten().map(|names| assembly.named(names)).collect::<Result<Vec<_>, _>>()?;
        let forces = if any_forces { WhichForces::Any } else { WhichForces::Canonical };
        let course = Course { order: &blocks, held: &held, forces };
        core::forces_along(&assembly, &course, wanted, |structure| {
            let placed = structure.blocks;
            gathered.add(structure);
            if last.elapsed() >= PERIOD {
                last = Instant::now();
                stopped = tell(progress.as_ref(), placed, blocks.len()).err();
            }
            stopped.is_none()
        })
    })?
    .map_err(plan_error)?;
    if let Some(error) = stopped {
        return Err(error);
    }
    let hand = |&(block, wrench): &(usize, [f64; 6])| {
        let own = assembly.components().iter().map(|&k| wrench[k]).collect();
        (assembly.body(block).name.clone(), own)
    };
    let hands = gathered.hands.iter().map(|hands| hands.iter().map(hand).collect()).collect();
    Ok(StructureForces {
        hands,
        blocks: vector(py, gathered.blocks).unbind(),
        stands: vector(py, gathered.stands).unbind(),
        offsets: vector(py, gathered.offsets).unbind(),
        contact: vector(py, gathered.contact).unbind(),
        force: if assembly.in_plane() {
            matrix(py, &gathered.force.iter().map(|f| [f[0], f[1]]).collect::<Vec<_>>())?.unbind()
        } else {
            matrix(py, &gathered.force)?.unbind()
        },
    })
}

/// Looks for Ctrl-C and reports progress.
fn tell(progress: Option<&Py<PyAny>>, placed: usize, blocks: usize) -> PyResult<()> {
    in_python(|py| {
        py.check_signals()?;
        progress.map_or(Ok(()), |function| function.call1(py, (placed, blocks)).map(drop))
    })
}
