//! Archives (ZIP) in memory, unpacked up to a limit.

use super::bytes::most_expanded;
use super::error::{Place, TopographyError, refused, shown};
use crate::io::read_limited;
use std::io::Cursor;
use zip::ZipArchive;
use zip::result::ZipError;

pub(super) const SIGNATURE: &[u8] = b"PK\x03\x04";

/// Archive in memory, and the most bytes to which its further files may expand.
pub(super) struct Archive<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    most: usize,
}

impl<'a> Archive<'a> {
    pub fn new(bytes: &'a [u8]) -> Result<Self, TopographyError> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| {
            refused(Place::File, format!("a damaged archive ({error})"), "an archive of ZIP")
        })?;
        Ok(Archive { archive, most: most_expanded(bytes.len()) })
    }

    /// Returns the first of these names that a file of the archive has.
    pub fn first_of(&self, names: &[&'static str]) -> Option<&'static str> {
        names.iter().find(|name| self.archive.index_for_name(name).is_some()).copied()
    }

    /// Returns the content of a file of the archive, at most `most` bytes.
    pub fn unpacked(&mut self, name: &str, most: usize) -> Result<Vec<u8>, TopographyError> {
        let damaged = |error: &dyn std::fmt::Display| {
            let fault = format!("cannot be unpacked ({error})");
            refused(Place::Part(name.to_owned()), fault, "a file stored or deflated")
        };
        let entry = self.archive.by_name(name).map_err(|error| match error {
            ZipError::FileNotFound => {
                let fault = format!("no file {} in the archive", shown(name));
                refused(Place::File, fault, "an archive with all files that it names")
            }
            error => damaged(&error),
        })?;
        let content = read_limited(entry, most.min(self.most)).map_err(|error| damaged(&error))?;
        self.most -= content.len();
        Ok(content)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use std::io::Write;
    use zip::write::SimpleFileOptions;

    pub fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, content) in files {
            writer.start_file(*name, SimpleFileOptions::default()).unwrap();
            writer.write_all(content).unwrap();
        }
        writer.finish().unwrap().into_inner()
    }

    #[test]
    fn files_of_an_archive_expand_to_a_limit_together() {
        let zeros = vec![0; 1 << 20];
        let bytes = archive(&[("one", &zeros), ("two", &zeros)]);
        let mut archive = Archive::new(&bytes).unwrap();
        assert!(archive.unpacked("one", usize::MAX).is_ok());
        let error = archive.unpacked("two", usize::MAX).unwrap_err().to_string();
        assert!(error.starts_with("two: cannot be unpacked (longer than"), "{error}");
        let error = archive.unpacked("three", 1).unwrap_err().to_string();
        assert!(error.starts_with("no file three in the archive"), "{error}");
        let error = Archive::new(b"PK\x03\x04").err().unwrap().to_string();
        assert!(error.starts_with("a damaged archive"), "{error}");
    }
}
