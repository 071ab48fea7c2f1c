//! The worker of the explorer, driven through its channels: the newest request wins, failures are shown, and a snapshot
//! of the animation is a point of the computed curve.

use super::common::deadline::within;
use super::common::scenes::{changed, one_spring, punch, rough, smooth, without_adhesion};
use asperity::contact::{ContactError, CurvePoint, Patch};
use asperity::explorer::panes::Pane;
use asperity::explorer::snapshot::{ContactSnapshot, Drive, SolvedScene};
use asperity::explorer::worker::{
    self, Engine, Focus, LineView, Newest, Report, Request, SnapshotRequest, Worker,
};
use asperity::scene::{Document, Observer, Scene};
use asperity::simulation::{AfterLeg, Outcome, RunError, Simulation};
use asperity::surface::Line;
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_secs(20);

/// A worker on a thread of its own, and its channel of reports.
struct Served {
    worker: Worker,
    reports: Receiver<Report>,
}

impl Served {
    fn by(engine: impl Engine + 'static) -> Self {
        let (requests, outbox) = channel();
        let (report, reports) = channel();
        let newest = Newest::default();
        worker::start(Box::new(engine), Arc::clone(&newest), outbox, move |one| report.send(one).is_ok())
            .unwrap();
        Served { worker: Worker::new(requests, newest), reports }
    }

    fn compute(&self, generation: u64, document: &Document) {
        let scene = Arc::new(document.scene().clone());
        self.worker.ask(Request::Compute { generation, scene });
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
        // The snapshot of an earlier scene may have been requested.
        let of_before = |report: &Report| matches!(report, Report::Shown(one) if one.generation < generation);
        match std::iter::repeat_with(|| self.answer()).find(|report| !of_before(report)).unwrap() {
            Report::Computed(computed) => computed,
            other => panic!("not computed: {other:?}"),
        }
    }

    fn shown(&self, request: SnapshotRequest) -> Arc<ContactSnapshot> {
        self.worker.ask(Request::Show(request));
        match self.answer() {
            Report::Shown(snapshot) => snapshot,
            other => panic!("not shown: {other:?}"),
        }
    }
}

/// A request for a snapshot of the first generation.
fn snapshot(leg: usize, indentation: f64) -> SnapshotRequest {
    SnapshotRequest {
        generation: 1,
        drive: Drive::Leg(leg),
        indentation,
        profile_columns: 100,
        profile: LineView::WHOLE,
        close_up_columns: 100,
        strip_cells: 50,
        focus: Focus::Summit,
        close_up_springs: 64,
        large: None,
        lower: Pane::CloseUp,
        crosshair: None,
        beside: None,
    }
}

fn compute(generation: u64, document: &Document) -> Request {
    Request::Compute { generation, scene: Arc::new(document.scene().clone()) }
}

/// Sends all requests to a worker at once and returns all its reports.
fn serve_all(engine: impl Engine + 'static, newest: u64, requests: Vec<Request>) -> Vec<Report> {
    let (sender, receiver) = channel();
    requests.into_iter().for_each(|request| sender.send(request).unwrap());
    drop(sender);
    let reports = RefCell::new(Vec::new());
    let generation = Newest::default();
    generation.set_generation(newest);
    worker::serve(Box::new(engine), &generation, &receiver, &|report| {
        reports.borrow_mut().push(report);
        true
    });
    reports.into_inner()
}

/// The computed generations, and those with shown states.
fn generations(reports: &[Report]) -> (Vec<u64>, Vec<u64>) {
    let (mut computed, mut shown) = (Vec::new(), Vec::new());
    for report in reports {
        match report {
            Report::Computed(one) => computed.push(one.generation),
            Report::Shown(one) => shown.push(one.generation),
            Report::Progress { .. } => {}
            Report::Failed { .. } | Report::Previewed(_) => panic!("{report:?}"),
        }
    }
    (computed, shown)
}

/// Replacement of a run in a [`Double`].
type Run = dyn FnMut(&Scene, &dyn Fn() -> bool) -> Option<RunError> + Send;

/// An engine that may act before a run, or in its place.
struct Double {
    simulation: Simulation,
    before: Box<Run>,
}

impl Double {
    fn new(before: impl FnMut(&Scene, &dyn Fn() -> bool) -> Option<RunError> + Send + 'static) -> Self {
        Double { simulation: Simulation::default(), before: Box::new(before) }
    }
}

impl Engine for Double {
    fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError> {
        match (self.before)(scene, stop) {
            Some(error) => Err(error),
            None => self.simulation.run(scene, stop, after),
        }
    }

    fn line(&self) -> Option<&Line> {
        self.simulation.line()
    }
}

fn seed(document: &Document, seed: u64) -> Document {
    document.set("roughness.seed", &seed.to_string()).unwrap()
}

