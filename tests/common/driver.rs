//! An explorer without a terminal: keys in, a screen out. Its worker is the real one, and every
//! request is answered before the next key counts, so that a script gives the same screens always.

use asperity::explorer::action::{Action, SaveError};
use asperity::explorer::keys;
use asperity::explorer::model::Model;
use asperity::explorer::snapshot::Loop;
use asperity::explorer::theme::Theme;
use asperity::explorer::update::{Effect, moment_request, update};
use asperity::explorer::view;
use asperity::explorer::worker::{self, Engine, Newest, Report, Request, Worker};
use asperity::scene::Document;
use asperity::simulation::{Simulation, Timings};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// Longest time a request may take.
const PATIENCE: Duration = Duration::from_secs(20);

/// An explorer without a terminal.
pub struct Driver {
    pub model: Model,
    /// What has been saved, by name.
    pub files: BTreeMap<PathBuf, String>,
    /// The seed that is drawn next.
    pub seed: u64,
    /// The effects of the last action, before they were done.
    pub effects: Vec<Effect>,
    worker: Worker,
    reports: Receiver<Report>,
}

impl Driver {
    /// The explorer as it opens, before anything is computed.
    pub fn open(document: Document) -> Self {
        Driver::open_with(document, Box::new(Simulation::default()))
    }

    /// The same with another engine.
    pub fn open_with(document: Document, engine: Box<dyn Engine>) -> Self {
        let (requests, outbox) = channel();
        let (report, reports) = channel();
        let newest = Newest::default();
        worker::start(engine, Arc::clone(&newest), outbox, move |one| report.send(one).is_ok()).unwrap();
        Driver {
            model: Model::new(document, (120, 40), Theme::Colours),
            files: BTreeMap::new(),
            seed: 4711,
            effects: Vec::new(),
            worker: Worker::new(requests, newest),
            reports,
        }
    }

    /// The explorer with its scene computed and the first moment shown.
    pub fn start(document: Document) -> Self {
        let mut driver = Driver::open(document);
        driver.perform(vec![Effect::Compute]);
        driver
    }

    /// Lets something happen, and all that follows from it.
    pub fn act(&mut self, action: Action) {
        let effects = update(&mut self.model, action);
        self.effects.clone_from(&effects);
        let of_this = self.effects.clone();
        self.perform(effects);
        self.effects = of_this;
    }

    /// Does what an action asks for.
    pub fn perform(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            match effect {
                Effect::Compute => {
                    let generation = self.model.generation;
                    let scene = Box::new(self.model.document.scene().clone());
                    self.worker.ask(Request::Compute { generation, scene });
                    self.answer(|report| matches!(report, Report::Computed(_) | Report::Failed { .. }));
                }
                Effect::Show => {
                    if let Some(request) = moment_request(&self.model) {
                        self.worker.ask(Request::Show(request));
                        self.answer(|report| matches!(report, Report::Shown(_) | Report::Failed { .. }));
                    }
                }
                Effect::DrawSeed => self.act(Action::SetSeed(self.seed)),
                Effect::Save { path, overwrite } => {
                    let result = if self.files.contains_key(&path) && !overwrite {
                        Err(SaveError::Exists(path))
                    } else {
                        self.files.insert(path.clone(), self.model.document.text().to_owned());
                        Ok(path)
                    };
                    self.act(Action::Saved(result));
                }
            }
        }
    }

    /// Takes reports up to the one that answers.
    fn answer(&mut self, answers: impl Fn(&Report) -> bool) {
        loop {
            let report = self.reports.recv_timeout(PATIENCE).expect("the worker answers");
            let last = answers(&report);
            self.act(action_of(report));
            if last {
                return;
            }
        }
    }

    /// Presses keys, their names separated by blanks: `j`, `Ctrl+c`, `Enter`, `Shift+Left`.
    pub fn press(&mut self, names: &str) {
        for name in names.split_whitespace() {
            let event = key_event(name);
            match (keys::command(&event, self.model.mode.kind()), event.code) {
                (Some(command), _) => self.act(Action::Command(command)),
                (None, KeyCode::Char(character)) => self.act(Action::Type(character)),
                (None, _) => {}
            }
        }
    }

    /// Types a text, character by character.
    pub fn type_text(&mut self, text: &str) {
        text.chars().for_each(|character| self.act(Action::Type(character)));
    }

    /// Types a value for the selected parameter in place of the one it has.
    pub fn enter(&mut self, value: &str) {
        self.press("e Ctrl+u");
        self.type_text(value);
        self.press("Enter");
    }

    /// Selects the parameter of a field, by keys.
    pub fn select(&mut self, path: &str) {
        self.press("g");
        for _ in 0..self.model.parameters.len() {
            if self.model.parameter().is_some_and(|parameter| parameter.field.path == path) {
                return;
            }
            self.press("j");
        }
        panic!("no parameter {path}: {:?}", self.model.parameters);
    }

    /// Lets time go by.
    pub fn elapse(&mut self, seconds: f64) {
        self.act(Action::Elapse(Duration::from_secs_f64(seconds)));
    }

    pub fn resize(&mut self, (columns, rows): (u16, u16)) {
        self.act(Action::Resize(columns, rows));
    }

    /// What is on the screen.
    pub fn screen(&self) -> Buffer {
        draw(&self.model)
    }

    /// The rows of the screen.
    pub fn rows(&self) -> Vec<String> {
        rows(&self.screen())
    }

    /// The screen as one text.
    pub fn text(&self) -> String {
        self.rows().join("\n")
    }
}

