//! An explorer without a terminal, in a folder of its own. It performs effects as the program does,
//! but at once: results do not depend on speed.

use asperity::explorer::action::{Action, Task};
use asperity::explorer::commands::opening::begin;
use asperity::explorer::commands::table::bindings;
use asperity::explorer::config::Config;
use asperity::explorer::opening::Opening;
use asperity::explorer::runtime::{Engine, Runtime};
use asperity::explorer::snapshot::Preview;
use asperity::explorer::solver::Solve;
use asperity::explorer::studies::Study;
use asperity::explorer::theme::{Appearance, Marker, Theme};
use asperity::scene::Simulation;
use asperity::scene::workload::Timings;
use asperity_plot::Colours;
use asperity_report::SceneSpectra;
use std::any::Any;
use std::fs;
use std::ops::{Deref, DerefMut};
use tempfile::TempDir;

/// The name of a file that cannot be saved.
pub const REFUSED: &str = "no such folder/mine.ron";

/// Appearance of the explorer.
pub const APPEARANCE: Appearance = Appearance {
    theme: Theme::Neutral,
    colours: Colours::Ansi16,
    marker: Marker::Braille,
};

/// An explorer without a terminal.
pub struct Driver {
    runtime: Runtime,
    /// Copied texts.
    pub copied: Vec<String>,
    folder: TempDir,
}

impl Driver {
    /// Opens the explorer, before any computation; of the studies it performs those that are done
    /// at once.
    pub fn open(opening: impl Into<Opening>) -> Self {
        // Times differ from run to run.
        let timeless: Solve = |simulation, scene, stop, after| {
            let mut outcome = simulation.run(scene, stop, after)?;
            outcome.timings = Timings::default();
            Ok(outcome)
        };
        let is_quick = |study: &Study| study.is::<SceneSpectra>() || study.is::<Preview>();
        Driver::open_with(opening, timeless, is_quick)
    }

    /// Opens the explorer with another solver, and studies for which a function returns true.
    pub fn open_with(
        opening: impl Into<Opening>,
        solve: Solve,
        performs: fn(&Study) -> bool,
    ) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("folder")).unwrap();
        let runtime = Runtime {
            app: begin(
                opening.into(),
                (120, 40),
                APPEARANCE,
                Config::new(bindings()),
            ),
            engine: Engine::inline(solve, performs),
            asked: 0,
            folder: folder.path().to_owned(),
        };
        Driver {
            runtime,
            copied: Vec::new(),
            folder,
        }
    }

    /// Performs the effects of an action.
    pub fn perform(&mut self, effects: Vec<Task>) {
        for effect in self.runtime.perform(effects) {
            if let Task::Copy(text) = effect {
                self.copied.push(text);
            }
        }
    }

    /// Reports the result of a study of the present scene, which the explorer waits for.
    pub fn find<T: Any + Clone + Send + Sync>(&mut self, result: Result<T, String>) {
        let study = Study::new(self.app.edit.generation, false, move |_, _| result);
        let mut found = Vec::new();
        for study in self.app.studies.begin(vec![study]) {
            study.perform(&mut Simulation::default(), &|| false, &mut |finding| {
                found.push(finding)
            });
        }
        found
            .into_iter()
            .for_each(|finding| drop(self.act(Action::Found(finding))));
    }

    /// Names of the files in the folder of the explorer, in the order of the alphabet.
    pub fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path())
            .unwrap()
            .map(Result::unwrap);
        let files = entries.filter(|entry| entry.path().is_file());
        let mut names: Vec<_> = files
            .map(|entry| entry.file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// The text of a file in the folder of the explorer.
    pub fn file(&self, name: &str) -> String {
        let content = fs::read(self.folder.path().join(name))
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        String::from_utf8_lossy(&content).into_owned()
    }
}

impl Deref for Driver {
    type Target = Runtime;

    fn deref(&self) -> &Runtime {
        &self.runtime
    }
}

impl DerefMut for Driver {
    fn deref_mut(&mut self) -> &mut Runtime {
        &mut self.runtime
    }
}
