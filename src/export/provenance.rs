//! Provenance of a table of results: the version, the command and the scene behind it, written into its file.
//!
//! In CSV the text fills the first lines, each after `# `; in `.npy` it is an array after that of the results.

use super::measured_hash::{MeasuredHash, MeasuredHashError, named_from};
use crate::scene::{Scene, to_ron};
use std::path::Path;

/// Version, command, measured files and scene behind a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    text: String,
}

impl Provenance {
    /// Provenance of a table of a scene. Files of the scene are relative to `folder`, and the table is written into
    /// `destination`.
    ///
    /// # Errors
    /// A measured file of the scene that cannot be read.
    pub fn new(
        command: &str,
        scene: &Scene,
        folder: &Path,
        destination: &Path,
    ) -> Result<Self, MeasuredHashError> {
        let files = scene.measured_files().into_iter();
        let hashes = files.map(|file| MeasuredHash::of_file(file, folder, destination));
        let Provenance { mut text } = Provenance::of_files(command, &hashes.collect::<Result<Vec<_>, _>>()?);
        let mut scene = scene.clone();
        scene.rename_measured_files(|file| named_from(file, folder, destination));
        if let Some(seed) = scene.seed() {
            text += &format!("seed: {seed}\n");
        }
        text += &format!("scene:\n{}", to_ron(&scene));
        Ok(Provenance { text })
    }

    /// Provenance of a table of measured files without a scene.
    #[must_use]
    pub fn of_files(command: &str, files: &[MeasuredHash]) -> Self {
        let hashes: String = files.iter().map(MeasuredHash::line).collect();
        let command = command.replace(['\n', '\r'], " ");
        Provenance { text: format!("asperity {}\n{hashes}command: {command}\n", env!("CARGO_PKG_VERSION")) }
    }

    /// The text: version, hashes of measured files, command and seed, one line each, and the scene.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The text as comments of CSV.
    #[must_use]
    pub fn comments(&self) -> String {
        self.text.lines().map(|line| format!("# {line}\n")).collect()
    }
}
