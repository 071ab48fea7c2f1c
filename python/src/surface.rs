//! Measured surfaces: from files by all readers of the program, or from arrays.

use crate::computing::computed;
use crate::failure::Failure;
use crate::fit::command;
use crate::force_loop::Profile;
use crate::results::{Report, bytes};
use crate::scene::Scene;
use asperity::cli::arguments::Command;
use asperity::cli::surface::SurfaceArguments;
use asperity::scene::Document;
use asperity::surface::{EquivalentLine, Topography, analyse};
use asperity_report::{MeasuredFace, SurfaceFile, SurfaceReport};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A map of heights, m, and the distances between its points and between its rows, m.
type Map<'py> = (PyReadonlyArray2<'py, f64>, [f64; 2]);

/// An analysed measured surface, from which profiles and scenes are made.
#[pyclass(frozen, module = "asperity._native")]
pub struct Surface {
    arguments: SurfaceArguments,
    report: Arc<SurfaceReport>,
}

#[pymethods]
impl Surface {
    /// Analyses the files among the words, or a map of heights in m with the distances between points and between rows, m.
    #[new]
    fn new(py: Python<'_>, words: Vec<String>, map: Option<Map<'_>>) -> PyResult<Surface> {
        let map = map.as_ref().map(|(map, at)| Ok::<_, PyErr>((map.as_slice()?, map.shape()[1], *at)));
        let map = map.transpose()?;
        computed(py, None, |_| {
            let Some(Command::Surface(arguments)) = command("surface", words)? else {
                return Err("surface: no options of a surface".to_owned().into());
            };
            let faces = match map {
                None => arguments
                    .faces()
                    .map_err(|error| Failure::of_files(&arguments.files, error.to_string()))?,
                Some((heights, columns, spacing)) => {
                    let surface = Topography::from_map(heights, columns, spacing)?;
                    let options = arguments.options().map_err(|error| error.to_string())?;
                    let files = vec![SurfaceFile::new(PathBuf::from("array"), &surface)];
                    vec![MeasuredFace { files, analysis: analyse(&[surface], &options.spectrum)? }]
                }
            };
            let line =
                EquivalentLine { faces: faces.iter().map(|face| face.analysis.isotropic.clone()).collect() };
            let (modulus, work) = (arguments.modulus, arguments.work);
            let report = Arc::new(SurfaceReport { faces, line, modulus, work, adhesion: None });
            Ok(Surface { arguments, report })
        })
    }

    /// The statistics and spectra as a report.
    #[getter]
    fn report(&self) -> Report {
        let report = Arc::clone(&self.report);
        Report::new(move |format| bytes(None, &*report, format))
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
    fn scene(&self, modulus: f64) -> Result<Scene, Failure> {
        let scene = self.arguments.scene_of(modulus, &self.report.faces, &self.report.line);
        Ok(Scene { document: Document::from_scene(&scene.map_err(|error| error.to_string())?, "scene")? })
    }
}
