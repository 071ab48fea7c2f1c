//! Any events in any order, in windows of any size: the explorer does not panic, it draws, and its
//! scene remains computable.

use super::common::driver::{Driver, REFUSED};
use super::common::effort::cases;
use super::common::scenes::{
    changed, one_spring, punch, relaxing, rough, smooth, without_adhesion,
};
use super::common::study::{PLAN, merged};
use asperity::explorer::action::{Action, Gesture, Mouse, Task};
use asperity::explorer::keys::bindings::KeyCommand;
use asperity::explorer::opening::Opening;
use asperity::explorer::parameters::Rows;
use asperity::explorer::snapshot::Reply;
use asperity::explorer::update::{request, update};
use asperity::explorer::view;
use asperity::scene::{Document, Scene, Solver};
use asperity::study::Quantity;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Sequences of events in a quick run. Random bytes of a terminal are in a test of their own.
const CASES: u32 = 75;
const LONGEST: usize = 60;

/// Scenes with more springs or samples are not computed, but reported as failed.
const MOST: u64 = 2048;

/// An event.
#[derive(Clone, Debug)]
enum Event {
    /// A key that is valid in the present mode, pressed several times.
    Keys(usize, usize),
    Type(char),
    Paste(String),
    /// A value typed for the selected parameter.
    Enter(String),
    /// The scene saved under a name.
    Save(String),
    /// The folder of the study, or another path, opened.
    Open(bool),
    Resize(u16, u16),
    /// The window has shrunk, unknown to the explorer.
    Shrunk(u16, u16),
    Mouse(Mouse),
    Elapse(f64),
    /// An answer to the oldest waiting request.
    Answer,
    /// An earlier report, repeated.
    Stale(usize),
}

fn size() -> impl Strategy<Value = (u16, u16)> {
    prop_oneof![
        4 => (0..=4_u16, 0..=4_u16),
        8 => (0..=80_u16, 0..=26_u16),
        4 => (60..=130_u16, 12..=42_u16),
        1 => (0..=4_u16, 0..=400_u16),
        1 => (0..=400_u16, 0..=4_u16),
    ]
}

fn mouse() -> impl Strategy<Value = Mouse> {
    let gesture = prop_oneof![
        Just(Gesture::Press),
        Just(Gesture::Drag),
        prop_oneof![-3..3_i32, Just(i32::MIN + 1)].prop_map(Gesture::Wheel),
    ];
    let place = || prop_oneof![8 => 0..130_u16, 1 => Just(u16::MAX)];
    (place(), place(), gesture).prop_map(|(column, row, gesture)| Mouse {
        column,
        row,
        gesture,
    })
}

fn value() -> impl Strategy<Value = String> {
    const VALUES: &str = "0;1;-1;2;64;1e-7;1e400;NaN;inf;50m;2.5 MPa;10 µm;None;();;(work: 0.05);(kappa: 3.0);\
        Punch(radius: 1.0e-5);Cone(angle: 0.1);Stepwise(step: 1.0e-9);(modulus: 2.0e6);\
        (modulus: 2.0e6, relaxation: (share: 0.9, time: 0.1));[ToForce(1.0e-5), Hold(1.0), ToSeparation];(1, 8);(9, 2);[];[ToTouch];\
        [ToForce(1.0e-5), ToForce(-1.0)];[ToIndentation(-1.0e-7)];10 µN, 0 N, separation;\
        [ToTouch, ToForce(1.0e-5), ToZeroForce, ToSeparation, ToTouch];Measured(file: \"nowhere.csv\");[;\";1 /*;𝟙;\
        18446744073709551616";
    let values: Vec<&str> = VALUES.split(';').collect();
    prop_oneof![4 => prop::sample::select(values).prop_map(str::to_owned), 1 => ".{0,12}"]
}

fn event() -> impl Strategy<Value = Event> {
    let names = prop_oneof![
        Just("a.ron".to_owned()),
        Just(REFUSED.to_owned()),
        Just("b/c.ron".to_owned())
    ];
    prop_oneof![
        15 => any::<usize>().prop_map(|key| Event::Keys(key, 1)),
        3 => (any::<usize>(), 2..8_usize).prop_map(|(key, times)| Event::Keys(key, times)),
        2 => any::<char>().prop_map(Event::Type),
        1 => ".{0,80}".prop_map(Event::Paste),
        4 => value().prop_map(Event::Enter),
        1 => names.prop_map(Event::Save),
        1 => prop::bool::weighted(0.8).prop_map(Event::Open),
        3 => size().prop_map(|(columns, rows)| Event::Resize(columns, rows)),
        2 => size().prop_map(|(columns, rows)| Event::Shrunk(columns, rows)),
        2 => mouse().prop_map(Event::Mouse),
        4 => (0.0..9.0).prop_map(Event::Elapse),
        12 => Just(Event::Answer),
        1 => any::<usize>().prop_map(Event::Stale),
    ]
}

