//! Measured surfaces for calls from Python, read from files or made from arrays.

use crate::advice::argument;
use crate::computing::computed;
use crate::failure::Failure;
use crate::results::{Report, bytes};
use crate::scene::Scene;
use asperity::cli::surface::SurfaceTask;
use asperity::data::{Control, parallel};
use asperity::scene::{Document, Numerics, Scene as SceneValues};
use asperity::surface::lines::MeasuredRoughness;
use asperity::surface::{Topography, analyse};
use asperity_report::{MeasuredFace, SurfaceFile};
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

/// Analyses the files of the measured roughness of a scene or, if `map` is given, this map with the
/// options of the roughness. If the modulus and the work of adhesion are given, also computes the
/// adhesion on `profiles` random profiles. Returns a report on the statistics and the spectra, and
/// a scene with the equivalent line, with the length in m and the number of springs that it has if
/// it is as long as the scan. If a map was given, its spectrum exists only in memory.
#[pyfunction]
pub fn surface(
    py: Python<'_>,
    scene: &Scene,
    numbers: Numbers,
    profiles: Option<u32>,
    jobs: Option<usize>,
    map: Option<Map<'_>>,
) -> PyResult<(Report, Scene, (f64, u64))> {
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
        Some((map, spacing)) => Some((map.as_slice()?.to_vec(), map.shape()[1], *spacing)),
        None => None,
    };
    computed(py, None, move |watch| {
        let is_array = heights.is_some();
        let faces = match heights {
            None => read_faces(&task)?,
            Some((heights, columns, spacing)) => faces_of_map(&task, &heights, columns, spacing)?,
        };
        let stop = || watch.stop();
        let report = task
            .report(faces, true, Control::default().stopped_by(&stop))
            .map_err(|error| error.to_string())?;
        // The caller gives the modulus later, and also the length, since a scan may be longer or
        // shorter than a scene allows.
        let whole = task.scene(1e6, &report.faces, &report.line);
        let size = (whole.length, whole.numerics.points);
        let scene = SceneValues {
            length: 1e-4,
            numerics: Numerics::default(),
            ..whole
        };
        let line = MeasuredRoughness::Equivalent(report.line.clone());
        let scene = Scene {
            document: Document::from_scene(&scene, "scene")?,
            in_memory: is_array.then(|| Arc::new(line)),
        };
        Ok((
            Report::new(move |format| bytes(None, &report, format)),
            scene,
            size,
        ))
    })
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
    let files = vec![SurfaceFile::new(PathBuf::from("array in memory"), &surface)];
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
