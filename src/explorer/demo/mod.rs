//! Demo of the explorer, which plays a script in a terminal, for a pipe or for a recording. The
//! demo shows exactly the same frames each time.

pub mod script;
pub mod watch;

use self::script::Cue;
use crate::explorer::action::{Action, Task};
use crate::explorer::app::App;
use crate::explorer::commands::table::bindings;
use crate::explorer::config::Config;
use crate::explorer::opening::{Opened, Opening};
use crate::explorer::runtime::{Engine, Runtime};
use crate::explorer::theme::Appearance;
use asperity_scene::{Document, Simulation, open};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::Duration;

const TYPING: f64 = 0.15;

pub struct Demo {
    explorer: Runtime,
    cues: VecDeque<Cue>,
    typing: VecDeque<char>,
    /// Time in s until the next cue of the script.
    pause: f64,
    /// Time in s since the demo began. The field `frame` is the time in s between two frames.
    seconds: f64,
    frame: f64,
    begun: bool,
}

impl Demo {
    /// Creates a demo that begins with the scene `document` and follows a script.
    pub fn new(
        document: Document,
        script: &[Cue],
        size: (u16, u16),
        appearance: Appearance,
        frames_per_second: f64,
    ) -> Self {
        let mut app = App::new(document, size, appearance, Config::new(bindings()));
        // Computing times would differ each time the demo plays.
        app.view.shows_times = false;
        app.view.demo = Some("");
        let engine = Engine::inline(Simulation::run, |study| !study.is_long);
        let mut explorer = Runtime {
            app,
            engine,
            asked: 0,
            folder: PathBuf::new(),
        };
        explorer.perform(vec![Task::Ask]);
        Demo {
            explorer,
            cues: script.iter().copied().collect(),
            typing: VecDeque::new(),
            pause: 0.0,
            seconds: 0.0,
            frame: frames_per_second.recip(),
            begun: false,
        }
    }

    /// Advances to the next frame and returns the time of this frame in s since the demo began.
    /// Returns `None` if the demo is over.
    pub fn advance(&mut self) -> Option<f64> {
        let mut left = if std::mem::replace(&mut self.begun, true) {
            self.frame
        } else {
            0.0
        };
        while self.pause <= left {
            left -= self.pause;
            self.play(self.pause);
            self.pause = 0.0;
            if let Some(character) = self.typing.pop_front() {
                self.explorer.act(Action::Paste(character.to_string()));
                self.pause = TYPING;
            } else if let Some(prompt) = &self.explorer.app.prompt {
                // If the typed value has been refused, its editor is still open and must be closed.
                let is_refused = prompt.refused.is_some();
                self.explorer
                    .command(if is_refused { "cancel" } else { "accept" });
            } else {
                let cue = self.cues.pop_front()?;
                self.follow(cue);
            }
        }
        self.pause -= left;
        self.play(left);
        let now = self.seconds;
        Some(now)
    }

    pub fn app(&self) -> &App {
        &self.explorer.app
    }

    pub fn resize(&mut self, columns: u16, rows: u16) {
        self.explorer.act(Action::Resize(columns, rows));
    }

    pub fn set_note(&mut self, note: &'static str) {
        self.explorer.app.view.demo = Some(note);
    }

    fn play(&mut self, seconds: f64) {
        self.seconds += seconds;
        if seconds > 0.0 && self.explorer.app.manual.is_none() {
            self.explorer
                .act(Action::Elapse(Duration::from_secs_f64(seconds)));
        }
    }

    fn follow(&mut self, cue: Cue) {
        match cue {
            Cue::Wait(seconds) => self.pause = seconds,
            Cue::Do(command) => drop(self.explorer.command(command)),
            Cue::Open(name) => {
                let opened =
                    open(name).map(|document| Opened::Scene(Box::new(Opening::from(document))));
                let opened = opened.map_err(|errors| errors.to_string());
                self.explorer.act(Action::Opened(name.to_owned(), opened));
            }
            Cue::Repeat(0, ..) => {}
            Cue::Repeat(times, seconds, command) => {
                self.explorer.command(command);
                self.pause = seconds;
                self.cues
                    .push_front(Cue::Repeat(times - 1, seconds, command));
            }
            Cue::Select(path) => {
                let edit = &mut self.explorer.app.edit;
                let mut rows = edit.parameters.iter();
                let row = rows.position(|parameter| parameter.path == path);
                edit.select(row.unwrap_or(0));
            }
            Cue::Enter(value) => {
                self.explorer.command("edit-value");
                self.explorer.command("clear");
                self.typing = value.chars().collect();
                self.pause = TYPING;
            }
        }
    }
}
