//! Computations that take long: without the lock of Python, with progress, and stopped by Ctrl-C.

use crate::failure::Failure;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread::{Builder, scope};
use std::time::Duration;

/// Time between two looks for a signal.
const PAUSE: Duration = Duration::from_millis(50);

/// What a running computation asks and reports.
#[derive(Default)]
pub struct Watch {
    is_stopped: AtomicBool,
    /// The exception of a signal or of the callback.
    raised: Mutex<Option<PyErr>>,
    progress: Option<Py<PyAny>>,
}

impl Watch {
    /// Returns true if the computation is to stop, since a signal or the callback has raised an exception.
    pub fn stop(&self) -> bool {
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

/// Result of a computation without the lock of Python. It runs on a thread of its own, so that the calling thread, which may be
/// the one that receives signals, looks for them meanwhile.
///
/// # Errors
/// The exception of a signal or of the callback, the failure as an exception, or `RuntimeError` for a defect.
pub fn computed<R: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Watch) -> Result<R, Failure> + Send,
) -> PyResult<R> {
    let watch = Watch { progress, ..Watch::default() };
    let done = py.detach(|| {
        let (ended, end) = channel::<()>();
        let working = || {
            // Closed at the end, however it comes.
            let _ended = ended;
            work(&watch)
        };
        scope(|scope| {
            let worker = Builder::new().spawn_scoped(scope, working)?;
            while end.recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout) {
                watch.keep(Python::attach(|py| py.check_signals()));
            }
            Ok::<_, std::io::Error>(worker.join())
        })
    });
    if let Some(error) = watch.raised.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(error);
    }
    match done {
        Ok(Ok(result)) => Ok(result?),
        Ok(Err(_)) => Err(PyRuntimeError::new_err("internal error, please report it")),
        Err(error) => Err(PyRuntimeError::new_err(format!("could not start a thread: {error}"))),
    }
}
