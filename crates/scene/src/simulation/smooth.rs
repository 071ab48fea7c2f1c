//! F_smooth: the adhesion force of the body of a scene without its roughness.

use super::outcome::RunError;
use super::reversals::FEW_SAMPLES;
use super::stages::Simulation;
use super::stages::SmoothSprings;
use crate::analysis::figures::Figures;
use crate::analysis::governing::Governing;
use crate::reference::smooth_adhesion_force;
use crate::scene::checked::CheckedScene;
use crate::scene::model::Scene;
use asperity_contact::Move;
use asperity_contact::{Body, Contact, Foundation, Reversal, Springs};
use asperity_surface::Form;
use asperity_surface::Line;
use std::sync::Arc;

impl Simulation {
    /// Adhesion force of the body of a scene without its roughness, N, after the preload in `figures`, or after zero force
    /// if the preload is not compressive; `None` without adhesion. In closed form where there is one, otherwise on the
    /// springs of the scene.
    ///
    /// # Errors
    /// Memory is insufficient or the form cannot be read.
    pub fn smooth_adhesion_force(
        &mut self,
        scene: &CheckedScene,
        governing: &Governing,
        figures: &Figures,
    ) -> Result<Option<f64>, RunError> {
        let Some(works) = governing.adhesive_works() else { return Ok(None) };
        let (length, effective_modulus) = (scene.length, governing.effective_modulus);
        let preload = figures.preload.unwrap_or(0.0).max(0.0);
        let closed = smooth_adhesion_force(scene.form.as_ref(), length, effective_modulus, works, preload);
        let Some(form) = scene.form.as_ref().filter(|_| closed.is_none()) else { return Ok(closed) };
        let is_smooth = scene.roughness.is_none();
        if let (Some(own), true) = (figures.adhesion_force, is_smooth && figures.preload >= Some(0.0)) {
            return Ok(Some(own));
        }
        let springs = if is_smooth { self.springs_of(scene)? } else { self.smooth_springs(scene, form)? };
        let spacing = length / scene.numerics.points as f64;
        let foundation = Foundation { spacing, effective_modulus, length };
        let rule = governing.hess_rule(foundation);
        let contact = Contact::of(springs, scene.numerics.edges, foundation, rule);
        let mut force = None;
        let mut see = |_, reversal: Reversal| {
            force = reversal.adhesion_force();
            Ok(())
        };
        match Body::new(&contact, FEW_SAMPLES as usize).reversals(&[Move::ToForce(preload)], &[], &mut see) {
            Err(error) if error.is_out_of_reach() => Ok(None),
            Err(error) => Err(error.into()),
            Ok(()) => Ok(force),
        }
    }

    /// Springs under a form without roughness: kept from the last scene if form, length and number are the same, or made.
    fn smooth_springs(&mut self, scene: &Scene, form: &Form) -> Result<Arc<Springs>, RunError> {
        let (length, points) = (scene.length, scene.numerics.points);
        let is_same = |of: &&SmoothSprings| of.form == *form && of.length == length && of.points == points;
        if let Some(known) = self.smooth.as_ref().filter(is_same) {
            return Ok(Arc::clone(&known.springs));
        }
        self.smooth = None;
        let line = Line::new(length, points as usize, Some(form), None, 0.0)?;
        let springs = Arc::new(Springs::new(line.gaps));
        self.smooth =
            Some(SmoothSprings { form: form.clone(), length, points, springs: Arc::clone(&springs) });
        Ok(springs)
    }
}
