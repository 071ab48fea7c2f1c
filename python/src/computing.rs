//! Computations that take long: without the lock of Python, with progress, and stopped by Ctrl-C.

use crate::failure::Failure;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::{ThreadId, current};
use std::time::{Duration, Instant};

/// Shortest time between two looks for a signal.
const PAUSE: Duration = Duration::from_millis(20);

/// What a running computation asks and reports.
pub struct Watch {
    caller: ThreadId,
    asked: Mutex<Instant>,
    is_stopped: AtomicBool,
    /// The exception of a signal or of the callback.
    raised: Mutex<Option<PyErr>>,
    progress: Option<Py<PyAny>>,
}

impl Watch {
    /// Returns true if the computation is to stop, since a signal or the callback has raised an exception.
    pub fn stop(&self) -> bool {
        if current().id() == self.caller {
            let mut asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
            if asked.elapsed() >= PAUSE {
                *asked = Instant::now();
                self.keep(Python::attach(|py| py.check_signals()));
            }
        }
        self.is_stopped.load(Ordering::Relaxed)
    }

    /// Calls the callback with the number of parts that are done and that of all parts.
    pub fn report(&self, done: u64, all: u64) {
        if let Some(progress) = &self.progress {
            self.keep(Python::attach(|py| progress.call1(py, (done, all)).map(drop)));
        }
    }

    fn keep(&self, result: PyResult<()>) {
        if let Err(error) = result {
            self.raised.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            self.is_stopped.store(true, Ordering::Relaxed);
        }
    }
}

/// Result of a computation without the lock of Python.
///
/// # Errors
/// The exception of a signal or of the callback, the failure as an exception, or `RuntimeError` for a defect.
pub fn computed<R: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Watch) -> Result<R, Failure> + Send,
) -> PyResult<R> {
    let (asked, is_stopped, raised) = (Mutex::new(Instant::now()), AtomicBool::new(false), Mutex::new(None));
    let watch = Watch { caller: current().id(), asked, is_stopped, raised, progress };
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(|| work(&watch))));
    if let Some(error) = watch.raised.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(error);
    }
    match done {
        Ok(result) => result.map_err(|failure| failure.exception(py)),
        Err(_) => Err(PyRuntimeError::new_err("internal error, please report it")),
    }
}
