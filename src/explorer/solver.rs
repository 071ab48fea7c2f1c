//! The solver of the explorer, which answers the newest request. It holds the simulation of the
//! newest scene and the stages of its loading (a stage is a motion of the body in one direction).
//! The solver runs on a thread of its own or, in tests and demos, answers at once.

use super::close_up::close_up;
use super::events::{LeastShare, ListedEvents, MOST_LISTED};
use super::manual_body::ManualBody;
use super::manual_path::ManualPath;
use super::player::{At, Player};
use super::request::{Drive, Request, SnapshotRequest};
use super::snapshot::{
    ContactSnapshot, FollowedPath, Probe, Reply, SolvedScene, SpringsInContact, profile_part,
};
use crate::explorer::advice;
use asperity_contact::motion::{JumpCollector, Stage};
use asperity_contact::{ContactError, CurvePoint, Events, StageRecord};
use asperity_data::Remedied;
use asperity_report::{LineColumns, SectionContact};
use asperity_scene::workload::{AfterStage, Reach};
use asperity_scene::{CheckedScene, Observer, Outcome, RunError, Simulation};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

/// Largest memory in bytes for the stages of a scene. Stages beyond this limit are computed again
/// when the animation reaches them.
const BYTES_KEPT: usize = 1 << 29;

/// Function that computes a scene, as [`Simulation::run`] does.
pub type Solve = fn(
    &mut Simulation,
    &CheckedScene,
    &dyn Fn() -> bool,
    &mut AfterStage<'_>,
) -> Result<Outcome, RunError>;

pub struct Solver {
    solve: Solve,
    simulation: Simulation,
    /// Generation of the scene for which the explorer waits. The solver stops the computation of a
    /// scene with any other generation.
    awaited: Arc<AtomicU64>,
    newest: Newest,
}

#[derive(Default)]
struct Newest {
    generation: u64,
    /// The scene, with the observers that the explorer needs; `None` if its computation failed.
    scene: Option<CheckedScene>,
    solved: Option<Arc<SolvedScene>>,
    /// Stages of the loading; `None` for each stage that did not fit into memory.
    stages: Vec<Option<Stage>>,
    manual: Option<Manual>,
    /// Events that were listed last for this scene.
    listed: Option<Arc<ListedEvents>>,
    /// Lowest and highest point of the profile in each column. They are stored, because the next
    /// snapshot usually needs them again.
    profile: LineColumns,
    close_up: LineColumns,
}

/// Manual loading of the newest scene: the body, and the path that it has followed.
struct Manual {
    body: ManualBody,
    followed: Arc<FollowedPath>,
}

/// Stages of a loading. Only as many stages are stored as the memory limit allows.
#[derive(Default)]
struct KeptStages {
    stages: Vec<Option<Stage>>,
    /// Memory in bytes that all stages so far would need if all of them were stored.
    bytes: usize,
    /// Largest force and indentation to which the contact of the first stage can be pressed.
    reach: Reach,
}

impl KeptStages {
    fn add(&mut self, motion: &Stage) {
        if self.stages.is_empty() {
            self.reach = Reach::of(motion.contact());
        }
        let is_kept = self.bytes <= BYTES_KEPT;
        self.stages
            .push(if is_kept { Some(motion.clone()) } else { None });
        self.bytes += motion.bytes();
    }
}

/// State of the contact for a snapshot.
struct ShownState {
    drive: Drive,
    /// Time in s since first touch; `None` without relaxation.
    seconds: Option<f64>,
    stage: Stage,
    point: CurvePoint,
}

impl Solver {
    /// Creates a solver that computes scenes with the function `solve`. `awaited` is the generation
    /// of the scene for which the explorer waits, a number that increases whenever the scene
    /// changes. The solver stops the computation of a scene whose generation differs from
    /// `awaited`.
    pub fn new(solve: Solve, awaited: Arc<AtomicU64>) -> Self {
        Solver {
            solve,
            simulation: Simulation::default(),
            awaited,
            newest: Newest::default(),
        }
    }

