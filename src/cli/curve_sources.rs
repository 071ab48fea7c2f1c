//! The measured curves that arguments name: those of files, of folders and of files with several
//! curves, such as maps.

use super::error::CliError;
use asperity_data::path_name;
use asperity_experiment::{
    CurveOptions, ExperimentError, MeasuredCurve, SeveralCurves, position_in,
};
use asperity_surface::files::content;
use std::fs::read_dir;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Beginning of the message of an error that names a line.
const LINE: &str = "line ";

/// A measured curve in a file.
pub(super) struct CurveSource {
    /// Path of the file as the user gave it, with the number of the curve after `#` if the file has
    /// several: `map.txt#3`.
    pub name: String,
    pub path: PathBuf,
    /// Curves of the file, and the index of this one; `None` for a file with one curve.
    part: Option<(Arc<SeveralCurves>, usize)>,
}

/// A curve, and the coordinates in m of the place at which it was measured, if they are known.
pub(super) struct PlacedCurve {
    pub curve: MeasuredCurve,
    pub position: Option<[f64; 2]>,
}

impl CurveSource {
    /// Reads the curve.
    pub fn read(&self, options: &CurveOptions) -> Result<PlacedCurve, ExperimentError> {
        if let Some((several, index)) = &self.part {
            let parse = |text: String| MeasuredCurve::parse(&self.path, text.as_bytes(), options);
            let curve = match parse(several.text(*index)) {
                Err(error) if error.to_string().starts_with(LINE) => {
                    parse(several.text_with_line_numbers(*index))
                }
                parsed => parsed,
            };
            return Ok(PlacedCurve {
                curve: curve?,
                position: several.position(*index),
            });
        }
        let bytes = content(&self.path)?;
        Ok(PlacedCurve {
            curve: MeasuredCurve::parse(&self.path, &bytes, options)?,
            position: position_in(&bytes)?,
        })
    }

    /// Returns the name of the file without its extension, with the number of the curve after `-`
    /// if the file has several.
    pub fn stem(&self) -> String {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        match &self.part {
            Some((_, index)) => format!("{stem}-{}", index + 1),
            None => stem.into_owned(),
        }
    }
}

/// Returns the curves that the arguments name, in the order of the arguments. In place of a folder,
/// the result has the curves of its files, sorted by their names. `output` is no curve.
pub(super) fn sources_of(
    curves: &[PathBuf],
    output: Option<&Path>,
    options: &CurveOptions,
) -> Result<Vec<CurveSource>, CliError> {
    let mut sources = Vec::new();
    for path in files_of(curves, output)? {
        let name = path.to_string_lossy().into_owned();
        let Some(several) = SeveralCurves::read(&path, options).map(Arc::new) else {
            sources.push(CurveSource {
                name,
                path,
                part: None,
            });
            continue;
        };
        for index in 0..several.count() {
            sources.push(CurveSource {
                name: format!("{name}#{}", index + 1),
                path: path.clone(),
                part: Some((Arc::clone(&several), index)),
            });
        }
    }
    Ok(sources)
}

/// Returns the files that the arguments name. In place of a folder, it returns the files in the
/// folder that may be curves, sorted by their names.
fn files_of(curves: &[PathBuf], output: Option<&Path>) -> Result<Vec<PathBuf>, CliError> {
    let mut files = Vec::new();
    for path in curves {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let mut entries = paths_in(path).map_err(|error| {
            CliError::named(path_name(path), format!("cannot be read: {error}"))
        })?;
        entries.retain(|entry| may_be_curve(entry) && Some(&**entry) != output);
        entries.sort();
        if entries.is_empty() {
            return Err(CliError::named(
                path_name(path),
                "no files in this folder; allowed: a folder of curves",
            ));
        }
        files.extend(entries);
    }
    Ok(files)
}

fn paths_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in read_dir(folder)? {
        paths.push(entry?.path());
    }
    Ok(paths)
}

/// Returns true for a file that is neither hidden nor a scene.
fn may_be_curve(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default();
    let is_hidden = name.to_string_lossy().starts_with('.');
    let is_scene = path.extension().is_some_and(|end| end == "ron");
    path.is_file() && !is_hidden && !is_scene
}
