//! Accuracy of the scene, its cost, and the map over κ and H: computed beside the worker, on a thread of its own, so
//! that no edit waits. A new order ends the running one.

use super::adhesion_spread::AdhesionSpread;
use super::panes::{Costs, Pane, PreloadCurve};
use super::snapshot::SolvedScene;
use crate::accuracy::{Choice, ChoiceError, Estimate, choose, estimate};
use crate::scene::Scene;
use crate::simulation::RunError;
use crate::study::map::LiveMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::Duration;

/// Quiet time before a waiting task begins: a key held down needs the machine.
const QUIET: Duration = Duration::from_millis(300);

/// Data of a pane, computed in parts: each part is shown at once, and an interrupted computation continues where it
/// ended, except that of costs, whose times are measured together.
#[derive(Clone, Debug, PartialEq)]
pub enum PaneData {
    /// The map over κ and H.
    Map(Arc<LiveMap>),
    /// Adhesion against preload.
    Preloads(Arc<PreloadCurve>),
    /// Adhesion of random profiles of a measured surface.
    Adhesion(Arc<AdhesionSpread>),
    /// Cost of accuracy of a scene.
    Costs(Arc<Scene>, Costs),
}

impl PaneData {
    /// Pane that shows the data.
    #[must_use]
    pub fn pane(&self) -> Pane {
        match self {
            PaneData::Map(_) => Pane::Chart,
            PaneData::Preloads(_) => Pane::Preloads,
            PaneData::Adhesion(_) => Pane::Spectrum,
            PaneData::Costs(..) => Pane::Accuracy,
        }
    }

    /// Computes the missing part; `report` receives the data after each addition.
    ///
    /// # Errors
    /// The reason why the data are incomplete, also after an interruption by `stop`.
    pub fn extended(self, stop: &dyn Fn() -> bool, report: &mut dyn FnMut(PaneData)) -> Result<Self, String> {
        let folder = Path::new(FOLDER);
        let described = |error: RunError| error.to_string();
        Ok(match self {
            PaneData::Map(mut map) => {
                let mut report = |map: &LiveMap| report(PaneData::Map(Arc::new(map.clone())));
                Arc::make_mut(&mut map).compute(folder, stop, &mut report);
                PaneData::Map(map)
            }
            PaneData::Preloads(mut curve) => {
                let mut report = |curve: &PreloadCurve| report(PaneData::Preloads(Arc::new(curve.clone())));
                Arc::make_mut(&mut curve).compute(folder, stop, &mut report).map_err(described)?;
                PaneData::Preloads(curve)
            }
            PaneData::Adhesion(mut spread) => {
                let mut report =
                    |spread: &AdhesionSpread| report(PaneData::Adhesion(Arc::new(spread.clone())));
                Arc::make_mut(&mut spread).compute(folder, stop, &mut report).map_err(described)?;
                PaneData::Adhesion(spread)
            }
            PaneData::Costs(scene, _) => {
                let mut report = |costs: &Costs| report(PaneData::Costs(Arc::clone(&scene), costs.clone()));
                let costs = Costs::measure(&scene, folder, stop, &mut report)?;
                PaneData::Costs(scene, costs)
            }
        })
    }
}

/// Task of a study of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Task {
    /// Estimated error of the outcome.
    Estimate(Arc<SolvedScene>),
    /// Springs and edges for a tolerance.
    Choose(Arc<Scene>, f64),
    /// Missing part of the data of a pane.
    Extend {
        /// The data so far.
        data: PaneData,
        /// True if the task waits for a quiet time.
        waits: bool,
    },
}

impl Task {
    /// Returns true if the task waits for a quiet time; a task awaited by the user does not.
    fn waits(&self) -> bool {
        !matches!(self, Task::Choose(..) | Task::Extend { waits: false, .. })
    }
}

/// Finding of a task.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// The error of the outcome, where known.
    Estimated(Option<Estimate>),
    /// Number of springs tried next for a tolerance.
    Choosing(u64),
    /// Choice for a tolerance, or the reason for none.
    Chosen(f64, Result<Choice, ChoiceError>),
    /// The data of a pane so far.
    Extended(PaneData),
    /// Reason why the data of a pane are not computed further.
    NotExtended(Pane, String),
}

/// A finding and the generation of its scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Generation of the scene.
    pub generation: u64,
    /// Finding.
    pub finding: Finding,
}

/// Solver of the studies: [`Accuracy`], or a substitute in tests that replaces some of the methods.
pub trait Appraiser: Send {
    /// See [`estimate`].
    fn estimate(&mut self, of: &SolvedScene, stop: &dyn Fn() -> bool) -> Option<Estimate> {
        estimate(&of.scene, Path::new(FOLDER), &of.outcome, stop)
    }

