//! The solver: it owns the simulation and the legs of the newest scene, and answers the newest
//! request of the explorer, on a thread of its own or at once.

use super::close_up::close_up;
use super::manual_body::ManualBody;
use super::player::{At, Player, indentations};
use super::request::{Drive, ManualMove, Request, SnapshotRequest};
use super::snapshot::{ContactSnapshot, Probe, Reply, SolvedScene, SpringsInContact, profile_part};
use asperity_contact::motion::Leg;
use asperity_contact::{ContactError, CurvePoint, Direction, LegRecord, Move};
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

/// Limit of the memory of kept legs, bytes; a leg beyond it is computed again when the animation
/// reaches it.
const BYTES_KEPT: usize = 1 << 29;

/// Number of curve points over the range of indentations when the body is pulled off manually.
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
    /// Generation of the scene that the explorer waits for; a run of any other scene stops.
    awaited: Arc<AtomicU64>,
    newest: Newest,
}

#[derive(Default)]
struct Newest {
    generation: u64,
    /// The scene as computed; `None` if it failed.
    scene: Option<CheckedScene>,
    solved: Option<Arc<SolvedScene>>,
    /// Legs of the loading; `None` for a leg that was not kept.
    legs: Vec<Option<Leg>>,
    body: Option<ManualBody>,
    /// Lowest and highest point of the profile in each column, kept between snapshots.
    profile: LineColumns,
    close_up: LineColumns,
}

impl Solver {
    /// Creates a solver with this function; it computes only the scene of the awaited generation.
    pub fn new(solve: Solve, awaited: Arc<AtomicU64>) -> Self {
        Solver {
            solve,
            simulation: Simulation::default(),
            awaited,
            newest: Newest::default(),
        }
    }

    /// Marks the scene of a request as awaited, and answers the request.
    pub fn answer(&mut self, request: Request, report: &mut dyn FnMut(Reply)) {
        self.awaited.store(request.generation, Ordering::Relaxed);
        self.serve(request, report);
    }

