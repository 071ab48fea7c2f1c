//! Profiles of rigid bodies, from heights or from the form and the roughness of a scene.

use crate::computing::computed;
use crate::quantity::{array, quantity, with_numbers};
use crate::scene::Scene;
use asperity::data::format_quantity;
use asperity::scene::{Document, Simulation};
use numpy::PyArray1;
use pyo3::prelude::*;

/// Profile of a rigid body: heights in m at equal distances, positive towards the half-space.
///
/// A profile of heights is taken as it is. A profile that `asperity.profile` makes of a form and a roughness knows both, and
/// so has a regime and a Tabor number once it is loaded.
#[pyclass(frozen, module = "asperity._native")]
pub struct Profile {
    pub profile: asperity::Profile,
    /// The scene whose form and roughness it has; `None` for heights.
    pub document: Option<Document>,
}

#[pymethods]
impl Profile {
    #[new]
    fn new(heights: &Bound<'_, PyAny>, spacing: &Bound<'_, PyAny>) -> PyResult<Self> {
        let spacing = quantity(spacing, "m", "spacing")?;
        with_numbers(heights, ("heights", 1), |heights, _| {
            Ok(Profile { profile: asperity::Profile::from_heights(heights, spacing)?, document: None })
        })
    }

    /// The profile of a scene.
    #[staticmethod]
    fn of_scene(py: Python<'_>, scene: &Scene) -> PyResult<Self> {
        let document = scene.document.clone();
        computed(py, None, |_| {
            let profile = Simulation::new(document.resolve("")).for_one_scene().profile(document.scene())?;
            Ok(Profile { profile, document: Some(document) })
        })
    }

    /// The scene with the form and the roughness of the profile; None for a profile of heights.
    #[getter]
    fn scene(&self) -> Option<Scene> {
        self.document.clone().map(|document| Scene { document })
    }

    /// Positions of the points along the profile, m; the profile begins at 0.
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, (0..self.profile.points()).map(|index| self.profile.position(index)).collect())
    }

    /// Heights, m.
    #[getter]
    fn heights<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.profile.heights().collect())
    }

    /// Gaps below the highest point, m.
    #[getter]
    fn gaps<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.profile.gaps().to_vec())
    }

    /// Distance between points, m.
    #[getter]
    fn spacing(&self) -> f64 {
        self.profile.spacing()
    }

    /// Length of the profile, m.
    #[getter]
    fn length(&self) -> f64 {
        self.profile.length()
    }

    fn __len__(&self) -> usize {
        self.profile.points()
    }

    fn __repr__(&self) -> String {
        format!("<Profile of {} points on {}>", self.__len__(), format_quantity(self.length(), "m"))
    }
}
