//! Random paths of manual loading under random edits: the path is always that of a fresh run of the
//! same moves, bit for bit, and no move or edit is lost.

use super::common::driver::Driver;
use super::common::effort::cases;
use super::common::scenes::{changed, one_spring, punch, rough, smooth, without_adhesion};
use asperity::contact::Move;
use asperity::explorer::action::Action;
use asperity::explorer::commands::manual;
use asperity::explorer::pane::Pane;
use asperity::scene::{Document, Simulation, Solver};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

/// Paths in a quick run; the slow tests try 1 000.
const PATHS: u32 = 250;
/// Orders of moves, edits, undo and redo.
const ORDERS: u32 = 200;

/// An act of the user.
#[derive(Clone, Copy, Debug)]
enum Act {
    Push(&'static str),
    /// A target typed.
    Go(&'static str),
    Separate,
    /// A drag to this share of the range of indentations.
    Drag(f64),
    Edit(&'static str, &'static str),
    Undo,
    Redo,
    Begin,
    Drop,
    Play,
}

fn step() -> impl Strategy<Value = Act> {
    let push = prop::sample::select(vec!["Left", "Right", "Shift+Left", "Shift+Right"]);
    let go = prop::sample::select(vec![
        "5 µN",
        "20 µN",
        "-1 µN",
        "-50 nN",
        "0 N",
        "60 nm",
        "-20 nm",
        "touch",
        "zero force",
        "separation",
        "displacement 80 nm",
        "1 mN",
    ]);
    prop_oneof![
        6 => push.prop_map(Act::Push),
        4 => go.prop_map(Act::Go),
        1 => Just(Act::Separate),
        2 => (-0.2..1.3_f64).prop_map(Act::Drag),
    ]
}

fn edit() -> impl Strategy<Value = Act> {
    let edits = vec![
        ("material.youngs_modulus", "1.0e6"),
        ("material.youngs_modulus", "4.0e6"),
        ("roughness.hurst", "0.5"),
        ("roughness.hurst", "0.9"),
        ("roughness.seed", "3"),
        ("roughness.seed", "12"),
        ("roughness.rms_height", "1.0e-7"),
        ("roughness.rms_height", "4.0e-7"),
        ("adhesion.kappa", "2.0"),
        ("adhesion.kappa", "30.0"),
        ("adhesion", "None"),
        ("adhesion", "(work: 0.02)"),
        ("loading", "[ToForce(5.0e-6), ToSeparation]"),
        ("loading", "[ToForce(4.0e-5)]"),
        (
            "loading",
            "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToSeparation]",
        ),
        ("numerics.points", "128"),
        ("numerics.edges", "Grid"),
        ("numerics.edges", "SubCell"),
        ("loading_stiffness", "20.0"),
        ("loading_stiffness", "0.5"),
        ("loading_stiffness", "None"),
        ("length", "5.0e-5"),
    ];
    prop::sample::select(edits).prop_map(|(path, value)| Act::Edit(path, value))
}

fn any_act() -> impl Strategy<Value = Act> {
    prop_oneof![
        8 => step(),
        3 => edit(),
        4 => Just(Act::Undo),
        2 => Just(Act::Redo),
        1 => Just(Act::Begin),
        1 => Just(Act::Drop),
        1 => Just(Act::Play),
    ]
}

/// Small scenes of each kind.
fn scenes() -> Vec<Document> {
    let few = [("numerics.points", "64"), ("numerics.samples", "16")];
    let waves = ("roughness.modes", "(2, 16)");
    let small = changed(&rough(), &[waves, few[0], few[1]]);
    let steps = "Stepwise(step: 2.0e-9)";
    vec![
        small.clone(),
        small.set("numerics.edges", "SubCell").unwrap(),
        small.set("loading_stiffness", "5.0").unwrap(),
        small
            .set(
                "loading",
                "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToSeparation]",
            )
            .unwrap(),
        changed(
            &small,
            &[("numerics.edges", "Grid"), ("numerics.solver", steps)],
        ),
        changed(&smooth(), &few),
        changed(&punch(), &few),
        changed(&without_adhesion(), &[waves, few[0], few[1]]),
        one_spring(),
    ]
}

/// An explorer whose animation is paused at a share of the loading.
fn paused(document: &Document, share: f64) -> Driver {
    let mut driver = Driver::start(document.clone());
    driver.press("Space");
    let stages = driver.app.stages().len();
    let stage = ((share * stages as f64) as usize).min(stages - 1);
    for _ in 0..stage {
        driver.press(">");
    }
    driver.press("Space");
    driver.elapse(6.0 * (share * stages as f64 - stage as f64));
    if driver.app.is_playing() {
        driver.press("Space");
    }
    driver
}

fn perform(driver: &mut Driver, act: Act) {
    if driver.app.prompt.is_some() {
        driver.press("Esc");
    }
    driver.app.view.pane = Pane::Force;
    match act {
        Act::Push(key) if driver.app.edit.path.is_some() => drop(driver.press(key)),
        Act::Push(_) | Act::Begin => {
            if driver.app.edit.path.is_none() {
                driver.press("d");
            }
        }
        Act::Go(target) => {
            if driver.app.edit.path.is_none() {
                driver.press("d");
            }
            driver.press(&format!("Enter `{target}` Enter"));
        }
        Act::Separate => drop(driver.press("S")),
        Act::Drag(share) => {
            let (low, high) = driver.app.indentations().unwrap_or_default();
            manual::move_to_indentation(&mut driver.app, low + share * (high - low));
            driver.act(Action::Resize(120, 40));
        }
        Act::Edit(path, value) => {
            let changed = driver.document().set(path, value);
            asperity::explorer::commands::edit::apply(&mut driver.app, changed);
            driver.act(Action::Resize(120, 40));
        }
        Act::Undo => drop(driver.press("u")),
        Act::Redo => drop(driver.press("U")),
        Act::Drop if driver.app.edit.path.is_some() => drop(driver.press("Esc")),
        Act::Drop => {}
        Act::Play => {
            driver.press("Space");
            driver.elapse(2.5);
            if driver.app.is_playing() {
                driver.press("Space");
            }
        }
    }
}

/// Checks that the path is that of a fresh run of the same moves, bit for bit.
fn judge(driver: &Driver) {
    let app = &driver.app;
    if !app.is_current() || app.edit.path.is_none() {
        return;
    }
    let followed = app.followed().expect("the path is computed with the scene");
    let scene = app.edit.document.scene();
    let exact = |loading: Vec<Move>| {
        let scene = scene.with(|scene| {
            scene.numerics.solver = Solver::Exact;
            scene.loading = loading;
        });
        scene.map(|scene| Simulation::default().compute(&scene))
    };
    let loading = followed.loading();
    if !loading.is_empty()
        && let Ok(run) = exact(loading.clone())
    {
        let history = run.expect("the path can be run").history;
        assert_eq!(history.stages, followed.stages, "{loading:?}");
        let end = history.stages.last().unwrap().curve.last().unwrap();
        if app.play_of_path.is_none() {
            assert_eq!(app.present().expect("the end is shown").point, *end);
        }
    }
    let path = app.edit.path.as_ref().unwrap();
    let moves: Vec<Move> = followed.moves().iter().map(|stage| stage.target).collect();
    assert_eq!(moves, path.moves[..followed.count()]);
    // The next move is refused by a fresh run, too.
    match (&followed.stopped, path.moves.get(followed.count())) {
        (None, None) => {}
        (Some(why), Some(next)) if followed.stages.len() >= followed.before => {
            let mut loading = loading;
            loading.push(*next);
            let refused = exact(loading).map_or(true, |run| run.is_err());
            assert!(refused, "{why}");
        }
        (stopped, next) => assert!(stopped.is_some(), "{stopped:?} {next:?}"),
    }
}

fn run<S: Strategy>(count: u32, strategy: &S, test: impl Fn(S::Value)) {
    let mut runner = TestRunner::new(Config {
        failure_persistence: None,
        max_shrink_time: 20_000,
        ..Config::with_cases(cases(count))
    });
    let outcome = runner.run(strategy, |value| {
        test(value);
        Ok(())
    });
    if let Err(failure) = outcome {
        panic!("{failure}");
    }
}

#[test]
fn a_path_under_edits_is_a_fresh_run_of_its_moves() {
    let scenes = scenes();
    let acts = (
        0..scenes.len(),
        0.0..1.0_f64,
        prop::collection::vec(step(), 1..8),
        prop::collection::vec(edit(), 1..5),
        prop::collection::vec(step(), 0..3),
    );
    run(PATHS, &acts, |(scene, share, moves, edits, more)| {
        let mut driver = paused(&scenes[scene], share);
        driver.press("d");
        for act in moves {
            perform(&mut driver, act);
            judge(&driver);
        }
        let path = driver.app.edit.path.clone();
        for act in edits {
            perform(&mut driver, act);
            assert_eq!(driver.app.edit.path, path, "an edit changes no move");
            judge(&driver);
        }
        for act in more {
            perform(&mut driver, act);
            judge(&driver);
        }
    });
}

/// The scene and the path.
fn state(driver: &Driver) -> (String, String) {
    let edit = &driver.app.edit;
    (edit.document.text().to_owned(), format!("{:?}", edit.path))
}

#[test]
fn no_move_and_no_edit_is_lost() {
    let scenes = scenes();
    let acts = (
        0..scenes.len(),
        0.0..1.0_f64,
        prop::collection::vec(any_act(), 1..16),
    );
    run(ORDERS, &acts, |(scene, share, acts)| {
        let mut driver = paused(&scenes[scene], share);
        let first = state(&driver);
        for act in acts {
            perform(&mut driver, act);
            judge(&driver);
        }
        if driver.app.prompt.is_some() {
            driver.press("Esc");
        }
        driver.text();
        // Everything can be undone, and then done again.
        let last = state(&driver);
        let shown = driver
            .app
            .followed()
            .map(|followed| followed.stages.clone());
        let entries = driver.app.edit.past.len();
        let mut states = vec![last.clone()];
        for _ in 0..entries {
            driver.press("u");
            judge(&driver);
            let state = state(&driver);
            assert_ne!(Some(&state), states.last(), "an undo changes something");
            states.push(state);
        }
        assert_eq!(states.pop(), Some(first));
        while let Some(expected) = states.pop() {
            driver.press("U");
            assert_eq!(state(&driver), expected);
        }
        assert_eq!(
            driver
                .app
                .followed()
                .map(|followed| followed.stages.clone()),
            shown
        );
    });
}
