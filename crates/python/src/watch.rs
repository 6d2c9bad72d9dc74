//! Long work looks for Ctrl-C, and tells how far it has come.

use drystone::plan::{Monitor, Progress};
use pyo3::{exceptions::PyKeyboardInterrupt, prelude::*};
use std::time::{Duration, Instant};

/// Time between two looks.
pub const PERIOD: Duration = Duration::from_millis(100);

/// Looks for Ctrl-C and reports progress, a few times a second.
pub struct Watch {
    progress: Option<Py<PyAny>>,
    last: Instant,
    error: Option<PyErr>,
}

impl Watch {
    /// Reports to `progress`, called with (tests done, blocks placed, blocks in all).
    pub fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { progress, last: Instant::now(), error: None }
    }

    /// What a callback raised.
    pub fn error(self) -> Option<PyErr> {
        self.error
    }

    /// Whether it is time for a look.
    fn is_due(&mut self) -> bool {
        let due = self.last.elapsed() >= PERIOD;
        if due {
            self.last = Instant::now();
        }
        due
    }

    /// False after Ctrl-C, which is then the error.
    pub fn no_interrupt(&mut self) -> bool {
        if self.is_due() {
            self.error = Python::attach(|py| py.check_signals().err());
        }
        self.error.is_none()
    }
}

impl Monitor for Watch {
    fn go_on(&mut self, progress: Progress) -> bool {
        if !self.is_due() {
            return true;
        }
        Python::attach(|py| {
            if py.check_signals().is_err() {
                return false; // Ctrl-C: the best so far is the answer
            }
            let Some(function) = &self.progress else { return true };
            let Progress { tests, placed, blocks, .. } = progress;
            let error = match function.call1(py, (tests, placed, blocks)) {
                Ok(_) => return true,
                Err(error) => error,
            };
            // Ctrl-C within the callback: the best so far is the answer, as above.
            self.error = Some(error).filter(|error| !error.is_instance_of::<PyKeyboardInterrupt>(py));
            false
        })
    }
}
