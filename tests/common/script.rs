//! Scripts for an explorer without a terminal: keys in, a screen out. Every request is answered
//! before the next key, so a script always shows the same screens.

use super::driver::Driver;
use asperity::contact::CurvePoint;
use asperity::explorer::action::{Action, Gesture, Mouse, Task};
use asperity::explorer::app::App;
use asperity::explorer::keys::key::Key;
use asperity::explorer::layout::{Layout, inside};
use asperity::explorer::opening::Opening;
use asperity::explorer::pane::Pane;
use asperity::explorer::snapshot::ContactSnapshot;
use asperity::explorer::update::update;
use asperity::explorer::view;
use asperity::scene::Document;
use asperity::scene::Outcome;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use std::time::Duration;

impl Driver {
    /// The explorer with its scene computed and the first state shown.
    pub fn start(opening: impl Into<Opening>) -> Self {
        let mut driver = Driver::open(opening);
        driver.perform(vec![Task::Ask]);
        driver
    }

    /// Performs an action and all its effects. Returns the effects of the action itself.
    pub fn act(&mut self, action: Action) -> Vec<Task> {
        let effects = update(&mut self.app, action);
        self.perform(effects.clone());
        effects
    }

    /// Runs a command of this name, and returns its effects, not performed.
    pub fn update(&mut self, name: &str) -> Vec<Task> {
        let command = self
            .app
            .config
            .bindings
            .named(name, self.app.keys())
            .expect("a valid command");
        update(&mut self.app, Action::Command(command))
    }

    /// Presses keys, their names separated by blanks: `j`, `Ctrl+c`, `Enter`, `Shift+Left`; text
    /// between grave accents is typed. Returns the effects of the last key.
    pub fn press(&mut self, keys: &str) -> Vec<Task> {
        let mut effects = Vec::new();
        for (place, part) in keys.split('`').enumerate() {
            if place % 2 == 1 {
                self.type_text(part);
                continue;
            }
            for name in part.split_whitespace() {
                let name = if name == "Space" { "space" } else { name };
                let key = Key::named(name).unwrap_or_else(|| panic!("no key is called {name}"));
                effects = self.act(Action::Key(key.event()));
            }
        }
        effects
    }

    /// Asserts that the screen shows these words.
    #[track_caller]
    pub fn shows(&self, words: impl AsRef<str>) {
        assert!(
            self.text().contains(words.as_ref()),
            "not shown: {}\n{}",
            words.as_ref(),
            self.text()
        );
    }

