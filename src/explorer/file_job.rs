//! File jobs of the explorer, each on a thread of its own: a disk that does not answer must not block the screen.

use super::action::{Action, Content, WriteFailure};
use super::completion::complete;
use super::config::remember;
use super::model::Model;
use super::opening::Opening;
use super::theme::Appearance;
use super::writing;
use crate::scene::Library;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

/// File job.
pub(super) enum FileJob {
    /// Write a file from the model as of the request.
    Write { model: Box<Model>, path: PathBuf, content: Content, overwrite: bool },
    /// Keep colours and markers in the configuration file.
    Remember { path: PathBuf, appearance: Appearance },
    /// List the scenes of the library.
    List,
    /// List the paths that complete a typed one.
    Complete(String),
    /// Open a scene or a study by its path.
    Open(String),
}

impl FileJob {
    /// Description for the waiting user.
    pub fn describe(&self) -> String {
        match self {
            FileJob::Write { path, .. } | FileJob::Remember { path, .. } => {
                format!("writing {} …", path.display())
            }
            FileJob::List => "listing scenes …".to_owned(),
            FileJob::Complete(_) => "listing files …".to_owned(),
            FileJob::Open(name) => format!("opening {name} …"),
        }
    }

    /// Runs the job on a thread of its own; `done` receives its action.
    pub fn start(self, done: impl FnOnce(Action) + Send + 'static) {
        let failed = self.failure();
        let (on_thread, otherwise) = (failed("internal error, please report it"), failed("no thread for it"));
        let done = std::sync::Arc::new(std::sync::Mutex::new(Some(done)));
        let pass_on = move |action| {
            if let Some(done) = done.lock().unwrap_or_else(std::sync::PoisonError::into_inner).take() {
                done(action);
            }
        };
        let started = std::thread::Builder::new().name("files".to_owned()).spawn({
            let pass_on = pass_on.clone();
            move || pass_on(catch_unwind(AssertUnwindSafe(|| self.perform())).unwrap_or(on_thread))
        });
        if started.is_err() {
            pass_on(otherwise);
        }
    }

    fn perform(self) -> Action {
        match self {
            FileJob::Write { model, path, content, overwrite } => {
                Action::Written(writing::write(&model, path, content, overwrite))
            }
            FileJob::Remember { path, appearance } => {
                let remembered = remember(&path, appearance).map_err(|error| error.to_string());
                Action::Remembered(remembered.map(|()| path))
            }
            FileJob::List => Action::Listed(Library::of_environment().list()),
            FileJob::Complete(typed) => {
                let paths = complete(&typed);
                Action::Completed { typed, paths }
            }
            FileJob::Open(name) => {
                Action::Opened(Opening::of(&name).map(Box::new).map_err(|error| error.to_string()))
            }
        }
    }

    /// The action of a failed job for a reason.
    fn failure(&self) -> impl Fn(&str) -> Action + use<> {
        let (writes, description) = (matches!(self, FileJob::Write { .. }), self.describe());
        move |why| {
            if writes {
                Action::Written(Err(WriteFailure::Refused(why.to_owned())))
            } else {
                Action::Opened(Err(format!("{description} {why}")))
            }
        }
    }
}
