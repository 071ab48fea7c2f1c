//! Scenes: named, read from files or from text, with other values of their fields.

use crate::failure::Failure;
use asperity::scene::library::is_path;
use asperity::scene::{Document, open};
use pyo3::prelude::*;

/// A checked scene: material, form, roughness, adhesion and loading of a contact, and settings of its computation.
#[pyclass(frozen, module = "asperity._native")]
pub struct Scene {
    pub document: Document,
}

#[pymethods]
impl Scene {
    /// Opens a built-in scene by its name, or a scene file by its path.
    #[staticmethod]
    fn open(name: &str) -> Result<Scene, Failure> {
        let document = open(name).map_err(|errors| match is_path(name) {
            true => Failure::of_files(&[name.into()], errors),
            false => errors.into(),
        });
        Ok(Scene { document: document? })
    }

    /// Reads the text of a scene. Files that the scene names are relative to the working folder.
    #[staticmethod]
    fn parse(text: &str) -> Result<Scene, Failure> {
        Ok(Scene { document: Document::parse(text, "scene")? })
    }

    /// Returns the scene with other values of fields, given as pairs of a path and a value in the notation of a scene file.
    fn set(&self, fields: Vec<(String, String)>) -> Result<Scene, Failure> {
        Ok(Scene { document: self.document.set_all(&fields)? })
    }

    /// Text of the scene, as a scene file holds it.
    #[getter]
    fn text(&self) -> &str {
        self.document.text()
    }

    fn __repr__(&self) -> String {
        format!("<Scene {:?}>", self.document.title())
    }
}

/// Returns the names of the built-in scenes.
#[pyfunction]
pub fn presets() -> Vec<&'static str> {
    asperity::scene::presets().iter().map(|preset| preset.name).collect()
}
