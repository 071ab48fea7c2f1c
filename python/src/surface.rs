//! Measured surfaces: from files by all readers of the program, or from arrays.

use crate::computing::computed;
use crate::failure::Failure;
use crate::fit::command;
use crate::profile::Profile;
use crate::report::{Report, bytes};
use crate::scene::Scene;
use asperity::cli::arguments::Command;
use asperity::cli::surface::SurfaceArguments;
use asperity::scene::{Adhesion, Document};
use asperity::surface::{EquivalentLine, Topography, analyse};
use asperity_report::{MeasuredFace, SurfaceFile, SurfaceReport};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// An analysed measured surface, from which profiles and scenes are made.
#[pyclass(frozen, module = "asperity._native")]
pub struct Surface {
    arguments: Arc<SurfaceArguments>,
    report: Arc<SurfaceReport>,
}

/// Options of `asperity surface` as words of its command line.
fn parsed(words: Vec<String>) -> Result<SurfaceArguments, Failure> {
    let Some(Command::Surface(arguments)) = command("surface", words)? else {
        return Err("surface: no options of a surface".to_owned().into());
    };
    Ok(arguments)
}

impl Surface {
    fn of(arguments: SurfaceArguments, faces: Vec<MeasuredFace>) -> Surface {
        let spectra = faces.iter().map(|face| face.analysis.isotropic.clone());
        let line = EquivalentLine { faces: spectra.collect() };
        let (modulus, work) = (arguments.modulus, arguments.work);
        let report = SurfaceReport { faces, line, modulus, work, adhesion: None };
        Surface { arguments: Arc::new(arguments), report: Arc::new(report) }
    }
}

#[pymethods]
impl Surface {
    /// Reads and analyses files.
    #[staticmethod]
    fn of_files(py: Python<'_>, words: Vec<String>) -> PyResult<Surface> {
        computed(py, None, |_| {
            let arguments = parsed(words)?;
            let faces = arguments.faces().map_err(|error| Failure::of_files(&arguments.files, error))?;
            Ok(Surface::of(arguments, faces))
        })
    }

    /// Analyses a map of heights in m, with the distances between points and between rows, m.
    #[staticmethod]
    fn of_heights(
        py: Python<'_>,
        heights: PyReadonlyArray2<'_, f64>,
        spacing: [f64; 2],
        words: Vec<String>,
    ) -> PyResult<Surface> {
        let (heights, columns) = (heights.as_slice()?, heights.shape()[1]);
        computed(py, None, |_| {
            let (arguments, surface) = (parsed(words)?, Topography::from_map(heights, columns, spacing)?);
            let options = arguments.options().map_err(|error| error.to_string())?;
            let files = vec![SurfaceFile::new(PathBuf::from("array"), &surface)];
            let analysis = analyse(&[surface], &options.spectrum)?;
            Ok(Surface::of(arguments, vec![MeasuredFace { files, analysis }]))
        })
    }

    /// The statistics and spectra as a report.
    #[getter]
    fn report(&self) -> Report {
        let report = Arc::clone(&self.report);
        Report::new(move |format| bytes(&*report, format, ""))
    }

    /// A random profile of the equivalent line.
    fn profile(&self, py: Python<'_>, length: f64, points: usize, seed: u64) -> PyResult<Profile> {
        computed(py, None, |_| {
            let heights = self.report.line.heights(length, points, seed)?;
            let profile = asperity::Profile::from_heights(heights, length / points as f64)?;
            Ok(Profile { profile })
        })
    }

    /// A scene of the equivalent line over the length of the scan, on a body of this effective modulus, Pa.
    fn scene(&self, py: Python<'_>, modulus: f64, work: Option<f64>) -> PyResult<Scene> {
        computed(py, None, |_| {
            let SurfaceReport { faces, line, .. } = &*self.report;
            let scene = self.arguments.scene_of(modulus, faces, line);
            let mut scene = scene.map_err(|error| error.to_string())?;
            scene.adhesion = work.map(Adhesion::by_work).or(scene.adhesion);
            Ok(Scene { document: Document::from_scene(&scene, "scene")? })
        })
    }
}
