//! The worker: one thread that owns the simulation, does the newest request and publishes snapshots.

use super::playback::Playback;
use super::snapshot::{Drive, Loop, Moment, Preview};
use crate::contact::ContactTree;
use crate::scene::Scene;
use crate::simulation::{AfterLeg, Outcome, RunError, Simulation};
use crate::surface::Line;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender};

/// What computes scenes. [`Simulation`] does; tests put others in its place.
pub trait Engine: Send {
    /// Computes a scene; see [`Simulation::run`].
    ///
    /// # Errors
    /// When it cannot be computed or `stop` says so.
    fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError>;

    /// The line of the last scene.
    fn line(&self) -> Option<&Line>;

    /// The tree of that line, where the scene called for one.
    fn tree(&self) -> Option<&Arc<ContactTree>>;
}

impl Engine for Simulation {
    fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError> {
        Simulation::run(self, scene, stop, after)
    }

    fn line(&self) -> Option<&Line> {
        Simulation::line(self)
    }

    fn tree(&self) -> Option<&Arc<ContactTree>> {
        Simulation::tree(self)
    }
}

/// What the explorer asks of the worker.
#[derive(Clone, Debug)]
pub enum Request {
    /// Compute a scene.
    Compute {
        /// Its generation.
        generation: u64,
        /// The scene.
        scene: Arc<Scene>,
    },
    /// Move the body by hand, in the scene that was computed last.
    Hand {
        /// Generation of the scene it belongs to.
        generation: u64,
        /// Where to.
        order: HandOrder,
    },
    /// Show a moment of the scene that was computed last.
    Show(MomentRequest),
    /// Compute a scene to be shown beside, or none.
    Beside(Option<Arc<Scene>>),
    /// Compute a scene of the library to look at its curve.
    Preview {
        /// The scene's text.
        text: String,
        /// The scene.
        scene: Arc<Scene>,
    },
}

/// What the hand does with the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HandOrder {
    /// Takes it where a leg of the loading has it at this indentation, m.
    Take {
        /// Index of the leg.
        leg: usize,
        /// Indentation, m.
        indentation: f64,
    },
    /// Gives it back.
    Give,
    /// Moves it to an indentation, m.
    To(f64),
    /// Moves it by so much, m; pressing is positive.
    By(f64),
    /// Moves it until its force is this one, N.
    ToForce(f64),
    /// Pulls until nothing touches.
    Separate,
}

/// Which moment to show, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentRequest {
    /// Generation of the scene it belongs to.
    pub generation: u64,
    /// What moves the body.
    pub drive: Drive,
    /// Indentation, m; the hand knows its own.
    pub indentation: f64,
    /// Columns of dots of the profile pane.
    pub profile_columns: usize,
    /// What part of the line it shows.
    pub profile: LineView,
    /// Columns of dots of the close-up pane.
    pub close_up_columns: usize,
    /// Cells across it.
    pub strip_cells: usize,
    /// Where the close-up looks.
    pub focus: Focus,
    /// Springs it shows.
    pub close_up_springs: usize,
    /// Whether the distribution of fragment lengths is shown.
    pub lengths: bool,
    /// Position of the crosshair as a share of the profile, 0 to 1.
    pub crosshair: Option<f64>,
    /// Loading stage and indentation, m, of the scene beside.
    pub beside: Option<(usize, f64)>,
}

/// What part of the line the profile shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineView {
    /// Its middle, as a share of the line.
    pub centre: f64,
    /// How much of the line it shows, above 0 to 1.
    pub share: f64,
    /// Whether its middle follows the close-up instead.
    pub follow: bool,
}

impl LineView {
    /// The whole line.
    pub const WHOLE: LineView = LineView { centre: 0.5, share: 1.0, follow: false };
}

/// Where the close-up looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    /// Where the bodies touch first.
    Summit,
    /// A spring.
    Spring(usize),
    /// The fragment after the one nearest to a spring.
    After(Option<usize>),
    /// The fragment before the one nearest to a spring.
    Before(Option<usize>),
    /// The longest fragment.
    Largest,
    /// The fragment that carries the largest force, pressing or pulling.
    MostLoaded,
}

impl Focus {
    /// Whether it is a question, to which a spring is the answer.
    #[must_use]
    pub fn is_question(self) -> bool {
        !matches!(self, Focus::Summit | Focus::Spring(_))
    }
}

