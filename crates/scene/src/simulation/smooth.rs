//! F_smooth: the pull-off force of the body of a scene without its roughness.

use super::outcome::RunError;
use super::stages::Simulation;
use super::stages::{SmoothProfile, profile_of};
use crate::analysis::governing::Governing;
use crate::reference::smooth_pull_off_force;
use crate::scene::checked::CheckedScene;
use crate::scene::model::FEW_SAMPLES;
use crate::scene::model::Scene;
use asperity_contact::motion::Body;
use asperity_contact::{Figures, Move, NominalForm, Profile, Reversal};
use asperity_surface::Form;
use asperity_surface::lines::Line;

impl Simulation {
    /// Computes the pull-off force F_smooth in N that the body of a scene has without its
    /// roughness, after the preload in `figures`. Returns `None` without adhesion.
    ///
    /// # Errors
    /// Returns an error if there is not enough memory, or if the table of the form cannot be read.
    pub fn smooth_pull_off_force(
        &mut self,
        scene: &CheckedScene,
        governing: &Governing,
        figures: &Figures,
    ) -> Result<Option<f64>, RunError> {
        let Some(works) = governing.adhesive_works() else {
            return Ok(None);
        };
        let preload = figures.preload.unwrap_or(0.0).max(0.0);
        let closed_form = smooth_pull_off_force(
            scene.form.as_ref(),
            scene.length,
            governing.modulus,
            works,
            preload,
        );
        if closed_form.is_some() {
            return Ok(closed_form);
        }
        let Some(form) = &scene.form else {
            return Ok(None);
        };
        let is_smooth = scene.roughness.is_none();
        let is_own_preload = is_smooth && figures.preload >= Some(0.0);
        if is_own_preload && figures.pull_off_force.is_some() {
            return Ok(figures.pull_off_force);
        }
        let profile = if is_smooth {
            self.profile(scene)?
        } else {
            self.smooth_profile(scene, form)?
        };
        let contact = governing
            .contact(&profile)?
            .edges(scene.numerics.edges)
            .build()?;
        let mut force = None;
        let mut body = Body::new(&contact, FEW_SAMPLES as usize);
        let unloaded = body.reversals(
            &[Move::ToForce(preload)],
            &[],
            &mut |_, reversal: Reversal| {
                force = reversal.pull_off_force();
                Ok(())
            },
        );
        match unloaded {
            Ok(()) => Ok(force),
            Err(error) if error.is_out_of_reach() => Ok(None),
            Err(error) => Err(error.into()),
        }
    }

    /// Returns the profile of a form without roughness. If the last scene had the same form, length
    /// and number of springs, the profile of the last scene is used again.
    fn smooth_profile(&mut self, scene: &Scene, form: &Form) -> Result<Profile, RunError> {
        let length = scene.length;
        let points = scene.numerics.points;
        if let Some(kept) = &self.smooth
            && kept.form == *form
            && kept.length == length
            && kept.points == points
        {
            return Ok(kept.profile.clone());
        }
        self.smooth = None;
        let line = Line::new(length, points as usize, Some(form), None, 0.0)?;
        let profile = profile_of(&line, NominalForm::Curved)?;
        self.smooth = Some(SmoothProfile {
            form: form.clone(),
            length,
            points,
            profile: profile.clone(),
        });
        Ok(profile)
    }
}
