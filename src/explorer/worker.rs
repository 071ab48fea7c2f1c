//! The worker: one thread that owns the simulation, serves the newest request and publishes snapshots.

pub use super::engine::Engine;
use super::playback::Playback;
pub use super::request::{Focus, LineView, ManualMove, Newest, Place, Request, SnapshotRequest, Tried};
use super::snapshot::Preview;
pub use super::snapshot::Report;
use crate::scene::Scene;
use crate::simulation::Simulation;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender};

/// State of the worker, which serves requests in succession.
pub struct WorkerState {
    engine: Box<dyn Engine>,
    playback: Playback,
    /// Engine of tried scenes, so that the shown scene keeps its line.
    tries: Simulation,
    /// The scene tried last.
    tried: Option<Arc<Scene>>,
}

impl WorkerState {
    /// A worker with an engine.
    #[must_use]
    pub fn new(engine: Box<dyn Engine>) -> Self {
        WorkerState { engine, playback: Playback::default(), tries: Simulation::default(), tried: None }
    }

    /// Serves a request, and reports.
    ///
    /// A panic ends the request, not the explorer.
    pub fn serve(&mut self, request: Request, newest: &Newest, report: &dyn Fn(Report) -> bool) {
        let generation = request.generation;
        let tried = request.tried.as_ref().map(|tried| tried.text.clone());
        let outcome = catch_unwind(AssertUnwindSafe(|| self.answer(request, newest, report)));
        let Err(panic) = outcome else { return };
        let error = format!("internal error, please report it: {}", panic_text(panic.as_ref()));
        self.playback = Playback::without_scene(generation);
        self.tries = Simulation::default();
        if let Some(text) = tried {
            report(Report::Tried(Arc::new(Preview { text, outcome: Err(error.clone()) })));
        }
        report(Report::Failed { generation, error });
    }

    fn answer(&mut self, request: Request, newest: &Newest, report: &dyn Fn(Report) -> bool) {
        let Request { generation, scene, moves, snapshot, tried } = request;
        let WorkerState { engine, playback, .. } = self;
        let is_new = generation != playback.generation();
        if is_new {
            match playback.compute(engine.as_mut(), generation, scene, newest, report) {
                Some(Ok(())) => {}
                Some(Err(error)) => drop(report(Report::Failed { generation, error })),
                None => return,
            }
        }
        for order in moves {
            playback.obey(engine.as_mut(), order);
        }
        let shown = playback.show(engine.as_mut(), &snapshot).map(Arc::new);
        match (playback.computed().filter(|_| is_new), shown) {
            (Some(computed), shown) => drop(report(Report::Solved(computed, shown))),
            (None, Some(shown)) => drop(report(Report::Shown(shown))),
            (None, None) => {}
        }
        if let Some(Tried { text, scene }) = tried
            && self.tried.as_ref().is_none_or(|last| !Arc::ptr_eq(last, &scene))
        {
            let is_stale = || !newest.is_tried(&scene);
            let outcome = match self.tries.run(&scene, &is_stale, &mut |_, _, _| Ok(())) {
                Err(error) if error.is_interruption() => return,
                outcome => outcome.map_err(|error| error.to_string()),
            };
            self.tried = Some(scene);
            report(Report::Tried(Arc::new(Preview { text, outcome })));
        }
    }
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("unknown cause")
}

/// Serves requests until the explorer is gone.
pub fn serve(
    engine: Box<dyn Engine>,
    newest: &Newest,
    requests: &Receiver<Request>,
    report: &dyn Fn(Report) -> bool,
) {
    let mut desk = WorkerState::new(engine);
    let is_heard = std::cell::Cell::new(true);
    let report = |one| {
        is_heard.set(is_heard.get() && report(one));
        is_heard.get()
    };
    // Without a listener no further request is awaited.
    while is_heard.get()
        && let Ok(first) = requests.recv()
    {
        let request = requests.try_iter().fold(first, |earlier, later| later.after(earlier));
        desk.serve(request, newest, &report);
    }
}

/// Starts the worker on a thread of its own. `report` receives its reports and returns true while
/// anyone listens.
///
/// # Errors
/// When the system refuses a thread.
pub fn start(
    engine: Box<dyn Engine>,
    newest: Newest,
    requests: Receiver<Request>,
    report: impl Fn(Report) -> bool + Send + 'static,
) -> std::io::Result<()> {
    std::thread::Builder::new()
        .name("simulation".to_owned())
        .spawn(move || serve(engine, &newest, &requests, &report))
        .map(drop)
}

/// The explorer's end of the channel to the worker.
#[derive(Clone)]
pub struct Worker {
    requests: Sender<Request>,
    newest: Newest,
}

impl Worker {
    /// A handle that sends to `requests` and updates `newest`.
    #[must_use]
    pub fn new(requests: Sender<Request>, newest: Newest) -> Self {
        Worker { requests, newest }
    }

    /// Sends a request and marks it as awaited, see [`Awaited::ask`](super::request::Awaited::ask).
    pub fn ask(&self, request: Request) {
        self.newest.ask(&request);
        // The worker only ends with the explorer.
        let _ = self.requests.send(request);
    }
}
