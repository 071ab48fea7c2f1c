//! Provenance of a table of results: version, command, measured files and scene, written into its file.
//!
//! In CSV the text fills the first lines, each after `# `; in `.npy` it is an array after that of the results.

use crate::io::sha256_of;
use crate::scene::{Document, Scene, to_ron};
use crate::text::{path_name, printable};
use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Prefix of the line of a measured file.
const HASH: &str = "sha256: ";

/// Provenance of a table of a scene. Files of the scene are relative to `folder`, and the table is written into
/// `destination`.
///
/// # Errors
/// A measured file of the scene that cannot be read.
pub fn scene_provenance(
    command: &str,
    scene: &Scene,
    folder: &Path,
    destination: &Path,
) -> Result<String, MeasuredFileError> {
    let files = scene.measured_files().into_iter();
    let hashes = files.map(|file| MeasuredFile::new(file, folder, destination));
    let mut text = head(command, &hashes.collect::<Result<Vec<_>, _>>()?);
    let mut scene = scene.clone();
    scene.rename_measured_files(|file| named_from(file, folder, destination));
    if let Some(seed) = scene.seed() {
        text += &format!("seed: {seed}\n");
    }
    Ok(text + &format!("scene:\n{}", to_ron(&scene)))
}

/// Provenance of a table of measured files without a scene.
///
/// # Errors
/// A file that cannot be read.
pub fn files_provenance(
    command: &str,
    files: &[PathBuf],
    destination: &Path,
) -> Result<String, MeasuredFileError> {
    let here = Path::new("");
    let hashes = files.iter().map(|file| MeasuredFile::new(&file.to_string_lossy(), here, destination));
    Ok(head(command, &hashes.collect::<Result<Vec<_>, _>>()?))
}

fn head(command: &str, files: &[MeasuredFile]) -> String {
    let hashes: String = files.iter().map(|file| format!("{file}\n")).collect();
    let command = command.replace(['\n', '\r'], " ");
    format!("asperity {}\n{hashes}command: {command}\n", env!("CARGO_PKG_VERSION"))
}

/// A measured file and the SHA-256 of its content, which identifies the input of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredFile {
    /// Name of the file, from the folder of the table.
    pub file: String,
    /// Hash in 64 hexadecimal digits.
    pub sha256: String,
}

/// The line of a provenance. The name is a RON string, always on one line.
impl fmt::Display for MeasuredFile {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{HASH}{} {:?}", self.sha256, self.file)
    }
}

/// A measured file that has changed or cannot be read.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct MeasuredFileError(String);

impl MeasuredFile {
    /// A file named from `folder`, for a table that is written into `destination`.
    fn new(file: &str, folder: &Path, destination: &Path) -> Result<Self, MeasuredFileError> {
        let sha256 = hash_of(&folder.join(file))?;
        Ok(MeasuredFile { file: named_from(file, folder, destination), sha256 })
    }

    /// Checks that the measured files of a scene are those behind the table of results that it was read from.
    ///
    /// # Errors
    /// [`MeasuredFileError`] of the first file that differs.
    pub fn check_all(document: &Document) -> Result<(), MeasuredFileError> {
        let files = document.scene().measured_files();
        let recorded = document.table_head().lines().filter_map(|line| {
            let (sha256, file) = line.strip_prefix(HASH)?.split_once(' ')?;
            Some(MeasuredFile { file: ron::from_str(file).ok()?, sha256: sha256.to_owned() })
        });
        let mut recorded = recorded.filter(|one| files.contains(&one.file.as_str()));
        recorded.try_for_each(|one| one.check(&document.resolve(""), &printable(document.name())))
    }

    /// Checks that the file, named from the folder of the table, still has this content.
    fn check(&self, folder: &Path, table: &str) -> Result<(), MeasuredFileError> {
        let path = folder.join(&self.file);
        let found = hash_of(&path)?;
        if found == self.sha256 {
            return Ok(());
        }
        let [found, expected] = [&found, &self.sha256].map(|hash| hash.chars().take(12).collect::<String>());
        let file = path_name(&path);
        Err(MeasuredFileError(format!(
            "{file}: the measured file has changed: its SHA-256 is {found}…, {table} has {expected}…; allowed: the \
             file as it was, or its scene in a file of its own"
        )))
    }
}

fn hash_of(path: &Path) -> Result<String, MeasuredFileError> {
    sha256_of(path).map_err(|reason| MeasuredFileError(format!("{}: {reason}", path_name(path))))
}

/// Name of a file relative to `folder` in a table that is written into `destination`: unchanged in the same folder,
/// else the absolute path.
#[must_use]
pub fn named_from(file: &str, folder: &Path, destination: &Path) -> String {
    let whole = |folder: &Path| Path::new(".").join(folder).canonicalize().ok();
    let is_same_folder =
        folder == destination || whole(folder).is_some_and(|one| Some(one) == whole(destination));
    match std::path::absolute(folder.join(file)) {
        Ok(absolute) if !is_same_folder => absolute.to_string_lossy().into_owned(),
        _ => file.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_file_is_named_with_both_hashes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a \"b\".txt");
        std::fs::write(&path, "abc").unwrap();
        let sha256 = hash_of(&path).unwrap();
        // The hash of `abc` in FIPS 180-2.
        assert_eq!(sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        let file = MeasuredFile { file: "a \"b\".txt".into(), sha256 };
        file.check(folder.path(), "t.csv").unwrap();
        std::fs::write(&path, "").unwrap();
        let error = file.check(folder.path(), "t.csv").unwrap_err().to_string();
        let expected =
            "the measured file has changed: its SHA-256 is e3b0c44298fc…, t.csv has ba7816bf8f01…; allowed: ";
        assert!(error.contains(expected), "{error}");
        std::fs::remove_file(&path).unwrap();
        assert!(file.check(folder.path(), "t.csv").unwrap_err().to_string().contains("cannot be read"));
    }
}
