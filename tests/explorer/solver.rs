//! The solver of the explorer, driven through its channels: the newest request wins, failures are
//! shown, and a snapshot of the animation is a point of the computed curve.

use super::common::deadline::within;
use super::common::scenes::{
    changed, one_spring, punch, relaxing, rough, smooth, without_adhesion,
};
use asperity::contact::{ContactError, CurvePoint, Move, Patch};
use asperity::explorer::events::LeastShare;
use asperity::explorer::manual_path::{ManualPath, PathStart};
use asperity::explorer::player::At;
use asperity::explorer::request::{Drive, Focus, LineView, Request, SnapshotRequest};
use asperity::explorer::snapshot::{ContactSnapshot, Reply, SolvedScene};
use asperity::explorer::solver::{Solve, Solver, SolverThread, serve};
use asperity::scene::Simulation;
use asperity::scene::{Document, Observer};
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_secs(20);

/// A solver on a thread of its own, and its channel of reports.
struct Served {
    thread: SolverThread,
    reports: Receiver<Reply>,
    /// The request of the last scene.
    last: RefCell<Request>,
}

impl Served {
    fn start() -> Self {
        Served::by(Simulation::run)
    }

    fn by(solve: Solve) -> Self {
        let (report, reports) = channel();
        let thread = SolverThread::start(solve, move |one| drop(report.send(one))).unwrap();
        Served {
            thread,
            reports,
            last: RefCell::new(compute(0, &rough())),
        }
    }

    fn compute(&self, generation: u64, document: &Document) {
        *self.last.borrow_mut() = compute(generation, document);
        self.thread.ask(compute(generation, document));
    }

    fn report(&self) -> Reply {
        self.reports
            .recv_timeout(PATIENCE)
            .expect("the worker reports")
    }

    /// The next report other than progress.
    fn answer(&self) -> Reply {
        loop {
            match self.report() {
                Reply::Progress { .. } | Reply::Listed(_) => {}
                other => return other,
            }
        }
    }

    fn computed(&self, generation: u64, document: &Document) -> Arc<SolvedScene> {
        self.compute(generation, document);
        match self.answer() {
            Reply::Solved(computed, _) => computed,
            other => panic!("not computed: {other:?}"),
        }
    }

    /// A snapshot of the last scene at an indentation of a stage.
    fn shown(
        &self,
        stage: usize,
        indentation: f64,
        snapshot: SnapshotRequest,
    ) -> Arc<ContactSnapshot> {
        self.shown_at(stage, At::Indentation(indentation), snapshot)
    }

    fn shown_at(&self, stage: usize, at: At, snapshot: SnapshotRequest) -> Arc<ContactSnapshot> {
        let snapshot = SnapshotRequest {
            drive: Drive::Stage(stage),
            at,
            ..snapshot
        };
        self.thread.ask(Request {
            snapshot,
            ..self.last.borrow().clone()
        });
        match self.answer() {
            Reply::Shown(snapshot) => snapshot,
            other => panic!("not shown: {other:?}"),
        }
    }
}

/// A request for a snapshot at the start of the animation.
const SNAPSHOT: SnapshotRequest = SnapshotRequest {
    drive: Drive::Stage(0),
    at: At::Start,
    profile_columns: 100,
    profile: LineView::WHOLE,
    close_up_columns: 100,
    focus: Focus::Summit,
    close_up_springs: Some(64),
    crosshair: None,
};

fn compute(generation: u64, document: &Document) -> Request {
    let scene = Arc::new(document.scene().clone());
    Request {
        generation,
        scene,
        path: None,
        least_share: LeastShare::default(),
        snapshot: SNAPSHOT,
    }
}

/// Sends all requests to a solver at once and returns all its reports.
fn serve_all(awaited: u64, requests: Vec<Request>) -> Vec<Reply> {
    let (sender, receiver) = channel();
    requests
        .into_iter()
        .for_each(|request| sender.send(request).unwrap());
    drop(sender);
    let mut reports = Vec::new();
    let solver = Solver::new(Simulation::run, Arc::new(AtomicU64::new(awaited)));
    serve(solver, &receiver, &mut |report| reports.push(report));
    reports
}

