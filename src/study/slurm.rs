//! A sweep as jobs of Slurm: an array with one task for each shard, and a merge that waits for all of them.
//!
//! Slurm starts a task at least once: a task whose node is lost is started again, while the lost one may still be
//! running. That does no harm, as each attempt writes a file of its own and the merge counts a cell once. Slurm
//! is slow at restarts, so the script of the task restarts a killed program at once, which continues where its
//! results end.

use super::plan::PLAN_FILE;
pub use super::sbatch::{SbatchOption, SbatchOptionError, sbatch_options};
use crate::scene::quoted;
use crate::text::{is_control, path_name};
use std::ffi::OsString;
use std::io;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use thiserror::Error;

/// Tasks of an array if the cluster does not state their number: Slurm's own `MaxArraySize`, one more than the
/// largest number of a task.
const USUAL_ARRAY_SIZE: u64 = 1001;

/// A sweep for a cluster. All paths are absolute paths on its nodes.
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
    /// Further arguments of the program, such as `--memory`.
    pub arguments: Vec<OsString>,
    /// Options of sbatch for both jobs.
    pub options: Vec<SbatchOption>,
}

/// The two jobs of a sweep, by their numbers in Slurm.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Jobs {
    /// The array.
    pub array: String,
    /// The merge.
    pub merge: String,
    /// Other messages of sbatch, such as warnings.
    pub notes: String,
}

/// Reason for not submitting a sweep.
#[derive(Debug, Error)]
pub enum SlurmError {
    /// The cluster's arrays are smaller.
    #[error(
        "--shards {shards}: this cluster has arrays of at most {most} tasks (its MaxArraySize is {size}); \
             allowed: 1 to {most}, each shard computes as many cells as it takes"
    )]
    TooManyShards {
        /// Requested shards.
        shards: u64,
        /// The largest number of a task.
        most: u64,
        /// The cluster's `MaxArraySize`, one more.
        size: u64,
    },
    /// An option of sbatch that the user cannot set.
    #[error(transparent)]
    Option(#[from] SbatchOptionError),
    /// A path cannot be given to a job.
    #[error(
        "{}: a job of Slurm cannot have this path; allowed: UTF-8 without a backslash or control characters",
        path_name(path)
    )]
    Path {
        /// The path.
        path: PathBuf,
    },
    /// There is no Slurm.
    #[error(
        "sbatch: there is no such program here; a login node of a Slurm cluster has it. Without a scheduler: {instead}"
    )]
    NoSlurm {
        /// Alternative command.
        instead: String,
    },
    /// A program of Slurm cannot be started.
    #[error("sbatch: cannot be started: {0}")]
    NotStarted(io::Error),
    /// A job was refused.
    #[error("sbatch refuses {job}: {reason}")]
    Refused {
        /// Job of the two.
        job: &'static str,
        /// Message of sbatch.
        reason: String,
    },
    /// The array was submitted, but its number is unknown.
    #[error(
        "sbatch took the array and did not answer with the number of a job, but: {answer}\n\
         The merge was not submitted. squeue --me lists the array, scancel ends it"
    )]
    NoNumber {
        /// Message of sbatch.
        answer: String,
    },
    /// The merge was refused, and the array submitted before was cancelled.
    #[error("sbatch refuses the merge: {reason}\nThe array {array} {cancelled}")]
    MergeRefused {
        /// The array.
        array: String,
        /// Message of sbatch.
        reason: String,
        /// Fate of the array.
        cancelled: String,
    },
}

impl Submission {
    /// Checks everything that needs no job; `array_size` is that of [`array_size`].
    ///
    /// # Errors
    /// More shards than tasks in the cluster's arrays; paths that a job of Slurm cannot have.
    pub fn check(&self, array_size: u64) -> Result<(), SlurmError> {
        let most = array_size.saturating_sub(1);
        if self.shards > most {
            return Err(SlurmError::TooManyShards { shards: self.shards, most, size: array_size });
        }
        for path in [&self.program, &self.folder] {
            // Slurm expands patterns in the names of its output files and ends them at a backslash.
            if path.to_str().is_none_or(|path| path.contains(|c| c == '\\' || is_control(c))) {
                return Err(SlurmError::Path { path: path.clone() });
            }
        }
        Ok(())
    }

    /// Paths and contents of both scripts.
    #[must_use]
    pub fn scripts(&self) -> [(PathBuf, String); 2] {
        [(self.shard_path(), self.shard_script()), (self.merge_path(), self.merge_script())]
    }

