//! Writing of files as a whole: a file has either its old or its new content. An existing file is
//! replaced only on request.

use crate::text::path_name;
use std::fs::{File, OpenOptions, Permissions};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fs, io};
use tempfile::TempPath;
use thiserror::Error;

/// Size of the output buffer in bytes.
const BUFFER: usize = 1 << 18;

/// Beginning of the name of a temporary file.
const PREFIX: &str = ".asperity-";
/// End of the name of a temporary file.
const SUFFIX: &str = ".tmp";

/// Age at which a temporary file counts as abandoned, if no process holds a lock on it.
const ABANDONED: Duration = Duration::from_secs(60);

/// Reason why a file was not written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The file already exists, and the caller did not ask to replace it.
    #[error("{}: there is a file of that name already", path_name(.0))]
    Exists(PathBuf),
    /// No file can be written at the path, for example because its folder does not exist.
    #[error("{}: {fault}", path_name(path))]
    Unsuitable {
        /// Path of the file.
        path: PathBuf,
        /// Reason why the file cannot be written.
        fault: String,
    },
    /// The system refused to write the file.
    #[error("{}: cannot be written: {reason}", path_name(path))]
    Failed {
        /// Path of the file.
        path: PathBuf,
        /// Error that the system returned.
        reason: io::Error,
    },
}

impl WriteError {
    fn unsuitable(path: &Path, fault: impl Into<String>) -> WriteError {
        WriteError::Unsuitable {
            path: path.into(),
            fault: fault.into(),
        }
    }

    fn failed(path: &Path) -> impl Fn(io::Error) -> WriteError {
        move |reason| WriteError::Failed {
            path: path.into(),
            reason,
        }
    }
}

/// Checks that [`write_new`] could write the file now, and returns an error if not. The check
/// leaves no file behind. A program calls this function before a long computation whose result it
/// will write.
pub fn check_writable(path: &Path, overwrite: bool) -> Result<(), WriteError> {
    if let Some(target) = Target::find(path, overwrite)? {
        temporary(&target.path)?;
    }
    Ok(())
}

/// Writes the content that the function `write` gives to a regular file, a pipe or a device. A
/// regular file is written as by [`write_new_file`]. For a pipe, the function waits until another
/// program reads from the pipe.
///
/// # Errors
/// Returns an error if the file cannot be written, if `write` returns an error, or if the file
/// exists and `overwrite` is false.
pub fn write_new(
    path: &Path,
    overwrite: bool,
    write: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>,
) -> Result<(), WriteError> {
    if Target::find(path, overwrite)?.is_some() {
        return write_new_file(path, overwrite, write);
    }
    let mut stream = OpenOptions::new()
        .write(true)
        .open(path)
        .map_err(WriteError::failed(path))?;
    fill(&mut stream, write).map_err(WriteError::failed(path))
}

/// Writes a regular file with the content that the function `write` writes. This function first
/// writes to a temporary file in the same folder. Other programs therefore see either the old file
/// or the complete new file. An existing file is replaced only if `overwrite` is true.
///
/// # Errors
/// Returns an error if the file cannot be written, if `write` returns an error, or if the file
/// exists and `overwrite` is false.
pub fn write_new_file(
    path: &Path,
    overwrite: bool,
    write: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>,
) -> Result<(), WriteError> {
    let failed = WriteError::failed(path);
    let Some(target) = Target::find(path, overwrite)? else {
        let fault = "this is not a regular file; allowed: the name of a file";
        return Err(WriteError::unsuitable(path, fault));
    };
    let mut file = temporary(&target.path)?;
    fill(&mut file.file, write).map_err(&failed)?;
    if let Some(permissions) = target.permissions {
        file.file.set_permissions(permissions).map_err(&failed)?;
    }
    file.file.sync_all().map_err(&failed)?;
    file.persist(&target.path, overwrite)
        .map_err(|reason| match reason.kind() {
            io::ErrorKind::AlreadyExists => WriteError::Exists(path.into()),
            _ => failed(reason),
        })?;
    // The folder is synchronised too, so that the name of the file also survives a power cut.
    sync_folder(folder_of(&target.path)).map_err(failed)
}