    /// Answers a request by calling `report`. Only the scene of this request is computed;
    /// computations of other versions of the scene stop.
    pub fn answer(&mut self, request: Request, report: &mut dyn FnMut(Reply)) {
        self.awaited.store(request.generation, Ordering::Relaxed);
        self.serve(request, report);
    }

    /// Answers a request by calling `report`. If the computation panics, only this request fails,
    /// and the explorer continues.
    pub fn serve(&mut self, request: Request, report: &mut dyn FnMut(Reply)) {
        let generation = request.generation;
        let served = catch_unwind(AssertUnwindSafe(|| self.try_serve(request, report)));
        if let Err(panic) = served {
            self.newest = Newest {
                generation,
                ..Newest::default()
            };
            self.simulation = Simulation::default();
            let why = panic_text(panic.as_ref());
            let error = format!("internal error, please report it: {why}");
            report(Reply::Failed { generation, error });
        }
    }

    fn try_serve(&mut self, request: Request, report: &mut dyn FnMut(Reply)) {
        let Request {
            generation,
            scene,
            path,
            least_share,
            snapshot,
        } = request;
        let is_new = generation != self.newest.generation;
        if is_new {
            match self.compute(generation, scene, report) {
                Ok(()) => {}
                Err(error) if error.is_interruption() => {
                    // With generation 0, a later request for this scene starts the computation from
                    // the beginning.
                    self.newest.generation = 0;
                    return;
                }
                Err(error) => report(Reply::Failed {
                    generation,
                    error: error.in_words(advice::row),
                }),
            }
        }
        let followed = match path {
            Some(path) => self.follow(path),
            None => {
                self.newest.manual = None;
                Ok(())
            }
        };
        if followed.is_err() {
            // A newer scene is awaited.
            self.newest.generation = 0;
            return;
        }
        let shown = self.snapshot(&snapshot).map(Arc::new);
        if is_new && let Some(solved) = self.newest.solved.clone() {
            report(Reply::Solved(solved, shown));
        } else if let Some(shown) = shown {
            report(Reply::Shown(shown));
        }
        // The events follow the answer, because to list them takes part of the time of the loop.
        if let Some(events) = self.list_events(least_share) {
            self.newest.listed = Some(Arc::clone(&events));
            report(Reply::Listed(events));
        }
    }

    /// Lists the events of the newest scene or, under manual loading, of the path. Returns `None`
    /// if they are listed already with this share, or if the explorer waits for a newer scene.
    fn list_events(&self, least_share: LeastShare) -> Option<Arc<ListedEvents>> {
        let solved = self.newest.solved.as_deref()?;
        let manual = self.newest.manual.as_ref();
        let path = manual.map(|manual| Arc::clone(&manual.followed.path));
        let is_listed =
            |listed: &Arc<ListedEvents>| listed.path == path && listed.least_share == least_share;
        if self.newest.listed.as_ref().is_some_and(is_listed) {
            return None;
        }
        let events = match manual {
            Some(manual) => manual.body.events(least_share).map_err(why_no_events),
            None => self.events_of_loading(solved, least_share)?,
        };
        Some(Arc::new(ListedEvents {
            generation: self.newest.generation,
            path,
            least_share,
            events,
        }))
    }

    /// Lists the events of the loading of a scene, or returns the reason why they cannot be listed.
    /// Returns `None` if the explorer waits for a newer scene.
    fn events_of_loading(
        &self,
        solved: &SolvedScene,
        least_share: LeastShare,
    ) -> Option<Result<Events, String>> {
        let records = &solved.outcome.history.stages;
        let mut jumps = JumpCollector::default();
        for (record, motion) in records.iter().zip(&self.newest.stages) {
            if self.awaited.load(Ordering::Relaxed) != solved.generation {
                return None;
            }
            let Some(motion) = motion else {
                let why = "the jumps of so many springs and stages do not fit into memory; fewer \
                           points N list them";
                return Some(Err(why.to_owned()));
            };
            if let Err(error) = jumps.observe(record, motion) {
                return Some(Err(why_no_events(error)));
            }
        }
        let events = jumps.events(records, least_share.value(), MOST_LISTED);
        Some(events.map_err(why_no_events))
    }

