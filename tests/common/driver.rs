//! An explorer without a terminal, in a folder of its own. It performs effects as the program does, but at once: results
//! do not depend on speed.

use asperity::explorer::Opening;
use asperity::explorer::action::Action;
use asperity::explorer::app::App;
use asperity::explorer::engine::Engine;
use asperity::explorer::runtime::{Console, Runtime, Solver, Studies};
use asperity::explorer::theme::{Appearance, Marker, Theme};
use asperity::explorer::update::Effect;
use asperity::scene::Scene;
use asperity::simulation::{AfterLeg, Outcome, RunError, Simulation, Timings};
use asperity::surface::Line;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::ops::{Deref, DerefMut};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The name of a file that cannot be saved.
pub const REFUSED: &str = "no such folder/mine.ron";

/// Appearance of the explorer.
pub const APPEARANCE: Appearance = Appearance { theme: Theme::Neutral, marker: Marker::Braille };

/// An explorer without a terminal.
pub struct Driver {
    runtime: Runtime,
    pub console: Recorded,
    folder: TempDir,
}

/// What an explorer sent to its terminal.
#[derive(Default)]
pub struct Recorded {
    /// Copied texts.
    pub copied: Vec<String>,
}

impl Console for Recorded {
    fn copy(&mut self, text: String) -> io::Result<()> {
        self.copied.push(text);
        Ok(())
    }

    fn redraw(&mut self) {}

    fn suspend(&mut self) -> io::Result<Option<Action>> {
        Ok(None)
    }
}

/// The engine of the program, without times: they differ from run to run.
struct Timeless(Simulation);

impl Engine for Timeless {
    fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError> {
        let outcome = self.0.run(scene, stop, after)?;
        Ok(Outcome { timings: Timings::default(), ..outcome })
    }

    fn line(&self) -> Option<&Line> {
        self.0.line()
    }
}

impl Driver {
    /// Opens the explorer, before any computation.
    pub fn open(opening: impl Into<Opening>) -> Self {
        Driver::open_with(opening, Box::new(Timeless(Simulation::default())))
    }

    /// Opens the explorer with another engine.
    pub fn open_with(opening: impl Into<Opening>, engine: Box<dyn Engine>) -> Self {
        let Opening { document, study_map, beside } = opening.into();
        let mut app = App::new(document, (120, 40), APPEARANCE);
        app.opens_beside = beside;
        if let Some(study_map) = study_map {
            app.show_study(study_map);
        }
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("folder")).unwrap();
        let runtime = Runtime {
            app,
            solver: Solver::inline(engine),
            studies: Studies::None,
            asked: 0,
            folder: folder.path().to_owned(),
            draw_seed: Box::new(|| 4711),
        };
        Driver { runtime, console: Recorded::default(), folder }
    }

    /// Performs the effects of an action.
    pub fn perform(&mut self, effects: Vec<Effect>) {
        self.runtime.perform(effects, &mut self.console).unwrap();
    }

    /// Actions that follow an effect.
    pub fn answer(&mut self, effect: Effect) -> Vec<Action> {
        self.runtime.answer(effect, &mut self.console).unwrap()
    }

    /// The files in the folder of the explorer, as text.
    pub fn files(&self) -> BTreeMap<PathBuf, String> {
        let mut files = BTreeMap::new();
        let mut folders = vec![self.folder.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let text = String::from_utf8_lossy(&fs::read(&path).unwrap()).into_owned();
                    files.insert(path.strip_prefix(self.folder.path()).unwrap().to_owned(), text);
                }
            }
        }
        files
    }

    /// The text of a file in the folder of the explorer.
    pub fn file(&self, name: &str) -> String {
        self.files().remove(Path::new(name)).unwrap_or_else(|| panic!("no {name}"))
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