    /// The script of a task of the array.
    fn shard_script(&self) -> String {
        let arguments: String =
            self.arguments.iter().map(|argument| format!(" {}", quoted(argument))).collect();
        format!(
            r#"{head}
retries={retries}
retry=0
while :; do
    "$program" sweep "$folder/{PLAN_FILE}" -o "$folder" --shard "$SLURM_ARRAY_TASK_ID/{shards}" \
        --jobs "${{SLURM_CPUS_PER_TASK:-${{SLURM_CPUS_ON_NODE:-1}}}}"{arguments}
    status=$?
    case $status in
    # Asked to end: hung up, interrupted, terminated.
    129 | 130 | 143) exit $status ;;
    # Killed by any other signal.
    1[3-9]? | 2??) ;;
    # Done, or failed in a way that it would again.
    *) exit $status ;;
    esac
    [ $retry -lt $retries ] || exit $status
    retry=$((retry + 1))
    echo "killed by signal $((status - 128)): retry $retry of $retries" >&2
done
"#,
            head = self.head(
                "One shard of a sweep, the task of an array; started again, it goes on where its results end."
            ),
            retries = self.retries,
            shards = self.shards,
        )
    }

    fn merge_script(&self) -> String {
        let head = self.head("The merge of a sweep, once all its shards are done.");
        format!("{head}\nexec \"$program\" sweep merge \"$folder\"\n")
    }

    fn head(&self, what: &str) -> String {
        let [program, folder] = [&self.program, &self.folder].map(quoted);
        format!("#!/bin/sh\n# {what}\nprogram={program}\nfolder={folder}")
    }

    /// Folder of the scripts and of the messages of the jobs.
    #[must_use]
    pub fn own_folder(&self) -> PathBuf {
        self.folder.join("slurm")
    }

    fn shard_path(&self) -> PathBuf {
        self.own_folder().join("shard.sh")
    }

    fn merge_path(&self) -> PathBuf {
        self.own_folder().join("merge.sh")
    }

    /// Arguments of sbatch for the array. The user's options follow those they may override and precede those they
    /// may not.
    #[must_use]
    pub fn array_arguments(&self) -> Vec<OsString> {
        let mut arguments = self.first_arguments("asperity-sweep", "%A_%a.log");
        let limit = self.at_once.map_or_else(String::new, |tasks| format!("%{tasks}"));
        arguments.extend([format!("--array=1-{}{limit}", self.shards).into(), "--requeue".into()]);
        arguments.push(self.shard_path().into());
        arguments
    }

    /// Arguments of sbatch for the merge that waits for an array.
    #[must_use]
    pub fn merge_arguments(&self, array: &str) -> Vec<OsString> {
        let mut arguments = self.first_arguments("asperity-merge", "merge-%j.log");
        arguments
            .extend([format!("--dependency=afterok:{array}").into(), "--kill-on-invalid-dep=yes".into()]);
        arguments.extend(["--requeue", "--ntasks=1", "--cpus-per-task=1"].map(OsString::from));
        arguments.push(self.merge_path().into());
        arguments
    }

    fn first_arguments(&self, name: &str, log: &str) -> Vec<OsString> {
        let folder = self.own_folder().to_string_lossy().replace('%', "%%");
        let output = format!("--output={folder}/{log}").into();
        let mut arguments = vec!["--parsable".into(), format!("--job-name={name}").into(), output];
        arguments.push("--open-mode=append".into());
        arguments.extend(self.options.iter().map(|option| OsString::from(option.to_string())));
        arguments
    }

    /// Command for hosts without a scheduler, with GNU parallel.
    #[must_use]
    pub fn without_scheduler(&self) -> String {
        let plan = self.folder.join(PLAN_FILE);
        let [program, plan, folder] = [&self.program, &plan, &self.folder].map(quoted);
        let shards = self.shards;
        format!(
            "seq {shards} | parallel --joblog shards.log --resume-failed --retries 3 \
             {program} sweep {plan} -o {folder} --shard {{}}/{shards} --jobs 1 && {program} sweep merge {folder}"
        )
    }

    /// Submits the array and the merge; their scripts must exist.
    ///
    /// # Errors
    /// Slurm is missing or refuses one of the two. An array whose merge is refused is cancelled.
    pub fn submit(&self) -> Result<Jobs, SlurmError> {
        let (array, mut notes) = self.sbatch("the array", &self.array_arguments())?;
        match self.sbatch("the merge", &self.merge_arguments(&array.number)) {
            Ok((merge, more)) => {
                notes.push_str(&more);
                Ok(Jobs { array: array.number, merge: merge.number, notes })
            }
            Err(error) => {
                let reason = match error {
                    SlurmError::Refused { reason, .. } => reason,
                    SlurmError::NoNumber { answer } => format!("no number of a job: {answer}"),
                    other => other.to_string(),
                };
                let cancelled =
                    if array.cancel() { "was cancelled." } else { "still runs: scancel ends it." };
                Err(SlurmError::MergeRefused { array: array.number, reason, cancelled: cancelled.into() })
            }
        }
    }

    fn sbatch(&self, job: &'static str, arguments: &[OsString]) -> Result<(Job, String), SlurmError> {
        let Output { status, stdout, stderr } =
            command("sbatch").args(arguments).output().map_err(|error| {
                if error.kind() == io::ErrorKind::NotFound {
                    SlurmError::NoSlurm { instead: self.without_scheduler() }
                } else {
                    SlurmError::NotStarted(error)
                }
            })?;
        let said = String::from_utf8_lossy(&stderr).into_owned();
        let answer = String::from_utf8_lossy(&stdout).trim().to_owned();
        if status.success()
            && let Some(job) = Job::of(&answer)
        {
            return Ok((job, said));
        }
        let reason = [said.trim(), &answer].into_iter().filter(|text| !text.is_empty());
        let reason = reason.collect::<Vec<_>>().join("\n");
        let reason = if reason.is_empty() { format!("{status}, without a word") } else { reason };
        if status.success() {
            return Err(SlurmError::NoNumber { answer: reason });
        }
        Err(SlurmError::Refused { job, reason })
    }
}

