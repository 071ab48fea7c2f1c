//! Adhesion of random profiles of a measured surface, beside its spectra: the spread over profiles and that of the fit.

use super::snapshot::SolvedScene;
use crate::scene::{Roughness, Scene, Solver};
use crate::simulation::RunError;
use crate::study::{MeasuredAdhesion, ProfileAdhesion};
use crate::surface::{EquivalentLine, read_faces};
use std::path::Path;
use std::sync::Arc;

/// Random profiles.
pub const PROFILES: usize = 16;

/// Adhesion of random profiles of a scene, as far as computed.
#[derive(Clone, Debug, PartialEq)]
pub struct AdhesionSpread {
    scene: Arc<Scene>,
    /// The profiles so far.
    pub found: MeasuredAdhesion,
}

impl AdhesionSpread {
    /// No profile yet of a computed scene; `None` unless its profile is an equivalent line that adheres.
    #[must_use]
    pub fn new(computed: &SolvedScene) -> Option<Self> {
        let scene = &computed.scene;
        let is_measured = matches!(scene.roughness, Some(Roughness::Measured { .. }));
        let adheres = scene.adhesion.is_some() && scene.numerics.solver == Solver::Exact;
        (is_measured && adheres && !scene.measured_as_line())
            .then(|| AdhesionSpread { scene: Arc::clone(scene), found: MeasuredAdhesion::default() })
    }

    /// Returns true once all profiles are computed.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.found.profiles.len() >= PROFILES
    }

    /// Computes the missing profiles. `report` receives them after each; an interruption by `stop` keeps them.
    ///
    /// # Errors
    /// When the surface cannot be read, a profile or its contact fails, or `stop` interrupts.
    pub fn compute(
        &mut self,
        folder: &Path,
        stop: &dyn Fn() -> bool,
        report: &mut dyn FnMut(&AdhesionSpread),
    ) -> Result<(), RunError> {
        let scene = Arc::clone(&self.scene);
        let line =
            EquivalentLine::new(&read_faces(&scene.measured_paths(folder))?, &scene.measured_options())?;
        let first = scene.seed().unwrap_or(0);
        while !self.is_whole() {
            let seed = first.wrapping_add(self.found.profiles.len() as u64);
            self.found.profiles.push(ProfileAdhesion::solve(&scene, &line, seed, stop)?);
            report(self);
        }
        Ok(())
    }
}
