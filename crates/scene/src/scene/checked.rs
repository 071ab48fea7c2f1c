//! A checked scene: the only kind of scene that is computed.

use std::mem::take;
use std::ops::Deref;

use super::check::check;
use super::errors::{MOST_LISTED, Origin, SceneError, SceneErrors};
use super::model::{Observer, Scene};
use super::text::index::Text;
use serde::Serialize;

/// A scene whose values have been checked. It can be read like a [`Scene`]; a changed one is checked again.
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
    /// Checks this scene.
    ///
    /// # Errors
    /// All invalid values, each with its field and its allowed range.
    pub fn checked(self) -> Result<CheckedScene, SceneErrors> {
        CheckedScene::of(self, None, |_| Origin::Scene)
    }
}

impl Scene {
    /// Removes what does not affect the figures: texts, observed quantities, and all but `samples` samples of the curve,
    /// since figures are at the ends of loading stages or exact extremes.
    pub fn strip(&mut self, samples: u64) {
        self.title.clear();
        self.notice.clear();
        self.observe.clear();
        self.numerics.samples = self.numerics.samples.min(samples);
    }
}

impl CheckedScene {
    /// Checks a scene that was read from a text. Errors of numbers that are not finite show them as written, `1e999`.
    pub(super) fn of(
        scene: Scene,
        text: Option<&Text>,
        origin: impl Fn(&SceneError) -> Origin,
    ) -> Result<CheckedScene, SceneErrors> {
        let mut errors = check(&scene);
        for error in errors.iter_mut().take(MOST_LISTED).filter(|error| error.value == "NaN") {
            let written = text.and_then(|text| text.value(&error.field));
            error.value = written.map_or(take(&mut error.value), str::to_owned);
        }
        SceneErrors::result(errors, origin)?;
        Ok(CheckedScene(scene))
    }

    /// This scene with a change, checked.
    ///
    /// # Errors
    /// All values that the change makes invalid.
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

    /// This scene with another seed of its random phases, if it has any. Every seed is allowed.
    #[must_use]
    pub fn with_seed(&self, seed: u64) -> CheckedScene {
        let mut scene = self.0.clone();
        scene.set_seed(seed);
        CheckedScene(scene)
    }

    /// This scene reduced to what its figures need; see [`Scene::strip`].
    pub fn stripped(&self, samples: u64) -> CheckedScene {
        let mut scene = self.0.clone();
        scene.strip(samples);
        CheckedScene(scene)
    }

    /// This scene with one more quantity observed besides the force curve.
    pub fn observing(&self, observer: Observer) -> CheckedScene {
        let mut scene = self.0.clone();
        if !scene.observe.contains(&observer) {
            scene.observe.push(observer);
        }
        CheckedScene(scene)
    }

    /// This scene with its files renamed. Names of files need no check here: reading the files checks them.
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