/// The computed scenes.
fn solved(reports: &[Reply]) -> Vec<Arc<SolvedScene>> {
    let computed = |report: &Reply| match report {
        Reply::Solved(computed, _) => Some(Arc::clone(computed)),
        Reply::Progress { .. } | Reply::Listed(_) => None,
        other => panic!("{other:?}"),
    };
    reports.iter().filter_map(computed).collect()
}

fn seed(document: &Document, seed: u64) -> Document {
    document.set("roughness.seed", &seed.to_string()).unwrap()
}

#[test]
fn a_scene_is_computed_stage_by_stage_and_then_whole() {
    within(30, || {
        let served = Served::start();
        served.compute(7, &rough());
        for done in 1..=2 {
            assert!(
                matches!(served.report(), Reply::Progress { generation: 7, stages } if stages == done)
            );
        }
        let Reply::Solved(computed, Some(shown)) = served.report() else {
            panic!("not computed")
        };
        assert_eq!((shown.generation, shown.drive), (7, Drive::Stage(0)));
        let rough = rough();
        let scene = rough
            .scene()
            .with(|scene| scene.observe.push(Observer::HeightHistogram))
            .unwrap();
        let mut alone = Simulation::default()
            .run(&scene, &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        let timings = computed.outcome.timings;
        assert_eq!(computed.generation, 7);
        alone.timings = timings;
        assert_eq!(computed.outcome, alone);
    });
}

#[test]
fn of_all_that_wait_only_the_newest_is_done() {
    within(30, || {
        let requests: Vec<_> = (1..=5)
            .map(|number| compute(number, &seed(&rough(), number)))
            .collect();
        let reports = serve_all(5, requests.clone());
        assert_eq!(
            solved(&reports)
                .iter()
                .map(|one| one.outcome.line.seed)
                .collect::<Vec<_>>(),
            [Some(5)]
        );
        assert!(
            serve_all(6, requests).is_empty(),
            "a newer scene is awaited"
        );
        // A request has the whole path, so no move is lost with the requests that are left out.
        let moved = |count: usize| {
            let start = PathStart {
                stage: 0,
                at: At::End,
            };
            let moves = [Move::ToForce(1.0e-5), Move::ToForce(1.5e-5)];
            let path = ManualPath {
                start,
                moves: moves[..count].to_vec(),
            };
            Request {
                path: Some(Arc::new(path)),
                snapshot: SnapshotRequest {
                    drive: Drive::Manual,
                    ..SNAPSHOT
                },
                ..compute(1, &rough())
            }
        };
        let reports = serve_all(1, vec![moved(0), moved(1), moved(2)]);
        let computed = reports.iter().find_map(|report| match report {
            Reply::Solved(_, shown) => shown.as_ref(),
            _ => None,
        });
        let Some(shown) = computed else {
            panic!("not computed: {reports:?}")
        };
        let followed = shown.followed.as_ref().unwrap();
        assert_eq!((followed.before, followed.count()), (1, 2));
        assert_eq!(followed.stopped, None);
    });
}

#[test]
fn a_newer_scene_stops_the_one_that_is_being_computed() {
    within(30, || {
        static BEGUN: AtomicBool = AtomicBool::new(false);
        let served = Served::by(|simulation, scene, stop, after| {
            if scene.title != "endless" {
                return simulation.run(scene, stop, after);
            }
            BEGUN.store(true, Ordering::Relaxed);
            while !stop() {
                std::thread::yield_now();
            }
            Err(ContactError::Interrupted.into())
        });
        served.compute(1, &rough().set("title", "\"endless\"").unwrap());
        while !BEGUN.load(Ordering::Relaxed) {
            std::thread::yield_now();
        }
        served.compute(2, &rough());
        let reports: Vec<_> = std::iter::from_fn(|| Some(served.report()))
            .take_while(|report| !matches!(report, Reply::Solved(..)))
            .collect();
        assert!(
            reports
                .iter()
                .all(|report| matches!(report, Reply::Progress { generation: 2, .. }))
        );
        assert_eq!(served.shown(0, 0.0, SNAPSHOT).generation, 2);
    });
}

#[test]
fn a_panic_is_stated_and_the_next_scene_is_computed() {
    within(30, || {
        let served = Served::by(
            |simulation, scene, stop, after| match scene.title.as_str() {
                "text" => panic!("no such spring"),
                "formatted" => panic!("no spring {}", scene.numerics.points),
                _ => simulation.run(scene, stop, after),
            },
        );
        let mut generation = 0;
        for (title, expected) in [
            ("\"text\"", "no such spring"),
            ("\"formatted\"", "no spring 1024"),
        ] {
            generation += 1;
            served.compute(generation, &rough().set("title", title).unwrap());
            let Reply::Failed {
                generation: of,
                error,
            } = served.answer()
            else {
                panic!("not failed")
            };
            assert_eq!(of, generation);
            assert!(
                error.contains("internal error") && error.contains(expected),
                "{error}"
            );
            assert_eq!(error.lines().count(), 1, "{error}");
            generation += 1;
            assert_eq!(served.computed(generation, &rough()).generation, generation);
            served.shown(1, 0.0, SNAPSHOT);
        }
    });
}

/// Scenes whose states are examined, with a name.
fn scenes() -> Vec<(&'static str, Document)> {
    let sphere = [
        ("form", "Paraboloid(radius: 1.0e-3)"),
        ("loading", "[ToForce(1.0e-5), ToSeparation]"),
    ];
    let several =
        "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToIndentation(-1.0e-8), ToSeparation]";
    vec![
        (
            "edges between springs",
            rough().set("numerics.edges", "SubCell").unwrap(),
        ),
        ("rough", rough()),
        ("several stages", rough().set("loading", several).unwrap()),
        ("rough sphere", changed(&rough(), &sphere)),
        ("smooth", smooth()),
        ("no adhesion", without_adhesion()),
        ("punch", punch()),
        ("one spring", one_spring()),
        (
            "never touches",
            rough().set("loading", "[ToIndentation(-1.0e-7)]").unwrap(),
        ),
    ]
}

/// Some points of a curve, including its ends.
fn some(curve: &[CurvePoint]) -> impl Iterator<Item = &CurvePoint> {
    let every = (curve.len() / 24).max(1);
    curve
        .iter()
        .enumerate()
        .filter(move |(index, _)| index % every == 0)
        .map(|(_, point)| point)
        .chain(curve.last())
}

#[test]
fn a_moment_at_a_sample_is_the_sample() {
    within(60, || {
        for (name, document) in scenes() {
            let served = Served::start();
            let computed = served.computed(1, &document);
            for (stage, record) in computed.outcome.history.stages.iter().enumerate() {
                for sample in some(&record.curve) {
                    let shown = served.shown(stage, sample.indentation, SNAPSHOT).point;
                    if record.most_springs() == 0 {
                        assert_eq!((shown.springs, shown.force), (0, 0.0), "{name}");
                        continue;
                    }
                    // At a jump into or out of contact two samples have one indentation.
                    let same = record
                        .curve
                        .iter()
                        .filter(|one| one.indentation == sample.indentation);
                    assert!(
                        same.clone().any(|one| near(one, &shown)),
                        "{name}, stage {stage}: {shown:?}, not {:?}",
                        same.collect::<Vec<_>>()
                    );
                }
            }
        }
    });
}

/// On a body that relaxes the shown state follows the time, also while the body rests, and the
/// springs that the panes count are those that they draw.
#[test]
fn a_moment_of_a_relaxing_body_is_the_sample_at_its_time() {
    within(60, || {
        let smooth = changed(
            &smooth(),
            &[
                (
                    "material",
                    "(modulus: 2.0e6, relaxation: (share: 0.4, time: 1.0))",
                ),
                ("loading_speed", "1.0e-6"),
                ("loading", "[ToForce(1.0e-4), Hold(2.0), ToSeparation]"),
            ],
        );
        let with_instrument = changed(&relaxing(), &[("loading_stiffness", "20.0")]);
        for document in [smooth, relaxing(), with_instrument] {
            let served = Served::start();
            let computed = served.computed(1, &document);
            let mut rest_has_changed = false;
            for (stage, record) in computed.outcome.history.stages.iter().enumerate() {
                for (index, sample) in record.curve.iter().enumerate().step_by(7) {
                    let seconds = record.seconds[index];
                    let snapshot = served.shown_at(stage, At::Seconds(seconds), SNAPSHOT);
                    let shown = snapshot.point;
                    // At a jump two samples have one time.
                    let first = record.seconds.partition_point(|&time| time < seconds);
                    let end = record.seconds.partition_point(|&time| time <= seconds);
                    let scale = record.largest.force.abs().max(record.smallest.force.abs());
                    assert!(
                        record.curve[first..end]
                            .iter()
                            .any(|same| (same.force - shown.force).abs() <= 1e-9 * scale),
                        "stage {stage}, {seconds} s: {shown:?}, not {sample:?}"
                    );
                    let drawn: usize = snapshot
                        .springs
                        .patches
                        .iter()
                        .map(|patch| patch.springs().len())
                        .sum();
                    assert_eq!(shown.springs, drawn as u64, "stage {stage}, {seconds} s");
                    rest_has_changed |= stage == 1 && shown.force != record.curve[0].force;
                }
            }
            assert!(rest_has_changed);
        }
    });
}

/// True if two points are the same except for the rounding of their sums: edges between springs are
/// summed in different orders on a stage and at a snapshot.
fn near(one: &CurvePoint, other: &CurvePoint) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-13 * a.abs().max(b.abs()).max(1e-12);
    one.indentation == other.indentation
        && (one.springs, one.patches) == (other.springs, other.patches)
        && same(one.force, other.force)
        && same(one.contact_length, other.contact_length)
}

