//! Computations that take long: without the lock of Python, with progress, and stopped by Ctrl-C.

use crate::failure::Failure;
use crate::scene::{Scene, simulation};
use asperity::data::{Control, parallel};
use asperity::scene::{Document, Simulation};
use asperity::study::Ensemble;
use asperity::surface::lines::MeasuredRoughness;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, scope};
use std::time::Duration;

/// Sentence for a defect of the program.
pub const DEFECT: &str = "internal error, please report it";

/// Callback of the progress.
pub type Progress = Option<Py<PyAny>>;

/// What a running computation asks and reports.
#[derive(Default)]
pub struct Watch {
    is_stopped: AtomicBool,
    /// The exception of a signal or of the callback.
    raised: Mutex<Option<PyErr>>,
    progress: Progress,
}

impl Watch {
    /// Returns true if the computation is to stop, since a signal or the callback has raised an
    /// exception.
    pub fn stop(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    /// Calls the callback with the number of parts that are done and that of all parts.
    pub fn report(&self, done: u64, all: u64) {
        if let Some(progress) = &self.progress {
            self.keep(Python::attach(|py| {
                progress.call1(py, (done, all)).map(drop)
            }));
        }
    }

    fn keep(&self, result: PyResult<()>) {
        if let Err(error) = result {
            self.raised
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .get_or_insert(error);
            self.is_stopped.store(true, Ordering::Relaxed);
        }
    }
}

/// Result of a computation without the lock of Python. It runs on a thread of its own, so that the
/// calling thread, which may be the one that receives signals, looks for them meanwhile.
pub fn computed<R: Send>(
    py: Python<'_>,
    progress: Progress,
    work: impl FnOnce(&Watch) -> Result<R, Failure> + Send,
) -> PyResult<R> {
    let watch = Watch {
        progress,
        ..Watch::default()
    };
    let done = py.detach(|| {
        let (ended, end) = channel::<()>();
        let watch = &watch;
        scope(|scope| {
            let started = Builder::new().spawn_scoped(scope, move || {
                // Closed at the end, however it comes.
                let _ended = ended;
                work(watch)
            });
            let worker = started.map_err(|error| {
                PyRuntimeError::new_err(format!("could not start a thread: {error}"))
            })?;
            while end.recv_timeout(Duration::from_millis(50)) == Err(RecvTimeoutError::Timeout) {
                watch.keep(Python::attach(|py| py.check_signals()));
            }
            Ok::<_, PyErr>(worker.join())
        })
    });
    if let Some(error) = watch
        .raised
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner)
    {
        return Err(error);
    }
    Ok(done?.map_err(|_| PyRuntimeError::new_err(DEFECT))??)
}

/// A scene, number of profiles, number of threads, and callback of the progress; numbers may be
/// left to the program.
#[derive(FromPyObject)]
pub struct Call(Py<Scene>, pub Option<u64>, Option<usize>, Progress);

/// A call that is computed.
pub struct Case<'a> {
    pub document: Document,
    /// Roughness in memory, of which the scene has no file.
    pub in_memory: Option<Arc<MeasuredRoughness>>,
    pub profiles: u64,
    pub jobs: usize,
    pub watch: &'a Watch,
}

impl Case<'_> {
    /// Returns a simulation of the scene.
    pub fn simulation(&self) -> Simulation {
        simulation(&self.document, self.in_memory.as_ref())
    }

    /// Runs a computation of `all` parts, which a signal or the callback may stop. `done` returns
    /// the number of finished parts from what the computation reports; `None` if it is unchanged.
    pub fn watched<P, T, E: Into<Failure>>(
        &self,
        all: u64,
        mut done: impl FnMut(&P) -> Option<u64>,
        work: impl FnOnce(Control<'_, P>) -> Result<T, E>,
    ) -> Result<T, Failure> {
        let stop = || self.watch.stop();
        let mut report = |progress: &P| {
            if let Some(done) = done(progress) {
                self.watch.report(done, all);
            }
        };
        let control = Control::default()
            .on_threads(self.jobs)
            .stopped_by(&stop)
            .reporting_to(&mut report);
        work(control).map_err(Into::into)
    }
}

impl Call {
    /// Computes a result as [`computed`] does.
    pub fn computed<R: Send>(
        self,
        py: Python<'_>,
        work: impl FnOnce(Case<'_>) -> Result<R, Failure> + Send,
    ) -> PyResult<R> {
        let Call(scene, profiles, jobs, progress) = self;
        let Scene {
            document,
            in_memory,
        } = scene.get();
        let document = document.clone();
        let in_memory = in_memory.clone();
        let profiles = profiles.unwrap_or_else(|| Ensemble::profiles_of(document.scene()));
        let jobs = jobs.unwrap_or_else(parallel::threads);
        computed(py, progress, move |watch| {
            work(Case {
                document,
                in_memory,
                profiles,
                jobs,
                watch,
            })
        })
    }
}
