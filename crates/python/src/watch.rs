//! Long work looks for signals, mostly Ctrl-C, and tells how far it has come.

use drystone::{
    interrupt::Interrupt,
    plan::{Monitor, Progress},
};
use pyo3::{exceptions::PyKeyboardInterrupt, prelude::*};
use std::{
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering::Relaxed},
    },
    time::{Duration, Instant},
};

/// Time between two looks within work that is then left half done.
const PERIOD: Duration = Duration::from_millis(100);
/// Time between two looks where work can be ended well, between two steps or tests: these come first where both are short.
const PERIOD_BETWEEN: Duration = Duration::from_millis(50);

/// Looks for signals a few times a second. Python's handlers run on its main thread only; on others nothing is ever seen.
#[derive(Debug, Clone)]
pub struct Signals {
    state: Arc<State>,
}

#[derive(Debug)]
struct State {
    /// Of the last look; of the first question before there was one, so that work too short to ask reads no clock.
    last: Mutex<Option<Instant>>,
    /// A handler may itself begin work that looks.
    looking: AtomicBool,
    stopped: AtomicBool,
    error: Mutex<Option<PyErr>>,
}

impl Signals {
    pub fn new() -> Self {
        let (looking, stopped) = (AtomicBool::new(false), AtomicBool::new(false));
        let state = State { last: Mutex::new(None), looking, stopped, error: Mutex::new(None) };
        Self { state: Arc::new(state) }
    }

    /// Whether to stop, which stays true. A handler has raised then, what [`Self::error`] returns.
    fn stop(&self, period: Duration) -> bool {
        let State { last, looking, stopped, error } = &*self.state;
        if stopped.load(Relaxed) {
            return true;
        }
        let due = |last: &mut Option<Instant>| {
            let due = last.is_some_and(|last| last.elapsed() >= period);
            if due || last.is_none() {
                *last = Some(Instant::now());
            }
            due
        };
        if due(&mut last.lock().unwrap_or_else(PoisonError::into_inner)) && !looking.swap(true, Relaxed) {
            if let Err(raised) = in_python(|py| py.check_signals()) {
                *error.lock().unwrap_or_else(PoisonError::into_inner) = Some(raised);
                stopped.store(true, Relaxed);
            }
            looking.store(false, Relaxed);
        }
        stopped.load(Relaxed)
    }

    /// False if it is time to stop, asked where work can be ended well.
    pub fn go_on(&self) -> bool {
        !self.stop(PERIOD_BETWEEN)
    }

    /// Does work without Python's lock. None if a signal stopped it.
    pub fn run<T: Send>(&self, py: Python<'_>, work: impl FnOnce() -> T + Send) -> Option<T> {
        let asked = self.clone();
        let interrupt = Interrupt::new(move || asked.stop(PERIOD));
        py.detach(move || interrupt.run(work))
    }

    /// What a handler has raised.
    pub fn raised(&self) -> Option<PyErr> {
        self.state.error.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// What stopped the work: without a signal, whoever has called this.
    pub fn error(&self) -> PyErr {
        self.raised().unwrap_or_else(|| PyKeyboardInterrupt::new_err(()))
    }
}

/// Calls Python from within work. What it calls there has signals of its own to look for, and is not unwound through.
pub fn in_python<T>(work: impl FnOnce(Python<'_>) -> T) -> T {
    Interrupt::default().instead(|| Python::attach(work)).expect("nobody stops it")
}

/// Does work without Python's lock, until a signal stops it.
pub fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let signals = Signals::new();
    signals.run(py, work).ok_or_else(|| signals.error())
}

/// Looks for signals now and then while many objects are made.
pub fn look(py: Python<'_>, made: usize) -> PyResult<()> {
    const OFTEN: usize = 1000;
    if made.is_multiple_of(OFTEN) { py.check_signals() } else { Ok(()) }
}

/// Looks for signals and reports progress, a few times a second.
pub struct Watch {
    pub signals: Signals,
    progress: Option<Py<PyAny>>,
    last: Instant,
    error: Option<PyErr>,
}

impl Watch {
    /// Reports to `progress`.
    pub fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { signals: Signals::new(), progress, last: Instant::now(), error: None }
    }

    /// What a callback or a handler raised. None after Ctrl-C: the best so far is the answer.
    pub fn error(self, py: Python<'_>) -> Option<PyErr> {
        self.error.or_else(|| self.signals.raised()).filter(|error| !error.is_instance_of::<PyKeyboardInterrupt>(py))
    }

    /// False if it is time to stop; otherwise `progress` may be called with `how_far`.
    pub fn go_on<A>(&mut self, how_far: impl FnOnce() -> A) -> bool
    where
        A: for<'py> pyo3::call::PyCallArgs<'py>,
    {
        if !self.signals.go_on() {
            return false;
        }
        let Some(function) = self.progress.as_ref().filter(|_| self.last.elapsed() >= PERIOD) else { return true };
        self.last = Instant::now();
        self.error = in_python(|py| function.call1(py, how_far()).err());
        self.error.is_none()
    }
}

impl Monitor for Watch {
    fn go_on(&mut self, progress: Progress) -> bool {
        let Progress { tests, placed, blocks, .. } = progress;
        Watch::go_on(self, || (tests, placed, blocks))
    }
}
