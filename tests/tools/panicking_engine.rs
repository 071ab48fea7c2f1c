//! The explorer with a solver that panics on the seed 13 and computes without end on the seed 14,
//! or with the argument `draw` with a view that panics. The tests check that the explorer reports
//! this and continues, shows keys at once under any load of the solver, or else restores the
//! terminal.

use asperity::contact::ContactError;
use asperity::explorer::app::App;
use asperity::explorer::commands::table::bindings;
use asperity::explorer::config::Config;
use asperity::explorer::session::{Options, open as explore};
use asperity::explorer::view;
use asperity::scene::library::DEFAULT;
use asperity::scene::workload::AfterStage;
use asperity::scene::{CheckedScene, Scene, open};
use asperity::scene::{Outcome, RunError, Simulation};
use ratatui::Frame;
use std::process::ExitCode;
use std::thread::sleep;
use std::time::Duration;

/// Panics on the seed 13, takes all its time on the seed 14, and computes otherwise.
fn solve(
    simulation: &mut Simulation,
    scene: &CheckedScene,
    stop: &dyn Fn() -> bool,
    after: &mut AfterStage<'_>,
) -> Result<Outcome, RunError> {
    beware(scene);
    if scene.seed() == Some(14) {
        while !stop() {
            sleep(Duration::from_millis(1));
        }
        return Err(ContactError::Interrupted.into());
    }
    simulation.run(scene, stop, after)
}

/// Panics on the seed 13.
fn beware(scene: &Scene) {
    assert!(scene.seed() != Some(13), "thirteen is unlucky");
}

fn draw(frame: &mut Frame<'_>, app: &App) {
    beware(app.edit.document.scene());
    view::draw(frame, app);
}

fn main() -> ExitCode {
    let document = match open(DEFAULT) {
        Ok(document) => document,
        Err(errors) => {
            eprintln!("{errors}");
            return ExitCode::FAILURE;
        }
    };
    let options = Options::new(Config::new(bindings()));
    let opened = if std::env::args().nth(1).as_deref() == Some("draw") {
        explore(document, options, Simulation::run, draw)
    } else {
        explore(document, options, solve, view::draw)
    };
    match opened {
        Ok(_) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
