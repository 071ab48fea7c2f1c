//! Arguments that name a scene and change its fields, and the computation of this scene.

use super::error::CliError;
use super::progress::{ProgressLine, Task, watched};
use crate::explorer::recognition::no_scene;
use asperity_data::{Control, counted, parallel, printable};
use asperity_report::{Format, Report};
use asperity_scene::library::open_argument;
use asperity_scene::{CheckedScene, Document, Outcome, RunError, Scene, Simulation};
use asperity_study::{Axis, Ensemble, Staircase};
use clap::Args;
use std::fmt::Display;
use std::io;
use std::io::Write;
use std::path::Path;

/// Largest number of random profiles of a scene.
pub(super) const MOST_LINES: i64 = 1_000_000;

/// A scene, with overrides.
#[derive(Args, Debug)]
pub struct SceneArguments {
    /// A scene file, or the name of a built-in scene (see `asperity presets list`)
    ///
    /// `-` is standard input. A pipe is read up to its end.
    pub scene: String,
    #[command(flatten)]
    pub overrides: Overrides,
}

/// Random profiles of a scene, and threads that share them.
#[derive(Args, Debug)]
pub struct ProfileArguments {
    /// Compute COUNT random profiles; default: 16, or 1 for a fixed profile
    ///
    /// Their seeds begin with the seed of the scene.
    #[arg(long = "profiles", value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=MOST_LINES), verbatim_doc_comment)]
    pub lines: Option<u32>,
    /// Threads that share the profiles; default: one for each core
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
}

impl ProfileArguments {
    /// Returns the number of random profiles to be computed for a scene.
    pub(super) fn count(&self, scene: &Scene) -> u64 {
        self.lines
            .map_or_else(|| Ensemble::profiles_of(scene), u64::from)
    }

    pub(super) fn threads(&self) -> usize {
        threads(self.jobs)
    }
}

/// Overrides of a scene's fields.
#[derive(Args, Debug)]
pub struct Overrides {
    /// Change a field of the scene; may be repeated
    ///
    /// The value is written as in a scene file. A number may have an SI prefix and its unit;
    /// None removes an optional part:
    ///   --set adhesion.work=50mJ/m2 --set numerics.points=16k --set form=None
    ///   --set "loading=[ToForce(2e-3), ToSeparation]"
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = path_and_value, verbatim_doc_comment)]
    pub set: Vec<(String, String)>,
}

impl SceneArguments {
    /// Opens the scene and applies the overrides.
    pub(super) fn open(&self) -> Result<Document, CliError> {
        self.overrides.apply(open_scene(&self.scene)?)
    }
}

/// Writes to standard error the premises of the model that a scene does not meet. Commands call
/// this function if their results contain no warnings, as in tables, figures and times.
pub(super) fn warn(document: &Document, warnings: &[impl Display]) {
    for warning in warnings {
        warn_of(document.name(), warning);
    }
}

/// Writes to standard error one premise of the model that a scene or a measured file does not meet.
/// `name` is the name of the scene or of the file.
pub(super) fn warn_of(name: &str, warning: &impl Display) {
    // An error in writing is ignored, so that the command continues even if standard error is
    // closed.
    let _ = writeln!(io::stderr(), "warning: {}: {warning}", printable(name));
}

/// Returns true if a result in this format contains its warnings.
pub(super) fn holds_warnings(format: Format) -> bool {
    matches!(format, Format::Text | Format::Json)
}

/// Writes the warnings of a report to standard error, unless its text or JSON states them. A table
/// or a figure also has them, but not where the user sees them at once.
pub(super) fn warn_beside(document: &Document, report: &impl Report, format: Format) {
    if !holds_warnings(format) {
        warn(document, &report.warnings());
    }
}

/// Opens the scene that an argument of the command line names. If the argument is a measured file
/// and not a scene, the error message names the commands that read such files.
pub(super) fn open_scene(name: &str) -> Result<Document, CliError> {
    open_argument(name).map_err(|errors| match no_scene(Path::new(name)) {
        Some(way) => CliError::message(way),
        None => errors.into(),
    })
}

impl Overrides {
    pub(super) fn apply(&self, document: Document) -> Result<Document, CliError> {
        if self.set.is_empty() {
            Ok(document)
        } else {
            Ok(document.set_all(&self.set)?)
        }
    }
}

/// Returns a simulation for a scene. Paths in the scene are relative to the folder of the scene
/// file.
pub(super) fn simulation_of(document: &Document) -> Simulation {
    Simulation::new(document.resolve("")).for_one_scene()
}

/// Computes a scene. On a terminal, the number of computed loading stages is shown meanwhile.
pub(super) fn compute(document: &Document, scene: &CheckedScene) -> Result<Outcome, CliError> {
    let mut simulation = simulation_of(document);
    compute_stages(document, scene, |stop, after| {
        simulation.run(scene, stop, &mut |stage, _, _| {
            after(stage);
            Ok(())
        })
    })
}

/// Computes a scene with the function `run`. Its first argument is a function that returns true if
/// the computation should stop. Its second argument is a function that must be called after each
/// loading stage. On a terminal, the number of computed loading stages is shown meanwhile.
pub(super) fn compute_stages(
    document: &Document,
    scene: &Scene,
    run: impl FnOnce(&Stop<'_>, &mut dyn FnMut(usize)) -> Result<Outcome, RunError>,
) -> Result<Outcome, CliError> {
    let stages = scene.loading.len();
    let task = Task {
        name: Some(document.name()),
        threads: 1,
        begins: format!("0 of {}", counted(stages as u64, "stage")),
    };
    watched(
        task,
        |done: &usize, line: &mut ProgressLine| {
            line.show(
                &format!("{done} of {}", counted(stages as u64, "stage")),
                None,
            )
        },
        |mut control: Control<'_, usize>| {
            let stop = control.stop();
            run(stop, &mut |stage| control.report(stage + 1))
        },
    )
}

/// Function that returns true if a computation is to be stopped.
type Stop<'a> = dyn Fn() -> bool + Sync + 'a;

/// Computes the pull-off force of a scene as a function of the preload.
pub(super) fn staircase_of(
    document: &Document,
    scene: &CheckedScene,
    preloads: &Axis,
    simulation: &mut Simulation,
) -> Result<Staircase, CliError> {
    let task = Task {
        name: Some(document.name()),
        threads: 1,
        begins: "0 preloads".to_owned(),
    };
    watched(
        task,
        |staircase: &Staircase, line: &mut ProgressLine| {
            line.show(&format!("{} preloads", staircase.forces.len()), None)
        },
        |control| Staircase::of(scene, preloads, simulation, control),
    )
}

/// Returns the number of threads among which the profiles are divided: the number that the user has
/// requested or, by default, one for each core.
pub(super) fn threads(asked: Option<u16>) -> usize {
    asked.map_or_else(parallel::threads, usize::from)
}

fn path_and_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((path, value)) if !path.trim().is_empty() => Ok((path.trim().into(), value.into())),
        _ => Err("a field and its value are expected, such as adhesion.work=0.1".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overrides_are_a_path_and_all_that_follows() {
        let both = |path: &str, value: &str| Ok((path.to_string(), value.to_string()));
        assert_eq!(
            path_and_value("adhesion.work=0.1"),
            both("adhesion.work", "0.1")
        );
        assert_eq!(path_and_value("title = \"a=b\""), both("title", " \"a=b\""));
        assert!(path_and_value("adhesion.work").is_err());
        assert!(path_and_value("=0.1").is_err());
    }
}
