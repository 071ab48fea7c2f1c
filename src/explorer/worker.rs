//! The worker: one thread that owns the simulation, does the newest request and publishes snapshots.

use super::reduce::Contact;
use super::snapshot::{CloseUp, FragmentFacts, Loop, Moment};
use crate::contact::{ContactError, CurvePoint, Foundation, GapScale, HessRule, LegRecord, Solver, Tally};
use crate::scene::{Observer, Scene};
use crate::simulation::{AfterLeg, Outcome, RunError, Simulation};
use crate::surface::Line;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender};

/// Legs whose thresholds are kept: beyond this many values, older legs are computed again when the
/// animation comes to them.
const VALUES_KEPT: usize = 1 << 26;

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
}

/// What the explorer asks of the worker.
#[derive(Clone, Debug)]
pub enum Request {
    /// Compute a scene.
    Compute {
        /// Its generation.
        generation: u64,
        /// The scene.
        scene: Box<Scene>,
    },
    /// Show a moment of the scene that was computed last.
    Show(MomentRequest),
}

/// Which moment to show, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentRequest {
    /// Generation of the scene it belongs to.
    pub generation: u64,
    /// Index of the leg.
    pub leg: usize,
    /// Indentation, m.
    pub indentation: f64,
    /// Columns of dots of the profile pane.
    pub profile_columns: usize,
    /// Columns of dots of the close-up pane.
    pub close_up_columns: usize,
    /// Where the close-up looks.
    pub focus: Focus,
    /// Springs it shows.
    pub close_up_springs: usize,
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
}

/// The generation the explorer waits for; a run for an older one stops.
pub type Newest = Arc<AtomicU64>;

