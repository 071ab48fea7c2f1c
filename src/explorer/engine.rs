//! The solver behind the worker.

use crate::scene::Scene;
use crate::simulation::{AfterLeg, Outcome, RunError, Simulation};
use crate::surface::Line;

/// Solver of scenes: [`Simulation`], or a substitute in tests.
pub trait Engine: Send {
    /// Computes a scene; see [`Simulation::run`].
    ///
    /// # Errors
    /// When the scene fails or `stop` interrupts.
    fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError>;

    /// The line of the last scene.
    fn line(&self) -> Option<&Line>;
}

impl Engine for Simulation {
    fn run(
        &mut self,
        scene: &Scene,
        stop: &dyn Fn() -> bool,
        after: &mut AfterLeg<'_>,
    ) -> Result<Outcome, RunError> {
        Simulation::run(self, scene, stop, after)
    }

    fn line(&self) -> Option<&Line> {
        Simulation::line(self)
    }
}