/// A job accepted by sbatch.
#[derive(Debug, PartialEq, Eq)]
struct Job {
    number: String,
    /// Name of the cluster, if there are several.
    cluster: Option<String>,
}

impl Job {
    /// Job of the answer of `sbatch --parsable`: exactly `number` or `number;cluster`.
    fn of(answer: &str) -> Option<Job> {
        let (number, cluster) = match answer.split_once(';') {
            Some((number, cluster)) => (number, Some(cluster)),
            None => (answer, None),
        };
        let is_number = number.bytes().all(|byte| byte.is_ascii_digit())
            && number.parse::<u32>().is_ok_and(|number| number > 0);
        let named = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte);
        let is_cluster = cluster.is_none_or(|name| !name.is_empty() && name.bytes().all(named));
        (is_number && is_cluster)
            .then(|| Job { number: number.to_owned(), cluster: cluster.map(str::to_owned) })
    }

    fn cancel(&self) -> bool {
        let mut scancel = command("scancel");
        scancel.args(self.cluster.iter().map(|cluster| format!("--clusters={cluster}"))).arg(&self.number);
        scancel.output().is_ok_and(|output| output.status.success())
    }
}

/// A program of Slurm controlled by its arguments alone, without the variables that would act as options.
fn command(program: &str) -> Command {
    let mut command = Command::new(program);
    for name in variables_of(program) {
        command.env_remove(name);
    }
    command.stdin(Stdio::null());
    command
}

/// Environment variables that a program of Slurm would take for options.
fn variables_of(program: &str) -> Vec<OsString> {
    let beginning = program.to_ascii_uppercase() + "_";
    let is_option = |name: &OsString| name.to_string_lossy().starts_with(&beginning);
    std::env::vars_os().map(|(name, _)| name).filter(is_option).collect()
}

/// Names of the environment variables of sbatch that are removed.
#[must_use]
pub fn ignored_variables() -> Vec<String> {
    let mut names: Vec<_> =
        variables_of("sbatch").iter().map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// The cluster's `MaxArraySize`, one more than the largest number of a task; Slurm's own if the cluster states none.
#[must_use]
pub fn array_size() -> u64 {
    let output = command("scontrol").args(["show", "config"]).output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    size_in(&text).unwrap_or(USUAL_ARRAY_SIZE)
}

fn size_in(config: &str) -> Option<u64> {
    let value =
        config.lines().find_map(|line| line.trim().strip_prefix("MaxArraySize")?.trim().strip_prefix('='));
    value?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_a_job_is_that_and_nothing_else() {
        let job = |number: &str, cluster: Option<&str>| {
            Some(Job { number: number.into(), cluster: cluster.map(str::to_owned) })
        };
        assert_eq!(Job::of("17"), job("17", None));
        assert_eq!(Job::of("21;east"), job("21", Some("east")));
        for wrong in [
            "",
            "0",
            "+17",
            "-17",
            "17 ",
            "17\n18",
            "Submitted batch job 17",
            "17;",
            "17;a b",
            "17;east;west",
            "99999999999",
            "1 7",
        ] {
            assert_eq!(Job::of(wrong), None, "{wrong:?}");
        }
    }
}