    /// Computes a scene, including the histogram of heights.
    fn compute(
        &mut self,
        generation: u64,
        scene: Arc<CheckedScene>,
        report: &mut dyn FnMut(Reply),
    ) -> Result<(), RunError> {
        self.newest = Newest {
            generation,
            ..Newest::default()
        };
        let observed = scene.observing(Observer::HeightHistogram);
        let stop = || self.awaited.load(Ordering::Relaxed) != generation;
        let mut kept = KeptStages::default();
        let outcome = (self.solve)(
            &mut self.simulation,
            &observed,
            &stop,
            &mut |stage, _, motion| {
                kept.add(motion);
                report(Reply::Progress {
                    generation,
                    stages: stage + 1,
                });
                Ok(())
            },
        )?;
        let solved = SolvedScene {
            generation,
            scene,
            outcome,
            reach: kept.reach,
        };
        self.newest = Newest {
            generation,
            scene: Some(observed),
            solved: Some(Arc::new(solved)),
            stages: kept.stages,
            ..Newest::default()
        };
        Ok(())
    }

    /// Moves the body along a path of manual loading, from separation or, if it has followed the
    /// beginning of the path already, from there.
    ///
    /// # Errors
    /// Returns an error if the explorer waits for a newer scene.
    fn follow(&mut self, path: Arc<ManualPath>) -> Result<(), ContactError> {
        let manual = self.newest.manual.take();
        let Some(solved) = self.newest.solved.clone() else {
            return Ok(());
        };
        if let Some(manual) = manual {
            if manual.followed.path == path {
                self.newest.manual = Some(manual);
                return Ok(());
            }
            return self.continue_path(manual.body, &solved, path);
        }
        let Some(motion) = self.newest.stages.iter().flatten().next() else {
            return Ok(());
        };
        let samples = solved.scene.numerics.samples as usize;
        let body = match solved.scene.material.relaxation {
            Some(_) => ManualBody::relaxing(motion.contact(), samples),
            None => ManualBody::new(motion.contact(), samples),
        };
        self.continue_path(body, &solved, path)
    }

    /// Moves a body on to the end of a path.
    fn continue_path(
        &mut self,
        mut body: ManualBody,
        solved: &SolvedScene,
        path: Arc<ManualPath>,
    ) -> Result<(), ContactError> {
        let mut stages = path
            .start
            .stages(&solved.scene.loading, &solved.outcome.history.stages);
        let before = stages.len();
        stages.extend(&path.moves);
        let stop = || self.awaited.load(Ordering::Relaxed) != solved.generation;
        let stopped = body.follow(&stages, &stop)?;
        let followed = FollowedPath {
            path,
            stages: body.records().to_vec(),
            before,
            stopped,
        };
        self.newest.manual = Some(Manual {
            body,
            followed: Arc::new(followed),
        });
        Ok(())
    }

