//! Where results go.

use super::CliError;
use crate::io::{check_writable, write_new};
use clap::Args;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file for results in place of standard output.
#[derive(Args, Debug)]
pub struct OutputArguments {
    /// Write to FILE, whole or not at all; `-` is standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Overwrite FILE if it exists
    #[arg(long, requires = "output")]
    pub force: bool,
}

impl OutputArguments {
    /// The file, unless results go to standard output.
    pub(super) fn file(&self) -> Option<&Path> {
        self.output.as_deref().filter(|path| *path != Path::new("-"))
    }

    /// Checks, before anything is computed, that the results can be written.
    pub(super) fn check(&self) -> Result<(), CliError> {
        Ok(self.file().map_or(Ok(()), |path| check_writable(path, self.force))?)
    }

    /// Writes results to where they go.
    pub(super) fn write(
        &self,
        stdout: &mut dyn Write,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), CliError> {
        match self.file() {
            Some(path) => Ok(write_new(path, self.force, |out| write(out))?),
            None => Ok(write(stdout)?),
        }
    }
}
