//! `asperity sweep submit`: a study as jobs of a Slurm cluster.

use super::run::size;
use crate::cli::{CliError, Overrides};
use crate::io::write_new;
use crate::scene::quoted;
use crate::study::slurm::{SlurmError, Submission, array_size, ignored_variables, sbatch_options};
use crate::study::{Changes, Folder, Plan, StudyError};
use crate::text::{printable, printable_lines};
use clap::Args;
use std::ffi::OsString;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  asperity sweep submit figure-5b -o study --shards 100 --dry-run
  asperity sweep submit figure-5b -o study --shards 100 -- --partition=short --time=2:00:00

One task of the array computes one shard, on as many threads as it has processors; the merge waits
for all of them. A killed program is started again within its task, a task whose node is lost on
another node, and both go on where the results end. Whatever is computed twice is counted once. The
folder must be seen by all nodes; the jobs' scripts and messages are in DIR/slurm.

Without a scheduler, GNU parallel does it on this machine, or with --sshlogin on others that see the
folder:
  asperity sweep my-plan.ron -o study --check
  seq 8 | parallel --joblog shards.log --resume-failed --retries 3 \\
    asperity sweep my-plan.ron -o study --shard {}/8 --jobs 1 && asperity sweep merge study
The same line goes on with what has failed.";

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
    /// Print the scripts and the commands; write and submit nothing
    #[arg(long)]
    pub dry_run: bool,
    #[command(flatten)]
    pub overrides: Overrides,
    /// Options of sbatch for both jobs, after --
    ///
    /// Whole names or letters: --partition=short, -t 2:00:00. SBATCH_… variables are left out.
    #[arg(last = true, value_name = "SBATCH OPTIONS")]
    pub options: Vec<OsString>,
}

/// Submits a study, or prints the commands of the submission.
pub(super) fn submit(arguments: &SubmitArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let changes = Changes { set: arguments.overrides.set.clone(), lines: arguments.lines };
    let plan = Plan::open(&arguments.plan, &changes).map_err(StudyError::from)?;
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let memory = arguments.memory.map(|bytes| [OsString::from("--memory"), bytes.to_string().into()]);
    let submission = Submission {
        program: std::env::current_exe()?,
        folder: absolute(&arguments.output),
        shards: arguments.shards,
        at_once: arguments.at_once,
        retries: arguments.retries,
        arguments: memory.into_iter().flatten().collect(),
        options: sbatch_options(&arguments.options).map_err(SlurmError::from)?,
    };
    submission.check(array_size())?;
    let ignored = ignored_variables();
    if !ignored.is_empty() {
        let names = ignored.join(", ");
        let _ = writeln!(
            io::stderr(),
            "not passed on to sbatch: {}; options for both jobs follow after --",
            printable(&names)
        );
    }
    if arguments.dry_run {
        return Ok(print_submission(&submission, stdout)?);
    }
    let folder = Folder::create(&arguments.output, &plan)?;
    let own = submission.own_folder();
    fs::create_dir_all(&own)
        .map_err(|error| StudyError::Folder { path: own, reason: format!("cannot be made: {error}") })?;
    for (path, script) in submission.scripts() {
        write_new(&path, true, |out| out.write_all(script.as_bytes()))?;
    }
    let jobs = submission.submit()?;
    // Warnings of sbatch are not a result.
    let _ = write!(io::stderr(), "{}", printable_lines(&jobs.notes));
    let (array, merge) = (&jobs.array, &jobs.merge);
    let path = quoted(folder.path().display().to_string());
    let tasks = if arguments.shards == 1 { "1 task".into() } else { format!("{} tasks", arguments.shards) };
    writeln!(stdout, "job {array}: {tasks}; job {merge}: the merge after them")?;
    writeln!(stdout, "squeue --jobs={array},{merge}, or asperity sweep status {path}, shows their progress")?;
    Ok(())
}

/// Prints the scripts and commands of a submission.
fn print_submission(submission: &Submission, stdout: &mut dyn Write) -> io::Result<()> {
    for (path, script) in submission.scripts() {
        writeln!(stdout, "==> {} <==\n{script}", path.display())?;
    }
    let command = |arguments: Vec<OsString>| {
        let words: Vec<_> = arguments.iter().map(quoted).collect();
        format!("sbatch {}", words.join(" "))
    };
    writeln!(stdout, "==> commands <==")?;
    writeln!(stdout, "{}", command(submission.array_arguments()))?;
    writeln!(stdout, "{}", command(submission.merge_arguments("ARRAY")))
}
