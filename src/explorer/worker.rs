//! The worker: one thread that owns the simulation, serves the newest request and publishes snapshots.

pub use super::engine::Engine;
use super::playback::Playback;
use super::request::Drive;
pub use super::request::{Focus, LineView, ManualMove, Newest, Request, SnapshotRequest};
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
    /// Engine of previews, so that the shown scene keeps its line.
    previews: Simulation,
    /// The scene shown beside.
    beside: Option<Beside>,
}

/// The scene shown beside: computed as soon as its pane is in sight.
struct Beside {
    /// The scene, until it is computed or has failed.
    waiting: Option<Arc<Scene>>,
    solved: Option<(Simulation, Playback)>,
}

/// Waiting requests: the newest of each kind, but every manual move.
#[derive(Default)]
struct Batch {
    compute: Option<(u64, Arc<Scene>)>,
    orders: Vec<(u64, ManualMove)>,
    show: Option<SnapshotRequest>,
    preview: Option<(String, Arc<Scene>)>,
    beside: Option<Option<Arc<Scene>>>,
}

impl Batch {
    fn of(requests: impl Iterator<Item = Request>) -> Self {
        let mut batch = Batch::default();
        for request in requests {
            match request {
                Request::Compute { generation, scene } => batch.compute = Some((generation, scene)),
                Request::Manual { generation, order } => batch.orders.push((generation, order)),
                Request::Show(snapshot) => batch.show = Some(snapshot),
                Request::Beside(scene) => batch.beside = Some(scene),
                Request::Preview { text, scene } => batch.preview = Some((text, scene)),
            }
        }
        batch
    }
}

impl WorkerState {
    /// A worker with an engine.
    #[must_use]
    pub fn new(engine: Box<dyn Engine>) -> Self {
        WorkerState { engine, playback: Playback::default(), previews: Simulation::default(), beside: None }
    }

    /// Serves the waiting requests, and reports.
    ///
    /// A panic ends the requests, not the explorer.
    pub fn serve(
        &mut self,
        requests: impl Iterator<Item = Request>,
        newest: &Newest,
        report: &dyn Fn(Report) -> bool,
    ) {
        let batch = Batch::of(requests);
        let generation =
            batch.compute.as_ref().map_or(self.playback.generation(), |(generation, _)| *generation);
        let previewed = batch.preview.as_ref().map(|(text, _)| text.clone());
        let outcome = catch_unwind(AssertUnwindSafe(|| self.do_all(batch, newest, report)));
        let Err(panic) = outcome else { return };
        let error = format!("internal error, please report it: {}", panic_text(panic.as_ref()));
        self.playback = Playback::default();
        self.previews = Simulation::default();
        self.beside = None;
        if let Some(text) = previewed {
            report(Report::Previewed(Arc::new(Preview { text, outcome: Err(error.clone()) })));
        }
        report(Report::Failed { generation, error });
    }

    fn do_all(&mut self, batch: Batch, newest: &Newest, report: &dyn Fn(Report) -> bool) {
        let WorkerState { engine, playback, .. } = self;
        if let Some((generation, scene)) = batch.compute
            && let Some(one) = playback.compute(engine.as_mut(), generation, scene, newest, report)
        {
            report(one);
        }
        for (generation, order) in batch.orders {
            if generation == playback.generation() {
                playback.obey(engine.as_mut(), order);
            }
        }
        if let Some(scene) = batch.beside {
            self.beside = scene.map(|scene| Beside { waiting: Some(scene), solved: None });
        }
        if let Some(request) = batch.show.filter(|request| request.generation == playback.generation())
            && let Some(mut snapshot) = playback.show(engine.as_mut(), &request)
        {
            if let (Some((leg, indentation)), Some(beside)) = (request.beside, &mut self.beside)
                && let Some((engine, playback)) = beside.solve(request.generation, newest)
            {
                let request = SnapshotRequest { drive: Drive::Leg(leg), indentation, ..request };
                snapshot.beside = playback.show(engine, &request).map(Box::new);
            }
            report(Report::Shown(Arc::new(snapshot)));
        }
        if let Some((text, scene)) = batch.preview {
            let is_stale = || !newest.is_preview(&scene);
            let outcome = match self.previews.run(&scene, &is_stale, &mut |_, _, _| Ok(())) {
                Err(error) if error.is_interruption() => return,
                outcome => outcome.map_err(|error| error.to_string()),
            };
            report(Report::Previewed(Arc::new(Preview { text, outcome })));
        }
    }
}

impl Beside {
    /// Engine and playback of the scene, which is computed first if need be; `None` where the computation fails or is
    /// interrupted by a newer generation.
    fn solve(&mut self, generation: u64, newest: &Newest) -> Option<&mut (Simulation, Playback)> {
        if let Some(scene) = &self.waiting {
            let (mut engine, mut playback) = (Simulation::default(), Playback::default());
            let report = playback.compute(&mut engine, generation, Arc::clone(scene), newest, &|_| true)?;
            self.solved = matches!(report, Report::Computed(_)).then_some((engine, playback));
            self.waiting = None;
        }
        self.solved.as_mut()
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
        desk.serve(std::iter::once(first).chain(requests.try_iter()), newest, &report);
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

    /// Makes all previews stale.
    pub fn stop_preview(&self) {
        self.newest.set_preview(None);
    }
}
