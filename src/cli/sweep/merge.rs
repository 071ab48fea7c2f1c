//! `asperity sweep merge`: writes the tables of a study.

use crate::cli::error::CliError;
use asperity_data::path_name;
use asperity_study::folders::Merged;
use asperity_study::{Folder, merge as merge_records};
use clap::Args;
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  asperity sweep merge study

Of a study that is not complete the finished records are merged, and the missing cells are counted.
results.csv has one row for each cell and line, summary.csv one for each cell: mean, standard
deviation and 95 % confidence interval of the mean over the lines. results.json says what the
columns mean. SI units.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct MergeArguments {
    /// Folder of the study
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

pub(super) fn merge(arguments: &MergeArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let folder = Folder::open(&arguments.folder)?;
    let merged = merge_records(&folder)?;
    write_merged(&folder, &merged, stdout)
}

/// Writes the number of merged records, and the numbers of failed, repeated and damaged records.
/// Returns an error if no record could be computed.
pub(super) fn write_merged(
    folder: &Folder,
    merged: &Merged,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let Merged {
        records,
        failed,
        first_failed,
        total,
        duplicates,
        damaged,
        missing_cells,
        ..
    } = merged;
    let path = path_name(folder.path());
    let files = [Merged::RESULTS, Merged::SUMMARY, Merged::SIDECAR].join(", ");
    writeln!(stdout, "{records} of {total} records in {path}: {files}")?;
    for (count, what) in [
        (
            failed,
            "records cannot be computed; results.csv has the reasons",
        ),
        (
            duplicates,
            "records were computed twice, with the same bits",
        ),
        (damaged, "torn or damaged lines were left out"),
        (missing_cells, "cells are not complete"),
    ] {
        if *count > 0 {
            writeln!(stdout, "{count} {what}")?;
        }
    }
    match first_failed.first() {
        Some((.., reason)) if failed == records => Err(CliError::named(
            path,
            format!("none of the {records} records can be computed: {reason}"),
        )),
        _ => Ok(()),
    }
}
