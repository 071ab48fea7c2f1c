//! `asperity sweep submit`: submits a study to a Slurm cluster as an array of jobs. The array has
//! one task for each shard (part of the study).
//!
//! If a node is lost, Slurm starts the task of this node again, while the lost task may still be
//! running. This does no harm, because each attempt writes a file of its own, and the merge counts
//! a record only once. But Slurm takes a long time to restart a task. Therefore the script of the
//! task restarts a killed program immediately, and the program computes only the records that are
//! still missing. The task that completes the study merges the results.

use crate::cli::error::CliError;
use crate::cli::scene::Overrides;
use crate::cli::typed::program_path;
use asperity_data::{is_control, path_name, printable_lines};
use asperity_scene::text::quoted;
use asperity_study::{Changes, Folder, Plan};
use clap::Args;
use std::ffi::OsString;
use std::io;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const EXAMPLES: &str = "\
Examples:
  asperity sweep submit figure-5b -o study --jobs 100 --check
  asperity sweep submit figure-5b -o study --jobs 100 -- --partition=short --time=2:00:00

One task of the array computes one shard, on as many threads as it has processors; the last one
merges. A killed program is started again within its task, a task whose node is lost on another
node, and both go on where the results end. Whatever is computed twice is counted once. The folder
must be seen by all nodes; it receives the messages of the tasks. Behind -- go the options of
sbatch, such as --array=1-100%10 for at most ten tasks at a time.

Without a scheduler, GNU parallel does it on this machine, or with --sshlogin on others that see the
folder; the same line goes on with what has failed:
  seq 8 | parallel --joblog shards.log --resume-failed --retries 3 \\
    asperity sweep my-plan.ron -o study --shard {}/8 --jobs 1";

/// Number of times that the script of a task restarts a killed program.
const RETRIES: u32 = 3;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SubmitArguments {
    /// A plan file, or the name of a built-in plan
    pub plan: String,
    /// Folder of the study, visible to all nodes; created if missing
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Jobs of the array, which compute one part of the plan each
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub jobs: u64,
    /// Random profiles of each cell, in place of the number in the plan
    #[arg(long = "profiles", value_name = "COUNT")]
    pub lines: Option<u64>,
    /// Print the script for sbatch; write and submit nothing
    #[arg(long)]
    pub check: bool,
    #[command(flatten)]
    pub overrides: Overrides,
    /// Options of sbatch, after --: --partition=short, -t 2:00:00
    #[arg(last = true, value_name = "SBATCH OPTIONS")]
    pub options: Vec<OsString>,
}

pub(super) fn submit(arguments: &SubmitArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let changes = Changes {
        set: arguments.overrides.set.clone(),
        lines: arguments.lines,
    };
    let plan = Plan::open(&arguments.plan, &changes)?;
    let script = script(
        arguments,
        &program_path()?,
        &std::path::absolute(&arguments.output)?,
    )?;
    if arguments.check {
        return Ok(stdout.write_all(script.as_bytes())?);
    }
    let folder = Folder::create(&arguments.output, &plan)?;
    let answer = answer_of_sbatch(&script, &arguments.options).map_err(CliError::message)?;
    let path = quoted(folder.path());
    writeln!(
        stdout,
        "{}\nasperity sweep status {path} shows the progress",
        printable_lines(answer.trim())
    )?;
    Ok(())
}

/// Returns the job script, with paths that are absolute on the nodes. Its directives are defaults,
/// over which variables `SBATCH_…` and options of sbatch have precedence.
fn script(arguments: &SubmitArguments, program: &Path, folder: &Path) -> Result<String, CliError> {
    let program = path_in_script(program)?;
    let folder = path_in_script(folder)?;
    Ok(format!(
        r#"#!/bin/sh
#SBATCH --job-name=asperity
#SBATCH --array=1-{shards}
#SBATCH --output="{log}/slurm-%A_%a.log"
#SBATCH --open-mode=append
#SBATCH --requeue
program={program}
folder={folder}
retry=0
while :; do
    "$program" sweep "$folder/plan.ron" -o "$folder" --shard "$SLURM_ARRAY_TASK_ID/{shards}" \
        --jobs "${{SLURM_CPUS_PER_TASK:-${{SLURM_CPUS_ON_NODE:-1}}}}"
    status=$?
    # Statuses above 128 are signals; after hangup, interrupt and termination the task ends.
    case $status in 129 | 130 | 143) exit $status ;; esac
    [ $status -gt 128 ] && [ $retry -lt {RETRIES} ] || exit $status
    retry=$((retry + 1))
    echo "killed by signal $((status - 128)): retry $retry of {RETRIES}" >&2
done
"#,
        log = folder.replace('%', "%%"),
        program = quoted(program),
        folder = quoted(folder),
        shards = arguments.jobs,
    ))
}

/// Returns a path as text. A path with a backslash or a double quote is refused, because Slurm
/// would read another path in a directive.
fn path_in_script(path: &Path) -> Result<&str, CliError> {
    match path.to_str() {
        Some(text) if !text.contains(|c| c == '\\' || c == '"' || is_control(c)) => Ok(text),
        _ => {
            let refused = "a script of Slurm cannot contain this path; allowed: UTF-8 without backslashes, double quotes and \
                           control characters";
            Err(CliError::named(path_name(path), refused))
        }
    }
}

fn not_run(error: io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => {
            "sbatch was not found; run this command on a login node of a Slurm cluster, or see asperity sweep submit \
             --help for hosts without a scheduler"
                .to_owned()
        }
        _ => format!("sbatch could not be run: {error}"),
    }
}

/// Submits a script with further options of sbatch. Returns the answer of sbatch or, if sbatch
/// refuses the script, the reason.
fn answer_of_sbatch(script: &str, options: &[OsString]) -> Result<String, String> {
    let mut command = Command::new("sbatch");
    command
        .args(options)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut sbatch = command.spawn().map_err(not_run)?;
    if let Some(mut stdin) = sbatch.stdin.take() {
        // An error in writing is ignored, because sbatch may refuse its options before it reads the
        // script.
        let _ = stdin.write_all(script.as_bytes());
    }
    let output = sbatch.wait_with_output().map_err(not_run)?;
    let [answer, message] =
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    if output.status.success() {
        return Ok(message + &answer);
    }
    let reason = if message.trim().is_empty() {
        "no error message"
    } else {
        message.trim()
    };
    Err(format!("sbatch failed ({}): {reason}", output.status))
}
