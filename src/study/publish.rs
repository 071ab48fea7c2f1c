//! Publication of several files as one.
//!
//! Tables are in a folder of their own. `tables` is a link to that folder, and the public names are links through
//! it, so one renaming of one link changes all of them at once:
//!
//! ```text
//! results.csv   -> tables/results.csv
//! summary.csv   -> tables/summary.csv
//! results.json  -> tables/results.json
//! tables        -> .tables-7
//! .tables-7/
//! ```
//!
//! On systems without such links the files of an earlier merge are removed before new ones are placed: a crash may
//! leave fewer files there, never new ones beside old.

use super::StudyError;
use crate::io::{Disk, make_folders, without_waiting};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// The link to the folder of the current tables.
pub(super) const TABLES: &str = "tables";
/// Prefix of the names of such folders, and of a link that is not in place yet.
const BEGINNING: &str = ".tables-";
const NEXT_LINK: &str = ".tables-link";
/// File locked by a merge, so that the unfinished tables of another merge are not removed as remains.
const LOCK: &str = ".merge.lock";

/// Calls `write` to make these files in a given folder, and publishes them in `study`. Other files published before
/// are removed.
pub(super) fn publish(
    disk: &dyn Disk,
    study: &Path,
    names: &[&str],
    write: &mut dyn FnMut(&Path) -> Result<(), StudyError>,
) -> Result<(), StudyError> {
    let _lock = lock(study);
    let publication = Publication { disk, study, names };
    let failed = StudyError::unwritable(study);
    let place = publication.new_place().map_err(&failed)?;
    write(&place).and_then(|()| publication.put_in_place(&place).map_err(&failed)).inspect_err(|_| {
        // An unpublished file, or a part of it, is removed.
        if publication.current().as_deref() != place.file_name() {
            let _ = remove(disk, &place);
        }
    })
}

/// Links a file of a published folder in the study under its own name.
#[cfg(feature = "parquet")]
pub(super) fn show(disk: &dyn Disk, study: &Path, name: &str) -> Result<(), StudyError> {
    if !is_link(&study.join(TABLES)) {
        return Ok(());
    }
    let shown =
        Publication { disk, study, names: &[name] }.link_names().and_then(|()| disk.sync_folder(study));
    shown.map_err(StudyError::unwritable(study))
}

/// The folder of published files.
#[cfg(feature = "parquet")]
pub(super) fn place_of(study: &Path) -> PathBuf {
    let tables = study.join(TABLES);
    if is_link(&tables) { tables } else { study.to_path_buf() }
}

struct Publication<'a> {
    disk: &'a dyn Disk,
    study: &'a Path,
    names: &'a [&'a str],
}