/// What the worker reports.
#[derive(Clone, Debug)]
pub enum Report {
    /// A scene has been computed.
    Computed(Arc<Loop>),
    /// A moment is ready.
    Shown(Arc<Moment>),
    /// Part of a scene is done.
    Progress {
        /// Its generation.
        generation: u64,
        /// Legs done.
        legs: usize,
    },
    /// A scene could not be computed.
    Failed {
        /// Its generation.
        generation: u64,
        /// Why, in one line.
        error: String,
    },
    /// A scene of the library has been computed, or could not be.
    Previewed(Arc<Preview>),
}

/// The generation the explorer waits for; a run for an older one stops.
pub type Newest = Arc<AtomicU64>;

/// The place where requests are done, one after the other.
pub struct Desk {
    engine: Box<dyn Engine>,
    playback: Playback,
    /// The library's scenes have an engine of their own: the one shown keeps its line.
    previews: Simulation,
    /// The scene that is shown beside.
    beside: Option<(Simulation, Playback)>,
}

/// Requests that wait together: of each kind the newest counts, but each order of the hand.
#[derive(Default)]
struct Batch {
    compute: Option<(u64, Arc<Scene>)>,
    orders: Vec<(u64, HandOrder)>,
    show: Option<MomentRequest>,
    preview: Option<(String, Arc<Scene>)>,
    beside: Option<Option<Arc<Scene>>>,
}

impl Batch {
    fn of(requests: impl Iterator<Item = Request>) -> Self {
        let mut batch = Batch::default();
        for request in requests {
            match request {
                Request::Compute { generation, scene } => batch.compute = Some((generation, scene)),
                Request::Hand { generation, order } => batch.orders.push((generation, order)),
                Request::Show(moment) => batch.show = Some(moment),
                Request::Beside(scene) => batch.beside = Some(scene),
                Request::Preview { text, scene } => batch.preview = Some((text, scene)),
            }
        }
        batch
    }
}

impl Desk {
    /// A desk with an engine.
    #[must_use]
    pub fn new(engine: Box<dyn Engine>) -> Self {
        Desk { engine, playback: Playback::default(), previews: Simulation::default(), beside: None }
    }

    /// Does the requests that wait together, and reports.
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
        let Desk { engine, playback, .. } = self;
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
            self.beside = scene.and_then(compute_beside);
        }
        if let Some(request) = batch.show.filter(|request| request.generation == playback.generation())
            && let Some(mut moment) = playback.show(engine.as_mut(), &request)
        {
            if let (Some((leg, indentation)), Some((engine, playback))) = (request.beside, &mut self.beside) {
                let drive = Drive::Leg(leg);
                let request = MomentRequest { generation: 0, drive, indentation, ..request };
                moment.beside = playback.show(engine, &request).map(Box::new);
            }
            report(Report::Shown(Arc::new(moment)));
        }
        if let Some((text, scene)) = batch.preview {
            let outcome = self.previews.run(&scene, &|| false, &mut |_, _, _| Ok(()));
            let outcome = outcome.map_err(|error| error.to_string());
            report(Report::Previewed(Arc::new(Preview { text, outcome })));
        }
    }
}

/// A scene that is shown beside, computed; `None` where the scene cannot be computed.
fn compute_beside(scene: Arc<Scene>) -> Option<(Simulation, Playback)> {
    let (mut engine, mut playback) = (Simulation::default(), Playback::default());
    // No newer scene takes its place before it is computed.
    let only = Newest::default();
    let report = playback.compute(&mut engine, 0, scene, &only, &|_| true);
    matches!(report, Some(Report::Computed(_))).then_some((engine, playback))
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
    let mut desk = Desk::new(engine);
    let is_heard = std::cell::Cell::new(true);
    let report = |one| {
        is_heard.set(is_heard.get() && report(one));
        is_heard.get()
    };
    // Once nobody listens no further request is waited for.
    while is_heard.get()
        && let Ok(first) = requests.recv()
    {
        desk.serve(std::iter::once(first).chain(requests.try_iter()), newest, &report);
    }
}

/// Starts the worker on a thread of its own. Its reports go through `report`, which says whether
/// anyone still listens.
///
/// # Errors
/// When the system gives no thread.
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
    /// A handle that sends to `requests` and marks what is newest.
    #[must_use]
    pub fn new(requests: Sender<Request>, newest: Newest) -> Self {
        Worker { requests, newest }
    }

    /// Asks for something; a scene makes all older ones stale at once.
    pub fn ask(&self, request: Request) {
        if let Request::Compute { generation, .. } = &request {
            self.newest.store(*generation, Ordering::Relaxed);
        }
        // The worker only ends with the explorer.
        let _ = self.requests.send(request);
    }
}
