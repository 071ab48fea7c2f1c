//! The solver of the explorer, driven through its channels: the newest request wins, failures are shown, and a snapshot
//! of the animation is a point of the computed curve.

use super::common::deadline::within;
use super::common::scenes::{changed, one_spring, punch, rough, smooth, without_adhesion};
use asperity::contact::{ContactError, CurvePoint, Patch};
use asperity::explorer::request::{Drive, Focus, LineView, ManualMove, Place, Request, SnapshotRequest};
use asperity::explorer::snapshot::{ContactSnapshot, Report, SolvedScene};
use asperity::explorer::solver::{Solve, Solver, SolverThread, serve};
use asperity::scene::{Document, Observer};
use asperity::simulation::{Outcome, Simulation};
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_secs(20);

/// A solver on a thread of its own, and its channel of reports.
struct Served {
    thread: SolverThread,
    reports: Receiver<Report>,
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
        Served { thread, reports, last: RefCell::new(compute(0, &rough())) }
    }

    fn compute(&self, generation: u64, document: &Document) {
        *self.last.borrow_mut() = compute(generation, document);
        self.thread.ask(compute(generation, document));
    }

    fn report(&self) -> Report {
        self.reports.recv_timeout(PATIENCE).expect("the worker reports")
    }

    /// The next report other than progress.
    fn answer(&self) -> Report {
        loop {
            match self.report() {
                Report::Progress { .. } => {}
                other => return other,
            }
        }
    }

    fn computed(&self, generation: u64, document: &Document) -> Arc<SolvedScene> {
        self.compute(generation, document);
        match self.answer() {
            Report::Solved(computed, _) => computed,
            other => panic!("not computed: {other:?}"),
        }
    }

    /// A snapshot of the last scene.
    fn shown(&self, snapshot: SnapshotRequest) -> Arc<ContactSnapshot> {
        self.thread.ask(Request { snapshot, ..self.last.borrow().clone() });
        match self.answer() {
            Report::Shown(snapshot) => snapshot,
            other => panic!("not shown: {other:?}"),
        }
    }
}

/// A request for a snapshot.
fn snapshot(leg: usize, indentation: f64) -> SnapshotRequest {
    SnapshotRequest {
        drive: Drive::Leg(leg),
        place: Place::Indentation(indentation),
        profile_columns: 100,
        profile: LineView::WHOLE,
        close_up_columns: 100,
        strip_cells: 50,
        focus: Focus::Summit,
        close_up_springs: 64,
        crosshair: None,
    }
}

fn compute(generation: u64, document: &Document) -> Request {
    let scene = Arc::new(document.scene().clone());
    Request { generation, scene, moves: Vec::new(), snapshot: snapshot(0, 0.0) }
}

/// Sends all requests to a solver at once and returns all its reports.
fn serve_all(awaited: u64, requests: Vec<Request>) -> Vec<Report> {
    let (sender, receiver) = channel();
    requests.into_iter().for_each(|request| sender.send(request).unwrap());
    drop(sender);
    let mut reports = Vec::new();
    let solver = Solver::new(Simulation::run, Arc::new(AtomicU64::new(awaited)));
    serve(solver, &receiver, &mut |report| reports.push(report));
    reports
}

/// The computed scenes.
fn solved(reports: &[Report]) -> Vec<Arc<SolvedScene>> {
    let computed = |report: &Report| match report {
        Report::Solved(computed, _) => Some(Arc::clone(computed)),
        Report::Progress { .. } => None,
        other => panic!("{other:?}"),
    };
    reports.iter().filter_map(computed).collect()
}

fn seed(document: &Document, seed: u64) -> Document {
    document.set("roughness.seed", &seed.to_string()).unwrap()
}

