//! Measured surfaces for Python, read from files or made from arrays.

use crate::advice::argument;
use crate::computing::computed;
use crate::failure::Failure;
use crate::results::{Report, bytes};
use crate::scene::Scene;
use asperity::cli::surface::SurfaceTask;
use asperity::data::{Control, parallel};
use asperity::scene::{Document, Roughness};
use asperity::surface::lines::MeasuredRoughness;
use asperity::surface::{Topography, analyse};
use asperity_report::{MeasuredFace, SurfaceFile, SurfaceReport};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A map of heights in m, with the distances in m between its columns and between its rows.
type Map<'py> = (PyReadonlyArray2<'py, f64>, [f64; 2]);

/// Radius of the tip (m), effective modulus (Pa), work of adhesion (J/m²), and preload (N); `None`
/// for an unknown number.
type Numbers = [Option<f64>; 4];

/// An analysed measured surface, from which profiles and scenes are made.
#[pyclass(frozen, module = "asperity._native")]
pub struct Surface {
    task: SurfaceTask,
    report: Arc<SurfaceReport>,
    /// True if the heights were given as an array. A scene cannot name a file for them.
    is_array: bool,
}

#[pymethods]
impl Surface {
    /// Analyses the files of the measured roughness of a scene. If `map` is given, this map of
    /// heights is analysed instead, with the options of the roughness. If modulus and work of
    /// adhesion are given, the adhesion on `profiles` random profiles is computed.
    #[new]
    fn new(
        py: Python<'_>,
        scene: &Scene,
        numbers: Numbers,
        profiles: Option<u32>,
        jobs: Option<usize>,
        map: Option<Map<'_>>,
    ) -> PyResult<Surface> {
        let Some(measured) = scene.document.scene().measured().cloned() else {
            return Err(Failure::from("a scene without a measured surface".to_owned()).into());
        };
        let [tip_radius, modulus, work, preload] = numbers;
        let jobs = jobs.unwrap_or_else(parallel::threads);
        let task = SurfaceTask {
            measured,
            tip_radius,
            modulus,
            work,
            preload,
            profiles,
            jobs,
            wording: argument,
        };
        let heights = match &map {
            Some((map, spacing)) => Some((map.as_slice()?, map.shape()[1], *spacing)),
            None => None,
        };
        computed(py, None, |watch| {
            let faces = match heights {
                None => read_faces(&task)?,
                Some((heights, columns, spacing)) => {
                    faces_of_map(&task, heights, columns, spacing)?
                }
            };
            let stop = || watch.stop();
            let report = task
                .report(faces, true, Control::default().stopped_by(&stop))
                .map_err(|error| error.to_string())?;
            Ok(Surface {
                task,
                report: Arc::new(report),
                is_array: heights.is_some(),
            })
        })
    }

    /// Returns the statistics and spectra as a report.
    #[getter]
    fn report(&self) -> Report {
        let report = Arc::clone(&self.report);
        Report::new(move |format| bytes(None, &*report, format))
    }

    /// Returns a scene with the roughness of this surface. `seed` is the seed of the random phases.
    /// For a surface from an array, the spectrum is kept in memory.
    fn roughen(&self, scene: &Scene, seed: u64) -> Result<Scene, Failure> {
        let mut measured = self.task.measured.clone();
        measured.seed = seed;
        let mut rough = (**scene.document.scene()).clone();
        rough.roughness = Some(Roughness::Measured(measured));
        Ok(Scene {
            document: Document::from_scene(&rough, "scene")?,
            in_memory: self.in_memory(),
        })
    }

    /// Returns a scene of the equivalent line over the length of the scan, on a body with the
    /// effective modulus `modulus` in Pa.
    fn scene(&self, modulus: f64) -> Result<Scene, Failure> {
        let scene = self
            .task
            .scene(modulus, &self.report.faces, &self.report.line);
        Ok(Scene {
            document: Document::from_scene(&scene, "scene")?,
            in_memory: self.in_memory(),
        })
    }
}

impl Surface {
    fn in_memory(&self) -> Option<Arc<MeasuredRoughness>> {
        self.is_array
            .then(|| Arc::new(MeasuredRoughness::Equivalent(self.report.line.clone())))
    }
}

fn read_faces(task: &SurfaceTask) -> Result<Vec<MeasuredFace>, Failure> {
    let mut files = task.files();
    files.extend(task.measured.opposite.iter().map(PathBuf::from));
    task.faces()
        .map_err(|error| Failure::of_files(&files, error.to_string()))
}

/// Analyses a map of heights in m, and the file of the opposite face if there is one. `spacing` is
/// in m.
fn faces_of_map(
    task: &SurfaceTask,
    heights: &[f64],
    columns: usize,
    spacing: [f64; 2],
) -> Result<Vec<MeasuredFace>, Failure> {
    let options = task.options();
    let surface = Topography::from_map_with(heights, columns, spacing, &options.reading)?;
    let files = vec![SurfaceFile::new(PathBuf::from("array"), &surface)];
    let mut faces = vec![MeasuredFace {
        files,
        analysis: analyse(&[surface], &options.spectrum)?,
    }];
    if let Some(file) = &task.measured.opposite {
        let opposite = task.opposite_face();
        let opposite =
            opposite.map_err(|error| Failure::of_files(&[file.into()], error.to_string()))?;
        faces.extend(opposite);
    }
    Ok(faces)
}
