//! Long computations that Python starts. They run without the lock of Python (GIL), report their
//! progress, and stop at Ctrl-C.

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
use std::thread::Builder;
use std::time::Duration;

/// Message of the exception that is raised if the program has a defect (a panic).
pub const DEFECT: &str = "internal error, please report it";

/// Python function (callback) that receives the progress of a computation. `None` if the caller of
/// the computation gives no such function.
pub type Progress = Option<Py<PyAny>>;

/// Connection between a running computation and Python. The computation uses it to report progress
/// and to learn that it must stop.
#[derive(Default)]
pub struct Watch {
    is_stopped: AtomicBool,
    /// Exception that a signal or the callback has raised; `None` if there is none.
    raised: Mutex<Option<PyErr>>,
    progress: Progress,
}

impl Watch {
    /// Returns true if the computation must stop. This is so if a signal or the callback has raised
    /// an exception.
    pub fn stop(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    /// Calls the callback with two numbers: the number of finished parts of the computation, and
    /// the number of all parts.
    pub fn report(&self, done: u64, all: u64) {
        if let Some(progress) = &self.progress
            && !self.stop()
        {
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

/// Runs a computation on a thread of its own, without the lock of Python (GIL), and returns its
/// result. Meanwhile the calling thread checks for signals, because it may be the only thread that
/// receives them.
///
/// After a signal or an exception of the callback, the calling thread does not wait. The
/// computation learns from [`Watch::stop`] that it must stop, but a single Fourier transform may
/// take seconds, and its end is of no interest. The computation therefore owns its data.
pub fn computed<R: Send + 'static>(
    py: Python<'_>,
    progress: Progress,
    work: impl FnOnce(&Watch) -> Result<R, Failure> + Send + 'static,
) -> PyResult<R> {
    let watch = Arc::new(Watch {
        progress,
        ..Watch::default()
    });
    let shared = Arc::clone(&watch);
    let (sender, receiver) = channel();
    let worker = Builder::new()
        .spawn(move || {
            let result = work(&shared);
            // Nobody receives the result of a computation that was stopped.
            let _ = sender.send(result);
        })
        .map_err(|error| PyRuntimeError::new_err(format!("could not start a thread: {error}")))?;
    let waiting = Arc::clone(&watch);
    let received = py.detach(move || {
        loop {
            match receiver.recv_timeout(Duration::from_millis(50)) {
                Err(RecvTimeoutError::Timeout) => {
                    waiting.keep(Python::attach(|py| py.check_signals()));
                }
                received => return received.ok(),
            }
            if waiting.stop() {
                return None;
            }
        }
    });
    if let Some(error) = watch
        .raised
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .take()
    {
        return Err(error);
    }
    // The thread has sent its result, or has ended by a panic.
    py.detach(|| worker.join())
        .map_err(|_| PyRuntimeError::new_err(DEFECT))?;
    Ok(received.ok_or_else(|| PyRuntimeError::new_err(DEFECT))??)
}

/// Arguments of a call from Python: a scene, the number of profiles, the number of threads, and the
/// callback for the progress. If one of the numbers is `None`, the program chooses it.
#[derive(FromPyObject)]
pub struct Call(Py<Scene>, pub Option<u64>, Option<usize>, Progress);

/// Data of a call from Python, in the form that a computation needs.
pub struct Case<'a> {
    pub document: Document,
    /// Roughness that exists only in memory and not in a file; `None` if the scene has none.
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

    /// Returns an error if several random profiles are requested of a scene with a fixed profile.
    pub fn check_profiles(&self) -> Result<(), Failure> {
        if self.profiles > 1 && self.document.scene().seed().is_none() {
            let allowed = "1, since the profile of this scene is fixed";
            return Err(Failure::field(
                "profiles",
                &self.profiles.to_string(),
                allowed,
            ));
        }
        Ok(())
    }

    /// Runs the computation `work`, which consists of `all` parts and which a signal or the
    /// callback may stop. `done` converts a progress report of the computation to the number of
    /// finished parts. It returns `None` if this number has not changed.
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
    /// Runs the computation `work` on the data of this call, by the function [`computed`].
    pub fn computed<R: Send + 'static>(
        self,
        py: Python<'_>,
        work: impl FnOnce(Case<'_>) -> Result<R, Failure> + Send + 'static,
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
