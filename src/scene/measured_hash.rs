//! Hashes of the measured files behind a table of results, which are part of its input.

use super::named_file::named_from;
use crate::io::{ReadError, sha256_of};
use crate::text::path_name;
use std::path::Path;
use thiserror::Error;

/// Prefix of a line in the provenance of a table.
const LINE: &str = "sha256: ";

/// Digits of a hash that a message shows.
const SHOWN: usize = 12;

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
pub enum MeasuredHashError {
    /// The file cannot be read.
    #[error("{file}: {reason}")]
    Unread {
        /// The file.
        file: String,
        /// Reason.
        reason: String,
    },
    /// The content of the file has changed.
    #[error(
        "{file}: the measured file has changed: its SHA-256 is {found}…, {table} has {expected}…; allowed: the file \
         as it was, or its scene in a file of its own"
    )]
    Changed {
        /// The file.
        file: String,
        /// First digits of its hash.
        found: String,
        /// The table.
        table: String,
        /// First digits of the hash in the table.
        expected: String,
    },
}

impl MeasuredHash {
    /// Hashes of files, named from `folder`, for a table that is written into `destination`.
    ///
    /// # Errors
    /// [`MeasuredHashError::Unread`].
    pub fn of_files<'a>(
        files: impl IntoIterator<Item = &'a str>,
        folder: &Path,
        destination: &Path,
    ) -> Result<Vec<Self>, MeasuredHashError> {
        let of_file = |file: &str| {
            let sha256 = hash_of(&folder.join(file))?;
            Ok(MeasuredHash { file: named_from(file, folder, destination), sha256 })
        };
        files.into_iter().map(of_file).collect()
    }

    /// Checks that the file, named from the folder of the table, still has this content.
    ///
    /// # Errors
    /// [`MeasuredHashError`].
    pub fn check(&self, folder: &Path, table: &str) -> Result<(), MeasuredHashError> {
        let path = folder.join(&self.file);
        let found = hash_of(&path)?;
        if found == self.sha256 {
            return Ok(());
        }
        let shown = |hash: &str| hash.chars().take(SHOWN).collect();
        Err(MeasuredHashError::Changed {
            file: path_name(&path),
            found: shown(&found),
            table: table.to_owned(),
            expected: shown(&self.sha256),
        })
    }

    /// Line of a provenance. The name is a RON string, always on one line.
    pub(super) fn line(&self) -> String {
        format!("{LINE}{} {:?}\n", self.sha256, self.file)
    }

    /// Hashes of the lines of a provenance that hold one.
    pub(super) fn of_lines(text: &str) -> Vec<Self> {
        let of_line = |line: &str| {
            let (sha256, file) = line.strip_prefix(LINE)?.split_once(' ')?;
            Some(MeasuredHash { file: ron::from_str(file).ok()?, sha256: sha256.to_owned() })
        };
        text.lines().filter_map(of_line).collect()
    }
}

fn hash_of(path: &Path) -> Result<String, MeasuredHashError> {
    let unread =
        |reason: ReadError| MeasuredHashError::Unread { file: path_name(path), reason: reason.to_string() };
    sha256_of(path).map_err(unread)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_file_is_named_with_both_hashes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a \"b\".txt");
        std::fs::write(&path, "abc").unwrap();
        let hashes = MeasuredHash::of_files(["a \"b\".txt"], folder.path(), folder.path()).unwrap();
        // The hash of `abc` in FIPS 180-2.
        let known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(hashes, [MeasuredHash { file: "a \"b\".txt".into(), sha256: known.into() }]);
        assert_eq!(MeasuredHash::of_lines(&format!("asperity 1\n{}seed: 1", hashes[0].line())), hashes);
        hashes[0].check(folder.path(), "t.csv").unwrap();
        std::fs::write(&path, "").unwrap();
        let error = hashes[0].check(folder.path(), "t.csv").unwrap_err().to_string();
        let expected =
            "the measured file has changed: its SHA-256 is e3b0c44298fc…, t.csv has ba7816bf8f01…; allowed: ";
        assert!(error.contains(expected), "{error}");
        std::fs::remove_file(&path).unwrap();
        assert!(hashes[0].check(folder.path(), "t.csv").unwrap_err().to_string().contains("cannot be read"));
    }
}