impl Publication<'_> {
    /// Name of the folder behind the link `tables`, if a merge has made it.
    fn current(&self) -> Option<OsString> {
        let name = fs::read_link(self.study.join(TABLES)).ok()?.into_os_string();
        let number = name.to_str()?.strip_prefix(BEGINNING)?;
        number.bytes().all(|byte| byte.is_ascii_digit()).then_some(name)
    }

    /// Makes a new folder beside the others and removes the remains of earlier merges.
    fn new_place(&self) -> io::Result<PathBuf> {
        let current = self.current();
        let mut number = 0;
        for path in self.disk.list(self.study)? {
            let name = path.file_name().and_then(|name| name.to_str());
            let Some(rest) = name.and_then(|name| name.strip_prefix(BEGINNING)) else { continue };
            number = rest.parse().map_or(number, |other: u64| number.max(other));
            if current.as_deref() != path.file_name() {
                // Remains that cannot be removed take room and do no other harm.
                let _ = remove(self.disk, &path);
            }
        }
        let place = self.study.join(format!("{BEGINNING}{}", number.saturating_add(1)));
        make_folders(self.disk, &place)?;
        Ok(place)
    }

    fn put_in_place(&self, place: &Path) -> io::Result<()> {
        let Publication { disk, study, .. } = *self;
        disk.sync_folder(place)?;
        let tables = study.join(TABLES);
        let next = study.join(NEXT_LINK);
        let (before, linked) = (self.current(), is_link(&tables));
        if let Err(error) = disk.symbolic_link(Path::new(place.file_name().unwrap_or_default()), &next) {
            // Where one link exists, another could be made; current tables stay.
            return if linked { Err(error) } else { self.move_files(place) };
        }
        if !linked {
            self.clear()?;
        }
        self.link_names()?;
        disk.sync_folder(study)?;
        disk.rename(&next, &tables)?;
        disk.sync_folder(study)?;
        self.remove_others()?;
        // The next merge removes a folder that cannot be removed now.
        if let Some(before) = before {
            let _ = remove(disk, &study.join(before));
        }
        Ok(())
    }

    /// Links the names to the files behind `tables`, where such links are missing.
    fn link_names(&self) -> io::Result<()> {
        for name in self.names {
            let (path, target) = (self.study.join(name), Path::new(TABLES).join(name));
            if fs::read_link(&path).is_ok_and(|there| there == target) {
                continue;
            }
            self.remove_table(&path)?;
            self.disk.symbolic_link(&target, &path)?;
        }
        Ok(())
    }

    /// Moves the files themselves into place instead of links.
    fn move_files(&self, place: &Path) -> io::Result<()> {
        self.clear()?;
        for name in self.names {
            self.disk.rename(&place.join(name), &self.study.join(name))?;
        }
        self.disk.sync_folder(self.study)?;
        self.remove_others()?;
        self.disk.remove_folder(place)
    }

    /// Removes tables that are no links: those of earlier versions, and of copies without links. The last published
    /// one is removed first: without it, the others do not count as a whole.
    fn clear(&self) -> io::Result<()> {
        let Publication { disk, study, names } = *self;
        for name in names.iter().rev() {
            self.remove_table(&study.join(name))?;
        }
        let tables = study.join(TABLES);
        if tables.is_dir() && !is_link(&tables) {
            remove(disk, &tables)?;
        }
        disk.sync_folder(study)
    }

    /// Removes other published files, which belong to earlier tables.
    fn remove_others(&self) -> io::Result<()> {
        let other = self.study.join(super::PARQUET);
        if !self.names.contains(&super::PARQUET) { self.remove_table(&other) } else { Ok(()) }
    }

    /// Removes a table or a link to one, if it exists, and nothing else.
    fn remove_table(&self, path: &Path) -> io::Result<()> {
        match fs::symlink_metadata(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            Err(error) => Err(error),
            Ok(found) if found.is_file() || found.is_symlink() => self.disk.remove_file(path),
            Ok(_) => Err(io::Error::new(
                io::ErrorKind::AlreadyExists,
                format!("{} is in the way: it is neither a file nor a link", crate::text::path_name(path)),
            )),
        }
    }
}

fn is_link(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink())
}

/// Removes a link, a file, or a folder with the files in it.
fn remove(disk: &dyn Disk, path: &Path) -> io::Result<()> {
    if !fs::symlink_metadata(path)?.is_dir() {
        return disk.remove_file(path);
    }
    for file in disk.list(path)? {
        disk.remove_file(&file)?;
    }
    disk.remove_folder(path)
}

/// Waits for other merges of the study and blocks them until the lock is dropped or the process ends. Without file
/// locking there is no waiting: of two merges at a time, one may then fail.
fn lock(study: &Path) -> Option<File> {
    let mut options = fs::OpenOptions::new();
    options.create(true).append(true);
    without_waiting(&mut options);
    let file = options.open(study.join(LOCK)).ok()?;
    #[cfg(unix)]
    rustix::io::retry_on_intr(|| rustix::fs::flock(&file, rustix::fs::FlockOperation::LockExclusive)).ok()?;
    Some(file)
}
