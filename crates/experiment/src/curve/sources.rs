//! The measured curves that paths name. A path may name a file with one curve, a file with several
//! curves, such as a map, or a folder.

use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};
use crate::read::options::CurveOptions;
use crate::read::several::{SeveralCurves, position_in};
use asperity_data::path_name;
use asperity_surface::files::content;
use std::fs::read_dir;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Beginning of the message of an error that names a line.
const LINE: &str = "line ";

/// A measured curve in a file. The name of a curve in a file with several curves has its number
/// after `#`, counted from 1: `map.txt#3`.
#[derive(Clone, Debug)]
pub struct CurveSource {
    path: PathBuf,
    part: Part,
}

/// Place of a curve in its file.
#[derive(Clone, Debug)]
enum Part {
    /// The only curve of the file.
    Whole,
    /// One of several curves, by its index from 0.
    OneOf(Arc<SeveralCurves>, usize),
}

/// A curve, and the coordinates in m of the place at which it was measured.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PlacedCurve {
    /// The curve.
    pub curve: MeasuredCurve,
    /// Coordinates x and y in m; `None` if the file does not state them.
    pub position: Option<[f64; 2]>,
}

impl CurveSource {
    /// Finds the curve that a path names: the only curve of a file, or one of several by its
    /// number, as in `map.txt#3`.
    ///
    /// # Errors
    /// Returns an error if the file has several curves and the path names none of them.
    pub fn new(path: &Path, options: &CurveOptions) -> Result<Self, ExperimentError> {
        let Named { path, number } = Named::new(path);
        let part = match (SeveralCurves::read(&path, options), number) {
            (None, None | Some(1)) => Part::Whole,
            (None, Some(number)) => {
                return refused(
                    format!("no curve {number}"),
                    "1, the only curve of the file",
                );
            }
            (Some(several), Some(number)) if (1..=several.count()).contains(&number) => {
                Part::OneOf(Arc::new(several), number - 1)
            }
            (Some(several), number) => {
                let count = several.count();
                let found = match number {
                    Some(number) => format!("no curve {number}"),
                    None => format!("{count} curves in one file"),
                };
                let name = path_name(&path);
                return refused(
                    found,
                    format!(
                        "one of them, {name}#1 to {name}#{count}, or a list of files to fit, which takes all"
                    ),
                );
            }
        };
        Ok(CurveSource { path, part })
    }

    /// Returns the file in which a path names a curve: `map.txt` for `map.txt#3`, unless a file has
    /// this name itself.
    pub fn file(path: &Path) -> PathBuf {
        Named::new(path).path
    }

    /// Finds the curves that paths name, in the order of the paths. A folder gives the curves of
    /// all its files except `skipped`, sorted by their names. A file with several curves gives all
    /// of them.
    ///
    /// # Errors
    /// Returns an error if a folder cannot be read or has no files, and for a number of a curve
    /// that a file does not have.
    pub fn all(
        paths: &[PathBuf],
        skipped: Option<&Path>,
        options: &CurveOptions,
    ) -> Result<Vec<Self>, ExperimentError> {
        let mut sources: Vec<CurveSource> = Vec::new();
        for path in files_of(paths, skipped)? {
            if let Some(next) = sources.last().and_then(|last| last.sibling(&path)) {
                sources.push(next);
                continue;
            }
            if path.exists()
                && let Some(several) = SeveralCurves::read(&path, options)
            {
                let several = Arc::new(several);
                for index in 0..several.count() {
                    sources.push(CurveSource {
                        path: path.clone(),
                        part: Part::OneOf(Arc::clone(&several), index),
                    });
                }
                continue;
            }
            let source = CurveSource::new(&path, options);
            sources.push(source.map_err(|error| in_curve(&path, error))?);
        }
        Ok(sources)
    }

    /// Returns the curve that a path names in the same file as this one, without reading the file
    /// again; `None` for a path of another file, and for a number that the file does not have.
    fn sibling(&self, path: &Path) -> Option<CurveSource> {
        let Part::OneOf(several, _) = &self.part else {
            return None;
        };
        let Named {
            path,
            number: Some(number),
        } = Named::new(path)
        else {
            return None;
        };
        let is_in_file = path == self.path && (1..=several.count()).contains(&number);
        is_in_file.then(|| CurveSource {
            path,
            part: Part::OneOf(Arc::clone(several), number - 1),
        })
    }

