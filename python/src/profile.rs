//! Profiles of rigid bodies, from heights or from the form and the roughness of a scene.

use crate::computing::computed;
use crate::failure::Failure;
use crate::quantity::array;
use crate::scene::Scene;
use asperity::scene::Simulation;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The profile of heights or of a scene; `asperity.Profile` gives its parts their names.
#[pyclass(frozen, module = "asperity._native")]
pub struct Profile {
    pub profile: asperity::Profile,
}

#[pymethods]
impl Profile {
    #[new]
    fn new(heights: PyReadonlyArray1<'_, f64>, spacing: f64) -> PyResult<Self> {
        let profile = asperity::Profile::from_heights(heights.as_slice()?, spacing);
        Ok(Profile { profile: profile.map_err(Failure::from)? })
    }

    /// The profile of a scene.
    #[staticmethod]
    fn of_scene(py: Python<'_>, scene: &Scene) -> PyResult<Self> {
        let document = &scene.document;
        computed(py, None, |_| {
            let profile = Simulation::new(document.resolve("")).for_one_scene().profile(document.scene())?;
            Ok(Profile { profile })
        })
    }

    /// Positions, heights and gaps of the points, m.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (profile, columns) = (&self.profile, PyDict::new(py));
        let positions = (0..profile.points()).map(|index| profile.position(index));
        columns.set_item("x", array::<f64>(py, positions.collect()))?;
        columns.set_item("heights", array::<f64>(py, profile.heights().collect()))?;
        columns.set_item("gaps", array(py, profile.gaps().to_vec()))?;
        Ok(columns)
    }

    /// Number of points, their distance, m, and the length of the profile, m.
    fn size(&self) -> (usize, f64, f64) {
        (self.profile.points(), self.profile.spacing(), self.profile.length())
    }
}