/// Contact patches, from one column for each spring.
fn patches(snapshot: &ContactSnapshot) -> Vec<Patch> {
    Patch::of_springs(
        snapshot
            .profile
            .columns
            .iter()
            .map(|column| column.contact.is_some()),
    )
}

#[test]
fn picture_counts_and_boundaries_say_the_same() {
    within(60, || {
        for (name, document) in scenes() {
            let served = Served::start();
            let computed = served.computed(1, &document);
            for (stage, record) in computed.outcome.history.stages.iter().enumerate() {
                for sample in some(&record.curve).step_by(4) {
                    let springs = document.scene().numerics.points as usize;
                    let line = computed.outcome.line;
                    let under = springs - 2 * line.first;
                    let request = SnapshotRequest {
                        profile_columns: under,
                        close_up_columns: under,
                        close_up_springs: Some(springs),
                        ..SNAPSHOT
                    };
                    let shown = served.shown(stage, sample.indentation, request);
                    let found = patches(&shown);
                    let held: usize = found.iter().map(|patch| patch.springs().len()).sum();
                    assert_eq!(shown.point.patches, found.len() as u64, "{name}");
                    assert_eq!(shown.point.springs, held as u64, "{name}");
                    let ends: Vec<usize> = found
                        .iter()
                        .flat_map(|&Patch { first, last }| {
                            if first == last {
                                vec![first]
                            } else {
                                vec![first, last]
                            }
                        })
                        .collect();
                    let boundaries = &shown.close_up.boundaries;
                    assert_eq!(
                        boundaries
                            .iter()
                            .map(|(spring, _)| *spring)
                            .collect::<Vec<_>>(),
                        ends,
                        "{name}"
                    );
                    for &(spring, height) in boundaries {
                        assert_eq!(
                            shown.profile.columns[spring].line,
                            (height, height),
                            "{name}"
                        );
                    }
                    let patch = shown
                        .close_up
                        .patch
                        .map(|facts| (facts.number, facts.patch));
                    assert_eq!(patch.is_some(), !found.is_empty(), "{name}");
                    if let Some((number, springs)) = patch {
                        assert_eq!(found[number], springs, "{name}");
                    }
                    // In contact the surface follows the line, elsewhere it lies at its level.
                    for column in &shown.profile.columns {
                        let level = (shown.profile.level, shown.profile.level);
                        assert_eq!(column.surface, column.contact.unwrap_or(level), "{name}");
                    }
                }
            }
        }
    });
}
