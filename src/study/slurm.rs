//! A study as an array of jobs of Slurm, one task for each shard.
//!
//! Slurm starts a task at least once: a task whose node is lost is started again, while the lost one may still be
//! running. That does no harm, as each attempt writes a file of its own and the merge counts a cell once. Slurm
//! is slow at restarts, so the script restarts a killed program at once, which continues where its results end. The task
//! that completes the study merges it.

use super::plan::PLAN_FILE;
use crate::scene::quoted;
use crate::text::{is_control, path_name};
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// A study for a cluster. All paths are absolute paths on its nodes.
#[derive(Clone, Debug)]
pub struct Submission {
    /// The program.
    pub program: PathBuf,
    /// The folder of the study, which also holds the plan.
    pub folder: PathBuf,
    /// Shards, each a task of the array.
    pub shards: u64,
    /// Most tasks at the same time, if limited.
    pub at_once: Option<u64>,
    /// Largest number of restarts of a killed program by its task.
    pub retries: u32,
    /// Most memory of a task, bytes.
    pub memory: Option<u64>,
}

impl Submission {
    /// Returns the script of the array. Its directives are defaults: variables `SBATCH_…` and options of sbatch override
    /// them.
    ///
    /// # Errors
    /// A path that a script of Slurm cannot contain.
    pub fn script(&self) -> Result<String, String> {
        let [program, folder] = [&self.program, &self.folder].map(|path| {
            // Slurm ends directives at a backslash and reads double quotes.
            let text =
                path.to_str().filter(|text| !text.contains(|c| c == '\\' || c == '"' || is_control(c)));
            text.ok_or_else(|| {
                format!(
                    "{}: a script of Slurm cannot contain this path; allowed: UTF-8 without backslashes, double \
                     quotes and control characters",
                    path_name(path)
                )
            })
        });
        let (program, folder) = (program?, folder?);
        let limit = self.at_once.map_or_else(String::new, |tasks| format!("%{tasks}"));
        let memory = self.memory.map_or_else(String::new, |bytes| format!(" --memory {bytes}"));
        Ok(format!(
            r#"#!/bin/sh
#SBATCH --job-name=asperity
#SBATCH --array=1-{shards}{limit}
#SBATCH --output="{log}/slurm-%A_%a.log"
#SBATCH --open-mode=append
#SBATCH --requeue
program={program}
folder={folder}
retry=0
while :; do
    "$program" sweep "$folder/{PLAN_FILE}" -o "$folder" --shard "$SLURM_ARRAY_TASK_ID/{shards}" \
        --jobs "${{SLURM_CPUS_PER_TASK:-${{SLURM_CPUS_ON_NODE:-1}}}}"{memory}
    status=$?
    # Statuses above 128 are signals; after hangup, interrupt and termination the task ends.
    case $status in 129 | 130 | 143) exit $status ;; esac
    [ $status -gt 128 ] && [ $retry -lt {retries} ] || exit $status
    retry=$((retry + 1))
    echo "killed by signal $((status - 128)): retry $retry of {retries}" >&2
done
"#,
            log = folder.replace('%', "%%"),
            program = quoted(program),
            folder = quoted(folder),
            shards = self.shards,
            retries = self.retries,
        ))
    }

    /// Submits the array with further options of sbatch and returns the answer of sbatch.
    ///
    /// # Errors
    /// As [`Submission::script`], and refusals of sbatch.
    pub fn submit(&self, options: &[OsString]) -> Result<String, String> {
        let not_run = |error: io::Error| {
            match error.kind() {
            io::ErrorKind::NotFound => {
                "sbatch was not found; run this command on a login node of a Slurm cluster, or see asperity sweep \
                 submit --help for hosts without a scheduler"
                    .to_owned()
            }
            _ => format!("sbatch could not be run: {error}"),
        }
        };
        let script = self.script()?;
        let mut command = Command::new("sbatch");
        command.args(options).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut sbatch = command.spawn().map_err(not_run)?;
        if let Some(mut stdin) = sbatch.stdin.take() {
            // sbatch may refuse its options before it reads the script.
            let _ = stdin.write_all(script.as_bytes());
        }
        let output = sbatch.wait_with_output().map_err(not_run)?;
        let [answer, message] =
            [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
        if output.status.success() {
            return Ok(message + &answer);
        }
        let reason = if message.trim().is_empty() { "no error message" } else { message.trim() };
        Err(format!("sbatch failed ({}): {reason}", output.status))
    }
}
