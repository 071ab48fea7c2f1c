//! Adhesion of random profiles of a measured surface, beside its spectra: the spread over profiles and that of the fit.

use super::snapshot::SolvedScene;
use crate::scene::{Roughness, Scene, Solver};
use crate::simulation::{RunError, measured_options};
use crate::study::{MeasuredAdhesion, ProfileAdhesion};
use crate::surface::EquivalentLine;
use std::path::Path;
use std::sync::Arc;

/// Random profiles.
pub const PROFILES: usize = 16;

/// Adhesion of random profiles of the present scene, as far as it is computed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AdhesionSpread {
    /// The profiles so far.
    pub found: Arc<MeasuredAdhesion>,
    /// Reason for which the computation ended early.
    pub failed: Option<String>,
    /// True if the scene has just been edited: somebody who holds a key down wants the machine.
    pub edited: bool,
}

impl AdhesionSpread {
    /// Forgets the scene, which has been changed.
    pub fn renew(&mut self) {
        *self = AdhesionSpread { edited: true, ..AdhesionSpread::default() };
    }

    /// Returns true for an equivalent line that adheres.
    #[must_use]
    pub fn is_of(scene: &Scene) -> bool {
        let is_measured =
            matches!(scene.roughness, Some(Roughness::Measured { .. })) && !scene.measured_as_line();
        is_measured && scene.adhesion.is_some() && scene.numerics.solver == Solver::Exact
    }

    /// The profiles to be gone on with, `None` once all are there or where there are none.
    #[must_use]
    pub fn wanted(&self, computed: &SolvedScene) -> Option<Arc<MeasuredAdhesion>> {
        let goes_on = self.failed.is_none() && self.found.profiles.len() < PROFILES;
        (goes_on && AdhesionSpread::is_of(&computed.scene)).then(|| Arc::clone(&self.found))
    }
}

/// Computes the missing profiles. `tell` receives them after each; they are kept where `stop` interrupts.
///
/// # Errors
/// When the surface cannot be read, or a profile or its contact fails, or `stop` says so.
pub fn compute(
    found: &mut MeasuredAdhesion,
    scene: &Scene,
    folder: &Path,
    stop: &dyn Fn() -> bool,
    tell: &mut dyn FnMut(&MeasuredAdhesion),
) -> Result<(), RunError> {
    let files: Vec<_> = scene.measured_files().into_iter().map(|file| folder.join(file)).collect();
    let line = EquivalentLine::read(&files, &measured_options(scene), &mut |_| ())?;
    let first = scene.seed().unwrap_or(0);
    while found.profiles.len() < PROFILES {
        let seed = first.wrapping_add(found.profiles.len() as u64);
        found.profiles.push(ProfileAdhesion::solve(scene, &line, seed, stop)?);
        tell(found);
    }
    Ok(())
}