#[test]
fn a_scene_is_computed_leg_by_leg_and_then_whole() {
    within(30, || {
        let served = Served::start();
        served.compute(7, &rough());
        for done in 1..=2 {
            assert!(matches!(served.report(), Report::Progress { generation: 7, legs } if legs == done));
        }
        let Report::Solved(computed, Some(shown)) = served.report() else { panic!("not computed") };
        assert_eq!((shown.generation, shown.drive), (7, Drive::Leg(0)));
        let mut scene = rough().scene().clone();
        scene.observe.push(Observer::HeightHistogram);
        let alone = Simulation::default().run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
        let timings = computed.outcome.timings;
        assert_eq!(computed.generation, 7);
        assert_eq!(computed.outcome, Outcome { timings, ..alone });
    });
}

#[test]
fn of_all_that_wait_only_the_newest_is_done() {
    within(30, || {
        let requests: Vec<_> = (1..=5).map(|number| compute(number, &seed(&rough(), number))).collect();
        let reports = serve_all(5, requests.clone());
        assert_eq!(solved(&reports).iter().map(|one| one.outcome.line.seed).collect::<Vec<_>>(), [Some(5)]);
        assert!(serve_all(6, requests).is_empty(), "a newer scene is awaited");
        // No manual move is lost, but those of another scene.
        let moved =
            |generation, by| Request { moves: vec![ManualMove::By(by)], ..compute(generation, &rough()) };
        assert_eq!(moved(1, 2.0).after(moved(1, 1.0)).moves, [ManualMove::By(1.0), ManualMove::By(2.0)]);
        assert_eq!(moved(2, 2.0).after(moved(1, 1.0)).moves, [ManualMove::By(2.0)]);
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
            .take_while(|report| !matches!(report, Report::Solved(..)))
            .collect();
        assert!(reports.iter().all(|report| matches!(report, Report::Progress { generation: 2, .. })));
        assert_eq!(served.shown(snapshot(0, 0.0)).generation, 2);
    });
}

#[test]
fn the_solver_ends_with_the_explorer() {
    within(30, || {
        let served = Served::start();
        served.computed(1, &rough());
        drop(served.thread);
        assert_eq!(served.reports.recv_timeout(PATIENCE).unwrap_err(), RecvTimeoutError::Disconnected);
    });
}

#[test]
fn a_panic_is_stated_and_the_next_scene_is_computed() {
    within(30, || {
        let served = Served::by(|simulation, scene, stop, after| match scene.title.as_str() {
            "text" => panic!("no such spring"),
            "formatted" => panic!("no spring {}", scene.numerics.points),
            _ => simulation.run(scene, stop, after),
        });
        let mut generation = 0;
        for (title, expected) in [("\"text\"", "no such spring"), ("\"formatted\"", "no spring 1024")] {
            generation += 1;
            served.compute(generation, &rough().set("title", title).unwrap());
            let Report::Failed { generation: of, error } = served.answer() else { panic!("not failed") };
            assert_eq!(of, generation);
            assert!(error.contains("internal error") && error.contains(expected), "{error}");
            assert_eq!(error.lines().count(), 1, "{error}");
            generation += 1;
            assert_eq!(served.computed(generation, &rough()).generation, generation);
            served.shown(snapshot(1, 0.0));
        }
    });
}

#[test]
fn a_leg_that_cannot_be_gone_is_stated_in_one_line() {
    within(30, || {
        let served = Served::start();
        let beyond = rough().set("loading", "[ToForce(1.0e-5), ToForce(-1.0)]").unwrap();
        served.compute(1, &beyond);
        let Report::Failed { generation: 1, error } = served.answer() else { panic!("not failed") };
        assert!(error.starts_with("loading.1 = ToForce(-1.0): the contact detaches above"), "{error}");
        assert_eq!(error.lines().count(), 1, "{error}");
        let alone = Simulation::default().run(beyond.scene(), &|| false, &mut |_, _, _| Ok(()));
        assert_eq!(error, alone.unwrap_err().to_string());
        // Nothing of the failed scene can be shown, and the next one is computed.
        served.thread.ask(compute(1, &beyond));
        served.computed(2, &rough());
    });
}

/// A rough sphere under adhesion.
fn rough_sphere() -> Document {
    changed(
        &rough(),
        &[("form", "Paraboloid(radius: 1.0e-3)"), ("loading", "[ToForce(1.0e-5), ToSeparation]")],
    )
}