/// Small scenes of each kind, one that cannot be computed, and a study.
pub fn scenes(study: &Path) -> Vec<Opening> {
    let few = [("numerics.points", "64"), ("numerics.samples", "16")];
    let small = changed(&rough(), &[("roughness.modes", "(2, 16)"), few[0], few[1]]);
    let beyond = small
        .set("loading", "[ToForce(1.0e-5), ToForce(-1.0)]")
        .unwrap();
    let mut scenes: Vec<Opening> = [
        small.clone(),
        small
            .set(
                "loading",
                "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToSeparation]",
            )
            .unwrap(),
        changed(&smooth(), &few),
        changed(&punch(), &few),
        changed(
            &relaxing(),
            &[("roughness.modes", "(2, 16)"), few[0], few[1]],
        ),
        changed(
            &relaxing(),
            &[
                ("roughness", "None"),
                ("form", "Paraboloid(radius: 1.0e-4)"),
                ("adhesion", "(work: 0.05)"),
                ("loading_stiffness", "20.0"),
                few[0],
                few[1],
            ],
        ),
        changed(
            &without_adhesion(),
            &[("roughness.modes", "(2, 16)"), few[0], few[1]],
        ),
        one_spring(),
        beyond,
    ]
    .map(Opening::from)
    .to_vec();
    scenes.push(Opening::of(study.to_str().unwrap()).unwrap());
    scenes
}

/// An explorer whose worker answers only on demand.
pub struct Explorer {
    pub driver: Driver,
    pub waiting: VecDeque<Task>,
    /// All reports so far.
    reports: Vec<Action>,
    /// The last judged generation.
    judged: u64,
    /// Folder of the study.
    study: PathBuf,
}

impl Explorer {
    pub fn new(opening: Opening, study: &Path) -> Self {
        let (driver, waiting) = (Driver::open(opening), VecDeque::from([Task::Ask]));
        Explorer {
            driver,
            waiting,
            reports: Vec::new(),
            judged: 0,
            study: study.to_owned(),
        }
    }

    pub fn act(&mut self, action: Action) {
        for effect in update(&mut self.driver.app, action) {
            match effect {
                // Of all waiting states, only the newest is computed.
                Task::Ask => {
                    self.waiting.retain(|one| *one != Task::Ask);
                    self.waiting.push_back(Task::Ask);
                }
                other => self.waiting.push_back(other),
            }
        }
        self.judge();
    }

    fn happen(&mut self, event: &Event) {
        match event {
            Event::Keys(key, times) => self.press(*key, *times),
            Event::Type(character) => self.act(Action::Paste(character.to_string())),
            Event::Paste(text) => self.act(Action::Paste(text.clone())),
            Event::Enter(value) => {
                self.command("edit-value");
                self.command("clear");
                self.act(Action::Paste(value.clone()));
                self.command("accept");
            }
            Event::Save(name) => {
                self.command("save");
                self.command("clear");
                self.act(Action::Paste(name.clone()));
                self.command("accept");
            }
            Event::Open(sound) => {
                self.command("open-library");
                let folder = if *sound {
                    self.study.clone()
                } else {
                    self.study.join("shards")
                };
                self.act(Action::Paste(folder.to_str().unwrap().to_owned()));
                self.command("accept");
            }
            Event::Resize(columns, rows) => self.act(Action::Resize(*columns, *rows)),
            Event::Shrunk(columns, rows) => self.draw((*columns, *rows)),
            Event::Mouse(mouse) => self.act(Action::Mouse(*mouse)),
            Event::Elapse(seconds) => self.act(Action::Elapse(Duration::from_secs_f64(*seconds))),
            Event::Answer => self.answer(),
            Event::Stale(which) => {
                if !self.reports.is_empty() {
                    self.act(self.reports[which % self.reports.len()].clone());
                }
            }
        }
    }

    /// Presses a key that is valid in the present mode, by its number among them.
    fn press(&mut self, number: usize, times: usize) {
        let bindings = self.driver.app.config.bindings.clone();
        let keys: Vec<_> = bindings
            .valid_in(self.driver.app.keys())
            .flat_map(|binding| binding.keys.iter().map(|key| (binding.row, key.event())))
            .collect();
        let (row, key) = keys[number % keys.len()];
        for _ in 0..times {
            self.act(Action::Command(KeyCommand {
                row,
                key: Some(key),
            }));
        }
    }

    /// Runs a command, where it is valid in the present mode.
    fn command(&mut self, name: &str) {
        let app = &self.driver.app;
        if let Some(command) = app.config.bindings.named(name, app.keys()) {
            self.act(Action::Command(command));
        }
    }

