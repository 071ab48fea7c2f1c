//! The results over the random profiles that are shown. Until the first profiles of a changed scene
//! are computed, these are the results before the change: over a slow line, results that disappear
//! and come back would be transmitted twice.

use super::app::App;
use asperity_study::Ensemble;

pub struct ShownEnsemble<'a> {
    pub ensemble: &'a Ensemble,
    /// True if the results belong to the scene before its last change.
    pub is_former: bool,
}

impl App {
    /// Returns the results over the random profiles; `None` if there are none, and if none follow.
    pub fn shown_ensemble(&self) -> Option<ShownEnsemble<'_>> {
        if let Some(ensemble) = self.studies.value::<Ensemble>() {
            return Some(ShownEnsemble {
                ensemble,
                is_former: false,
            });
        }
        if !self.awaits_profiles() {
            return None;
        }
        let ensemble = self.studies.former::<Ensemble>()?;
        Some(ShownEnsemble {
            ensemble,
            is_former: true,
        })
    }

    /// Returns true if the scene has random profiles, which the explorer computes next.
    pub fn awaits_profiles(&self) -> bool {
        let has_failed = self.studies.failure::<Ensemble>().is_some();
        Ensemble::profiles_of(&self.edit.scene) > 1
            && self.edit.count_profiles() > 1
            && !has_failed
            && self.studies.value::<Ensemble>().is_none()
    }
}
