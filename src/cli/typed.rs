//! The arguments of the program, exactly as the user typed them.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Arguments of the program, beginning with the name of the program. They are stored here, because
/// the arguments of the process are others if a Python script runs the program.
pub(super) static TYPED: OnceLock<Vec<OsString>> = OnceLock::new();

/// Returns the path of this program for scripts that start it. It is the path with which the
/// program was started or, if this path is unknown, the executable file of the process.
pub(super) fn program_path() -> io::Result<PathBuf> {
    let started = TYPED.get().and_then(|typed| typed.first()).map(Path::new);
    match started.filter(|path| path.components().count() > 1 && path.is_file()) {
        Some(path) => std::path::absolute(path),
        None => std::env::current_exe(),
    }
}
