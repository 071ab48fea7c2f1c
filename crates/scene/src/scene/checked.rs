//! Checked scenes. Only a checked scene can be computed.

use std::mem::take;
use std::ops::Deref;

use super::check::check;
use super::errors::{MOST_LISTED, Origin, SceneError, SceneErrors};
use super::model::{FEW_SAMPLES, Observer, Scene};
use super::text::index::Text;
use serde::Serialize;

/// A scene whose values are valid. A `CheckedScene` can be read like a [`Scene`].
///
/// ```
/// use asperity_scene::{Material, Scene};
///
/// let scene = Scene::new(Material::effective(1.0e6), 1.0e-4).checked()?;
/// assert_eq!(scene.spacing(), 1.0e-4 / scene.numerics.points as f64);
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckedScene(Scene);

impl Scene {
    /// Checks all values of this scene.
    ///
    /// # Errors
    /// Returns an error for each invalid value, with its field and its allowed range.
    pub fn checked(self) -> Result<CheckedScene, SceneErrors> {
        CheckedScene::of(self, None, |_| Origin::Scene)
    }
}

impl Scene {
    /// Removes what forces and energies do not depend on: the title, the notes, the [`Observer`]s,
    /// and all points of the force curve except two on each loading stage.
    pub fn strip(&mut self) {
        self.title.clear();
        self.notice.clear();
        self.observe.clear();
        self.numerics.samples = self.numerics.samples.min(FEW_SAMPLES);
    }
}

impl CheckedScene {
    /// Checks a scene that was read from a text. Errors show numbers that are not finite as they
    /// are written: `1e999`.
    pub(super) fn of(
        scene: Scene,
        text: Option<&Text>,
        origin: impl Fn(&SceneError) -> Origin,
    ) -> Result<CheckedScene, SceneErrors> {
        let mut errors = check(&scene);
        for error in errors
            .iter_mut()
            .take(MOST_LISTED)
            .filter(|error| error.value == "NaN")
        {
            let written = text.and_then(|text| text.value(&error.field));
            error.value = written.map_or(take(&mut error.value), str::to_owned);
        }
        SceneErrors::result(errors, origin)?;
        Ok(CheckedScene(scene))
    }

    /// Returns this scene after `change`, checked anew.
    ///
    /// # Errors
    /// Returns an error for each value that the change makes invalid.
    ///
    /// ```
    /// let sphere = asperity_scene::open("jkr-sphere")?;
    /// let coarse = sphere.scene().with(|scene| scene.numerics.points = 1024)?;
    /// assert_eq!(coarse.numerics.points, 1024);
    /// assert!(sphere.scene().with(|scene| scene.numerics.points = 0).is_err());
    /// # Ok::<(), asperity_scene::SceneErrors>(())
    /// ```
    pub fn with(&self, change: impl FnOnce(&mut Scene)) -> Result<CheckedScene, SceneErrors> {
        let mut scene = self.0.clone();
        change(&mut scene);
        scene.checked()
    }

    /// Returns this scene with another seed of the random phases, if the profile is random.
    #[must_use]
    pub fn with_seed(&self, seed: u64) -> CheckedScene {
        let mut scene = self.0.clone();
        scene.set_seed(seed);
        CheckedScene(scene)
    }

    /// Returns this scene without the parts that its forces and energies do not depend on, as
    /// [`Scene::strip`] removes them.
    pub fn stripped(&self) -> CheckedScene {
        let mut scene = self.0.clone();
        scene.strip();
        CheckedScene(scene)
    }

    /// Returns this scene with `observer` among the quantities that are recorded in addition to the
    /// force curve.
    pub fn observing(&self, observer: Observer) -> CheckedScene {
        let mut scene = self.0.clone();
        if !scene.observe.contains(&observer) {
            scene.observe.push(observer);
        }
        CheckedScene(scene)
    }

    /// Returns this scene with each name of a measured file replaced by the name that `rename`
    /// returns.
    #[must_use]
    pub fn with_files_named(&self, rename: impl Fn(&str) -> String) -> CheckedScene {
        let mut scene = self.0.clone();
        scene.rename_measured_files(rename);
        CheckedScene(scene)
    }
}

impl Deref for CheckedScene {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        &self.0
    }
}
