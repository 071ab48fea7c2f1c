//! Premises of the model that a scene, or the answer of a search, does not meet.

use super::axis::Axis;
use super::find::Found;
use super::plan::Plan;
use asperity_contact::Move;
use asperity_data::Warning;
use asperity_scene::{CheckedScene, Simulation};

/// Returns the premises of the model that a scene and its loading do not meet on its own profile.
/// If the scene cannot be computed, these are the premises that are known from its fields.
///
/// ```
/// use asperity_scene::Simulation;
///
/// let narrow = asperity_scene::open("jkr-sphere")?.set("length", "20 µm")?;
/// let warnings = asperity_study::trust::warnings_of(narrow.scene(), &mut Simulation::default());
/// assert_eq!(warnings[0].name(), "contact_at_ends");
/// # Ok::<(), asperity_scene::Error>(())
/// ```
pub fn warnings_of(scene: &CheckedScene, simulation: &mut Simulation) -> Vec<Warning> {
    let computed = simulation.compute(&scene.stripped());
    computed.map_or_else(|_| scene.warnings(), |outcome| outcome.warnings)
}

impl Found {
    /// Returns the premises of the model that the scene does not meet at the median answer, on its
    /// own profile. `scene` is the scene of the question, whose premises are returned if there is
    /// no median answer.
    pub fn warnings(&self, scene: &CheckedScene, simulation: &mut Simulation) -> Vec<Warning> {
        let answer = self.quantile(0.5).and_then(|value| self.scene_at(value));
        warnings_of(answer.as_ref().unwrap_or(scene), simulation)
    }

    /// Returns the scene of the question with this value of the number that is sought; `None` if
    /// the scene does not allow it.
    fn scene_at(&self, value: f64) -> Option<CheckedScene> {
        let question = &self.question;
        if question.is_of_preload() {
            let loading = vec![Move::ToForce(value), Move::ToSeparation];
            return question
                .plan
                .scene
                .clone()
                .checked()
                .ok()?
                .with(|scene| scene.loading = loading)
                .ok();
        }
        let axis = Axis {
            values: vec![value],
            ..question.axis.clone()
        };
        Plan {
            axes: vec![axis],
            ..question.plan.clone()
        }
        .scene_of(0)
        .ok()
    }
}
