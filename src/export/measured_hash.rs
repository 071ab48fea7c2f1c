//! Hashes of the measured files behind a table of results, which are part of its input.

use crate::io::sha256_of;
use crate::scene::Document;
use crate::text::{path_name, printable};
use std::path::Path;
use thiserror::Error;

/// Prefix of a line in the provenance of a table.
const LINE: &str = "sha256: ";

/// A measured file and the SHA-256 of its content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredHash {
    /// Name of the file, from the folder of the table.
    pub file: String,
    /// Hash in 64 hexadecimal digits.
    pub sha256: String,
}

/// Reason why a table cannot be computed again, or has no hash.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct MeasuredHashError(String);

impl MeasuredHash {
    /// Hash of a file, named from `folder`, for a table that is written into `destination`.
    ///
    /// # Errors
    /// [`MeasuredHashError`] of a file that cannot be read.
    pub fn of_file(file: &str, folder: &Path, destination: &Path) -> Result<Self, MeasuredHashError> {
        let sha256 = hash_of(&folder.join(file))?;
        Ok(MeasuredHash { file: named_from(file, folder, destination), sha256 })
    }

    /// Checks that the file, named from the folder of the table, still has this content.
    fn check(&self, folder: &Path, table: &str) -> Result<(), MeasuredHashError> {
        let path = folder.join(&self.file);
        let found = hash_of(&path)?;
        if found == self.sha256 {
            return Ok(());
        }
        let [found, expected] = [&found, &self.sha256].map(|hash| hash.chars().take(12).collect::<String>());
        let file = path_name(&path);
        Err(MeasuredHashError(format!(
            "{file}: the measured file has changed: its SHA-256 is {found}…, {table} has {expected}…; allowed: the \
             file as it was, or its scene in a file of its own"
        )))
    }

    /// Line of a provenance. The name is a RON string, always on one line.
    pub(super) fn line(&self) -> String {
        format!("{LINE}{} {:?}\n", self.sha256, self.file)
    }

    /// Checks that the measured files of a scene are those behind its table of results.
    ///
    /// # Errors
    /// [`MeasuredHashError`] of the first file that differs.
    pub fn check_all(document: &Document) -> Result<(), MeasuredHashError> {
        let files = document.scene().measured_files();
        let hashes = MeasuredHash::of_lines(document.table_head());
        let mut named = hashes.iter().filter(|hash| files.contains(&hash.file.as_str()));
        named.try_for_each(|hash| hash.check(&document.resolve(""), &printable(document.name())))
    }

    /// Hashes of the lines of a provenance that hold one.
    fn of_lines(text: &str) -> Vec<Self> {
        let of_line = |line: &str| {
            let (sha256, file) = line.strip_prefix(LINE)?.split_once(' ')?;
            Some(MeasuredHash { file: ron::from_str(file).ok()?, sha256: sha256.to_owned() })
        };
        text.lines().filter_map(of_line).collect()
    }
}

fn hash_of(path: &Path) -> Result<String, MeasuredHashError> {
    sha256_of(path).map_err(|reason| MeasuredHashError(format!("{}: {reason}", path_name(path))))
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
        let hash = MeasuredHash::of_file("a \"b\".txt", folder.path(), folder.path()).unwrap();
        // The hash of `abc` in FIPS 180-2.
        let known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(hash, MeasuredHash { file: "a \"b\".txt".into(), sha256: known.into() });
        let head = format!("asperity 1\n{}seed: 1", hash.line());
        assert_eq!(MeasuredHash::of_lines(&head), std::slice::from_ref(&hash));
        hash.check(folder.path(), "t.csv").unwrap();
        std::fs::write(&path, "").unwrap();
        let error = hash.check(folder.path(), "t.csv").unwrap_err().to_string();
        let expected =
            "the measured file has changed: its SHA-256 is e3b0c44298fc…, t.csv has ba7816bf8f01…; allowed: ";
        assert!(error.contains(expected), "{error}");
        std::fs::remove_file(&path).unwrap();
        assert!(hash.check(folder.path(), "t.csv").unwrap_err().to_string().contains("cannot be read"));
    }
}
