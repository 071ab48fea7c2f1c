//! The interpreter of effects: one for the session, for demos and for tests. Solver and studies run on threads of their
//! own, or at once: the same actions then lead to the same screens.

use super::action::Action;
use super::app::App;
use super::completion::complete;
use super::config::remember;
use super::keys::Context;
use super::opening::Opening;
use super::study::{Accuracy, Appraiser, Found, PaneData, Study, Task, perform};
use super::update::{Effect, request, study_tasks, update};
use super::worker::{Engine, Newest, Report, Request, Worker, WorkerState};
use super::writing;
use crate::scene::Library;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::io;
use std::path::PathBuf;

/// Most springs for an estimate in a demo: above, viewers would have to wait.
const MOST_ESTIMATED: u64 = 1 << 17;
/// Most springs for the map of a demo, of hundreds of scenes.
const MOST_CHARTED: u64 = 1 << 12;

/// The terminal around the explorer.
pub trait Console {
    /// Sends a text to the clipboard.
    ///
    /// # Errors
    /// When the terminal refuses.
    fn copy(&mut self, text: String) -> io::Result<()>;

    /// Draws the whole screen anew with the next frame.
    fn redraw(&mut self);

    /// Returns the terminal to the shell for a while; the action is the size of the window afterwards.
    ///
    /// # Errors
    /// When the terminal refuses.
    fn suspend(&mut self) -> io::Result<Option<Action>>;
}

/// No terminal.
impl Console for () {
    fn copy(&mut self, _: String) -> io::Result<()> {
        Ok(())
    }

    fn redraw(&mut self) {}

    fn suspend(&mut self) -> io::Result<Option<Action>> {
        Ok(None)
    }
}

/// Solver of the scenes.
pub enum Solver {
    /// On a thread of its own, which reports.
    Thread(Worker),
    /// At once.
    Inline(Box<WorkerState>, Newest),
}

impl Solver {
    /// A solver that answers at once.
    #[must_use]
    pub fn inline(engine: Box<dyn Engine>) -> Self {
        Solver::Inline(Box::new(WorkerState::new(engine)), Newest::default())
    }

    fn ask(&mut self, request: Request) -> Vec<Action> {
        match self {
            Solver::Thread(worker) => {
                worker.ask(request);
                Vec::new()
            }
            Solver::Inline(worker, newest) => {
                newest.ask(&request);
                let reports: RefCell<Vec<Report>> = RefCell::default();
                worker.serve(request, newest, &|report| {
                    reports.borrow_mut().push(report);
                    true
                });
                reports.into_inner().into_iter().map(Action::Report).collect()
            }
        }
    }
}

/// Solver of the studies.
pub enum Studies {
    /// On a thread of its own, which reports.
    Thread(Study),
    /// At once.
    Inline(Box<dyn Appraiser>),
    /// At once, without the studies that take long or whose results differ from run to run.
    Demo,
    /// No studies.
    None,
}

impl Studies {
    fn stop(&self) {
        if let Studies::Thread(study) = self {
            study.stop();
        }
    }

    fn ask(&mut self, generation: u64, tasks: Vec<Task>) -> Vec<Action> {
        let mut accuracy = Accuracy;
        let (appraiser, tasks): (&mut dyn Appraiser, _) = match self {
            Studies::Thread(study) => {
                study.ask(generation, tasks);
                return Vec::new();
            }
            Studies::None => return Vec::new(),
            Studies::Inline(appraiser) => (appraiser.as_mut(), tasks),
            Studies::Demo => (&mut accuracy, tasks.into_iter().filter(is_short).collect()),
        };
        let mut found = Vec::new();
        for task in tasks {
            perform(appraiser, &task, &|| false, &mut |finding| {
                found.push(Action::Found(Found { generation, finding }));
            });
        }
        found
    }
}

