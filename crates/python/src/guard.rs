//! Objects that change: one thread at a time has them, and another one gets an error in place of a wait.

use crate::errors::{broken, busy};
use pyo3::prelude::*;
use std::sync::{RwLock, RwLockReadGuard, RwLockWriteGuard, TryLockError};

/// A value that a call may change while Python's lock is free for other threads.
#[derive(Debug)]
pub struct Guarded<T> {
    lock: RwLock<T>,
    /// What users call it.
    what: &'static str,
}

impl<T> Guarded<T> {
    pub fn new(what: &'static str, value: T) -> Self {
        Self { lock: RwLock::new(value), what }
    }

    /// To look at it.
    ///
    /// # Errors
    /// `BusyError` while another call changes it.
    pub fn read(&self) -> PyResult<RwLockReadGuard<'_, T>> {
        self.lock.try_read().map_err(|error| self.error(&error))
    }

    /// To change it.
    ///
    /// # Errors
    /// `BusyError` while another call has it.
    pub fn write(&self) -> PyResult<RwLockWriteGuard<'_, T>> {
        self.lock.try_write().map_err(|error| self.error(&error))
    }

    fn error<G>(&self, error: &TryLockError<G>) -> PyErr {
        match error {
            TryLockError::WouldBlock => busy(self.what),
            TryLockError::Poisoned(_) => broken(self.what),
        }
    }
}