    pub fn answer(&mut self) {
        let Some(effect) = self.waiting.pop_front() else {
            return;
        };
        let is_cheap = |document: &Document| {
            let scene = document.scene();
            let numerics = scene.numerics;
            let is_small =
                numerics.points <= MOST && numerics.samples <= MOST && scene.loading.len() <= 16;
            is_small && numerics.solver == Solver::Exact
        };
        let actions = match &effect {
            Task::Ask if !is_cheap(&self.driver.app.edit.document) => {
                let generation = request(&mut self.driver.app).generation;
                vec![Action::Reply(Reply::Failed {
                    generation,
                    error: "too large for a test\nin two lines".to_owned(),
                })]
            }
            _ => self.driver.answer(effect),
        };
        self.reports.extend(actions.iter().cloned());
        actions.into_iter().for_each(|action| self.act(action));
    }

    /// Draws into a window of this size.
    fn draw(&self, (columns, rows): (u16, u16)) {
        let mut terminal = Terminal::new(TestBackend::new(columns, rows)).unwrap();
        terminal
            .draw(|frame| view::draw(frame, &self.driver.app))
            .unwrap();
    }

    /// Checks conditions that always hold.
    fn judge(&mut self) {
        let app = &self.driver.app;
        assert!(app.edit.generation >= self.judged, "generations only grow");
        if app.edit.generation > self.judged {
            self.judged = app.edit.generation;
            let document = &app.edit.document;
            assert_eq!(
                Scene::clone(document.scene()).checked().as_ref(),
                Ok(document.scene())
            );
            let again =
                Document::parse(document.text(), document.name()).expect("the text is a scene");
            assert_eq!(again.scene(), document.scene());
            assert_eq!(
                app.edit.parameters,
                Rows::of(
                    document,
                    app.edit.measured.as_ref(),
                    app.edit.profiles,
                    &app.edit.revealed
                )
                .listed
            );
            assert!(!app.is_refused(), "a changed scene is not refused");
        }
        assert!(app.edit.parameter().is_some());
        assert!(
            (0.0..=1.0).contains(&app.play.share(app.stages())),
            "{:?}",
            app.play
        );
        assert!(app.indentation().is_finite());
        if let Some(study) = app.map.shown_study() {
            assert!(study.slice < study.study_map.slices());
        }
        if let Some(grid) = app.grid() {
            let mapped = app.mapped();
            let any = grid.quantities();
            assert!(
                any.contains(&mapped) || any.is_empty() && mapped == Quantity::Regime,
                "{mapped:?}"
            );
        }
        if app
            .solved
            .as_ref()
            .is_some_and(|computed| computed.generation == app.edit.generation)
        {
            assert!(app.play.stage < app.stages().len(), "{:?}", app.play);
            assert!(!app.is_computing());
        }
        if let Some(prompt) = &app.prompt {
            assert!(!prompt.line.text().contains(char::is_control));
        }
        self.draw(self.driver.app.view.size);
    }

    /// Lets the worker catch up: the explorer then shows the outcome of the scene, or an error.
    pub fn settle(&mut self) {
        while !self.waiting.is_empty() {
            self.answer();
        }
        let app = &self.driver.app;
        assert!(!app.is_computing());
        let current = |generation: u64| generation == app.edit.generation;
        if app
            .solved
            .as_ref()
            .is_some_and(|computed| current(computed.generation))
        {
            assert!(
                app.snapshot
                    .as_ref()
                    .is_some_and(|snapshot| current(snapshot.generation))
            );
        } else {
            assert!(app.message.is_some() || app.prompt.is_some());
        }
    }
}

#[test]
fn whatever_happens_it_draws_and_its_scene_is_sound() {
    let folder = tempfile::tempdir().unwrap();
    // Few values: the edges of the map are near.
    let plan = PLAN
        .replace("count: 9", "count: 2")
        .replace("count: 13", "count: 3")
        .replace("profiles: 12", "profiles: 2");
    merged(folder.path(), &plan);
    let scenes = scenes(folder.path());
    let drawn = (
        0..scenes.len(),
        size(),
        prop::collection::vec(event(), 1..=LONGEST),
    );
    let mut runner = TestRunner::new(Config {
        failure_persistence: None,
        max_shrink_time: 20_000,
        ..Config::with_cases(cases(CASES))
    });
    let outcome = runner.run(&drawn, |(scene, (columns, rows), events)| {
        let mut explorer = Explorer::new(scenes[scene].clone(), folder.path());
        explorer.act(Action::Resize(columns, rows));
        for event in &events {
            explorer.happen(event);
        }
        explorer.settle();
        Ok(())
    });
    if let Err(failure) = outcome {
        panic!("{failure}");
    }
}