    /// Asserts that the screen shows all of these words.
    #[track_caller]
    pub fn shows_all<'t>(&self, words: impl IntoIterator<Item = &'t str>) {
        words.into_iter().for_each(|words| self.shows(words));
    }

    /// Asserts that the screen does not show these words.
    #[track_caller]
    pub fn hides(&self, words: impl AsRef<str>) {
        assert!(
            !self.text().contains(words.as_ref()),
            "shown: {}\n{}",
            words.as_ref(),
            self.text()
        );
    }

    /// Asserts that the status line has these words.
    #[track_caller]
    pub fn states(&self, words: impl AsRef<str>) {
        assert!(
            self.status().contains(words.as_ref()),
            "not stated: {}\n{}",
            words.as_ref(),
            self.text()
        );
    }

    /// Presses keys, after which the screen shows these words.
    #[track_caller]
    pub fn sees(&mut self, keys: &str, words: impl AsRef<str>) {
        self.press(keys);
        self.shows(words);
    }

    /// Presses keys, after which the status line has these words.
    #[track_caller]
    pub fn answers(&mut self, keys: &str, words: impl AsRef<str>) {
        self.press(keys);
        self.states(words);
    }

    /// Types a text, character by character.
    pub fn type_text(&mut self, text: &str) {
        text.chars()
            .for_each(|character| drop(self.act(Action::Paste(character.to_string()))));
    }

    /// Types a value for the selected parameter in place of the present one.
    pub fn enter(&mut self, value: &str) {
        self.press(&format!("Enter Ctrl+u `{value}` Enter"));
    }

    /// Types a value for the parameter of this path.
    pub fn set(&mut self, path: &str, value: &str) {
        self.select(path);
        self.enter(value);
    }

    /// Reason why the typed text was refused.
    pub fn refusal(&self) -> Option<&str> {
        self.app.prompt.as_ref()?.refused.as_deref()
    }

    /// Selects the row of this path, by keys.
    pub fn select(&mut self, path: &str) {
        self.press("g");
        for _ in 0..self.app.edit.parameters.len() {
            if self
                .app
                .edit
                .parameter()
                .is_some_and(|parameter| parameter.path == path)
            {
                return;
            }
            self.press("j");
        }
        panic!("no parameter {path}: {:?}", self.app.edit.parameters);
    }

    /// Advances the clock.
    pub fn elapse(&mut self, seconds: f64) -> Vec<Task> {
        self.act(Action::Elapse(Duration::from_secs_f64(seconds)))
    }

    /// Resizes the window.
    pub fn resize(&mut self, (columns, rows): (u16, u16)) {
        self.act(Action::Resize(columns, rows));
    }

    /// Present screen.
    pub fn screen(&self) -> Buffer {
        draw(&self.app)
    }

    /// The rows of the screen.
    pub fn rows(&self) -> Vec<String> {
        rows(&self.screen())
    }

    /// The screen as one text.
    pub fn text(&self) -> String {
        self.rows().join("\n")
    }

    /// The rows of a pane with its frame.
    pub fn pane(&self, pane: Pane) -> Vec<String> {
        let area = Layout::of(&self.app).pane(pane).expect("the pane is shown");
        let row = |row: &String| {
            row.chars()
                .skip(area.x.into())
                .take(area.width.into())
                .collect()
        };
        self.rows()[usize::from(area.y)..usize::from(area.bottom())]
            .iter()
            .map(row)
            .collect()
    }

    /// The area inside the frame of a pane.
    pub fn area(&self, pane: Pane) -> Rect {
        inside(Layout::of(&self.app).pane(pane).expect("the pane is shown"))
    }

    /// The row of the keys.
    pub fn footer(&self) -> String {
        let row = Layout::of(&self.app).footer.expect("there is a footer").y;
        self.rows()[usize::from(row)].clone()
    }

    /// Moves the mouse.
    pub fn mouse(&mut self, column: u16, row: u16, gesture: Gesture) -> Vec<Task> {
        self.act(Action::Mouse(Mouse {
            column,
            row,
            gesture,
        }))
    }

    /// The scene as text.
    pub fn document(&self) -> &Document {
        &self.app.edit.document
    }

    /// The state shown.
    pub fn snapshot(&self) -> &ContactSnapshot {
        self.app.snapshot.as_deref().expect("a state is shown")
    }

    /// Its point of the curve.
    pub fn point(&self) -> CurvePoint {
        self.snapshot().point
    }

    /// The outcome of the scene.
    pub fn outcome(&self) -> &Outcome {
        &self
            .app
            .solved
            .as_ref()
            .expect("the scene is computed")
            .outcome
    }

    /// The row below the panes.
    pub fn status(&self) -> String {
        let row = Layout::of(&self.app).status.y;
        self.rows()[usize::from(row)].clone()
    }
}

/// Draws a model.
pub fn draw(app: &App) -> Buffer {
    let (columns, rows) = app.view.size;
    let mut terminal = Terminal::new(TestBackend::new(columns, rows)).unwrap();
    terminal.draw(|frame| view::draw(frame, app)).unwrap();
    terminal.backend().buffer().clone()
}

/// The rows of a screen, without the blanks at their ends.
pub fn rows(screen: &Buffer) -> Vec<String> {
    let width = usize::from(screen.area.width).max(1);
    let row = |cells: &[Cell]| {
        let text: String = cells.iter().map(Cell::symbol).collect();
        text.trim_end().to_owned()
    };
    screen.content.chunks(width).map(row).collect()
}