/// Removes temporary files that killed processes have left in a folder. A temporary file is removed
/// only if it is older than a minute and no process holds a lock on it. Files that cannot be
/// removed stay in the folder.
pub fn remove_abandoned(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_temporary = name
            .to_str()
            .is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX));
        if is_temporary && is_abandoned(&entry.path()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Returns true if a temporary file is older than [`ABANDONED`] and no process writes to it. A
/// process locks its temporary file right after creating it.
fn is_abandoned(path: &Path) -> bool {
    let Ok(file) = crate::read::open_regular(path) else {
        return false;
    };
    let modified = file.metadata().and_then(|found| found.modified());
    let is_old = modified.is_ok_and(|time| time.elapsed().is_ok_and(|age| age >= ABANDONED));
    is_old && file.try_lock().is_ok()
}

/// File that is being written. The file is removed if it never gets its final name.
struct Temporary {
    file: File,
    /// Temporary path of the file; `None` on Linux, where the file has no name while it is written,
    /// so that the system removes it even if the process is killed.
    name: Option<TempPath>,
}

impl Temporary {
    /// Gives the file its final name. If a file of this name exists, it is replaced if `overwrite`
    /// is true; otherwise the function returns an error.
    fn persist(self, path: &Path, overwrite: bool) -> io::Result<()> {
        let name = match self.name {
            Some(name) => name,
            None => {
                // If no file of this name exists, the file gets its final name directly, and never
                // has a temporary name.
                match link(&self.file, path) {
                    Err(error) if error.kind() == io::ErrorKind::AlreadyExists && overwrite => {}
                    linked => return linked,
                }
                names()
                    .make_in(folder_of(path), |name| link(&self.file, name))
                    .map_err(without_path)?
                    .into_temp_path()
            }
        };
        let persisted = if overwrite {
            name.persist(path)
        } else {
            name.persist_noclobber(path)
        };
        // The file has been open and locked until here, so that no other process has removed it as
        // abandoned.
        persisted.map_err(|error| error.error)
    }
}

/// Returns an error of the package `tempfile` without the name of the temporary file, which the
/// package appends to the message.
fn without_path(error: io::Error) -> io::Error {
    let text = error.to_string();
    match text.split_once(" at path ") {
        Some((reason, _)) => io::Error::new(error.kind(), reason.to_owned()),
        None => error,
    }
}

/// Makes a temporary file in the folder of `path`.
fn temporary(path: &Path) -> Result<Temporary, WriteError> {
    let folder = folder_of(path);
    if let Some(file) = unnamed(folder) {
        // The file is locked, because it may later get a temporary name. See `is_abandoned`.
        let _ = file.try_lock();
        return Ok(Temporary { file, name: None });
    }
    let mut builder = names();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(Permissions::from_mode(0o666));
    }
    let made = builder.tempfile_in(folder).map_err(|reason| {
        if folder.is_dir() {
            WriteError::failed(path)(without_path(reason))
        } else {
            WriteError::unsuitable(path, format!("there is no folder {}", path_name(folder)))
        }
    })?;
    let (file, name) = made.into_parts();
    #[cfg(unix)]
    let _ = file.try_lock();
    Ok(Temporary {
        file,
        name: Some(name),
    })
}

/// Returns a builder for the names of temporary files.
fn names() -> tempfile::Builder<'static, 'static> {
    let mut names = tempfile::Builder::new();
    names.prefix(PREFIX).suffix(SUFFIX);
    names
}

/// Creates a file without a name in a folder; `None` if the file system has no such files.
#[cfg(target_os = "linux")]
fn unnamed(folder: &Path) -> Option<File> {
    use rustix::fs::{CWD, Mode, OFlags, openat};
    let flags = OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC;
    let file = openat(CWD, folder, flags, Mode::from_raw_mode(0o666)).ok()?;
    Path::new(DESCRIPTORS).is_dir().then(|| file.into())
}

#[cfg(not(target_os = "linux"))]
fn unnamed(_: &Path) -> Option<File> {
    None
}

/// Folder in which each open file of this process has a name.
#[cfg(target_os = "linux")]
const DESCRIPTORS: &str = "/proc/self/fd";

