//! Profiles of rigid bodies, from heights or from the form and the roughness of a scene.

use crate::computing::computed;
use crate::quantity::{array, quantity, with_numbers};
use crate::scene::Scene;
use asperity::scene::{Document, Simulation};
use asperity::surface::Line;
use numpy::PyArray1;
use pyo3::prelude::*;

/// Profile of a rigid body: heights in m at equal distances, positive towards the half-space.
///
/// A profile of heights is taken as it is. A profile that `asperity.profile` makes of a form and a roughness knows both, and
/// so has a regime and a Tabor number once it is loaded.
#[pyclass(frozen, module = "asperity._native")]
pub struct Profile {
    pub shape: Shape,
}

/// Where a profile comes from.
pub enum Shape {
    Heights(asperity::Profile),
    /// The form and the roughness of a scene.
    Scene(Line, Document),
}

#[pymethods]
impl Profile {
    #[new]
    fn new(heights: &Bound<'_, PyAny>, spacing: &Bound<'_, PyAny>) -> PyResult<Self> {
        let spacing = quantity(spacing, "m", "spacing")?;
        with_numbers(heights, "heights", |heights| {
            Ok(Profile { shape: Shape::Heights(asperity::Profile::from_heights(heights, spacing)?) })
        })
    }

    /// The profile of a scene.
    #[staticmethod]
    fn of_scene(py: Python<'_>, scene: &Scene) -> PyResult<Self> {
        let document = scene.document.clone();
        computed(py, None, |_| {
            let mut simulation = Simulation::new(document.resolve("")).for_one_scene();
            let line = simulation.make_line(document.scene())?.0.clone();
            Ok(Profile { shape: Shape::Scene(line, document) })
        })
    }

    /// The scene with the form and the roughness of the profile; None for a profile of heights.
    #[getter]
    fn scene(&self) -> Option<Scene> {
        match &self.shape {
            Shape::Heights(_) => None,
            Shape::Scene(_, document) => Some(Scene { document: document.clone() }),
        }
    }

    /// Positions of the points along the profile, m; 0 in the middle.
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let (spacing, length) = (self.spacing(), self.length());
        let position = |index| (index as f64 + 0.5) * spacing - 0.5 * length;
        array(
            py,
            match &self.shape {
                Shape::Heights(profile) => (0..profile.points()).map(position).collect(),
                Shape::Scene(line, _) => (0..line.gaps.len()).map(|index| line.position(index)).collect(),
            },
        )
    }

    /// Heights, m.
    #[getter]
    fn heights<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(
            py,
            match &self.shape {
                Shape::Heights(profile) => profile.heights().collect(),
                Shape::Scene(line, _) => line.heights().collect(),
            },
        )
    }

    /// Gaps below the highest point, m.
    #[getter]
    fn gaps<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(
            py,
            match &self.shape {
                Shape::Heights(profile) => profile.gaps().to_vec(),
                Shape::Scene(line, _) => line.gaps.to_vec(),
            },
        )
    }

    /// Distance between points, m.
    #[getter]
    pub fn spacing(&self) -> f64 {
        match &self.shape {
            Shape::Heights(profile) => profile.spacing(),
            Shape::Scene(line, _) => line.spacing,
        }
    }

    /// Length of the profile, m.
    #[getter]
    fn length(&self) -> f64 {
        match &self.shape {
            Shape::Heights(profile) => profile.length(),
            Shape::Scene(line, _) => line.length,
        }
    }

    fn __len__(&self) -> usize {
        match &self.shape {
            Shape::Heights(profile) => profile.points(),
            Shape::Scene(line, _) => line.gaps.len(),
        }
    }

    fn __repr__(&self) -> String {
        let length = asperity::data::format_quantity(self.length(), "m");
        format!("<Profile of {} points on {length}>", self.__len__())
    }
}
