//! An explorer without a terminal. Its worker is the real one, and every answer is awaited: results do not depend on
//! its speed.

use asperity::explorer::action::{Action, Content, WriteFailure, Written};
use asperity::explorer::model::Model;
use asperity::explorer::snapshot::SolvedScene;
use asperity::explorer::study::{Appraiser, Found, perform};
use asperity::explorer::theme::{Appearance, Marker, Theme};
use asperity::explorer::update::{Effect, request, study_tasks};
use asperity::explorer::worker::{self, Engine, Newest, Report, Request, Worker};
use asperity::explorer::{Opening, complete, scene_file, write};
use asperity::scene::Library;
use asperity::simulation::{Simulation, Timings};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// The name of a file that cannot be saved.
pub const REFUSED: &str = "refused.ron";

/// Appearance of the explorer.
pub const APPEARANCE: Appearance = Appearance { theme: Theme::Neutral, marker: Marker::Braille };

/// Longest time a request may take.
const PATIENCE: Duration = Duration::from_secs(20);

/// An explorer without a terminal.
pub struct Driver {
    pub model: Model,
    /// The working folder of the library.
    pub folder: PathBuf,
    /// Saved files by name.
    pub files: BTreeMap<PathBuf, String>,
    /// Copied texts.
    pub copied: Vec<String>,
    /// Next random seed.
    pub seed: u64,
    /// Computes estimates of accuracy; `None`: no estimates.
    pub appraiser: Option<Box<dyn Appraiser>>,
    worker: Worker,
    reports: Receiver<Report>,
}

impl Driver {
    /// Opens the explorer, before any computation.
    pub fn open(opening: impl Into<Opening>) -> Self {
        Driver::open_with(opening, Box::new(Simulation::default()))
    }

    /// Opens the explorer with another engine.
    pub fn open_with(opening: impl Into<Opening>, engine: Box<dyn Engine>) -> Self {
        let Opening { document, study_map, beside } = opening.into();
        let mut model = Model::new(document, (120, 40), APPEARANCE);
        model.opens_beside = beside;
        if let Some(study_map) = study_map {
            model.show_study(study_map);
        }
        let (requests, outbox) = channel();
        let (report, reports) = channel();
        let newest = Newest::default();
        worker::start(engine, Arc::clone(&newest), outbox, move |one| report.send(one).is_ok()).unwrap();
        Driver {
            model,
            files: BTreeMap::new(),
            copied: Vec::new(),
            folder: PathBuf::from("no such folder"),
            seed: 4711,
            appraiser: None,
            worker: Worker::new(requests, newest),
            reports,
        }
    }

    /// Actions that follow an effect.
    pub fn answer(&mut self, effect: Effect) -> Vec<Action> {
        match effect {
            Effect::Compute | Effect::Show | Effect::Preview(_) => {
                request(&self.model, &effect).map_or(Vec::new(), |one| self.ask(one))
            }
            // Answered with the next state.
            Effect::Beside | Effect::Manual(_) => {
                request(&self.model, &effect).into_iter().for_each(|one| self.worker.ask(one));
                Vec::new()
            }
            Effect::Study => self.study(),
            Effect::Complete(typed) => {
                let paths = complete(&typed);
                vec![Action::Completed { typed, paths }]
            }
            Effect::Open(name) => {
                let opened = Opening::of(&name).map(Box::new).map_err(|error| error.to_string());
                vec![Action::Opened(opened)]
            }
            Effect::List => vec![Action::Listed(Library::of(None, self.folder.clone()).list())],
            Effect::Copy(text) => {
                self.copied.push(text);
                Vec::new()
            }
            Effect::Remember { path, .. } => vec![Action::Remembered(Ok(path))],
            Effect::StopPreview => {
                self.worker.stop_preview();
                Vec::new()
            }
            Effect::Suspend => Vec::new(),
            Effect::DrawSeed => vec![Action::SetSeed(self.seed)],
            Effect::Write { path, .. } if path.ends_with(REFUSED) => {
                vec![Action::Written(Err(WriteFailure::Refused("no room".to_owned())))]
            }
            // An absolute path is a file on disk.
            Effect::Write { path, content, overwrite } if path.is_absolute() => {
                vec![Action::Written(write(&self.model, path, content, overwrite))]
            }
            Effect::Write { path, content, overwrite } => {
                let named = if content == Content::Scene { scene_file(path) } else { Ok(path) };
                let path = match named {
                    Ok(path) => path,
                    Err(error) => {
                        return vec![Action::Written(Err(WriteFailure::Refused(error.to_string())))];
                    }
                };
                let result = if self.files.contains_key(&path) && !overwrite {
                    Err(WriteFailure::Exists(path, content))
                } else {
                    let text = match content {
                        Content::Scene => self.model.document.text().to_owned(),
                        other => format!("{other:?}"),
                    };
                    self.files.insert(path.clone(), text);
                    Ok(Written { path, content })
                };
                vec![Action::Written(result)]
            }
        }
    }

    /// All findings about accuracy, without a key in between.
    fn study(&mut self) -> Vec<Action> {
        let (generation, tasks) = (self.model.generation, study_tasks(&self.model));
        let mut found = Vec::new();
        if let Some(appraiser) = &mut self.appraiser {
            for task in tasks {
                perform(appraiser.as_mut(), &task, &|| false, &mut |finding| {
                    found.push(Action::Found(Found { generation, finding }));
                });
            }
        }
        found
    }

    /// Sends a request to the worker, and waits for all its reports.
    fn ask(&mut self, request: Request) -> Vec<Action> {
        self.worker.ask(request.clone());
        let mut actions = Vec::new();
        loop {
            let report = self.reports.recv_timeout(PATIENCE);
            let report = report.unwrap_or_else(|_| panic!("the worker does not answer {request:?}"));
            let last = !matches!(report, Report::Progress { .. });
            actions.push(action_of(report));
            if last {
                return actions;
            }
        }
    }
}

/// Action of a report, without its times: they differ from run to run.
fn action_of(report: Report) -> Action {
    Action::Report(match report {
        Report::Computed(computed) => {
            let mut outcome = computed.outcome.clone();
            outcome.timings = Timings::default();
            let scene = Arc::clone(&computed.scene);
            Report::Computed(Arc::new(SolvedScene { generation: computed.generation, scene, outcome }))
        }
        other => other,
    })
}
