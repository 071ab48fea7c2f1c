//! Changes to files that have to survive a crash, each step separate.
//!
//! Content reaches a disk when its file is synchronised, and the name of a file when its folder is. Between these a
//! crash may leave old, new or torn content under old or new names. Studies and files written whole use a [`Disk`],
//! so that tests can make each step fail, or be the last one.

use std::fmt::Debug;
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Changes of files: [`SystemDisk`], or a simulated disk in tests. Files are read without a disk.
///
/// # Errors
/// Every function returns the error of the operating system. If a name exists, functions that make an entry under a
/// new name fail with [`io::ErrorKind::AlreadyExists`]; only [`Disk::rename`] replaces a file or a link.
/// [`Disk::symbolic_link`] fails with [`io::ErrorKind::Unsupported`] on systems without such links.
pub trait Disk: Debug + Send + Sync {
    /// Makes a folder within an existing one.
    fn make_folder(&self, path: &Path) -> io::Result<()>;

    /// Makes a file for writing.
    fn make_file(&self, path: &Path) -> io::Result<Box<dyn DiskFile>>;

    /// Makes a file without a name in a folder, which vanishes with the process unless it is named; `None` if the
    /// system has no such files.
    fn make_nameless_file(&self, folder: &Path) -> Option<Box<dyn DiskFile>>;

    /// Adds a second name to a file.
    fn link(&self, file: &Path, name: &Path) -> io::Result<()>;

    /// Makes a symbolic link to `target`.
    fn symbolic_link(&self, target: &Path, name: &Path) -> io::Result<()>;

    /// Renames a file, a link or a folder. Replaces a file or link of the new name.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Removes a file or a link.
    fn remove_file(&self, path: &Path) -> io::Result<()>;

    /// Removes an empty folder.
    fn remove_folder(&self, path: &Path) -> io::Result<()>;

    /// Paths of all entries of a folder, in no order.
    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>>;

    /// Waits until the content of an existing file has reached the disk, regardless of its writer.
    fn sync_file(&self, path: &Path) -> io::Result<()>;

    /// Waits until the names in a folder have reached the disk.
    fn sync_folder(&self, path: &Path) -> io::Result<()>;
}

/// A file of a [`Disk`] during writing, with the errors of a [`Disk`].
pub trait DiskFile: Write + Send {
    /// Waits until all written content has reached the disk.
    fn sync(&mut self) -> io::Result<()>;

    /// Sets the permissions.
    fn set_permissions(&mut self, permissions: Permissions) -> io::Result<()>;

    /// Names a nameless file; the name must not exist yet.
    fn give_name(&self, path: &Path) -> io::Result<()>;
}

/// The file systems of the operating system.
#[derive(Clone, Copy, Debug, Default)]
pub struct SystemDisk;

impl SystemDisk {
    /// The shared disk.
    #[must_use]
    pub fn shared() -> Arc<dyn Disk> {
        Arc::new(SystemDisk)
    }
}

impl DiskFile for File {
    fn sync(&mut self) -> io::Result<()> {
        self.sync_all()
    }

    fn set_permissions(&mut self, permissions: Permissions) -> io::Result<()> {
        File::set_permissions(self, permissions)
    }

    #[cfg(target_os = "linux")]
    fn give_name(&self, path: &Path) -> io::Result<()> {
        use rustix::fs::{AtFlags, CWD, linkat};
        Ok(linkat(CWD, of_descriptor(self), CWD, path, AtFlags::SYMLINK_FOLLOW)?)
    }

    #[cfg(not(target_os = "linux"))]
    fn give_name(&self, _: &Path) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

impl Disk for SystemDisk {
    fn make_folder(&self, path: &Path) -> io::Result<()> {
        fs::create_dir(path)
    }

    fn make_file(&self, path: &Path) -> io::Result<Box<dyn DiskFile>> {
        Ok(Box::new(File::create_new(path)?))
    }

    #[cfg(target_os = "linux")]
    fn make_nameless_file(&self, folder: &Path) -> Option<Box<dyn DiskFile>> {
        use rustix::fs::{Mode, OFlags, open};
        let mode = Mode::from_raw_mode(0o666);
        let file: File = open(folder, OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC, mode).ok()?.into();
        // The file can be named only through this folder.
        fs::metadata(of_descriptor(&file)).ok()?;
        Some(Box::new(file))
    }

    #[cfg(not(target_os = "linux"))]
    fn make_nameless_file(&self, _: &Path) -> Option<Box<dyn DiskFile>> {
        None
    }

    fn link(&self, file: &Path, name: &Path) -> io::Result<()> {
        fs::hard_link(file, name)
    }

    #[cfg(unix)]
    fn symbolic_link(&self, target: &Path, name: &Path) -> io::Result<()> {
        std::os::unix::fs::symlink(target, name)
    }

    #[cfg(not(unix))]
    fn symbolic_link(&self, _: &Path, _: &Path) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)
    }

    fn remove_file(&self, path: &Path) -> io::Result<()> {
        fs::remove_file(path)
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        fs::remove_dir(path)
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect()
    }

    fn sync_file(&self, path: &Path) -> io::Result<()> {
        // Windows requires write access.
        OpenOptions::new().read(true).write(cfg!(windows)).open(path)?.sync_all()
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        // Some systems cannot open a folder, some folders may not be read, and some file systems cannot synchronise
        // one: there, names are as safe as the system makes them.
        let lenient = |error: io::Error| match error.kind() {
            io::ErrorKind::PermissionDenied | io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported => {
                Ok(())
            }
            _ => Err(error),
        };
        File::open(path).and_then(|folder| folder.sync_all()).or_else(lenient)
    }
}

#[cfg(target_os = "linux")]
fn of_descriptor(file: &File) -> PathBuf {
    use std::os::fd::AsRawFd;
    PathBuf::from(format!("/proc/self/fd/{}", file.as_raw_fd()))
}

/// Makes a folder and its missing parents, so that they survive a crash.
pub(crate) fn make_folders(disk: &dyn Disk, path: &Path) -> io::Result<()> {
    if path.as_os_str().is_empty() || path.is_dir() {
        return Ok(());
    }
    let parent = path.parent().unwrap_or(Path::new(""));
    make_folders(disk, parent)?;
    match disk.make_folder(path) {
        // Another process was faster.
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists && path.is_dir() => {}
        made => made?,
    }
    disk.sync_folder(folder_of(path))
}

/// The parent folder of a path.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}
