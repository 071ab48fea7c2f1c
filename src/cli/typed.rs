//! The arguments of the program, as a user typed them.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Arguments of the program, the first of which is the name of the program. They are kept here
/// because a Python script that runs the program has other arguments of its process.
pub(super) static TYPED: OnceLock<Vec<OsString>> = OnceLock::new();

/// Returns the path of the program for scripts that start it: the started file or, if it is
/// unknown, the executable of the process.
pub(super) fn program_path() -> io::Result<PathBuf> {
    let started = TYPED.get().and_then(|typed| typed.first()).map(Path::new);
    match started.filter(|path| path.components().count() > 1 && path.is_file()) {
        Some(path) => std::path::absolute(path),
        None => std::env::current_exe(),
    }
}