#[test]
fn a_scene_is_computed_leg_by_leg_and_then_whole() {
    within(30, || {
        let served = Served::by(Simulation::default());
        served.compute(7, &rough());
        for done in 1..=2 {
            assert!(matches!(served.report(), Report::Progress { generation: 7, legs } if legs == done));
        }
        let Report::Computed(computed) = served.report() else { panic!("not computed") };
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
        let show = |leg| Request::Show(SnapshotRequest { generation: 5, ..snapshot(leg, 0.0) });
        let mut requests: Vec<_> = (1..=5).map(|number| compute(number, &seed(&rough(), number))).collect();
        requests.extend([show(0), show(0), show(1)]);
        let reports = serve_all(Simulation::default(), 5, requests);
        assert_eq!(generations(&reports), (vec![5], vec![5]));
        let Some(Report::Shown(shown)) = reports.last() else { panic!("{reports:?}") };
        assert_eq!(shown.drive, Drive::Leg(1));
        let Some(Report::Computed(computed)) = reports.iter().rev().nth(1) else { panic!("{reports:?}") };
        assert_eq!(computed.outcome.line.seed, Some(5));
    });
}

#[test]
fn moments_of_another_scene_are_not_shown() {
    within(30, || {
        let show = |generation| Request::Show(SnapshotRequest { generation, ..snapshot(0, 0.0) });
        for generation in [1, 3] {
            let requests = vec![compute(2, &rough()), show(generation)];
            assert_eq!(generations(&serve_all(Simulation::default(), 2, requests)), (vec![2], vec![]));
        }
        // Before any scene there is nothing to show.
        assert!(serve_all(Simulation::default(), 0, vec![show(0)]).is_empty());
        let past_the_end = Request::Show(SnapshotRequest { generation: 2, ..snapshot(2, 0.0) });
        let requests = vec![compute(2, &rough()), past_the_end];
        assert_eq!(generations(&serve_all(Simulation::default(), 2, requests)), (vec![2], vec![]));
    });
}

#[test]
fn a_scene_that_is_no_longer_wanted_is_not_computed() {
    within(30, || {
        let show = Request::Show(snapshot(0, 0.0));
        let reports = serve_all(Simulation::default(), 2, vec![compute(1, &rough()), show]);
        assert!(reports.is_empty(), "{reports:?}");
    });
}

#[test]
fn a_preview_that_is_no_longer_wanted_is_not_computed() {
    within(30, || {
        let preview = |seed_of| {
            let document = seed(&rough(), seed_of);
            let scene = Arc::new(document.scene().clone());
            (Arc::clone(&scene), Request::Preview { text: document.text().to_owned(), scene })
        };
        let serve = |awaited: &Newest, requests: Vec<Request>| {
            let reports = RefCell::new(Vec::new());
            let mut desk = worker::WorkerState::new(Box::new(Simulation::default()));
            desk.serve(requests.into_iter(), awaited, &|report| {
                reports.borrow_mut().push(report);
                true
            });
            reports.into_inner()
        };
        let ((first, one), (second, other)) = (preview(1), preview(2));
        let awaited = Newest::default();
        awaited.set_preview(Some(second));
        assert!(serve(&awaited, vec![one.clone()]).is_empty(), "a newer one is waited for");
        let reports = serve(&awaited, vec![one.clone(), other.clone()]);
        let Request::Preview { text, .. } = &other else { panic!("{other:?}") };
        assert!(matches!(&reports[..], [Report::Previewed(preview)] if preview.text == *text), "{reports:?}");
        awaited.set_preview(None);
        assert!(serve(&awaited, vec![other]).is_empty(), "none is waited for");
        // A newer scene makes the request stale.
        let (requests, _outbox) = channel();
        awaited.set_preview(Some(Arc::clone(&first)));
        Worker::new(requests, Arc::clone(&awaited)).ask(compute(1, &rough()));
        assert!(!awaited.is_preview(&first));
    });
}

#[test]
fn a_newer_scene_stops_the_one_that_is_being_computed() {
    within(30, || {
        let (started, wait) = channel();
        let (go_on, words) = channel();
        let served = Served::by(Double::new(move |scene, stop| {
            if scene.title != "endless" {
                return None;
            }
            started.send(()).unwrap();
            Some(stop_when_asked(&words, stop))
        }));
        served.compute(1, &rough().set("title", "\"endless\"").unwrap());
        wait.recv_timeout(PATIENCE).expect("the first scene is begun");
        served.compute(2, &rough());
        go_on.send(()).unwrap();
        let reports: Vec<_> = std::iter::from_fn(|| Some(served.report()))
            .take_while(|report| !matches!(report, Report::Computed(_)))
            .collect();
        assert!(reports.iter().all(|report| matches!(report, Report::Progress { generation: 2, .. })));
        served.worker.ask(Request::Show(SnapshotRequest { generation: 2, ..snapshot(0, 0.0) }));
        assert!(matches!(served.report(), Report::Shown(snapshot) if snapshot.generation == 2));
    });
}

