//! An explorer without terminal and threads: an action and all its effects are completed before the next
//! action. The same actions lead to the same screens.

use super::action::Action;
use super::mode::ModeKind;
use super::model::Model;
use super::study::{Accuracy, Found, PaneData, Task, perform};
use super::theme::Appearance;
use super::update::{Effect, request, study_tasks, update};
use super::worker::{Engine, Newest, Report, WorkerState};
use crate::scene::Document;
use std::cell::RefCell;
use std::collections::VecDeque;

/// Most springs for an estimate of the error: above, viewers would have to wait.
const MOST_ESTIMATED: u64 = 1 << 17;

/// Most springs for the map over κ and H, of hundreds of scenes.
const MOST_CHARTED: u64 = 1 << 12;

/// Explorer without a terminal.
pub struct Headless {
    /// The model.
    pub model: Model,
    worker: WorkerState,
    newest: Newest,
    /// Seeds drawn so far, in place of random ones.
    seeds: u64,
}

impl Headless {
    /// An explorer on a scene, computed and with its first snapshot shown.
    #[must_use]
    pub fn open(
        document: Document,
        size: (u16, u16),
        appearance: Appearance,
        engine: Box<dyn Engine>,
    ) -> Self {
        let mut model = Model::new(document, size, appearance);
        // Times differ from run to run.
        model.shows_times = false;
        let mut headless =
            Headless { model, worker: WorkerState::new(engine), newest: Newest::default(), seeds: 0 };
        headless.perform(vec![Effect::Compute]);
        headless
    }

    /// Runs a command by its name, if valid in the present mode or, while exploring, in [`ModeKind::Explore`].
    pub fn command(&mut self, name: &str) {
        let (bindings, here) = (&self.model.bindings, self.model.keys());
        let elsewhere = || bindings.named(name, ModeKind::Explore).filter(|_| here.is_exploring());
        if let Some(command) = bindings.named(name, here).or_else(elsewhere) {
            self.act(Action::Command(command));
        }
    }

    /// Applies an action with all its effects.
    pub fn act(&mut self, action: Action) {
        let effects = update(&mut self.model, action);
        self.perform(effects);
    }

    fn perform(&mut self, effects: Vec<Effect>) {
        let mut waiting = VecDeque::from(effects);
        while let Some(effect) = waiting.pop_front() {
            for action in self.answer(effect) {
                waiting.extend(update(&mut self.model, action));
            }
        }
    }

    /// Actions that follow an effect. Nothing leaves the program.
    fn answer(&mut self, effect: Effect) -> Vec<Action> {
        let request = match &effect {
            Effect::Study => return self.study(),
            Effect::DrawSeed => {
                self.seeds += 1;
                return vec![Action::SetSeed(self.seeds)];
            }
            effect => request(&self.model, effect),
        };
        let Some(request) = request else { return Vec::new() };
        self.newest.ask(&request);
        let reports: RefCell<Vec<Report>> = RefCell::default();
        self.worker.serve(std::iter::once(request), &self.newest, &|report| {
            reports.borrow_mut().push(report);
            true
        });
        reports.into_inner().into_iter().map(Action::Report).collect()
    }

    /// Findings on accuracy without its cost: times differ from run to run.
    fn study(&self) -> Vec<Action> {
        let generation = self.model.generation;
        let mut found = Vec::new();
        for task in study_tasks(&self.model) {
            match &task {
                Task::Extend { data: PaneData::Costs(..), .. } => continue,
                Task::Extend { data: PaneData::Map(map), .. } if map.template().springs() > MOST_CHARTED => {
                    continue;
                }
                Task::Estimate(of) if of.scene.numerics.points > MOST_ESTIMATED => continue,
                _ => {}
            }
            perform(&mut Accuracy, &task, &|| false, &mut |finding| {
                found.push(Action::Found(Found { generation, finding }));
            });
        }
        found
    }
}
