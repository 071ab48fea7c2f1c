//! Scenes: named, read from files or from text, with other values of their fields.

use crate::failure::Failure;
use asperity::scene::{Document, SceneErrors, is_path, open};
use pyo3::prelude::*;

/// A checked scene: one problem with material, profile, adhesion, loading and numerics.
#[pyclass(frozen, module = "asperity._native")]
pub struct Scene {
    pub document: Document,
}

impl Scene {
    fn of(document: Result<Document, SceneErrors>) -> Result<Scene, Failure> {
        Ok(Scene { document: document? })
    }
}

#[pymethods]
impl Scene {
    /// Opens a built-in scene by its name, or the scene of a file.
    #[staticmethod]
    fn open(py: Python<'_>, name: &str) -> PyResult<Scene> {
        Scene::of(open(name)).map_err(|failure| match failure {
            Failure::Value(message) if is_path(name) => {
                Failure::of_files(&[name.into()], message).exception(py)
            }
            failure => failure.exception(py),
        })
    }

    /// Reads a scene from text; its files are relative to the working folder.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str) -> PyResult<Scene> {
        Scene::of(Document::parse(text, "scene")).map_err(|failure| failure.exception(py))
    }

    /// The scene with other values, given as pairs of a path and a value in the notation of a scene file.
    fn set(&self, py: Python<'_>, fields: Vec<(String, String)>) -> PyResult<Scene> {
        Scene::of(self.document.set_all(&fields)).map_err(|failure| failure.exception(py))
    }

    /// The text of the scene, as a file holds it.
    #[getter]
    fn text(&self) -> &str {
        self.document.text()
    }

    fn __repr__(&self) -> String {
        format!("<Scene {:?}>", self.document.title())
    }
}

/// Names and titles of the built-in scenes.
#[pyfunction]
pub fn presets() -> Vec<(&'static str, String)> {
    let title =
        |name: &str| open(name).map_or_else(|_| String::new(), |document| document.title().to_owned());
    asperity::scene::presets().iter().map(|preset| (preset.name, title(preset.name))).collect()
}
