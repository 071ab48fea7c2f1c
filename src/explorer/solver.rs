//! The solver of the explorer, which answers the newest request. It holds the simulation of the
//! newest scene and the legs of its loading (a leg is a motion of the body in one direction). The
//! solver runs on a thread of its own or, in tests and demos, answers at once.

use super::close_up::close_up;
use super::manual_body::{ManualBegin, ManualBody};
use super::player::{At, Player, indentations};
use super::request::{Drive, ManualMove, Request, SnapshotRequest};
use super::snapshot::{ContactSnapshot, Probe, Reply, SolvedScene, SpringsInContact, profile_part};
use crate::explorer::advice;
use asperity_contact::motion::Leg;
use asperity_contact::{ContactError, CurvePoint, Direction, LegRecord, Move};
use asperity_data::Remedied;
use asperity_report::{LineColumns, SectionContact};
use asperity_scene::stages::{AfterLeg, Reach};
use asperity_scene::{
    CheckedScene, Observer, Outcome, RunError, Simulation, Solver as SceneSolver,
};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

/// Largest memory in bytes for the legs of a scene. Legs beyond this limit are computed again when
/// the animation reaches them.
const BYTES_KEPT: usize = 1 << 29;

/// Number of points on the force curve between the highest and the lowest indentation, if the user
/// pulls the body off manually.
const STEPS_OF_A_PULL: f64 = 200.0;

/// Function that computes a scene, as [`Simulation::run`] does.
pub type Solve = fn(
    &mut Simulation,
    &CheckedScene,
    &dyn Fn() -> bool,
    &mut AfterLeg<'_>,
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
    /// Legs of the loading; `None` for each leg that did not fit into memory.
    legs: Vec<Option<Leg>>,
    body: Option<ManualBody>,
    /// Lowest and highest point of the profile in each column. They are stored, because the next
    /// snapshot usually needs them again.
    profile: LineColumns,
    close_up: LineColumns,
}

/// Legs of a loading. Only as many legs are stored as the memory limit allows.
#[derive(Default)]
struct KeptLegs {
    legs: Vec<Option<Leg>>,
    /// Memory in bytes that all legs so far would need if all of them were stored.
    bytes: usize,
    /// Largest force and indentation to which the contact of the first leg can be pressed.
    reach: Reach,
}

impl KeptLegs {
    fn add(&mut self, leg: &Leg) {
        if self.legs.is_empty() {
            self.reach = Reach::of(leg.contact());
        }
        let is_kept = self.bytes <= BYTES_KEPT;
        self.legs
            .push(if is_kept { Some(leg.clone()) } else { None });
        self.bytes += leg.bytes();
    }
}

/// State of the contact for a snapshot.
struct ShownState {
    drive: Drive,
    leg: Leg,
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
            moves,
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
        for order in moves {
            self.follow(order);
        }
        let shown = self.snapshot(&snapshot).map(Arc::new);
        if is_new && let Some(solved) = self.newest.solved.clone() {
            report(Reply::Solved(solved, shown));
        } else if let Some(shown) = shown {
            report(Reply::Shown(shown));
        }
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
        let mut kept = KeptLegs::default();
        let outcome = (self.solve)(
            &mut self.simulation,
            &observed,
            &stop,
            &mut |stage, _, leg| {
                kept.add(leg);
                report(Reply::Progress {
                    generation,
                    legs: stage + 1,
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
            legs: kept.legs,
            ..Newest::default()
        };
        Ok(())
    }

    fn follow(&mut self, order: ManualMove) {
        match order {
            ManualMove::Take { leg, at } => self.newest.body = self.take(leg, at),
            order => {
                if let Some(body) = &mut self.newest.body {
                    body.follow(order);
                }
            }
        }
    }

    /// Begins manual loading at a position of a loading stage. Returns `None` if there is no such
    /// stage, or not enough memory.
    fn take(&mut self, number: usize, at: At) -> Option<ManualBody> {
        self.newest.body = None;
        let solved = self.newest.solved.clone()?;
        let leg = self.exact_leg(&solved, number)?;
        let legs = &solved.outcome.history.legs;
        let player = Player {
            leg: number,
            at,
            playing: false,
        };
        let (low, high) = indentations(legs).unwrap_or_default();
        let begin = ManualBegin {
            indentation: player.indentation(legs),
            is_separated: at == At::End && is_separated(legs.get(number)),
            step: (high - low) / STEPS_OF_A_PULL,
            loading: stages_until(&solved, number, at),
            direction: direction_at(&solved, number, at),
        };
        ManualBody::take(&leg, begin)
    }

    /// Returns a leg of the loading, computed by the exact solver. Manual loading needs such a leg,
    /// because only the legs of the exact solver can be continued beyond the end of their stage.
    fn exact_leg(&mut self, solved: &SolvedScene, number: usize) -> Option<Leg> {
        if solved.scene.numerics.solver == SceneSolver::Exact {
            return self.leg(number);
        }
        let exact = solved
            .scene
            .with(|scene| scene.numerics.solver = SceneSolver::Exact)
            .ok()?;
        self.leg_of(&exact, number)
    }

    /// Makes the requested snapshot. Returns `None` if there is no such stage, or if manual loading
    /// has not begun.
    fn snapshot(&mut self, request: &SnapshotRequest) -> Option<ContactSnapshot> {
        let state = match request.drive {
            Drive::Leg(number) => self.state_of_loading(number, request.at)?,
            Drive::Manual => {
                let body = self.newest.body.as_ref()?;
                ShownState {
                    drive: Drive::Manual,
                    leg: body.leg(),
                    point: body.point(),
                }
            }
        };
        let ShownState { drive, leg, point } = state;
        let newest = &mut self.newest;
        let line = newest.solved.as_deref()?.outcome.line;
        let patches = if point.springs == 0 {
            Vec::new()
        } else {
            leg.patches(point.indentation)
        };
        let gaps = leg.contact().gaps();
        let contact = SectionContact {
            gaps,
            summit: line.summit,
            indentation: point.indentation,
            patches: &patches,
        };
        let close_up = close_up(&contact, &leg, request, &mut newest.close_up);
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
            contact_radius: leg.contact().contact_radius(&patches, point),
            profile: contact.section(part, &mut newest.profile),
            close_up,
            probe,
            manual: newest.body.as_mut().map(ManualBody::travel),
            springs: SpringsInContact {
                gaps: Arc::downgrade(leg.contact().profile().shared_gaps()),
                patches,
            },
        })
    }