    /// Makes the requested snapshot. Returns `None` if there is no such stage, or if manual loading
    /// has not begun.
    fn snapshot(&mut self, request: &SnapshotRequest) -> Option<ContactSnapshot> {
        let state = match request.drive {
            Drive::Stage(number) => self.state_of_loading(number, request.at)?,
            Drive::Manual => self.state_at_end_of_path()?,
            Drive::Path(number) => self.state_on_path(number, request.at)?,
        };
        let ShownState {
            drive,
            seconds,
            stage: motion,
            point,
        } = state;
        let newest = &mut self.newest;
        let line = newest.solved.as_deref()?.outcome.line;
        let patches = if point.springs == 0 {
            Vec::new()
        } else {
            motion.patches(point.indentation)
        };
        let gaps = motion.contact().gaps();
        let contact = SectionContact {
            gaps,
            summit: line.summit,
            indentation: point.indentation,
            patches: &patches,
        };
        let close_up = close_up(&contact, &motion, request, &mut newest.close_up);
        let part = profile_part(request, gaps.len());
        let probe = request
            .crosshair
            .and_then(|position| Probe::at(&contact, position));
        Some(ContactSnapshot {
            generation: newest.generation,
            drive,
            line,
            focus: request.focus,
            point,
            seconds,
            contact_radius: motion.contact().contact_radius(&patches, point),
            profile: contact.section(part, &mut newest.profile),
            close_up,
            probe,
            followed: newest
                .manual
                .as_ref()
                .map(|manual| Arc::clone(&manual.followed)),
            springs: SpringsInContact {
                gaps: Arc::downgrade(motion.contact().profile().shared_gaps()),
                patches,
            },
        })
    }

    /// Returns the state of the contact at a position of the animation. If there is no stage with
    /// this number, the nearest stage is used.
    fn state_of_loading(&mut self, number: usize, at: At) -> Option<ShownState> {
        let solved = self.newest.solved.clone()?;
        let records = &solved.outcome.history.stages;
        let player = position(records, number, at);
        let motion = self.stage(player.stage)?;
        Some(ShownState {
            drive: Drive::Stage(player.stage),
            seconds: player.seconds(records),
            point: point_at(&player, records, &motion)?,
            stage: motion,
        })
    }

    fn state_at_end_of_path(&self) -> Option<ShownState> {
        let body = &self.newest.manual.as_ref()?.body;
        Some(ShownState {
            drive: Drive::Manual,
            seconds: None,
            stage: body.stage(),
            point: body.point(),
        })
    }

    /// Returns the state of the contact at a position of the animation along the path of manual
    /// loading.
    fn state_on_path(&self, number: usize, at: At) -> Option<ShownState> {
        let Manual { body, followed } = self.newest.manual.as_ref()?;
        if followed.stages.is_empty() {
            return self.state_at_end_of_path();
        }
        let player = position(&followed.stages, number, at);
        let motion = body.stage_of(player.stage).ok()?;
        Some(ShownState {
            drive: Drive::Path(player.stage),
            seconds: None,
            point: point_at(&player, &followed.stages, &motion)?,
            stage: motion,
        })
    }

    /// Returns a stage of the loading. If the stage is not stored in memory, it is computed again.
    fn stage(&mut self, number: usize) -> Option<Stage> {
        if self.newest.stages.get(number)?.is_none() {
            let scene = self.newest.scene.take()?;
            let computed = self.stage_of(&scene, number);
            self.newest.scene = Some(scene);
            // Of the stages that do not fit into memory, only the one computed last is stored.
            let kept = match &computed {
                Some(motion) => BYTES_KEPT / motion.bytes().max(1),
                None => 0,
            };
            for motion in self.newest.stages.iter_mut().skip(kept + 1) {
                *motion = None;
            }
            self.newest.stages[number] = computed;
        }
        self.newest.stages[number].clone()
    }

    /// Computes the stage of one loading stage. For this purpose, the scene is computed from the
    /// beginning to the end of this stage.
    fn stage_of(&mut self, scene: &CheckedScene, wanted: usize) -> Option<Stage> {
        let mut found = None;
        // When the stage has been found, an error ends the computation. This error is ignored.
        let _ = (self.solve)(
            &mut self.simulation,
            scene,
            &|| false,
            &mut |stage, _, motion| {
                if stage < wanted {
                    return Ok(());
                }
                found = Some(motion.clone());
                Err(ContactError::Interrupted)
            },
        );
        found
    }
}

