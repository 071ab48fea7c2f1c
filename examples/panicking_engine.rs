//! The explorer with an engine that panics on the seed 13. The tests open it to see that the explorer
//! says so and goes on.

use asperity::explorer::open_with;
use asperity::explorer::worker::Engine;
use asperity::scene::{DEFAULT, Roughness, Scene, open};
use asperity::simulation::{AfterLeg, Outcome, RunError, Simulation};
use asperity::surface::Line;
use std::process::ExitCode;

/// An engine that panics on the seed 13, and simulates otherwise.
struct Superstitious(Simulation);

impl Engine for Superstitious {
    fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError> {
        if let Some(Roughness::SelfAffine { seed: 13, .. }) = scene.roughness {
            panic!("thirteen is unlucky");
        }
        self.0.run(scene, stop, after)
    }

    fn line(&self) -> Option<&Line> {
        self.0.line()
    }
}

fn main() -> ExitCode {
    let document = match open(DEFAULT) {
        Ok(document) => document,
        Err(errors) => {
            eprintln!("{errors}");
            return ExitCode::FAILURE;
        }
    };
    match open_with(document, Box::new(Superstitious(Simulation::default()))) {
        Ok(_) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
