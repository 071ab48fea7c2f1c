//! `asperity sweep status`: shows the progress of a study.

use crate::cli::error::CliError;
use crate::cli::output::AnswerFormat;
use asperity_data::grouped;
use asperity_report::Sheet;
use asperity_study::{Folder, Status};
use clap::Args;
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  asperity sweep status study
  asperity sweep status study --format json";

/// Number of characters from which on the name of a machine is shortened in the table.
const LONGEST_HOST: usize = 20;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct StatusArguments {
    /// Folder of the study
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// A table, or one object.
    #[command(flatten)]
    pub format: AnswerFormat,
}

pub(super) fn status(arguments: &StatusArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let folder = Folder::open(&arguments.folder)?;
    let status = Status::of(&folder)?;
    arguments.format.write(stdout, || text(&folder, &status), &status)
}

fn text(folder: &Folder, status: &Status) -> String {
    let mut sheet = Sheet::default();
    sheet.paragraph(&folder.plan().title);
    let share = 100.0 * status.done as f64 / status.total.max(1) as f64;
    sheet.heading(&format!(
        "{} of {} records are there, {share:.1} %; {} are missing",
        grouped(status.done),
        grouped(status.total),
        grouped(status.missing)
    ));
    if status.failed > 0 {
        let failed = grouped(status.failed);
        sheet.paragraph(&format!("{failed} records cannot be computed; a merge states the reasons."));
    }
    if status.damaged > 0 {
        sheet.paragraph(&format!("{} torn or damaged lines are left out.", grouped(status.damaged)));
    }
    let mut rows =
        vec![["shard", "there", "of", "machine", "process", "wrote", "per second"].map(String::from)];
    for shard in &status.shards {
        for (index, attempt) in shard.attempts.iter().enumerate() {
            let first = |text: String| if index == 0 { text } else { String::new() };
            rows.push([
                first(shard.shard.clone()),
                first(grouped(shard.done)),
                first(grouped(shard.total)),
                attempt.host.chars().take(LONGEST_HOST).collect(),
                attempt.process.to_string(),
                grouped(attempt.records),
                attempt.rate.map_or_else(String::new, |rate| format!("{rate:.2}")),
            ]);
        }
    }
    sheet.table(&rows);
    sheet.into_text()
}
