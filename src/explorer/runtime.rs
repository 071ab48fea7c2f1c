//! The runtime performs the tasks of the explorer in the same way for sessions, demos and tests. In
//! a session, the solver and the studies (background computations) have threads of their own. In
//! demos and tests they answer at once, so that the same actions always give the same screens.

use super::action::{Action, Task};
use super::app::App;
use super::commands::accuracy::studies;
use super::completion::complete;
use super::keys::bindings::Context;
use super::openable::{Openable, openables};
use super::opening::Opened;
use super::request::Request;
use super::solver::{Solve, Solver, SolverThread};
use super::studies::{Study, StudyThread};
use super::update::{request, update};
use super::writing;
use crate::explorer::advice;
use asperity_data::Remedied;
use asperity_scene::Simulation;
use asperity_scene::library::own_folder;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};

/// The solver and the studies (background computations). Both answer either at once or, if they
/// have threads, later by sending actions.
pub struct Engine {
    /// Sends a request to the solver. Returns the answers that are available at once.
    solve: Box<dyn FnMut(Request) -> Vec<Action>>,
    /// Performs these studies and stops all earlier ones. Returns the results that are available at
    /// once.
    perform: Box<dyn FnMut(Vec<Study>) -> Vec<Action>>,
    /// True while the solver has not answered the last request.
    is_waiting: bool,
}

impl Engine {
    pub fn threads(solver: SolverThread, studies: StudyThread) -> Self {
        Engine {
            solve: Box::new(move |request| {
                solver.ask(request);
                Vec::new()
            }),
            perform: Box::new(move |wanted| {
                studies.ask(wanted);
                Vec::new()
            }),
            is_waiting: false,
        }
    }

    /// Creates an engine in which the solver and the studies (background computations) answer at
    /// once. Only those studies are performed for which `performs` returns true.
    pub fn inline(solve: Solve, performs: fn(&Study) -> bool) -> Self {
        let mut solver = Solver::new(solve, Default::default());
        Engine {
            solve: Box::new(move |request| replies(&mut solver, request)),
            perform: Box::new(move |wanted| findings(wanted, performs)),
            is_waiting: false,
        }
    }
}

/// Returns all replies of a solver to a request.
fn replies(solver: &mut Solver, request: Request) -> Vec<Action> {
    let mut actions = Vec::new();
    solver.answer(request, &mut |reply| actions.push(Action::Reply(reply)));
    actions
}

/// Performs the studies for which `performs` returns true, and returns their results.
fn findings(studies: Vec<Study>, performs: fn(&Study) -> bool) -> Vec<Action> {
    let mut actions = Vec::new();
    for study in studies {
        if performs(&study) {
            let mut report = |finding| actions.push(Action::Found(finding));
            study.perform(&mut Simulation::default(), &|| false, &mut report);
        }
    }
    actions
}

/// The explorer without its terminal: the state, and everything that is needed to perform tasks.
pub struct Runtime {
    pub app: App,
    pub engine: Engine,
    /// Generation of the scene in the last request to the solver. The generation is a number that
    /// increases by 1 whenever the scene changes.
    pub asked: u64,
    /// Folder to which the paths of files are relative; empty for the working folder.
    pub folder: PathBuf,
}

impl Runtime {
    /// Applies an action to the state, and performs the tasks that follow from the action. Tasks
    /// that only the owner of the terminal can perform are returned.
    pub fn act(&mut self, action: Action) -> Vec<Task> {
        if let Action::Reply(reply) = &action
            && reply.is_answer()
        {
            self.engine.is_waiting = false;
        }
        let tasks = update(&mut self.app, action);
        self.perform(tasks)
    }

    /// Returns true while the solver has not answered the last request, or has not listed the
    /// events after its answer.
    pub fn awaits_answer(&self) -> bool {
        let wanted = self.app.view.least_share;
        let is_listed = self.app.listed_events().is_some() && self.app.listed_share() == wanted;
        let awaits_events = self.app.is_current() && !is_listed;
        self.engine.is_waiting || awaits_events
    }

    /// Runs the command with this name if it is valid in the present context. If no prompt is open,
    /// the commands of the context [`Context::Explore`] run as well. Returns the tasks that only
    /// the owner of the terminal can perform.
    pub fn command(&mut self, name: &str) -> Vec<Task> {
        let bindings = &self.app.config.bindings;
        let mut command = bindings.named(name, self.app.keys());
        if command.is_none() && self.app.prompt.is_none() {
            command = bindings.named(name, Context::Explore);
        }
        match command {
            Some(command) => self.act(Action::Command(command)),
            None => Vec::new(),
        }
    }

    /// Performs tasks, and all further tasks that follow from their results. Tasks that only the
    /// owner of the terminal can perform are returned.
    pub fn perform(&mut self, tasks: Vec<Task>) -> Vec<Task> {
        let mut waiting = VecDeque::from(tasks);
        let mut of_terminal = Vec::new();
        while let Some(task) = waiting.pop_front() {
            if matches!(task, Task::Copy(_) | Task::Redraw | Task::Suspend) {
                of_terminal.push(task);
                continue;
            }
            for action in self.answer(task) {
                waiting.extend(update(&mut self.app, action));
            }
        }
        of_terminal
    }

    /// Performs a task. Returns the actions to which the task leads at once.
    pub fn answer(&mut self, task: Task) -> Vec<Action> {
        let action = match task {
            Task::Ask => return self.ask(),
            Task::Study => return (self.engine.perform)(studies(&mut self.app)),
            Task::Write(file) => writing::write(&self.app, &self.folder, file),
            Task::List => Action::Listed(self.openables()),
            Task::Complete(typed) => Action::Completed(complete(&typed)),
            Task::Open(name) => {
                let opened = Opened::of(&name);
                Action::Opened(name, opened)
            }
            Task::OpenCurve(question) => {
                let name = question.path.to_string_lossy().into_owned();
                Action::Opened(name, Ok(Opened::of_curve(question)))
            }
            Task::ReadCurve(wanted) => {
                let Some(measured) = &self.app.edit.measured else {
                    return Vec::new();
                };
                let read = measured.read_again(wanted.options.clone()).map(Box::new);
                Action::CurveRead(wanted, read.map_err(|error| error.in_words(advice::row)))
            }
            Task::Copy(_) | Task::Redraw | Task::Suspend => return Vec::new(),
        };
        vec![action]
    }

    /// Requests the state of the contact for which the screen waits. If the scene has changed, the
    /// studies of the previous scene are stopped, because they would only slow down the solver.
    fn ask(&mut self) -> Vec<Action> {
        let request = request(&mut self.app);
        if request.generation != self.asked {
            if self.asked > 0 {
                (self.engine.perform)(Vec::new());
            }
            self.asked = request.generation;
        }
        let replies = (self.engine.solve)(request);
        self.engine.is_waiting = replies.is_empty();
        replies
    }

    /// Returns the scenes and files that can be opened. Tests and demos set `folder`; then the
    /// scenes in the user's own folder are left out.
    fn openables(&self) -> Vec<Openable> {
        if self.folder.as_os_str().is_empty() {
            openables(own_folder().as_deref(), Path::new("."))
        } else {
            openables(None, &self.folder)
        }
    }
}