/// Scenes whose states are examined, with a name.
fn scenes() -> Vec<(&'static str, Document)> {
    let several = "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToIndentation(-1.0e-8), ToSeparation]";
    vec![
        ("edges between springs", rough().set("numerics.edges", "SubCell").unwrap()),
        ("rough", rough()),
        ("several legs", rough().set("loading", several).unwrap()),
        ("rough sphere", rough_sphere()),
        ("smooth", smooth()),
        ("no adhesion", without_adhesion()),
        ("punch", punch()),
        ("one spring", one_spring()),
        ("stepwise", rough().set("numerics.solver", "Stepwise(step: 2.0e-9)").unwrap()),
        ("never touches", rough().set("loading", "[ToIndentation(-1.0e-7)]").unwrap()),
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
            for (leg, record) in computed.outcome.history.legs.iter().enumerate() {
                for sample in some(&record.curve) {
                    if name == "stepwise" && sample.springs == 0 && sample.indentation == 0.0 {
                        // Its curve begins before the touch, and may not keep the point after it.
                        continue;
                    }
                    let shown = served.shown(snapshot(leg, sample.indentation)).point;
                    // At a jump into or out of contact two samples have one indentation.
                    let same = record.curve.iter().filter(|one| one.indentation == sample.indentation);
                    assert!(
                        same.clone().any(|one| near(one, &shown)),
                        "{name}, leg {leg}: {shown:?}, not {:?}",
                        same.collect::<Vec<_>>()
                    );
                }
            }
        }
    });
}

/// True if two points are the same except for the rounding of their sums: edges between springs are summed in different
/// orders on a leg and at a snapshot.
fn near(one: &CurvePoint, other: &CurvePoint) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-13 * a.abs().max(b.abs()).max(1e-12);
    one.indentation == other.indentation
        && (one.springs, one.fragments) == (other.springs, other.fragments)
        && same(one.force, other.force)
        && same(one.contact_length, other.contact_length)
}

#[test]
fn a_moment_between_samples_is_the_one_a_finer_curve_has() {
    within(60, || {
        for (name, document) in
            [("rough", rough()), ("rough sphere", rough_sphere()), ("no adhesion", without_adhesion())]
        {
            let served = Served::start();
            let coarse = served.computed(1, &document.set("numerics.samples", "17").unwrap());
            let finer = document.set("numerics.samples", "65").unwrap();
            let fine = Simulation::default().run(finer.scene(), &|| false, &mut |_, _, _| Ok(())).unwrap();
            let mut between = 0;
            for (leg, record) in fine.history.legs.iter().enumerate() {
                let known = &coarse.outcome.history.legs[leg].curve;
                let new = |point: &&CurvePoint| known.iter().all(|one| one.indentation != point.indentation);
                for point in record.curve.iter().filter(new) {
                    let shown = served.shown(snapshot(leg, point.indentation)).point;
                    assert!(near(&shown, point), "{name}, leg {leg}: {shown:?}, not {point:?}");
                    between += 1;
                }
            }
            assert!(between > 64, "{name}: {between}");
        }
    });
}

#[test]
fn above_the_foundation_nothing_touches() {
    within(30, || {
        let served = Served::start();
        served.computed(1, &rough());
        let shown = served.shown(SnapshotRequest { close_up_springs: 1024, ..snapshot(0, -1e-8) });
        assert_eq!((shown.point.springs, shown.point.fragments, shown.point.force), (0, 0, 0.0));
        assert!(shown.profile.columns.iter().all(|column| column.contact.is_none()));
        assert!(shown.close_up.boundaries.is_empty() && shown.close_up.fragment.is_none());
        assert!(shown.profile.level > shown.profile.heights.1, "the surface is above the line");
    });
}

/// Contact patches, from one column for each spring.
fn fragments(snapshot: &ContactSnapshot) -> Vec<Patch> {
    Patch::of_springs(snapshot.profile.columns.iter().map(|column| column.contact.is_some()))
}

