//! ZIP archives in memory. The total size of the decompressed files of an archive is limited.

use super::bytes::most_expanded;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{read_limited, shown};
use std::collections::HashMap;
use std::fmt;
use std::io::Cursor;
use zip::ZipArchive;

/// First bytes of a ZIP archive.
pub(super) const ZIP: &[u8] = b"PK\x03\x04";

pub(super) struct Archive<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    /// Index in the archive of each file, found by its name in the spelling of [`plain_name`].
    places: HashMap<String, usize>,
    /// Folder that contains the index file. Names of other files are relative to this folder.
    folder: String,
    /// Number of bytes that may still be decompressed from files whose size is not known in
    /// advance.
    most: usize,
}

/// A file of an archive that may be its index file. Of several such files the smallest in the
/// derived order is preferred: first the one in the fewest folders.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct IndexFile {
    /// Number of nested folders that contain the file.
    depth: usize,
    /// Index of the name of the file in the list of possible names.
    name: usize,
    folder: String,
}

/// Returns the name of a file in an archive in a uniform spelling: with slashes between folders and
/// without parts that are `.`.
fn plain_name(name: &str) -> String {
    let mut parts: Vec<&str> = name.split(['/', '\\']).collect();
    parts.retain(|part| !matches!(*part, "" | "."));
    parts.join("/")
}

impl<'a> Archive<'a> {
    pub fn new(bytes: &'a [u8]) -> Result<Self, SurfaceError> {
        let archive = match ZipArchive::new(Cursor::new(bytes)) {
            Ok(archive) => archive,
            Err(error) => {
                let found = format!("a damaged archive ({error})");
                return Err(refused(Place::File, found, "an archive of ZIP"));
            }
        };
        let mut places = HashMap::new();
        for place in 0..archive.len() {
            if let Some(Ok(name)) = archive.name_for_index(place) {
                places.insert(plain_name(&name), place);
            }
        }
        Ok(Archive {
            archive,
            places,
            folder: String::new(),
            most: most_expanded(bytes.len()),
        })
    }

    /// Finds the index file of the archive, and returns its name; `None` if there is no index file.
    /// `names` are the names that an index file may have. If several files have such a name, the
    /// file in the fewest folders is the index file. In later calls, names of files are relative to
    /// the folder of the index file.
    ///
    /// # Errors
    /// Returns an error if two index files are in equally many folders.
    pub fn index(&mut self, names: &[&'static str]) -> Result<Option<&'static str>, SurfaceError> {
        let mut found = self.index_files(names);
        found.sort();
        if let [first, second, ..] = &found[..]
            && first.depth == second.depth
            && first.name == second.name
        {
            let name = names[first.name];
            let folder = shown(&first.folder);
            let other_folder = shown(&second.folder);
            let found = format!("{name} in the folders {folder} and {other_folder}");
            let allowed = "an archive with one surface, or a container";
            return Err(refused(Place::File, found, allowed));
        }
        let Some(first) = found.into_iter().next() else {
            return Ok(None);
        };
        self.folder = first.folder;
        Ok(Some(names[first.name]))
    }

    fn index_files(&self, names: &[&'static str]) -> Vec<IndexFile> {
        let mut found = Vec::new();
        for path in self.places.keys() {
            let (folder, file) = path.rsplit_once('/').unwrap_or(("", path));
            if let Some(name) = names.iter().position(|name| *name == file) {
                found.push(IndexFile {
                    depth: path.matches('/').count(),
                    name,
                    folder: folder.to_owned(),
                });
            }
        }
        found
    }

    /// Returns the names of all files, in the form that [`plain_name`] gives them.
    pub fn names(&self) -> impl Iterator<Item = &str> + Clone {
        self.places.keys().map(String::as_str)
    }

    /// Returns the decompressed content of a file whose size no header states. The content counts
    /// towards the limit of the archive for all such files. Returns an error if the content has
    /// more bytes than `most` or than this limit allows.
    pub fn unpacked(&mut self, name: &str, most: usize) -> Result<Vec<u8>, SurfaceError> {
        let content = self.unpacked_up_to(name, most.min(self.most))?;
        self.most -= content.len();
        Ok(content)
    }

    /// Returns the decompressed content of a file whose size a header states. `most` is this size
    /// in bytes. Returns an error if the content has more bytes.
    pub fn unpacked_up_to(&mut self, name: &str, most: usize) -> Result<Vec<u8>, SurfaceError> {
        let path = plain_name(&format!("{}/{name}", self.folder));
        let Some(place) = self.places.get(&path) else {
            let found = format!("no file {} in the archive", shown(name));
            let allowed = "an archive with all files that it names";
            return Err(refused(Place::File, found, allowed));
        };
        let entry = self.archive.by_index(*place);
        let entry = entry.map_err(|error| damaged(name, &error))?;
        read_limited(entry, most).map_err(|error| damaged(name, &error))
    }
}

fn damaged(name: &str, error: &dyn fmt::Display) -> SurfaceError {
    let place = Place::Part(name.to_owned());
    let found = format!("cannot be unpacked ({error})");
    refused(place, found, "a file stored or deflated")
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use std::io::Write;
    use zip::write::SimpleFileOptions;

    pub fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, content) in files {
            writer
                .start_file(*name, SimpleFileOptions::default())
                .unwrap();
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
        assert!(
            error.starts_with("two: cannot be unpacked (longer than"),
            "{error}"
        );
        let error = archive.unpacked("three", 1).unwrap_err().to_string();
        assert!(error.starts_with("no file three in the archive"), "{error}");
        let error = Archive::new(b"PK\x03\x04").err().unwrap().to_string();
        assert!(error.starts_with("a damaged archive"), "{error}");
    }
}
