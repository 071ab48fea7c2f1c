//! `asperity sweep submit`: a study as an array of jobs of a Slurm cluster.

use super::run::size;
use crate::cli::{CliError, Overrides};
use crate::scene::quoted;
use crate::study::slurm::Submission;
use crate::study::{Changes, Folder, Plan, StudyError};
use crate::text::printable_lines;
use clap::Args;
use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  asperity sweep submit figure-5b -o study --shards 100 --dry-run
  asperity sweep submit figure-5b -o study --shards 100 -- --partition=short --time=2:00:00

One task of the array computes one shard, on as many threads as it has processors; the last one
merges. A killed program is started again within its task, a task whose node is lost on another
node, and both go on where the results end. Whatever is computed twice is counted once. The folder
must be seen by all nodes; it receives the messages of the tasks.

Without a scheduler, GNU parallel does it on this machine, or with --sshlogin on others that see the
folder; the same line goes on with what has failed:
  seq 8 | parallel --joblog shards.log --resume-failed --retries 3 \\
    asperity sweep my-plan.ron -o study --shard {}/8 --jobs 1";

/// Arguments of `sweep submit`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SubmitArguments {
    /// A plan file, or the name of a built-in plan
    pub plan: String,
    /// Folder of the study, visible to all nodes; created if missing
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Parts the plan is cut into, one task each
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub shards: u64,
    /// Most tasks that run at the same time
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub at_once: Option<u64>,
    /// Most restarts of a killed program by a task
    #[arg(long, value_name = "COUNT", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub retries: u32,
    /// Most memory for a task: 500M, 2G
    #[arg(long, value_name = "SIZE", value_parser = size)]
    pub memory: Option<u64>,
    /// Random profiles of each cell, in place of the number in the plan
    #[arg(long, value_name = "COUNT")]
    pub lines: Option<u64>,
    /// Print the script for sbatch; write and submit nothing
    #[arg(long)]
    pub dry_run: bool,
    #[command(flatten)]
    pub overrides: Overrides,
    /// Options of sbatch, after --: --partition=short, -t 2:00:00
    #[arg(last = true, value_name = "SBATCH OPTIONS")]
    pub options: Vec<OsString>,
}

/// Submits a study, or prints the script of the submission.
pub(super) fn submit(arguments: &SubmitArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let changes = Changes { set: arguments.overrides.set.clone(), lines: arguments.lines };
    let plan = Plan::open(&arguments.plan, &changes).map_err(StudyError::from)?;
    let submission = Submission {
        program: std::env::current_exe()?,
        folder: std::path::absolute(&arguments.output)?,
        shards: arguments.shards,
        at_once: arguments.at_once,
        retries: arguments.retries,
        memory: arguments.memory,
    };
    let script = submission.script().map_err(CliError::message)?;
    if arguments.dry_run {
        return Ok(stdout.write_all(script.as_bytes())?);
    }
    let folder = Folder::create(&arguments.output, &plan)?;
    let answer = submission.submit(&arguments.options).map_err(CliError::message)?;
    let path = quoted(folder.path());
    writeln!(stdout, "{}\nasperity sweep status {path} shows the progress", printable_lines(answer.trim()))?;
    Ok(())
}
