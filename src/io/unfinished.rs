//! A file during writing, in its final folder, and without its name until it is complete.
//!
//! On systems with nameless files (Linux, on most file systems) the file has no name: the system removes it with
//! the process, in any kind of end. Elsewhere it has a temporary name with the number of its process.

use super::WriteError;
use super::disk::{Disk, DiskFile, folder_of};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Names tried for a temporary file.
const MOST_NAMES: u32 = 1000;

/// Most entries of a folder searched for temporary files of ended processes.
const MOST_LOOKED_AT: usize = 10_000;

/// A file that is removed unless it is published.
pub(super) struct Unfinished<'d> {
    disk: &'d dyn Disk,
    pub file: Box<dyn DiskFile>,
    folder: PathBuf,
    /// Temporary name; `None` for a file without one.
    path: Option<PathBuf>,
}

impl<'d> Unfinished<'d> {
    /// Makes a new file in the folder of `target`.
    ///
    /// # Errors
    /// [`WriteError::NoFolder`], [`WriteError::Failed`].
    pub fn beside(target: &Path, disk: &'d dyn Disk) -> Result<Unfinished<'d>, WriteError> {
        let folder = folder_of(target);
        if let Some(file) = disk.make_nameless_file(folder) {
            return Ok(Unfinished { disk, file, folder: folder.into(), path: None });
        }
        remove_left_behind(folder);
        match named(folder, |path| disk.make_file(path)) {
            Ok((file, path)) => Ok(Unfinished { disk, file, folder: folder.into(), path: Some(path) }),
            Err(_) if !folder.is_dir() => {
                Err(WriteError::NoFolder { path: target.into(), folder: folder.into() })
            }
            Err(reason) => Err(WriteError::Failed { path: target.into(), reason }),
        }
    }

    /// Names the file; replaces an existing file only with `overwrite`.
    ///
    /// # Errors
    /// Error of the operating system; [`io::ErrorKind::AlreadyExists`] without `overwrite`.
    pub fn publish(mut self, path: &Path, overwrite: bool) -> io::Result<()> {
        if self.path.is_none() {
            if !overwrite {
                return self.file.give_name(path);
            }
            // Only a renaming replaces a file, and only a named file can be renamed.
            remove_left_behind(&self.folder);
            let ((), name) = named(&self.folder, |name| self.file.give_name(name))?;
            self.path = Some(name);
        }
        let Some(name) = &self.path else { return Ok(()) };
        if overwrite {
            return self.disk.rename(name, path);
        }
        // A link cannot be made if the file exists by now, while a renaming would replace it.
        match self.disk.link(name, path) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                // On file systems without links an empty file claims the name.
                drop(self.disk.make_file(path)?);
                self.disk.rename(name, path).inspect_err(|_| drop(self.disk.remove_file(path)))
            }
            done => done,
        }
    }
}

impl Drop for Unfinished<'_> {
    fn drop(&mut self) {
        // After a renaming there is no temporary name to remove.
        if let Some(path) = &self.path {
            let _ = self.disk.remove_file(path);
        }
    }
}

