//! The interpreter of tasks, the same for a session, for demos and for tests. Solver and studies
//! run on threads of their own, or at once: the same actions then give the same screens.

use super::action::{Action, Task};
use super::app::App;
use super::commands::accuracy::studies;
use super::completion::complete;
use super::keys::bindings::Context;
use super::opening::Opened;
use super::request::Request;
use super::solver::{Solve, Solver, SolverThread};
use super::studies::{Study, StudyThread};
use super::update::{request, update};
use super::writing;
use asperity_scene::Simulation;
use asperity_scene::library::{own_folder, scenes};
use std::collections::VecDeque;
use std::path::{Path, PathBuf};

/// Solver and studies; they answer at once, or later by actions.
pub struct Engine {
    solve: Box<dyn FnMut(Request) -> Vec<Action>>,
    /// Performs these studies in place of all others.
    perform: Box<dyn FnMut(Vec<Study>) -> Vec<Action>>,
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
        }
    }

    /// Creates an engine that answers at once and performs the studies for which `performs` returns
    /// true.
    pub fn inline(solve: Solve, performs: fn(&Study) -> bool) -> Self {
        let mut solver = Solver::new(solve, Default::default());
        let solve = move |request| {
            let mut reports = Vec::new();
            solver.answer(request, &mut |report| reports.push(Action::Reply(report)));
            reports
        };
        let perform = move |wanted: Vec<Study>| {
            let mut found = Vec::new();
            for study in wanted.into_iter().filter(performs) {
                let mut report = |finding| found.push(Action::Found(finding));
                study.perform(&mut Simulation::default(), &|| false, &mut report);
            }
            found
        };
        Engine {
            solve: Box::new(solve),
            perform: Box::new(perform),
        }
    }
}

/// The explorer with all that its tasks need, except the terminal.
pub struct Runtime {
    pub app: App,
    pub engine: Engine,
    /// Generation of the scene that was requested last.
    pub asked: u64,
    /// Folder to which paths are relative; empty for the working folder.
    pub folder: PathBuf,
}

impl Runtime {
    /// Applies an action and performs the tasks that follow; returns the tasks that need the
    /// terminal.
    pub fn act(&mut self, action: Action) -> Vec<Task> {
        let effects = update(&mut self.app, action);
        self.perform(effects)
    }

    /// Runs a command by its name, if its keys are valid here or, while exploring, in another pane;
    /// returns the tasks that need the terminal.
    pub fn command(&mut self, name: &str) -> Vec<Task> {
        let bindings = &self.app.config.bindings;
        let elsewhere = || {
            bindings
                .named(name, Context::Explore)
                .filter(|_| self.app.prompt.is_none())
        };
        let command = bindings.named(name, self.app.keys()).or_else(elsewhere);
        command.map_or_else(Vec::new, |command| self.act(Action::Command(command)))
    }

    /// Performs tasks, and the tasks of the actions that follow; returns the tasks that need the
    /// terminal.
    pub fn perform(&mut self, effects: Vec<Task>) -> Vec<Task> {
        let (mut waiting, mut left) = (VecDeque::from(effects), Vec::new());
        while let Some(effect) = waiting.pop_front() {
            if matches!(effect, Task::Copy(_) | Task::Redraw | Task::Suspend) {
                left.push(effect);
                continue;
            }
            for action in self.answer(effect) {
                waiting.extend(update(&mut self.app, action));
            }
        }
        left
    }

    /// Performs one task; returns the actions that follow at once.
    pub fn answer(&mut self, effect: Task) -> Vec<Action> {
        let Runtime {
            app,
            engine,
            folder,
            asked,
            ..
        } = self;
        let action = match effect {
            Task::Ask => {
                let request = request(app);
                if request.generation != *asked {
                    if *asked > 0 {
                        // Estimates of the former scene are of no use, and take time from this one.
                        (engine.perform)(Vec::new());
                    }
                    *asked = request.generation;
                }
                return (engine.solve)(request);
            }
            Task::Study => return (engine.perform)(studies(app)),
            Task::Write(file) => writing::write(app, folder, file),
            Task::List if folder.as_os_str().is_empty() => {
                Action::Listed(scenes(own_folder().as_deref(), Path::new(".")))
            }
            Task::List => Action::Listed(scenes(None, folder)),
            Task::Complete(typed) => Action::Completed(complete(&typed)),
            Task::Open(name) => {
                let opened = Opened::of(&name);
                Action::Opened(name, opened)
            }
            Task::ReadCurve(wanted) => {
                let Some(measured) = &app.edit.measured else {
                    return Vec::new();
                };
                let read = measured.read_again(wanted.options.clone()).map(Box::new);
                Action::CurveRead(wanted, read.map_err(|error| error.to_string()))
            }
            Task::Copy(_) | Task::Redraw | Task::Suspend => return Vec::new(),
        };
        vec![action]
    }
}
