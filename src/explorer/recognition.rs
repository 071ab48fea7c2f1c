//! Recognition of measured files that are given in another place than theirs, by what the readers
//! find in them.

use asperity_data::{Remedied, Wording, path_name, printable};
use asperity_experiment::{ExperimentError, MeasuredCurve};
use asperity_scene::text::quoted;
use asperity_surface::files::content;
use asperity_surface::{ReadOptions, SurfaceError, read};
use std::path::Path;

/// What a measured file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredFile {
    Curve,
    Surface,
}

impl MeasuredFile {
    /// Reads a file as a force curve and as a surface; `None` if it is neither.
    pub fn of(path: &Path) -> Option<MeasuredFile> {
        if !path.is_file() {
            None
        } else if MeasuredCurve::is_in(path) {
            Some(MeasuredFile::Curve)
        } else if is_surface(path) {
            Some(MeasuredFile::Surface)
        } else {
            None
        }
    }

    /// What the file is, and the commands that use it.
    fn way(self, path: &Path) -> String {
        // Control characters of a name would act on the terminal.
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

/// Returns true if a file is read as a surface. Units and spacing may be missing in a file that no
/// text editor would show, since this file cannot be anything else.
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

/// What a measured file is that was given as a scene, in one line; `None` if it is no such file.
pub fn no_scene(path: &Path) -> Option<String> {
    let file = MeasuredFile::of(path)?;
    Some(format!("{}: {}", path_name(path), file.way(path)))
}

/// The reason why a file is not read as a force curve, with the way to read it if it is a surface.
pub fn no_curve(path: &Path, why: &ExperimentError, wording: Wording) -> String {
    let reason = why.in_words(wording);
    match (why, MeasuredFile::of(path)) {
        (ExperimentError::File(_), Some(MeasuredFile::Surface)) => {
            with_way(&reason, MeasuredFile::Surface, path)
        }
        _ => reason,
    }
}

/// The reason why a file is not read as a surface, with the way to read it if it is a force curve.
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