/// Returns the reason why events cannot be listed, in the words of the explorer.
fn why_no_events(error: ContactError) -> String {
    match error {
        ContactError::Stepwise => {
            "the stepwise solver knows no jumps; the solver Exact lists them".to_owned()
        }
        error => error.to_string(),
    }
}

/// Returns true if nothing is in contact at the end of a stage.
fn is_separated(stage: Option<&StageRecord>) -> bool {
    match stage.and_then(|record| record.curve.last()) {
        Some(end) => end.springs == 0,
        None => false,
    }
}

/// Returns the position of an animation over these stages that is nearest to the given position.
fn position(records: &[StageRecord], number: usize, at: At) -> Player {
    let player = Player {
        stage: number,
        at,
        playing: false,
    };
    player.within(records)
}

/// Returns the point of the force curve at a position of an animation. `stage` is the motion in the
/// stage of this position. On a body that relaxes the force also depends on the time, so the point
/// is interpolated between those of the recorded curve.
fn point_at(player: &Player, records: &[StageRecord], motion: &Stage) -> Option<CurvePoint> {
    let record = records.get(player.stage);
    if let (Some(record), Some(seconds)) = (record, player.seconds(records)) {
        if seconds < 0.0 {
            // Above first touch.
            return Some(CurvePoint {
                indentation: player.indentation(records),
                ..CurvePoint::default()
            });
        }
        let mut point = record.at_time(seconds)?;
        // The springs in contact are those that the panes show.
        let patches = motion.patches(point.indentation);
        if player.at != At::End || !is_separated(Some(record)) {
            point.patches = patches.len() as u64;
            let springs = patches.iter().map(|patch| patch.springs().len() as u64);
            point.springs = springs.sum();
        }
        return Some(point);
    }
    // After a separation nothing is in contact, although the animation still shows the indentation
    // of the last contact. Therefore the end of the curve, and not the indentation, gives the
    // point.
    if player.at == At::End && is_separated(record) {
        return record.and_then(|record| record.curve.last().copied());
    }
    let indentation = player.indentation(records);
    motion.point(indentation).ok()
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    if let Some(text) = panic.downcast_ref::<&str>() {
        return text;
    }
    match panic.downcast_ref::<String>() {
        Some(text) => text,
        None => "unknown cause",
    }
}

pub struct SolverThread {
    requests: Sender<Request>,
    awaited: Arc<AtomicU64>,
}

impl SolverThread {
    /// Starts the thread of the solver. `report` receives the replies of the solver.
    pub fn start(solve: Solve, report: impl Fn(Reply) + Send + 'static) -> std::io::Result<Self> {
        let (requests, inbox) = channel();
        let awaited = Arc::new(AtomicU64::new(0));
        let solver = Solver::new(solve, Arc::clone(&awaited));
        let newest = Arc::clone(&awaited);
        // Replies about earlier scenes are dropped on this thread, because the explorer may already
        // receive more input than it can handle.
        let mut report_awaited = move |reply: Reply| {
            if reply.generation() == newest.load(Ordering::Relaxed) {
                report(reply);
            }
        };
        std::thread::Builder::new()
            .name("simulation".to_owned())
            .spawn(move || serve(solver, &inbox, &mut report_awaited))?;
        Ok(SolverThread { requests, awaited })
    }

    /// Sends a request to the solver, which stops the computation of any other scene.
    pub fn ask(&self, request: Request) {
        self.awaited.store(request.generation, Ordering::Relaxed);
        // Sending cannot fail, because the solver thread ends only together with the explorer.
        let _ = self.requests.send(request);
    }
}

/// Answers requests until the explorer ends. Of all waiting requests, only the newest is answered.
pub fn serve(mut solver: Solver, requests: &Receiver<Request>, report: &mut dyn FnMut(Reply)) {
    while let Ok(first) = requests.recv() {
        let newest = requests.try_iter().last().unwrap_or(first);
        solver.serve(newest, report);
    }
}
