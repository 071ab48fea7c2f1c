//! Checked scenes. Only a checked scene can be computed.

use std::mem::take;
use std::ops::Deref;

use super::check::check;
use super::errors::{MOST_LISTED, Origin, SceneError, SceneErrors};
use super::model::{FEW_SAMPLES, Observer, Scene};
use super::text::index::Text;
use serde::Serialize;

/// A scene whose values are valid. It can be read like a [`Scene`], but its fields cannot be
/// changed.
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
    /// Removes the parts of the scene that do not affect forces and energies: the title, the notes
    /// and the [`Observer`]s. The number of points of the force curve is reduced to two for each
    /// loading stage.
    pub fn strip(&mut self) {
        self.title.clear();
        self.notice.clear();
        self.observe.clear();
        self.numerics.samples = self.numerics.samples.min(FEW_SAMPLES);
    }
}

impl CheckedScene {
    /// Checks a scene that was read from a text. If a number is not finite, the error message shows
    /// it as the text states it, such as `1e999`.
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

    /// Returns this scene with changes that the function `change` makes. The changed scene is
    /// checked again.
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

    /// Returns this scene with another seed of the random phases. A scene without a random profile
    /// is returned unchanged.
    #[must_use]
    pub fn with_seed(&self, seed: u64) -> CheckedScene {
        let mut scene = self.0.clone();
        scene.set_seed(seed);
        CheckedScene(scene)
    }

    /// Returns this scene without title, notes and [`Observer`]s, and with only two points of the
    /// force curve for each loading stage ([`Scene::strip`]). Forces and energies do not depend on
    /// these parts.
    pub fn stripped(&self) -> CheckedScene {
        let mut scene = self.0.clone();
        scene.strip();
        CheckedScene(scene)
    }

    /// Returns this scene with `observer` added: the computation then also records this quantity,
    /// beside the force curve.
    pub fn observing(&self, observer: Observer) -> CheckedScene {
        let mut scene = self.0.clone();
        if !scene.observe.contains(&observer) {
            scene.observe.push(observer);
        }
        CheckedScene(scene)
    }

    /// Returns this scene with other names of measured files. `rename` receives each name and
    /// returns the new name.
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
