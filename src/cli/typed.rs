//! The arguments of the program, as a user typed them.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Arguments, the first of which is the name of the program. Those of the process differ where a
/// script of Python runs it.
pub(super) static TYPED: OnceLock<Vec<OsString>> = OnceLock::new();

/// Path of the program, for scripts that start it: the file that was started, or else the
/// executable of the process.
pub(super) fn program_path() -> io::Result<PathBuf> {
    let started = TYPED.get().and_then(|typed| typed.first()).map(Path::new);
    match started.filter(|path| path.components().count() > 1 && path.is_file()) {
        Some(path) => std::path::absolute(path),
        None => std::env::current_exe(),
    }
}