    /// See [`choose`].
    ///
    /// # Errors
    /// When nothing reaches the tolerance.
    fn choose(
        &mut self,
        scene: &Scene,
        tolerance: f64,
        stop: &dyn Fn() -> bool,
        trying: &mut dyn FnMut(u64),
    ) -> Result<Choice, ChoiceError> {
        choose(scene, Path::new(FOLDER), tolerance, stop, trying)
    }

    /// See [`PaneData::extended`].
    ///
    /// # Errors
    /// The reason why the data are incomplete, also after an interruption by `stop`.
    fn extend(
        &mut self,
        data: PaneData,
        stop: &dyn Fn() -> bool,
        report: &mut dyn FnMut(PaneData),
    ) -> Result<PaneData, String> {
        data.extended(stop, report)
    }
}

/// The appraiser of the program.
#[derive(Clone, Copy, Debug, Default)]
pub struct Accuracy;

/// Files of an explored scene are named by whole paths.
const FOLDER: &str = "";

impl Appraiser for Accuracy {}

/// Reason for no result after a panic.
const INTERNAL: &str = "internal error, please report it";

/// Performs a task. Findings after `stop` has returned true are dropped.
pub fn perform(
    appraiser: &mut dyn Appraiser,
    task: &Task,
    stop: &dyn Fn() -> bool,
    report: &mut dyn FnMut(Finding),
) {
    let mut report = |finding: Finding| {
        if !stop() {
            report(finding);
        }
    };
    let done = catch_unwind(AssertUnwindSafe(|| match task {
        Task::Estimate(of) => Finding::Estimated(appraiser.estimate(of, stop)),
        Task::Choose(scene, tolerance) => {
            let choice =
                appraiser.choose(scene, *tolerance, stop, &mut |points| report(Finding::Choosing(points)));
            Finding::Chosen(*tolerance, choice)
        }
        Task::Extend { data, .. } => {
            let mut report = |data| report(Finding::Extended(data));
            match appraiser.extend(data.clone(), stop, &mut report) {
                Ok(data) => Finding::Extended(data),
                Err(why) => Finding::NotExtended(data.pane(), why),
            }
        }
    }));
    report(done.unwrap_or_else(|_| match task {
        Task::Estimate(_) => Finding::Estimated(None),
        Task::Choose(_, tolerance) => Finding::Chosen(*tolerance, Err(ChoiceError::Stopped)),
        Task::Extend { data, .. } => Finding::NotExtended(data.pane(), INTERNAL.to_owned()),
    }));
}

/// Studies of one scene in succession; a new order replaces the last one.
struct Order {
    number: u64,
    generation: u64,
    tasks: Vec<Task>,
}

/// The explorer's end of the channel to the study.
pub struct Study {
    orders: Sender<Order>,
    newest: Arc<AtomicU64>,
}

impl Study {
    /// Starts a study on a thread of its own. `report` receives its findings and returns true while anyone
    /// listens.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(
        appraiser: Box<dyn Appraiser>,
        report: impl Fn(Found) -> bool + Send + 'static,
    ) -> std::io::Result<Self> {
        let (orders, inbox) = std::sync::mpsc::channel();
        let newest = Arc::new(AtomicU64::new(0));
        let watched = Arc::clone(&newest);
        std::thread::Builder::new()
            .name("accuracy".to_owned())
            .spawn(move || serve(appraiser, &watched, &inbox, &report))?;
        Ok(Study { orders, newest })
    }

    /// Ends the running tasks and requests these in their place.
    pub fn ask(&self, generation: u64, tasks: Vec<Task>) {
        let number = self.newest.fetch_add(1, Ordering::Relaxed) + 1;
        // The study only ends with the explorer.
        let _ = self.orders.send(Order { number, generation, tasks });
    }

    /// Ends the running tasks.
    pub fn stop(&self) {
        self.ask(0, Vec::new());
    }
}

/// Performs the newest order until the explorer is gone.
fn serve(
    mut appraiser: Box<dyn Appraiser>,
    newest: &AtomicU64,
    orders: &Receiver<Order>,
    report: &dyn Fn(Found) -> bool,
) {
    let mut next = None;
    while let Some(order) = next.take().or_else(|| orders.recv().ok()) {
        let Order { number, generation, tasks } = order;
        let stop = || newest.load(Ordering::Relaxed) != number;
        for task in tasks {
            if task.waits() {
                match orders.recv_timeout(QUIET) {
                    Ok(newer) => next = Some(newer),
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
            if next.is_some() || stop() {
                break;
            }
            let mut heard = true;
            perform(appraiser.as_mut(), &task, &stop, &mut |finding| {
                heard = heard && report(Found { generation, finding });
            });
            if !heard {
                return;
            }
        }
    }
}