/// Returns true for a task of a demo: times differ from run to run, and viewers do not wait.
fn is_short(task: &Task) -> bool {
    match task {
        Task::Extend { data: PaneData::Costs(..), .. } => false,
        Task::Extend { data: PaneData::Map(map), .. } => map.template().springs() <= MOST_CHARTED,
        Task::Estimate(of) => of.scene.numerics.points <= MOST_ESTIMATED,
        _ => true,
    }
}

/// The explorer and all that its effects need.
pub struct Runtime {
    /// The state of the explorer.
    pub app: App,
    /// Solver of the scenes.
    pub solver: Solver,
    /// Solver of the studies.
    pub studies: Studies,
    /// Generation of the scene requested last.
    pub asked: u64,
    /// Folder of relative paths; empty for the working folder.
    pub folder: PathBuf,
    /// Draws a seed.
    pub draw_seed: Box<dyn FnMut() -> u64>,
}

impl Runtime {
    /// Applies an action, with all effects that can be performed at once.
    ///
    /// # Errors
    /// When the terminal refuses.
    pub fn act(&mut self, action: Action, console: &mut dyn Console) -> io::Result<()> {
        let effects = update(&mut self.app, action);
        self.perform(effects, console)
    }

    /// Runs a command by its name, if its keys are valid or, while exploring, in another pane.
    ///
    /// # Errors
    /// When the terminal refuses.
    pub fn command(&mut self, name: &str, console: &mut dyn Console) -> io::Result<()> {
        let bindings = &self.app.config.bindings;
        let elsewhere = || bindings.named(name, Context::Explore).filter(|_| self.app.prompt.is_none());
        match bindings.named(name, self.app.keys()).or_else(elsewhere) {
            Some(command) => self.act(Action::Command(command), console),
            None => Ok(()),
        }
    }

    /// Performs effects, and those of the actions that follow.
    ///
    /// # Errors
    /// When the terminal refuses.
    pub fn perform(&mut self, effects: Vec<Effect>, console: &mut dyn Console) -> io::Result<()> {
        let mut waiting = VecDeque::from(effects);
        while let Some(effect) = waiting.pop_front() {
            for action in self.answer(effect, console)? {
                waiting.extend(update(&mut self.app, action));
            }
        }
        Ok(())
    }

    /// Performs one effect; returns the actions that follow at once.
    ///
    /// # Errors
    /// When the terminal refuses.
    pub fn answer(&mut self, effect: Effect, console: &mut dyn Console) -> io::Result<Vec<Action>> {
        let Runtime { app, solver, studies, folder, asked, .. } = self;
        let action = match effect {
            Effect::Ask => {
                let request = request(app);
                if request.generation != *asked {
                    // Estimates of the former scene are of no use, and take time from this one.
                    studies.stop();
                    *asked = request.generation;
                }
                return Ok(solver.ask(request));
            }
            Effect::Study => return Ok(studies.ask(app.edit.generation, study_tasks(app))),
            Effect::DrawSeed => Action::SetSeed((self.draw_seed)()),
            Effect::Write(file) => writing::write(app, folder, file),
            Effect::Remember { path, appearance } => {
                let remembered = remember(&folder.join(&path), appearance).map_err(|error| error.to_string());
                Action::Remembered(remembered.map(|()| path))
            }
            Effect::List if folder.as_os_str().is_empty() => Action::Listed(Library::of_environment().list()),
            Effect::List => Action::Listed(Library::of(None, folder.clone()).list()),
            Effect::Complete(typed) => Action::Completed(complete(&typed)),
            Effect::Open(name) => {
                let opened = Opening::of(&name).map(Box::new).map_err(|error| error.to_string());
                Action::Opened(name, opened)
            }
            Effect::Copy(text) => {
                console.copy(text)?;
                return Ok(Vec::new());
            }
            Effect::Redraw => {
                console.redraw();
                return Ok(Vec::new());
            }
            Effect::Suspend => return Ok(console.suspend()?.into_iter().collect()),
        };
        Ok(vec![action])
    }
}