    /// Returns the state of the contact at a position of the animation, and ends manual loading. If
    /// there is no stage with this number, the nearest stage is used.
    fn state_of_loading(&mut self, number: usize, at: At) -> Option<ShownState> {
        self.newest.body = None;
        let legs = &self.newest.solved.as_deref()?.outcome.history.legs;
        let player = Player {
            leg: number,
            at,
            playing: false,
        }
        .within(legs);
        let indentation = player.indentation(legs);
        let record = legs.get(player.leg);
        // After a separation nothing is in contact, although the animation still shows the
        // indentation of the last contact. Therefore the end of the curve, and not the indentation,
        // gives the point.
        let end = if player.at == At::End && is_separated(record) {
            record.and_then(|record| record.curve.last().copied())
        } else {
            None
        };
        let leg = self.leg(player.leg)?;
        let point = match end {
            Some(end) => end,
            None => leg.point(indentation).ok()?,
        };
        Some(ShownState {
            drive: Drive::Leg(player.leg),
            leg,
            point,
        })
    }

    /// Returns a leg of the loading. If the leg is not stored in memory, it is computed again.
    fn leg(&mut self, number: usize) -> Option<Leg> {
        if self.newest.legs.get(number)?.is_none() {
            let scene = self.newest.scene.take()?;
            let computed = self.leg_of(&scene, number);
            self.newest.scene = Some(scene);
            // Of the legs that do not fit into memory, only the one computed last is stored.
            let kept = match &computed {
                Some(leg) => BYTES_KEPT / leg.bytes().max(1),
                None => 0,
            };
            for leg in self.newest.legs.iter_mut().skip(kept + 1) {
                *leg = None;
            }
            self.newest.legs[number] = computed;
        }
        self.newest.legs[number].clone()
    }

    /// Computes the leg of one loading stage. For this purpose, the scene is computed from the
    /// beginning to the end of this stage.
    fn leg_of(&mut self, scene: &CheckedScene, wanted: usize) -> Option<Leg> {
        let mut found = None;
        // When the leg has been found, an error ends the computation. This error is ignored.
        let _ = (self.solve)(
            &mut self.simulation,
            scene,
            &|| false,
            &mut |stage, _, leg| {
                if stage < wanted {
                    return Ok(());
                }
                found = Some(leg.clone());
                Err(ContactError::Interrupted)
            },
        );
        found
    }
}

/// Returns true if nothing is in contact at the end of a stage.
fn is_separated(leg: Option<&LegRecord>) -> bool {
    match leg.and_then(|leg| leg.curve.last()) {
        Some(end) => end.springs == 0,
        None => false,
    }
}

/// Returns true if the animation has not moved the contact in this stage yet: the animation is at
/// the start of the stage or, in the first stage, still above first touch.
fn has_not_begun(leg: &LegRecord, number: usize, at: At) -> bool {
    match at {
        At::Start => true,
        At::Indentation(indentation) => number == 0 && indentation <= leg.start(),
        At::PullOff | At::End => false,
    }
}

/// Returns the loading history up to a position of the animation in a loading stage.
fn stages_until(solved: &SolvedScene, number: usize, at: At) -> Vec<Move> {
    let loading = &solved.scene.loading;
    let mut stages: Vec<Move> = loading.iter().take(number).copied().collect();
    let Some(leg) = solved.outcome.history.legs.get(number) else {
        return stages;
    };
    if !has_not_begun(leg, number, at) {
        stages.push(match at {
            At::Indentation(indentation) => Move::ToIndentation(indentation),
            At::Start | At::PullOff | At::End => leg.target,
        });
    }
    stages
}

/// Returns the direction of the last motion before a position of the animation in a loading stage;
/// `None` if the first stage has not begun.
fn direction_at(solved: &SolvedScene, number: usize, at: At) -> Option<Direction> {
    let legs = &solved.outcome.history.legs;
    let leg = legs.get(number)?;
    if has_not_begun(leg, number, at) {
        let before = legs.get(number.checked_sub(1)?)?;
        return Some(before.direction);
    }
    Some(leg.direction)
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

/// Answers requests until the explorer ends. If several requests are waiting, they are combined to
/// one.
pub fn serve(mut solver: Solver, requests: &Receiver<Request>, report: &mut dyn FnMut(Reply)) {
    while let Ok(first) = requests.recv() {
        let newest = requests
            .try_iter()
            .fold(first, |earlier, later| later.after(earlier));
        solver.serve(newest, report);
    }
}