#[test]
fn picture_counts_and_boundaries_say_the_same() {
    within(60, || {
        for (name, document) in scenes() {
            let served = Served::start();
            let computed = served.computed(1, &document);
            for (leg, record) in computed.outcome.history.legs.iter().enumerate() {
                for sample in some(&record.curve).step_by(4) {
                    let springs = document.scene().numerics.points as usize;
                    let line = computed.outcome.line;
                    let under = springs - 2 * line.first;
                    let request = SnapshotRequest {
                        profile_columns: under,
                        close_up_columns: under,
                        close_up_springs: springs,
                        ..snapshot(leg, sample.indentation)
                    };
                    let shown = served.shown(request);
                    let found = fragments(&shown);
                    let held: usize = found.iter().map(|patch| patch.springs().len()).sum();
                    assert_eq!(shown.point.fragments, found.len() as u64, "{name}");
                    assert_eq!(shown.point.springs, held as u64, "{name}");
                    let ends: Vec<usize> = found
                        .iter()
                        .flat_map(
                            |&Patch { first, last }| {
                                if first == last { vec![first] } else { vec![first, last] }
                            },
                        )
                        .collect();
                    let boundaries = &shown.close_up.boundaries;
                    assert_eq!(
                        boundaries.iter().map(|(spring, _)| *spring).collect::<Vec<_>>(),
                        ends,
                        "{name}"
                    );
                    for &(spring, height) in boundaries {
                        assert_eq!(shown.profile.columns[spring].line, (height, height), "{name}");
                    }
                    let fragment = shown.close_up.fragment.map(|facts| (facts.number, facts.patch));
                    assert_eq!(fragment.is_some(), !found.is_empty(), "{name}");
                    if let Some((number, springs)) = fragment {
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

#[test]
fn at_the_end_of_a_leg_the_fragments_are_those_observed() {
    within(30, || {
        let served = Served::start();
        let fields = [("loading", "[ToForce(2.0e-5), ToZeroForce]"), ("observe", "[Fragments]")];
        let document = changed(&rough(), &fields);
        let computed = served.computed(1, &document);
        for (leg, record) in computed.outcome.history.legs.iter().enumerate() {
            let request = SnapshotRequest { profile_columns: 1024, ..snapshot(leg, record.end()) };
            let found = fragments(&served.shown(request));
            assert!(found.len() > 1, "{found:?}");
            assert_eq!(found, computed.outcome.fragments[leg]);
        }
    });
}

#[test]
fn next_and_previous_fragment_go_round() {
    within(60, || {
        let served = Served::start();
        let computed = served.computed(1, &rough());
        let leg = &computed.outcome.history.legs[0];
        let request = SnapshotRequest { close_up_springs: 16, ..snapshot(0, leg.end()) };
        let count = leg.curve.last().unwrap().fragments as usize;
        assert!(count > 3, "{count} fragments");
        let look = |focus| {
            let shown = served.shown(SnapshotRequest { focus, ..request });
            let facts = shown.close_up.fragment.expect("something touches");
            let section = &shown.close_up.section;
            let seen = section.first..section.first + section.springs;
            let middle = facts.patch.middle();
            let centred = matches!(focus, Focus::After(_) | Focus::Before(_));
            assert!(!centred || seen.contains(&middle), "{facts:?} not in {seen:?}");
            (facts.number, middle)
        };
        let (start, place) = look(Focus::Summit);
        let (mut number, mut spring) = (start, place);
        for _ in 0..count {
            let (next, middle) = look(Focus::After(Some(spring)));
            assert_eq!(next, (number + 1) % count);
            assert_eq!(look(Focus::Before(Some(middle))).0, number);
            (number, spring) = (next, middle);
        }
        assert_eq!(number, start);
        // Without a spring the summit is the first one; a given spring is shown as is.
        assert_eq!(look(Focus::After(None)).0, (start + 1) % count);
        assert_eq!(look(Focus::Before(None)).0, (start + count - 1) % count);
        assert_eq!(look(Focus::Spring(spring)).0, start);
    });
}

#[test]
fn the_close_up_stays_on_the_line() {
    within(30, || {
        let served = Served::start();
        let computed = served.computed(1, &rough());
        let end = computed.outcome.history.legs[0].end();
        for focus in [Focus::Spring(0), Focus::Spring(1023), Focus::Spring(usize::MAX), Focus::Summit] {
            for close_up_springs in [0, 1, 2, 1023, 1024, usize::MAX] {
                for close_up_columns in [0, 1, 3000] {
                    let request =
                        SnapshotRequest { focus, close_up_springs, close_up_columns, ..snapshot(0, end) };
                    let close_up = &served.shown(request).close_up;
                    let section = &close_up.section;
                    assert_eq!(section.springs, close_up_springs.clamp(1, 1024));
                    assert!(section.first + section.springs <= 1024);
                    assert_eq!(section.columns.len(), close_up_columns);
                    let seen = section.first..section.first + section.springs;
                    assert!(close_up.boundaries.iter().all(|(spring, _)| seen.contains(spring)));
                }
            }
        }
    });
}

#[test]
fn a_section_knows_its_heights_without_a_column_to_show_them() {
    within(30, || {
        let served = Served::start();
        served.computed(1, &rough());
        let wide = served.shown(SnapshotRequest { profile_columns: 1024, ..snapshot(0, 0.0) });
        let none =
            served.shown(SnapshotRequest { profile_columns: 0, close_up_columns: 0, ..snapshot(0, 0.0) });
        for section in [&none.profile, &none.close_up.section] {
            let (low, high) = section.heights;
            assert!(low.is_finite() && high.is_finite() && low <= high, "{low} {high}");
        }
        assert_eq!(none.profile.heights, wide.profile.heights);
    });
}

#[test]
fn a_fragment_bears_what_the_rule_of_hess_allows() {
    within(30, || {
        let served = Served::start();
        let computed = served.computed(1, &rough());
        let spacing = computed.outcome.line.spacing;
        let governing = computed.outcome.governing;
        let range = governing.work_of_adhesion.unwrap() / governing.effective_modulus;
        for sample in some(&computed.outcome.history.legs[1].curve).filter(|sample| sample.springs > 0) {
            let facts = served.shown(snapshot(1, sample.indentation)).close_up.fragment.unwrap();
            let springs = facts.patch.springs().len();
            // The edges of the patch lie within a cell of its outermost springs.
            assert!((facts.length / spacing - springs as f64).abs() <= 1.0 + 1e-9, "{facts:?}");
            // Eq. (10), written anew.
            let bears = (2.0 * std::f64::consts::PI * (facts.length / 2.0) * range).sqrt();
            assert!((facts.largest_stretch / bears - 1.0).abs() < 1e-12, "{facts:?}, not {bears}");
            assert!(facts.most_stretched <= facts.largest_stretch * (1.0 + 1e-9), "{facts:?}");
        }
        let served = Served::start();
        let computed = served.computed(1, &without_adhesion());
        let end = computed.outcome.history.legs[0].end();
        let facts = served.shown(snapshot(0, end)).close_up.fragment.unwrap();
        assert_eq!(facts.largest_stretch, 0.0);
        assert!(facts.most_stretched <= 0.0);
    });
}

#[test]
fn the_histogram_is_there_whatever_a_scene_observes() {
    within(30, || {
        let served = Served::start();
        let all = ["[]", "[Fragments]", "[HeightHistogram]", "[Fragments, HeightHistogram]"];
        for (generation, observe) in (1..).zip(all) {
            let document = rough().set("observe", observe).unwrap();
            let computed = served.computed(generation, &document);
            let histogram = computed.outcome.histogram.as_ref().expect("the heights are observed");
            assert_eq!(histogram.counts.iter().sum::<u64>(), 1024);
            let observed = document.scene().observe.contains(&Observer::Fragments);
            assert_eq!(computed.outcome.fragments.len(), if observed { 2 } else { 0 });
        }
    });
}
