//! The explorer with an engine that panics on the seed 13 and computes without end on the seed 14, or with the argument
//! `draw` one whose view panics. The tests check that the explorer reports this and continues, shows keys at once under
//! any load of the engine, or else restores the terminal.

use asperity::contact::ContactError;
use asperity::explorer::app::App;
use asperity::explorer::worker::Engine;
use asperity::explorer::{Options, open_with, view};
use asperity::scene::{DEFAULT, Roughness, Scene, open};
use asperity::simulation::{AfterLeg, Outcome, RunError, Simulation};
use asperity::surface::Line;
use ratatui::Frame;
use std::process::ExitCode;
use std::thread::sleep;
use std::time::Duration;

/// An engine that panics on the seed 13, takes all its time on the seed 14, and simulates otherwise.
struct Superstitious(Simulation);

impl Engine for Superstitious {
    fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError> {
        beware(scene);
        if matches!(scene.roughness, Some(Roughness::SelfAffine { seed: 14, .. })) {
            while !stop() {
                sleep(Duration::from_millis(1));
            }
            return Err(ContactError::Interrupted.into());
        }
        self.0.run(scene, stop, after)
    }

    fn line(&self) -> Option<&Line> {
        self.0.line()
    }
}

/// Panics on the seed 13.
fn beware(scene: &Scene) {
    if let Some(Roughness::SelfAffine { seed: 13, .. }) = scene.roughness {
        panic!("thirteen is unlucky");
    }
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
    let opened = if std::env::args().nth(1).as_deref() == Some("draw") {
        open_with(document, Options::default(), Box::new(Simulation::default()), draw)
    } else {
        let engine = Box::new(Superstitious(Simulation::default()));
        open_with(document, Options::default(), engine, view::draw)
    };
    match opened {
        Ok(_) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
