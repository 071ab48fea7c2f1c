//! An explorer without a terminal. Its worker is the real one, and is waited for: what happens does not
//! depend on how fast it is.

use asperity::explorer::action::{Action, SaveError};
use asperity::explorer::model::Model;
use asperity::explorer::snapshot::Loop;
use asperity::explorer::theme::Theme;
use asperity::explorer::update::{Effect, moment_request};
use asperity::explorer::worker::{self, Engine, Newest, Report, Request, Worker};
use asperity::scene::Document;
use asperity::simulation::{Simulation, Timings};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// The name of a file that cannot be saved.
pub const REFUSED: &str = "refused.ron";

/// Longest time a request may take.
const PATIENCE: Duration = Duration::from_secs(20);

/// An explorer without a terminal.
pub struct Driver {
    pub model: Model,
    /// What has been saved, by name.
    pub files: BTreeMap<PathBuf, String>,
    /// The seed that is drawn next.
    pub seed: u64,
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
            worker: Worker::new(requests, newest),
            reports,
        }
    }

    /// What comes back when an effect is done.
    pub fn answer(&mut self, effect: Effect) -> Vec<Action> {
        match effect {
            Effect::Compute => {
                let generation = self.model.generation;
                let scene = Box::new(self.model.document.scene().clone());
                self.ask(Request::Compute { generation, scene })
            }
            Effect::Show => {
                moment_request(&self.model).map_or(Vec::new(), |one| self.ask(Request::Show(one)))
            }
            Effect::DrawSeed => vec![Action::SetSeed(self.seed)],
            Effect::Save { path, .. } if path.ends_with(REFUSED) => {
                vec![Action::Saved(Err(SaveError::Refused("no room".to_owned())))]
            }
            Effect::Save { path, overwrite } => {
                let result = if self.files.contains_key(&path) && !overwrite {
                    Err(SaveError::Exists(path))
                } else {
                    self.files.insert(path.clone(), self.model.document.text().to_owned());
                    Ok(path)
                };
                vec![Action::Saved(result)]
            }
        }
    }

    /// Asks the worker, and waits for all it reports.
    fn ask(&mut self, request: Request) -> Vec<Action> {
        self.worker.ask(request);
        let mut actions = Vec::new();
        loop {
            let report = self.reports.recv_timeout(PATIENCE).expect("the worker answers");
            let last = !matches!(report, Report::Progress { .. });
            actions.push(action_of(report));
            if last {
                return actions;
            }
        }
    }
}

/// What a report does. Times are taken out of it: they differ from run to run.
fn action_of(report: Report) -> Action {
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
