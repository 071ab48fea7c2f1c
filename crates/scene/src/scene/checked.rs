//! A checked scene: the only kind of scene that is computed.

use std::mem::take;
use std::ops::Deref;

use super::check::check;
use super::errors::{MOST_LISTED, Origin, SceneError, SceneErrors};
use super::model::{Observer, Scene};
use super::text::index::Text;
use serde::Serialize;

/// A scene whose values have been checked, the only kind that is computed. Its fields are read as the fields of a
/// [`Scene`]; a change is checked again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckedScene(Scene);

impl Scene {
    /// This scene, checked.
    ///
    /// # Errors
    /// All invalid values, each with its field and its allowed range.
    pub fn checked(self) -> Result<CheckedScene, SceneErrors> {
        CheckedScene::of(self, None, |_| Origin::Scene)
    }
}

impl Scene {
    /// Removes all that changes no figure: texts, what is observed, and all but a few samples of the curve, as figures are at
    /// the ends of loading stages or exact extremes.
    pub fn strip(&mut self, samples: u64) {
        self.title.clear();
        self.notice.clear();
        self.observe.clear();
        self.numerics.samples = self.numerics.samples.min(samples);
    }
}

impl CheckedScene {
    /// The checked scene of a text. Its errors have numbers that are not finite as the text has them: `1e999`.
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

    /// This scene with a change.
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

    /// This scene with another seed of its random phases, if it has any: each seed is allowed.
    #[must_use]
    pub fn with_seed(&self, seed: u64) -> CheckedScene {
        let mut scene = self.0.clone();
        scene.set_seed(seed);
        CheckedScene(scene)
    }

    /// This scene for its figures alone, see [`Scene::strip`].
    pub fn stripped(&self, samples: u64) -> CheckedScene {
        let mut scene = self.0.clone();
        scene.strip(samples);
        CheckedScene(scene)
    }

    /// This scene, with one more quantity observed beside its force curve.
    pub fn observing(&self, observer: Observer) -> CheckedScene {
        let mut scene = self.0.clone();
        if !scene.observe.contains(&observer) {
            scene.observe.push(observer);
        }
        CheckedScene(scene)
    }

    /// This scene with other names of its files, which are checked by reading the files.
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