#[test]
fn a_scene_beside_is_computed_only_in_sight_and_gives_way_to_a_newer_scene() {
    within(60, || {
        let served = Served::by(Simulation::default());
        served.computed(1, &rough());
        // Ten million relaxations of a million springs take hours.
        let endless = [
            ("numerics.points", "1048576"),
            ("numerics.solver", "Stepwise(step: 1.0e-15)"),
            ("loading", "[ToIndentation(1.0e-8)]"),
        ];
        let endless = Arc::new(changed(&rough(), &endless).scene().clone());
        served.worker.ask(Request::Beside(Some(Arc::clone(&endless))));
        assert!(served.shown(snapshot(0, 0.0)).beside.is_none(), "out of sight it takes no time");
        let in_sight =
            |generation| SnapshotRequest { generation, beside: Some((0, 0.0)), ..snapshot(0, 0.0) };
        served.worker.ask(Request::Show(in_sight(1)));
        served.computed(2, &rough());
        let small = Arc::new(smooth().scene().clone());
        served.worker.ask(Request::Beside(Some(small)));
        let shown = served.shown(in_sight(2));
        assert_eq!(shown.beside.as_ref().map(|beside| beside.line.seed), Some(None), "the smooth sphere");
    });
}

/// A run that waits for a message, and then stops if asked to.
fn stop_when_asked(words: &Receiver<()>, stop: &dyn Fn() -> bool) -> RunError {
    words.recv_timeout(PATIENCE).expect("a word to go on");
    assert!(stop(), "the run is asked to stop");
    ContactError::Interrupted.into()
}

#[test]
fn the_worker_ends_with_the_explorer() {
    within(30, || {
        let served = Served::by(Simulation::default());
        served.computed(1, &rough());
        drop(served.worker);
        assert_eq!(served.reports.recv_timeout(PATIENCE).unwrap_err(), RecvTimeoutError::Disconnected);
        // Without a receiver no second report is sent.
        let (sender, receiver) = channel();
        sender.send(compute(1, &rough())).unwrap();
        let generation = Newest::default();
        generation.set_generation(1);
        let calls = RefCell::new(0);
        worker::serve(Box::new(Simulation::default()), &generation, &receiver, &|_| {
            *calls.borrow_mut() += 1;
            false
        });
        assert_eq!(calls.into_inner(), 1);
        assert!(sender.send(compute(2, &rough())).is_ok(), "the queue itself is still there");
    });
}

#[test]
fn a_panic_is_stated_and_the_next_scene_is_computed() {
    within(30, || {
        let served = Served::by(Double::new(|scene, _| match scene.title.as_str() {
            "text" => panic!("no such spring"),
            "formatted" => panic!("no spring {}", scene.numerics.points),
            _ => None,
        }));
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
            served.shown(SnapshotRequest { generation, ..snapshot(1, 0.0) });
        }
    });
}

#[test]
fn a_leg_that_cannot_be_gone_is_stated_in_one_line() {
    within(30, || {
        let served = Served::by(Simulation::default());
        let beyond = rough().set("loading", "[ToForce(1.0e-5), ToForce(-1.0)]").unwrap();
        served.compute(1, &beyond);
        let Report::Failed { generation: 1, error } = served.answer() else { panic!("not failed") };
        assert!(error.starts_with("loading.1 = ToForce(-1.0): the contact detaches above"), "{error}");
        assert_eq!(error.lines().count(), 1, "{error}");
        let alone = Simulation::default().run(beyond.scene(), &|| false, &mut |_, _, _| Ok(()));
        assert_eq!(error, alone.unwrap_err().to_string());
        // Nothing of the failed scene can be shown, and the next one is computed.
        served.worker.ask(Request::Show(snapshot(0, 0.0)));
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
            let served = Served::by(Simulation::default());
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
            let served = Served::by(Simulation::default());
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
        let served = Served::by(Simulation::default());
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
            let served = Served::by(Simulation::default());
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
        let served = Served::by(Simulation::default());
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
        let served = Served::by(Simulation::default());
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
        let served = Served::by(Simulation::default());
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
        let served = Served::by(Simulation::default());
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
        let served = Served::by(Simulation::default());
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
        let served = Served::by(Simulation::default());
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
        let served = Served::by(Simulation::default());
        for observe in ["[]", "[Fragments]", "[HeightHistogram]", "[Fragments, HeightHistogram]"] {
            let document = rough().set("observe", observe).unwrap();
            let computed = served.computed(1, &document);
            let histogram = computed.outcome.histogram.as_ref().expect("the heights are observed");
            assert_eq!(histogram.counts.iter().sum::<u64>(), 1024);
            let observed = document.scene().observe.contains(&Observer::Fragments);
            assert_eq!(computed.outcome.fragments.len(), if observed { 2 } else { 0 });
        }
    });
}