/// Gives a name to a file that [`unnamed`] has created.
#[cfg(target_os = "linux")]
fn link(file: &File, name: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    let open = Path::new(DESCRIPTORS).join(file.as_raw_fd().to_string());
    Ok(linkat(CWD, open, CWD, name, AtFlags::SYMLINK_FOLLOW)?)
}

#[cfg(not(target_os = "linux"))]
fn link(_: &File, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Waits until the system has written the names of the files in the folder `path` to the disk.
///
/// # Errors
/// Returns an error if the system cannot write the names.
pub fn sync_folder(path: &Path) -> io::Result<()> {
    use io::ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
    let path = if path.as_os_str().is_empty() {
        Path::new(".")
    } else {
        path
    };
    match File::open(path).and_then(|folder| folder.sync_all()) {
        // Some systems cannot open a folder, some folders may not be read, and some file systems
        // cannot synchronise a folder. In these cases nothing more can be done, so the function
        // returns no error.
        Err(error) if matches!(error.kind(), PermissionDenied | InvalidInput | Unsupported) => {
            Ok(())
        }
        synced => synced,
    }
}

/// Returns the folder that contains a file.
fn folder_of(path: &Path) -> &Path {
    path.parent()
        .filter(|folder| *folder != Path::new(""))
        .unwrap_or(Path::new("."))
}

/// Writes the content of a file through a buffer. `write` produces the content.
fn fill(
    file: &mut (impl Write + Send),
    write: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>,
) -> io::Result<()> {
    let mut buffered = BufWriter::with_capacity(BUFFER, file);
    write(&mut buffered)?;
    buffered.flush()
}

/// Regular file that may be written.
struct Target {
    /// Path of the file, with symbolic links resolved.
    path: PathBuf,
    /// Permissions of the file, if it already exists.
    permissions: Option<Permissions>,
}

impl Target {
    /// Finds the file to which `path` leads, through symbolic links. Returns `None` for a pipe or a
    /// device.
    fn find(path: &Path, overwrite: bool) -> Result<Option<Self>, WriteError> {
        let ends_as_folder = path.to_string_lossy().ends_with(std::path::is_separator);
        let found = fs::metadata(path);
        let is_folder = found.as_ref().is_ok_and(fs::Metadata::is_dir);
        if path.file_name().is_none() || ends_as_folder || is_folder {
            let fault = "this is not the name of a file";
            return Err(WriteError::unsuitable(path, fault));
        }
        match found {
            Ok(found) if !found.is_file() => Ok(None),
            Ok(found) => Target::existing(path, &found, overwrite).map(Some),
            Err(reason) => Target::missing(path, reason, overwrite),
        }
    }

    fn existing(path: &Path, found: &fs::Metadata, overwrite: bool) -> Result<Self, WriteError> {
        if !overwrite {
            return Err(WriteError::Exists(path.into()));
        }
        if found.permissions().readonly() {
            let fault = "this file may not be written";
            return Err(WriteError::unsuitable(path, fault));
        }
        // A symbolic link stays a link, and the file to which it leads is written.
        Ok(Target {
            path: fs::canonicalize(path).map_err(WriteError::failed(path))?,
            permissions: Some(found.permissions()),
        })
    }

    /// Finds the file to be written if the system found no file at `path`. `reason` is the error of
    /// the system.
    fn missing(
        path: &Path,
        reason: io::Error,
        overwrite: bool,
    ) -> Result<Option<Self>, WriteError> {
        // A symbolic link counts as an existing file, even if it leads to no file.
        if !overwrite && fs::symlink_metadata(path).is_ok() {
            return Err(WriteError::Exists(path.into()));
        }
        // An error other than a missing file is returned, for example the error for a circle of
        // symbolic links.
        if reason.kind() != io::ErrorKind::NotFound {
            return Err(WriteError::failed(path)(reason));
        }
        if path.is_symlink() {
            let link = fs::read_link(path).map_err(WriteError::failed(path))?;
            return Target::find(&folder_of(path).join(link), overwrite);
        }
        Ok(Some(Target {
            path: path.into(),
            permissions: None,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect()
    }

    #[test]
    fn a_file_is_written_once_and_overwritten_only_when_asked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("curve.csv");
        write_new(&path, false, |out| out.write_all(b"one")).unwrap();
        let again = write_new(&path, false, |out| out.write_all(b"two"));
        assert!(matches!(again, Err(WriteError::Exists(_))), "{again:?}");
        assert!(matches!(
            check_writable(&path, false),
            Err(WriteError::Exists(_))
        ));
        assert_eq!(fs::read(&path).unwrap(), b"one");
        check_writable(&path, true).unwrap();
        write_new(&path, true, |out| out.write_all(b"two")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names_in(folder.path()), ["curve.csv"]);
    }

    #[test]
    fn a_failure_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("curve.csv");
        let in_folder = || names_in(folder.path());
        let broken = |out: &mut (dyn Write + Send)| {
            out.write_all(&[b'x'; 2 * BUFFER])?;
            // The content is being written here. If the process ended now, no temporary file would
            // remain on Linux.
            assert!(
                !cfg!(target_os = "linux")
                    || !in_folder().iter().any(|name| name.ends_with(".tmp"))
            );
            Err(io::Error::other("no more"))
        };
        assert!(
            write_new(&path, false, broken)
                .unwrap_err()
                .to_string()
                .contains("no more")
        );
        assert_eq!(names_in(folder.path()), Vec::<String>::new());
        write_new(&path, false, |out| out.write_all(b"one")).unwrap();
        assert!(write_new(&path, true, broken).is_err());
        assert_eq!(names_in(folder.path()), ["curve.csv"]);
        assert_eq!(fs::read(&path).unwrap(), b"one");
    }

    #[test]
    fn a_file_that_appears_meanwhile_is_not_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("curve.csv");
        let late = write_new(&path, false, |out| {
            fs::write(&path, "theirs")?;
            out.write_all(b"ours")
        });
        assert!(matches!(late, Err(WriteError::Exists(_))), "{late:?}");
        assert_eq!(fs::read(&path).unwrap(), b"theirs");
        assert_eq!(names_in(folder.path()), ["curve.csv"]);
    }

    /// A new file never has a temporary name. Therefore a process that is killed cannot leave a
    /// temporary file behind.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_new_file_is_named_at_once() {
        use std::sync::atomic::{AtomicBool, Ordering};
        let folder = tempfile::tempdir().unwrap();
        let is_done = AtomicBool::new(false);
        let temporary_names = std::thread::scope(|scope| {
            let watch = scope.spawn(|| {
                let mut seen = 0;
                while !is_done.load(Ordering::SeqCst) {
                    seen += names_in(folder.path())
                        .iter()
                        .filter(|name| name.ends_with(SUFFIX))
                        .count();
                }
                seen
            });
            for number in 0..100 {
                let path = folder.path().join(format!("{number}.csv"));
                write_new(&path, number % 2 == 0, |out| out.write_all(b"one")).unwrap();
                fs::remove_file(&path).unwrap();
            }
            is_done.store(true, Ordering::SeqCst);
            watch.join().unwrap()
        });
        assert_eq!(temporary_names, 0);
    }

    #[cfg(unix)]
    #[test]
    fn only_abandoned_temporary_files_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let old = std::time::SystemTime::now() - 2 * ABANDONED;
        let make = |name: &str, time: Option<std::time::SystemTime>| {
            let file = File::create(folder.path().join(name)).unwrap();
            if let Some(time) = time {
                file.set_modified(time).unwrap();
            }
            file
        };
        drop(make(".asperity-dead.tmp", Some(old)));
        drop(make(".asperity-young.tmp", None));
        drop(make(
            ".asperity-future.tmp",
            Some(std::time::SystemTime::now() + ABANDONED),
        ));
        drop(make("asperity-other.tmp", Some(old)));
        drop(make(".asperity-other.csv", Some(old)));
        let alive = make(".asperity-alive.tmp", Some(old));
        alive.lock().unwrap();
        fs::create_dir(folder.path().join(".asperity-folder.tmp")).unwrap();
        remove_abandoned(folder.path());
        let mut left = names_in(folder.path());
        left.sort();
        let kept = [
            ".asperity-alive.tmp",
            ".asperity-folder.tmp",
            ".asperity-future.tmp",
            ".asperity-other.csv",
        ];
        assert_eq!(
            left,
            [&kept[..], &[".asperity-young.tmp", "asperity-other.tmp"]].concat()
        );
        drop(alive);
        remove_abandoned(folder.path());
        assert!(!folder.path().join(".asperity-alive.tmp").exists());
        remove_abandoned(&folder.path().join("missing"));
    }

    /// A temporary file is not removed as abandoned before its write is finished, no matter how
    /// long the write takes.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_being_named_is_not_abandoned() {
        let folder = tempfile::tempdir().unwrap();
        let file = temporary(&folder.path().join("curve.csv")).unwrap();
        let name = folder.path().join(".asperity-named.tmp");
        link(&file.file, &name).unwrap();
        file.file
            .set_modified(std::time::SystemTime::now() - 2 * ABANDONED)
            .unwrap();
        assert!(!is_abandoned(&name));
        drop(file);
        assert!(is_abandoned(&name));
    }

    #[cfg(unix)]
    #[test]
    fn a_refusal_names_the_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        fs::set_permissions(folder.path(), Permissions::from_mode(0o500)).unwrap();
        let refused = check_writable(&folder.path().join("curve.csv"), false);
        // If the administrator runs the test, every folder can be written, and there is no error to
        // check.
        if let Err(refused) = refused {
            let message = refused.to_string();
            assert!(
                message.contains("curve.csv: cannot be written: ") && !message.contains(".tmp"),
                "{message}"
            );
        }
        let error = names()
            .tempfile_in(folder.path().join("missing"))
            .unwrap_err();
        assert!(error.to_string().contains(PREFIX), "{error}");
        let plain = without_path(error);
        assert_eq!(plain.kind(), io::ErrorKind::NotFound);
        assert!(!plain.to_string().contains(PREFIX), "{plain}");
        fs::set_permissions(folder.path(), Permissions::from_mode(0o700)).unwrap();
    }

    #[test]
    fn a_path_without_a_file_name_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        for (path, expected) in [
            (folder.path().to_path_buf(), "not the name of a file"),
            (folder.path().join("new/"), "not the name of a file"),
            (folder.path().join(".."), "not the name of a file"),
            (PathBuf::new(), "not the name of a file"),
            (folder.path().join("none/curve.csv"), "there is no folder"),
            (folder.path().join("x".repeat(1000)), "cannot be written"),
        ] {
            let message = check_writable(&path, true).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        }
        assert_eq!(names_in(folder.path()), Vec::<String>::new());
    }

    #[cfg(unix)]
    #[test]
    fn links_lead_to_the_file_they_name() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link, lost) = (
            folder.path().join("file"),
            folder.path().join("link"),
            folder.path().join("lost"),
        );
        std::os::unix::fs::symlink(&file, &link).unwrap();
        std::os::unix::fs::symlink(folder.path().join("nothing"), &lost).unwrap();
        fs::write(&file, "one").unwrap();
        assert!(matches!(
            check_writable(&link, false),
            Err(WriteError::Exists(_))
        ));
        assert!(matches!(
            check_writable(&lost, false),
            Err(WriteError::Exists(_))
        ));
        write_new(&link, true, |out| out.write_all(b"two")).unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"two");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        write_new(&lost, true, |out| out.write_all(b"found")).unwrap();
        assert_eq!(fs::read(folder.path().join("nothing")).unwrap(), b"found");
        assert!(fs::symlink_metadata(&lost).unwrap().is_symlink());
    }

    #[cfg(unix)]
    #[test]
    fn pipes_and_devices_are_refused_at_once_where_a_file_is_asked_for() {
        use rustix::fs::{CWD, FileType, Mode, mknodat};
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        mknodat(CWD, &pipe, FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
        for path in [&pipe, Path::new("/dev/null")] {
            for overwrite in [false, true] {
                let refused = write_new_file(path, overwrite, |out| out.write_all(b"one"));
                assert!(
                    matches!(refused, Err(WriteError::Unsuitable { .. })),
                    "{refused:?}"
                );
            }
        }
        assert_eq!(names_in(folder.path()), ["pipe"]);
        let path = folder.path().join("curve.csv");
        write_new_file(&path, false, |out| out.write_all(b"one")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one");
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_written_to_and_stay_devices() {
        let null = Path::new("/dev/null");
        check_writable(null, false).unwrap();
        write_new(null, true, |out| out.write_all(b"gone")).unwrap();
        assert!(!fs::metadata(null).unwrap().is_file());
    }
}