/// Draws a model.
pub fn draw(model: &Model) -> Buffer {
    let (columns, rows) = model.size;
    let mut terminal = Terminal::new(TestBackend::new(columns, rows)).unwrap();
    terminal.draw(|frame| view::draw(frame, model)).unwrap();
    terminal.backend().buffer().clone()
}

/// The rows of a screen, without the blanks at their ends.
pub fn rows(screen: &Buffer) -> Vec<String> {
    let width = usize::from(screen.area.width).max(1);
    let row = |cells: &[ratatui::buffer::Cell]| {
        let text: String = cells.iter().map(ratatui::buffer::Cell::symbol).collect();
        text.trim_end().to_owned()
    };
    screen.content.chunks(width).map(row).collect()
}

/// What a report does. Times are taken out of it: they differ from run to run.
pub fn action_of(report: Report) -> Action {
    match report {
        Report::Computed(computed) => {
            let mut outcome = computed.outcome.clone();
            outcome.timings = Timings::default();
            Action::Computed(Arc::new(Loop { generation: computed.generation, outcome }))
        }
        Report::Shown(moment) => Action::Shown(moment),
        Report::Progress { generation, legs } => Action::Progress { generation, legs },
        Report::Failed { generation, error } => Action::Failed { generation, error },
    }
}

/// The event of a key by its name.
fn key_event(name: &str) -> KeyEvent {
    let (modifiers, name) = match name.split_once('+') {
        Some(("Ctrl", rest)) => (KeyModifiers::CONTROL, rest),
        Some(("Shift", rest)) => (KeyModifiers::SHIFT, rest),
        _ => (KeyModifiers::NONE, name),
    };
    let code = match name {
        "Space" => KeyCode::Char(' '),
        "Enter" => KeyCode::Enter,
        "Esc" => KeyCode::Esc,
        "Tab" => KeyCode::Tab,
        "Left" => KeyCode::Left,
        "Right" => KeyCode::Right,
        "Up" => KeyCode::Up,
        "Down" => KeyCode::Down,
        "Home" => KeyCode::Home,
        "End" => KeyCode::End,
        "Backspace" => KeyCode::Backspace,
        "Delete" => KeyCode::Delete,
        _ => match (name.chars().next(), name.chars().nth(1)) {
            (Some(character), None) => KeyCode::Char(character),
            _ => panic!("no key is called {name}"),
        },
    };
    KeyEvent::new(code, modifiers)
}
