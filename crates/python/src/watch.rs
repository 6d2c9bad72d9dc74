//! Long work looks for signals, mostly Ctrl-C, and tells how far it has come.

use drystone::{
    interrupt::Interrupt,
    plan::{Monitor, Progress},
};
use pyo3::{exceptions::PyKeyboardInterrupt, prelude::*};
use std::{
    cell::Cell,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering::Relaxed},
    },
    thread,
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

    /// Whether a yes has been given, which is never taken back.
    fn has_stopped(&self) -> bool {
        self.state.stopped.load(Relaxed)
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

thread_local! {
    /// What [`briefly`] asks, where it is not in use: to make it anew takes a fifth of the time of a short step.
    static IDLE: Cell<Option<Holding>> = const { Cell::new(None) };
}

/// Signals of work that keeps Python's lock, and who asks them.
struct Holding {
    signals: Signals,
    interrupt: Interrupt,
}

impl Holding {
    fn new() -> Self {
        let signals = Signals::new();
        let (asked, owner) = (signals.clone(), thread::current().id());
        let stop = move || {
            if thread::current().id() == owner {
                in_python(|py| py.detach(|| ())); // lets other threads have the lock, if they wait for it
                asked.stop(PERIOD)
            } else {
                asked.has_stopped() // to wait for the lock here could be to wait for ever
            }
        };
        Self { signals, interrupt: Interrupt::new(stop) }
    }
}

/// [`interruptible`] for work that is mostly too short to let go of Python's lock, which takes as long as a short step. If it
/// turns out to be long, other threads have the lock now and then: at each question, as between two lines of Python.
pub fn briefly<T>(_py: Python<'_>, work: impl FnOnce() -> T) -> PyResult<T> {
    let Holding { signals, interrupt } = IDLE.take().unwrap_or_else(Holding::new);
    let (done, interrupt) = interrupt.lent(work);
    let done = done.ok_or_else(|| signals.error());
    if !signals.has_stopped() {
        IDLE.set(Some(Holding { signals, interrupt }));
    }
    done
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

    /// What stopped work of which no half is an answer.
    pub fn stopped(self) -> PyErr {
        self.error.unwrap_or_else(|| self.signals.error())
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