/// Makes an entry under a free temporary name.
fn named<T>(folder: &Path, make: impl Fn(&Path) -> io::Result<T>) -> io::Result<(T, PathBuf)> {
    let mut number = 0;
    loop {
        // The name is independent of the target's, which may have the greatest length.
        let path = folder.join(format!("{}{number}.tmp", prefix(std::process::id())));
        match make(&path) {
            Ok(made) => return Ok((made, path)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && number < MOST_NAMES => number += 1,
            Err(error) => return Err(error),
        }
    }
}

/// Prefix of the temporary names of a process, with its number and machine: several machines can share a folder.
fn prefix(process: u32) -> String {
    format!(".asperity-{}-{process}-", machine())
}

/// Removes the temporary files of ended processes of this machine.
fn remove_left_behind(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.take(MOST_LOOKED_AT).flatten() {
        let name = entry.file_name();
        let owner = name.to_str().and_then(owner);
        if owner.is_some_and(|process| process != std::process::id() && is_gone(process)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Number of the process of this machine behind a temporary name.
fn owner(name: &str) -> Option<u32> {
    let process = name.strip_prefix(".asperity-")?.strip_prefix(&machine())?.strip_prefix('-')?;
    let (process, number) = process.strip_suffix(".tmp")?.split_once('-')?;
    number.parse::<u32>().ok()?;
    process.parse().ok()
}

/// Identifier of this machine, and of this container on it, among the users of a folder: a checksum of its name and
/// of its process namespace.
#[cfg(unix)]
pub fn machine() -> String {
    let mut hash = crc32fast::Hasher::new();
    hash.update(rustix::system::uname().nodename().to_bytes());
    let numbering = fs::read_link("/proc/self/ns/pid").unwrap_or_default();
    hash.update(numbering.as_os_str().as_encoded_bytes());
    format!("{:08x}", hash.finalize())
}

#[cfg(not(unix))]
pub fn machine() -> String {
    "0".into()
}

/// Returns true for a process id that is unused on this machine.
#[cfg(unix)]
pub fn is_gone(process: u32) -> bool {
    use rustix::process::{Pid, test_kill_process};
    let process = i32::try_from(process).ok().and_then(Pid::from_raw);
    process.is_some_and(|process| test_kill_process(process) == Err(rustix::io::Errno::SRCH))
}

/// Elsewhere no process is known to have ended.
#[cfg(not(unix))]
pub fn is_gone(_: u32) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::SystemDisk;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// A file with a temporary name, as on systems without nameless files.
    fn with_name(folder: &Path) -> Unfinished<'static> {
        let (file, path) = named(folder, |path| SystemDisk.make_file(path)).unwrap();
        Unfinished { disk: &SystemDisk, file, folder: folder.into(), path: Some(path) }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn nothing_is_seen_of_a_file_until_it_is_published() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("curve.csv");
        for (overwrite, text) in [(false, "one"), (true, "two")] {
            let before = names(folder.path());
            let mut unfinished = Unfinished::beside(&target, &SystemDisk).unwrap();
            if unfinished.path.is_some() {
                println!("skipped: this file system has no files without a name");
                return;
            }
            unfinished.file.write_all(text.as_bytes()).unwrap();
            assert_eq!(names(folder.path()), before);
            unfinished.publish(&target, overwrite).unwrap();
            assert_eq!(fs::read_to_string(&target).unwrap(), text);
            assert_eq!(names(folder.path()), ["curve.csv"]);
        }
        let again = Unfinished::beside(&target, &SystemDisk).unwrap().publish(&target, false).unwrap_err();
        assert_eq!(again.kind(), io::ErrorKind::AlreadyExists);
    }

    #[test]
    fn a_file_with_a_temporary_name_is_published_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("curve.csv");
        for (overwrite, text) in [(false, "one"), (true, "two")] {
            let mut unfinished = with_name(folder.path());
            unfinished.file.write_all(text.as_bytes()).unwrap();
            assert!(names(folder.path()).iter().any(|name| owner(name) == Some(std::process::id())));
            unfinished.publish(&target, overwrite).unwrap();
            assert_eq!(fs::read_to_string(&target).unwrap(), text);
            assert_eq!(names(folder.path()), ["curve.csv"]);
        }
        let again = with_name(folder.path()).publish(&target, false).unwrap_err();
        assert_eq!(again.kind(), io::ErrorKind::AlreadyExists);
        assert_eq!(names(folder.path()), ["curve.csv"]);
    }

    #[cfg(unix)]
    #[test]
    fn what_processes_that_are_gone_left_behind_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let mut ended = std::process::Command::new("/bin/sh").args(["-c", "exit 0"]).spawn().unwrap();
        let gone = ended.id();
        ended.wait().unwrap();
        let own = with_name(folder.path());
        let (left, of_others) = (format!("{}0.tmp", prefix(gone)), format!("{}0.tmp", prefix(1)));
        let of_another_machine = format!(".asperity-ffffffffx-{gone}-0.tmp");
        for name in [&left, &of_others, &of_another_machine, ".asperity-notes.tmp"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        remove_left_behind(folder.path());
        let now = names(folder.path());
        assert!(!now.contains(&left), "{now:?}");
        assert_eq!(now.len(), 4, "{now:?}");
        drop(own);
        assert_eq!(names(folder.path()).len(), 3);
    }
}