    /// Returns the path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the path of the file as it was given, with the number of the curve after `#` if the
    /// file has several: `map.txt#3`.
    pub fn name(&self) -> String {
        let path = self.path.to_string_lossy();
        match &self.part {
            Part::Whole => path.into_owned(),
            Part::OneOf(_, index) => format!("{path}#{}", index + 1),
        }
    }

    /// Returns the name of the file without its extension, with the number of the curve after `-`
    /// if the file has several.
    pub fn stem(&self) -> String {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        match &self.part {
            Part::Whole => stem.into_owned(),
            Part::OneOf(_, index) => format!("{stem}-{}", index + 1),
        }
    }

    /// Reads the curve.
    ///
    /// # Errors
    /// Returns an error in the same cases as [`MeasuredCurve::parse`], and if the file cannot be
    /// read.
    pub fn read(&self, options: &CurveOptions) -> Result<PlacedCurve, ExperimentError> {
        let Part::OneOf(several, index) = &self.part else {
            let bytes = content(&self.path)?;
            return Ok(PlacedCurve {
                curve: MeasuredCurve::parse(&self.path, &bytes, options)?,
                position: position_in(&bytes)?,
            });
        };
        let parse = |text: String| MeasuredCurve::parse(&self.path, text.as_bytes(), options);
        let curve = match parse(several.text(*index)) {
            Err(error) if error.to_string().starts_with(LINE) => {
                parse(several.text_with_line_numbers(*index))
            }
            parsed => parsed,
        };
        Ok(PlacedCurve {
            curve: curve?,
            position: several.position(*index),
        })
    }
}

impl MeasuredCurve {
    /// Reads a curve from a file with text, CSV or a NumPy array, of at most 1 GiB. The file may be
    /// compressed by gzip. Of a file with several curves, the path names one by its number, counted
    /// from 1: `map.txt#3`.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or has no columns of displacement and force. It
    /// also returns an error if the curve has no points before contact, no points in contact, or no
    /// retraction. A curve without a retraction is allowed if [`CurveOptions::segments`] selects
    /// only the first approach.
    pub fn read(path: &Path, options: &CurveOptions) -> Result<Self, ExperimentError> {
        let source = CurveSource::new(path, options)?;
        Ok(source.read(options)?.curve)
    }
}

/// Path of a file, and the number of one of its curves if the path names one.
struct Named {
    path: PathBuf,
    number: Option<usize>,
}

impl Named {
    /// Divides a path such as `map.txt#3`, unless a file has this name itself.
    fn new(path: &Path) -> Self {
        if !path.exists()
            && let Some((file, number)) = path.to_str().and_then(|name| name.rsplit_once('#'))
            && let Ok(number) = number.parse()
        {
            return Named {
                path: PathBuf::from(file),
                number: Some(number),
            };
        }
        Named {
            path: path.to_owned(),
            number: None,
        }
    }
}

fn in_curve(path: &Path, error: ExperimentError) -> ExperimentError {
    ExperimentError::InCurve {
        name: path_name(path),
        error: Box::new(error),
    }
}

/// Returns the files that the paths name. In place of a folder, it returns the files in the folder
/// that may be curves, sorted by their names.
fn files_of(paths: &[PathBuf], skipped: Option<&Path>) -> Result<Vec<PathBuf>, ExperimentError> {
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let mut entries = match paths_in(path) {
            Ok(entries) => entries,
            Err(error) => {
                let refusal = refused(format!("cannot be read: {error}"), "a folder of curves");
                return refusal.map_err(|error| in_curve(path, error));
            }
        };
        entries.retain(|entry| may_be_curve(entry) && Some(&**entry) != skipped);
        entries.sort();
        if entries.is_empty() {
            let refusal = refused("no files in this folder", "a folder of curves");
            return refusal.map_err(|error| in_curve(path, error));
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
