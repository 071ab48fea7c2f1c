//! Measured surfaces for calls from Python, read from files or made from arrays.

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

/// A map of heights in m, with the distance in m between its columns, and the distance in m between
/// its rows.
type Map<'py> = (PyReadonlyArray2<'py, f64>, [f64; 2]);

/// Radius of the tip (m), effective modulus (Pa), work of adhesion (J/m²), and preload (N); `None`
/// for a number that is not given.
type Numbers = [Option<f64>; 4];

/// A measured surface with its analysis. Profiles and scenes can be made from it.
#[pyclass(frozen, module = "asperity._native")]
pub struct Surface {
    task: SurfaceTask,
    report: Arc<SurfaceReport>,
    /// True if the heights were given as an array, so that a scene cannot name their file.
    is_array: bool,
}

#[pymethods]
impl Surface {
    /// Analyses the files of the measured roughness of a scene or, if `map` is given, this map with
    /// the options of the roughness. If the modulus and the work of adhesion are given, also
    /// computes the adhesion on `profiles` random profiles.
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

    /// Returns a report on the statistics and the spectra.
    #[getter]
    fn report(&self) -> Report {
        let report = Arc::clone(&self.report);
        Report::new(move |format| bytes(None, &*report, format))
    }

    /// Returns a scene with the roughness of this surface. `seed` is the seed of the random phases.
    /// If the surface was made from an array, its spectrum exists only in memory.
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

    /// Returns a scene in which a body with the effective modulus `modulus` (in Pa) has the profile
    /// of the equivalent line, as long as the scan.
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

/// Analyses a map of heights in m and, if there is one, the file of the opposite face. `spacing`
/// has the distances in m between the columns and between the rows.
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
