//! Recognition of measured files, for messages to a user who has named such a file in place of
//! another kind of file. A file is a force curve or a surface if the reader for this kind can read
//! it.

use asperity_data::{Remedied, Remedy, Wording, path_name, printable};
use asperity_experiment::{CurveOptions, CurveSource, ExperimentError, MeasuredCurve};
use asperity_scene::text::quoted;
use asperity_surface::files::content;
use asperity_surface::{ReadOptions, SurfaceError, read};
use std::path::Path;

/// Kind of data that a measured file contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredFile {
    Curve,
    Surface,
}

impl MeasuredFile {
    /// Returns the kind of a measured file: a force curve or a surface. `None` if the file cannot
    /// be read as either of the two.
    pub fn of(path: &Path) -> Option<MeasuredFile> {
        let file = CurveSource::file(path);
        if !file.is_file() {
            None
        } else if MeasuredCurve::is_in(&file) {
            Some(MeasuredFile::Curve)
        } else if is_surface(path) {
            Some(MeasuredFile::Surface)
        } else {
            None
        }
    }

    /// Returns a sentence that states what the file is, and which commands can use it.
    fn way(self, path: &Path) -> String {
        // Control characters in the name of the file could act on the terminal, so they are
        // replaced.
        let file = printable(&quoted(path)).into_owned();
        match self {
            MeasuredFile::Curve => format!(
                "a force curve: asperity SCENE --measured {file} shows it beside a scene, asperity fit {file} SCENE fits a scene \
                 to it"
            ),
            MeasuredFile::Surface => format!(
                "a surface: asperity surface {file} analyses it, asperity SCENE --set roughness={file} makes it the roughness of \
                 a scene"
            ),
        }
    }
}

/// Returns true if a file is a table of numbers that could be read as a force curve with further
/// options. Such options state the columns, their units or the travel of the instrument.
pub fn lacks_options(path: &Path) -> bool {
    let Err(error) = MeasuredCurve::read(path, &CurveOptions::default()) else {
        return false;
    };
    let missing = [Remedy::Columns, Remedy::Units, Remedy::Ramp];
    path.is_file()
        && error
            .remedies()
            .iter()
            .any(|remedy| missing.contains(remedy))
}

/// Returns true if a file can be read as a surface. In a binary file, units, spacing and single
/// points may be missing, because a binary file with heights can hardly be anything else.
fn is_surface(path: &Path) -> bool {
    if read(path, &ReadOptions::default()).is_ok() {
        return true;
    }
    let is_binary = content(path).is_ok_and(|bytes| bytes.contains(&0));
    if !is_binary {
        return false;
    }
    let assumed = ReadOptions {
        convention: "m".parse().ok(),
        spacing: Some(1.0),
        interpolate: true,
        ..ReadOptions::default()
    };
    read(path, &assumed).is_ok()
}

/// Returns a line of text for a user who has named a measured file in place of a scene. The line
/// states the kind of the file. `None` if the file is not a measured file.
pub fn no_scene(path: &Path) -> Option<String> {
    let file = MeasuredFile::of(path)?;
    Some(format!("{}: {}", path_name(path), file.way(path)))
}

/// Returns the reason why a file cannot be read as a force curve. `why` is the error of the reader.
/// If the file is a surface, the reason also names the commands that can use it.
pub fn no_curve(path: &Path, why: &ExperimentError, wording: Wording) -> String {
    let reason = why.in_words(wording);
    match (why, MeasuredFile::of(path)) {
        (ExperimentError::File(_), Some(MeasuredFile::Surface)) => {
            with_way(&reason, MeasuredFile::Surface, path)
        }
        _ => reason,
    }
}

/// Returns the reason why a file cannot be read as a surface. `why` is the error of the reader. If
/// the file is a force curve, the reason also names the commands that can use it.
pub fn no_surface(path: &Path, why: &SurfaceError, wording: Wording) -> String {
    let reason = why.in_words(wording);
    match MeasuredFile::of(path) {
        Some(MeasuredFile::Curve) => with_way(&reason, MeasuredFile::Curve, path),
        _ => reason,
    }
}

fn with_way(reason: &str, file: MeasuredFile, path: &Path) -> String {
    format!("{reason}; it can be read as {}", file.way(path))
}