/// Serves requests until the explorer is gone: of all that wait, only the newest scene and the newest
/// moment are done.
pub fn serve(
    mut engine: Box<dyn Engine>,
    newest: &Newest,
    requests: &Receiver<Request>,
    report: &dyn Fn(Report) -> bool,
) {
    let mut stage = Playback::default();
    while let Ok(first) = requests.recv() {
        let (mut compute, mut show) = (None, None);
        for request in std::iter::once(first).chain(requests.try_iter()) {
            match request {
                Request::Compute { generation, scene } => compute = Some((generation, scene)),
                Request::Show(moment) => show = Some(moment),
            }
        }
        let mut reports = Vec::new();
        let generation = compute.as_ref().map_or(stage.generation, |(generation, _)| *generation);
        // A panic ends the request, not the explorer.
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            if let Some((generation, scene)) = compute {
                reports.extend(stage.compute(engine.as_mut(), generation, *scene, newest, report));
            }
            if let Some(request) = show.filter(|request| request.generation == stage.generation) {
                reports.extend(stage.show(engine.as_mut(), &request));
            }
        }));
        if let Err(panic) = outcome {
            stage = Playback::default();
            let error = format!("internal error, please report it: {}", panic_text(panic.as_ref()));
            reports.push(Report::Failed { generation, error });
        }
        for one in reports {
            if !report(one) {
                return;
            }
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

/// The scene that was computed last, ready to be played.
#[derive(Default)]
struct Playback {
    generation: u64,
    scene: Option<Scene>,
    outcome: Option<Arc<Loop>>,
    thresholds: Vec<Option<Vec<f64>>>,
    /// Springs in contact at the moment shown last, to tell how many changed.
    last: Option<(u64, usize, f64)>,
}

impl Playback {
    fn compute(
        &mut self,
        engine: &mut dyn Engine,
        generation: u64,
        mut scene: Scene,
        newest: &Newest,
        report: &dyn Fn(Report) -> bool,
    ) -> Option<Report> {
        *self = Playback { generation, ..Playback::default() };
        // The pane beside the profile observes the heights.
        if !scene.observe.contains(&Observer::HeightHistogram) {
            scene.observe.push(Observer::HeightHistogram);
        }
        let stop = || newest.load(Ordering::Relaxed) != generation;
        let mut kept = 0;
        let mut thresholds = Vec::new();
        let result = engine.run(&scene, &stop, &mut |leg, _, solver| {
            let mut values = Vec::new();
            solver.thresholds_along_line(&mut values);
            kept += values.len();
            thresholds.push((kept <= VALUES_KEPT).then_some(values));
            report(Report::Progress { generation, legs: leg + 1 });
            Ok(())
        });
        match result {
            Ok(outcome) => {
                let computed = Arc::new(Loop { generation, outcome });
                self.thresholds = thresholds;
                self.scene = Some(scene);
                self.outcome = Some(Arc::clone(&computed));
                Some(Report::Computed(computed))
            }
            Err(error) if error.is_interruption() => None,
            Err(error) => Some(Report::Failed { generation, error: error.to_string() }),
        }
    }

    /// Computes the thresholds of a leg that were not kept.
    fn recall(&mut self, engine: &mut dyn Engine, wanted: usize) {
        let Some(scene) = &self.scene else { return };
        let mut found = None;
        let mut after = |leg: usize, _: &LegRecord, solver: &dyn Solver| {
            if leg < wanted {
                return Ok(());
            }
            let mut values = Vec::new();
            solver.thresholds_along_line(&mut values);
            found = Some(values);
            // Nothing after this leg is needed.
            Err(ContactError::Interrupted)
        };
        if engine.run(scene, &|| false, &mut after).is_ok() || found.is_some() {
            // Only one recalled leg is kept at a time.
            let firsts = VALUES_KEPT / found.as_ref().map_or(1, |values: &Vec<f64>| values.len().max(1));
            self.thresholds.iter_mut().skip(firsts).for_each(|leg| *leg = None);
            if let Some(leg) = self.thresholds.get_mut(wanted) {
                *leg = found;
            }
        }
    }

    fn show(&mut self, engine: &mut dyn Engine, request: &MomentRequest) -> Option<Report> {
        if self.thresholds.get(request.leg)?.is_none() {
            self.recall(engine, request.leg);
        }
        let computed = self.outcome.clone()?;
        let line = engine.line()?;
        let thresholds = self.thresholds.get(request.leg)?.as_ref()?;
        let indentation = request.indentation;
        let contact = Contact { gaps: &line.gaps, thresholds, summit: line.summit, indentation };
        let before =
            self.last.filter(|&(generation, leg, _)| (generation, leg) == (request.generation, request.leg));
        let tally = tally(&contact, before.map_or(indentation, |(_, _, last)| last));
        self.last = Some((request.generation, request.leg, indentation));
        let governing = computed.outcome.governing;
        let foundation = Foundation { spacing: line.spacing, effective_modulus: governing.effective_modulus };
        let force = foundation.spring_stiffness() * tally.contact.compression(indentation, &tally.scale);
        let profile = contact.section(0, line.gaps.len(), request.profile_columns);
        let hess = governing.adhesive_work().map(|work| HessRule::new(foundation, work));
        let close_up = close_up(&contact, &tally.fragments, request, foundation, hess);
        Some(Report::Shown(Arc::new(Moment {
            generation: request.generation,
            leg: request.leg,
            focus: request.focus,
            point: CurvePoint {
                indentation,
                force,
                springs: tally.contact.springs.unsigned_abs(),
                fragments: tally.fragments.len() as u64,
            },
            changed: tally.changed,
            profile,
            close_up,
        })))
    }
}

/// What is in contact at a moment, found in one look at the line.
struct MomentTally {
    contact: Tally,
    scale: GapScale,
    fragments: Vec<(usize, usize)>,
    /// Springs that are in another state than at the moment before.
    changed: u64,
}

fn tally(contact: &Contact<'_>, before: f64) -> MomentTally {
    let reached = contact.indentation;
    let largest = contact.gaps.iter().copied().fold(0.0, f64::max);
    let scale = GapScale::for_gaps_up_to(largest);
    let mut tally = Tally::default();
    let mut fragments: Vec<(usize, usize)> = Vec::new();
    let mut changed = 0;
    for (index, (&gap, &threshold)) in contact.gaps.iter().zip(contact.thresholds).enumerate() {
        changed += u64::from((threshold <= reached) != (threshold <= before));
        if threshold <= reached {
            tally.springs += 1;
            tally.quanta += i128::from(scale.quanta(gap));
            match fragments.last_mut() {
                Some((_, last)) if *last + 1 == index => *last = index,
                _ => fragments.push((index, index)),
            }
        }
    }
    tally.fragments = fragments.len() as i64;
    MomentTally { contact: tally, scale, fragments, changed }
}

fn close_up(
    contact: &Contact<'_>,
    fragments: &[(usize, usize)],
    request: &MomentRequest,
    foundation: Foundation,
    hess: Option<HessRule>,
) -> CloseUp {
    let count = contact.gaps.len();
    let summit = || (0..count).find(|&spring| contact.gaps[spring] == 0.0).unwrap_or(count / 2);
    let middle = |(first, last): (usize, usize)| first + (last - first) / 2;
    let nearest = |spring: usize| {
        let distance =
            |&(first, last): &(usize, usize)| first.saturating_sub(spring).max(spring.saturating_sub(last));
        (0..fragments.len()).min_by_key(|&number| distance(&fragments[number]))
    };
    let centre = match request.focus {
        Focus::Summit => summit(),
        Focus::Spring(spring) => spring.min(count.saturating_sub(1)),
        Focus::After(spring) | Focus::Before(spring) => {
            let from = spring.unwrap_or_else(summit);
            let forward = matches!(request.focus, Focus::After(_));
            nearest(from)
                .map(|number| {
                    let next = if forward { number + 1 } else { number + fragments.len() - 1 };
                    middle(fragments[next % fragments.len()])
                })
                .unwrap_or(from)
        }
    };
    let springs = request.close_up_springs.clamp(1, count.max(1));
    let first = centre.saturating_sub(springs / 2).min(count.saturating_sub(springs));
    let section = contact.section(first, springs, request.close_up_columns);
    let shown = first..first + springs;
    let boundaries = fragments
        .iter()
        .flat_map(|&(start, end)| if start == end { vec![start] } else { vec![start, end] })
        .filter(|spring| shown.contains(spring))
        .map(|spring| (spring, contact.height(spring)))
        .collect();
    let fragment = nearest(centre).map(|number| {
        let (start, end) = fragments[number];
        let length = end + 1 - start;
        let deepest = contact.gaps[start..=end].iter().copied().fold(0.0, f64::max);
        FragmentFacts {
            number,
            springs: (start, end),
            length: length as f64 * foundation.spacing,
            largest_stretch: hess.map_or(0.0, |hess| hess.largest_stretch(length as u32)),
            most_stretched: deepest - request.indentation,
        }
    });
    CloseUp { section, boundaries, fragment }
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