    /// Answers a request. A panic ends the request, and not the explorer.
    pub fn serve(&mut self, request: Request, report: &mut dyn FnMut(Reply)) {
        let generation = request.generation;
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| self.try_serve(request, report))) {
            self.newest = Newest {
                generation,
                ..Newest::default()
            };
            self.simulation = Simulation::default();
            let error = format!(
                "internal error, please report it: {}",
                panic_text(panic.as_ref())
            );
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
                // Unless the scene is awaited again.
                Err(error) if error.is_interruption() => return self.newest.generation = 0,
                Err(error) => report(Reply::Failed {
                    generation,
                    error: error.to_string(),
                }),
            }
        }
        for order in moves {
            self.follow(order);
        }
        let shown = self.snapshot(&snapshot).map(Arc::new);
        match (self.newest.solved.clone().filter(|_| is_new), shown) {
            (Some(solved), shown) => report(Reply::Solved(solved, shown)),
            (None, Some(shown)) => report(Reply::Shown(shown)),
            (None, None) => {}
        }
    }

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
        // The histogram beside the profile needs the heights.
        let observed = scene.observing(Observer::HeightHistogram);
        let stop = || self.awaited.load(Ordering::Relaxed) != generation;
        let (mut bytes, mut legs, mut reach) = (0, Vec::new(), Reach::default());
        let outcome = (self.solve)(
            &mut self.simulation,
            &observed,
            &stop,
            &mut |stage, _, leg| {
                if stage == 0 {
                    reach = Reach::of(leg.contact());
                }
                legs.push(Some(leg.clone()).filter(|_| bytes <= BYTES_KEPT));
                bytes += leg.bytes();
                report(Reply::Progress {
                    generation,
                    legs: stage + 1,
                });
                Ok(())
            },
        )?;
        let solved = Some(Arc::new(SolvedScene {
            generation,
            scene,
            outcome,
            reach,
        }));
        self.newest = Newest {
            generation,
            scene: Some(observed),
            solved,
            legs,
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

    fn take(&mut self, number: usize, at: At) -> Option<ManualBody> {
        self.newest.body = None;
        let solved = self.newest.solved.clone()?;
        let leg = if solved.scene.numerics.solver == SceneSolver::Exact {
            self.leg(number)
        } else {
            // The stepwise solver knows no leg but those of the loading.
            let exact = solved
                .scene
                .with(|scene| scene.numerics.solver = SceneSolver::Exact)
                .ok()?;
            self.leg_of(&exact, number)
        }?;
        let legs = &solved.outcome.history.legs;
        let indentation = Player {
            leg: number,
            at,
            playing: false,
        }
        .indentation(legs);
        let (low, high) = indentations(legs).unwrap_or_default();
        let so_far = stages_until(&solved, number, at);
        let is_separated = at == At::End && is_separated(legs.get(number));
        ManualBody::take(
            &leg,
            (indentation, is_separated),
            (high - low) / STEPS_OF_A_PULL,
            so_far,
        )
    }

    /// Makes the requested snapshot; `None` if there is no such stage or manual loading has not
    /// begun.
    fn snapshot(&mut self, request: &SnapshotRequest) -> Option<ContactSnapshot> {
        let (drive, leg, point) = match request.drive {
            Drive::Leg(number) => {
                self.newest.body = None;
                let legs = &self.newest.solved.as_deref()?.outcome.history.legs;
                // The existing leg nearest to the requested one.
                let player = Player {
                    leg: number,
                    at: request.at,
                    playing: false,
                }
                .within(legs);
                let (number, indentation) = (player.leg, player.indentation(legs));
                // After a separation nothing is in contact, at the same indentation.
                let end = legs
                    .get(number)
                    .filter(|leg| player.at == At::End && is_separated(Some(leg)));
                let end = end.and_then(|leg| leg.curve.last().copied());
                let leg = self.leg(number)?;
                let point = end.map_or_else(|| leg.point(indentation).ok(), Some)?;
                (Drive::Leg(number), leg, point)
            }
            Drive::Manual => {
                let body = self.newest.body.as_ref()?;
                (Drive::Manual, body.leg(), body.point())
            }
        };
        let Newest {
            generation,
            solved,
            body,
            profile,
            close_up: columns,
            ..
        } = &mut self.newest;
        let line = solved.as_deref()?.outcome.line;
        let patches = if point.springs == 0 {
            Vec::new()
        } else {
            leg.patches(point.indentation)
        };
        let CurvePoint { indentation, .. } = point;
        let gaps = leg.contact().gaps();
        let contact = SectionContact {
            gaps,
            summit: line.summit,
            indentation,
            patches: &patches,
        };
        let close_up = close_up(&contact, &leg, request, columns);
        let part = profile_part(request, gaps.len());
        Some(ContactSnapshot {
            generation: *generation,
            drive,
            line,
            focus: request.focus,
            point,
            contact_radius: leg.contact().contact_radius(&patches, point),
            profile: contact.section(part, profile),
            close_up,
            probe: request
                .crosshair
                .and_then(|position| Probe::at(&contact, position)),
            manual: body.as_mut().map(ManualBody::travel),
            springs: SpringsInContact {
                gaps: Arc::downgrade(leg.contact().profile().shared_gaps()),
                patches,
            },
        })
    }

    /// A leg of the loading; computed again if it was not kept.
    fn leg(&mut self, number: usize) -> Option<Leg> {
        if self.newest.legs.get(number)?.is_none() {
            let scene = self.newest.scene.take()?;
            let found = self.leg_of(&scene, number);
            self.newest.scene = Some(scene);
            // Only one recalled leg is kept at a time.
            let firsts = found
                .as_ref()
                .map_or(0, |leg| BYTES_KEPT / leg.bytes().max(1));
            self.newest
                .legs
                .iter_mut()
                .skip(firsts + 1)
                .for_each(|leg| *leg = None);
            self.newest.legs[number] = found;
        }
        self.newest.legs[number].clone()
    }

    /// Computes the leg of one loading stage by running the scene up to it.
    fn leg_of(&mut self, scene: &CheckedScene, wanted: usize) -> Option<Leg> {
        let mut found = None;
        // The run ends as soon as the leg is found.
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
    leg.and_then(|leg| leg.curve.last())
        .is_some_and(|end| end.springs == 0)
}

/// The loading history up to a position in a stage, and the direction of its last stage.
fn stages_until(solved: &SolvedScene, number: usize, at: At) -> (Vec<Move>, Option<Direction>) {
    let (legs, loading) = (&solved.outcome.history.legs, &solved.scene.loading);
    let mut stages = loading.iter().take(number).copied().collect::<Vec<_>>();
    let before = number
        .checked_sub(1)
        .and_then(|before| legs.get(before))
        .map(|leg| leg.direction);
    let Some(leg) = legs.get(number) else {
        return (stages, None);
    };
    match at {
        At::Start => return (stages, before),
        // The animation begins above the foundation.
        At::Indentation(indentation) if number == 0 && indentation <= leg.start() => {
            return (stages, before);
        }
        At::Indentation(indentation) => stages.push(Move::ToIndentation(indentation)),
        At::PullOff | At::End => stages.push(leg.target),
    }
    (stages, Some(leg.direction))
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("unknown cause")
}

pub struct SolverThread {
    requests: Sender<Request>,
    awaited: Arc<AtomicU64>,
}

impl SolverThread {
    /// Starts the thread of the solver. `report` receives its replies.
    pub fn start(solve: Solve, report: impl Fn(Reply) + Send + 'static) -> std::io::Result<Self> {
        let (requests, inbox) = channel();
        let awaited = Arc::new(AtomicU64::new(0));
        let solver = Solver::new(solve, Arc::clone(&awaited));
        let newest = Arc::clone(&awaited);
        // The explorer may be behind with its input: reports of scenes that it has left do not wait
        // for it.
        let mut report = move |one: Reply| {
            if one.generation() == newest.load(Ordering::Relaxed) {
                report(one);
            }
        };
        let serve = move || serve(solver, &inbox, &mut report);
        std::thread::Builder::new()
            .name("simulation".to_owned())
            .spawn(serve)?;
        Ok(SolverThread { requests, awaited })
    }

    /// Sends a request; a run of any other scene stops.
    pub fn ask(&self, request: Request) {
        self.awaited.store(request.generation, Ordering::Relaxed);
        // The thread only ends with the explorer.
        let _ = self.requests.send(request);
    }
}

/// Answers the newest request, again and again, until the explorer is gone.
pub fn serve(mut solver: Solver, requests: &Receiver<Request>, report: &mut dyn FnMut(Reply)) {
    while let Ok(first) = requests.recv() {
        let newest = requests
            .try_iter()
            .fold(first, |earlier, later| later.after(earlier));
        solver.serve(newest, report);
    }
}
