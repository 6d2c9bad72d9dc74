//! Typed errors in Python: one map from each Rust error to its exception.

use drystone::{
    SceneError,
    plan::PlanError,
    simulate::{SimulationError, StepFailure},
};
use drystone_lcp::LcpError;
use pyo3::{
    exceptions::{PyException, PyRuntimeError, PyValueError},
    prelude::*,
    sync::PyOnceLock,
    types::{IntoPyDict, PyTuple, PyType},
};

struct Exceptions {
    base: Py<PyType>,
    scene: Py<PyType>,
    lcp: Py<PyType>,
    contact: Py<PyType>,
    start: Py<PyType>,
    simulation: Py<PyType>,
    step: Py<PyType>,
    busy: Py<PyType>,
}

static EXCEPTIONS: PyOnceLock<Exceptions> = PyOnceLock::new();

fn exceptions(py: Python<'_>) -> PyResult<&'static Exceptions> {
    EXCEPTIONS.get_or_try_init(py, || {
        // `type(name, bases, {...})`: two bases, so that bad input is also a ValueError.
        let make = |name: &str, doc: &str, bases: &[&Bound<'_, PyType>]| -> PyResult<Py<PyType>> {
            let namespace = [("__module__", "drystone"), ("__doc__", doc)].into_py_dict(py)?;
            let class = py.get_type::<PyType>().call1((name, PyTuple::new(py, bases)?, namespace))?;
            Ok(class.cast_into::<PyType>()?.unbind())
        };
        let value_error = py.get_type::<PyValueError>();
        let base = make("DrystoneError", "Base of drystone's errors.", &[&py.get_type::<PyException>()])?;
        let both = [base.bind(py), &value_error];
        let scene = make("SceneError", "A scene that is not valid; says what to mend.", &both)?;
        let lcp = make("LcpError", "A complementarity problem that is not valid.", &both)?;
        let contact = make("ContactError", "A contact problem that is not valid; says what to mend.", &both)?;
        let start = make("StartError", "A start that does not fit the problem.", &[lcp.bind(py)])?;
        let simulation = make("SimulationError", "Bad input to a simulation; says what to mend.", &both)?;
        let step = make("StepError", "A step that could not be made; the world is as before.", &[base.bind(py)])?;
        let busy_bases = [base.bind(py), &py.get_type::<PyRuntimeError>()];
        let busy =
            make("BusyError", "Another call, of another thread or around this one, has the object.", &busy_bases)?;
        Ok(Exceptions { base, scene, lcp, contact, start, simulation, step, busy })
    })
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let known = exceptions(py)?;
    module.add("DrystoneError", known.base.bind(py))?;
    module.add("SceneError", known.scene.bind(py))?;
    module.add("LcpError", known.lcp.bind(py))?;
    module.add("ContactError", known.contact.bind(py))?;
    module.add("StartError", known.start.bind(py))?;
    module.add("SimulationError", known.simulation.bind(py))?;
    module.add("StepError", known.step.bind(py))?;
    module.add("BusyError", known.busy.bind(py))
}

fn raise(pick: impl Fn(&Exceptions) -> &Py<PyType>, message: String) -> PyErr {
    Python::attach(|py| match exceptions(py) {
        Ok(known) => PyErr::from_type(pick(known).bind(py).clone(), (message,)),
        Err(error) => error,
    })
}

pub fn scene_error(error: &SceneError) -> PyErr {
    raise(|known| &known.scene, error.to_string())
}

pub fn lcp_error(error: &LcpError) -> PyErr {
    match error {
        LcpError::Start(start) => raise(|known| &known.start, start.to_string()),
        other => raise(|known| &known.lcp, other.to_string()),
    }
}

pub fn contact_error(error: impl std::fmt::Display) -> PyErr {
    raise(|known| &known.contact, error.to_string())
}

/// Another call has the object.
pub fn busy(what: &str) -> PyErr {
    let message = format!(
        "this {what} is in use by another call: let one thread at a time have it, or give each a copy (copy.copy)"
    );
    raise(|known| &known.busy, message)
}

/// A call that changed the object broke off in the middle.
pub fn broken(what: &str) -> PyErr {
    raise(|known| &known.base, format!("this {what} was left unfinished by an internal error: make another one"))
}

/// Bytes that are no structure.
pub fn no_structure(reason: impl std::fmt::Display) -> PyErr {
    raise(|known| &known.base, format!("this is no structure that was written down: {reason}"))
}

/// Bytes that are no contact forces.
pub fn no_forces(reason: impl std::fmt::Display) -> PyErr {
    raise(|known| &known.base, format!("these are no contact forces that were written down: {reason}"))
}

/// A solver ended without an answer on a structure of so many blocks.
pub fn no_answer(blocks: usize) -> PyErr {
    raise(|known| &known.base, format!("the equilibrium solver gave no answer on a structure of {blocks} blocks"))
}

pub fn simulation_error(error: &SimulationError) -> PyErr {
    match error {
        SimulationError::Scene(error) => scene_error(error),
        other => raise(|known| &known.simulation, other.to_string()),
    }
}

pub fn step_error(failure: &StepFailure) -> PyErr {
    raise(|known| &known.step, failure.to_string())
}

pub fn plan_error(error: PlanError) -> PyErr {
    match error {
        PlanError::Scene(error) => scene_error(&error),
        PlanError::External(error) => match error.downcast::<PyErr>() {
            Ok(error) => *error,
            Err(error) => raise(|known| &known.base, error.to_string()),
        },
        other => raise(|known| &known.base, other.to_string()),
    }
}
