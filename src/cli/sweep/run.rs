//! `asperity sweep PLAN`: computes a study or, if a part of it is computed already, the missing
//! records.

use super::merge::write_merged;
use crate::cli::error::CliError;
use crate::cli::progress::{ProgressLine, SignalWatch};
use crate::cli::scene::{Overrides, threads};
use asperity_data::{Control, counted, memory_size};
use asperity_report::{counted_record_texts, progress_text};
use asperity_study::folders::Status;
use asperity_study::{Changes, Folder, Plan, Shard, StudyProgress, StudyRun, merge, run_study};
use clap::Args;
use std::io;
use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Time between two lines of progress, if standard error is not a terminal.
const BETWEEN: Duration = Duration::from_secs(10);

#[derive(Args, Debug)]
pub struct SweepRunArguments {
    /// A plan file, or the name of a built-in plan (see `asperity sweep plans`)
    #[arg(required = true)]
    pub plan: Option<String>,
    /// Folder of the study; created if missing
    #[arg(short, long, value_name = "DIR", required_unless_present = "check")]
    pub output: Option<PathBuf>,
    /// Threads; default: one for each core
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Compute only part K of N; the part that completes the study merges it
    ///
    /// All parts write to the same folder, or their folders are copied into one before merging.
    #[arg(long, value_name = "K/N")]
    pub shard: Option<Shard>,
    /// Random profiles of each cell, in place of the number in the plan
    #[arg(long = "profiles", value_name = "COUNT")]
    pub lines: Option<u64>,
    /// Check the plan and print its cost, without computing
    #[arg(long)]
    pub check: bool,
    #[command(flatten)]
    pub overrides: Overrides,
}

pub(super) fn run(arguments: &SweepRunArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let changes = Changes {
        set: arguments.overrides.set.clone(),
        lines: arguments.lines,
    };
    // `plan` is `None` only if there is a subcommand, as the argument parser ensures. So a plan is
    // given here.
    let plan = Plan::open(arguments.plan.as_deref().unwrap_or_default(), &changes)?;
    let jobs = threads(arguments.jobs) as u64;
    let text = cost_of(&plan, jobs)?;
    let mut stderr = io::stderr();
    if arguments.check {
        writeln!(stdout, "{text}")?;
        return Ok(());
    }
    let _ = writeln!(stderr, "{text}");
    let Some(output) = &arguments.output else {
        return Ok(());
    };
    let folder = Folder::create(output, &plan)?;
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let computed = compute(&folder, shard, jobs as usize)?;
    for text in counted_record_texts(&computed.warnings, computed.progress.computed()) {
        let _ = writeln!(stderr, "warning: {text}");
    }
    if let Some(shard) = arguments.shard {
        let total = computed.progress.total;
        let _ = writeln!(stderr, "all {total} records of shard {shard} exist");
        // The process that completes the study merges its records. If two processes finish at the
        // same time, both of them merge, with the same result.
        if Status::of(&folder)?.missing > 0 {
            return Ok(());
        }
    }
    write_merged(&folder, &merge(&folder)?, stdout)
}

/// Returns as text the number of records of a plan, and the memory that `jobs` threads need.
fn cost_of(plan: &Plan, jobs: u64) -> Result<String, CliError> {
    Ok(format!(
        "{} on {}: {}; {}, at most {} of memory",
        counted(plan.cells(), "cell"),
        counted(plan.lines, "profile"),
        counted(plan.records_in_all(), "record"),
        counted(jobs, "thread"),
        memory_size(plan.memory(jobs)?)
    ))
}

/// Computes the missing records of one part of a study. The progress is shown meanwhile.
fn compute(folder: &Folder, shard: Shard, threads: usize) -> Result<StudyRun, CliError> {
    let watch = SignalWatch::begin()?;
    let stop = || watch.is_signalled();
    let mut line = ProgressLine::default();
    let mut printed = None::<Instant>;
    let mut report = |progress: &StudyProgress| {
        let text = progress_text(progress);
        let is_due =
            progress.is_complete() || printed.is_none_or(|printed| printed.elapsed() >= BETWEEN);
        if is_due {
            printed = Some(Instant::now());
        }
        line.show(&text, is_due.then_some(&text));
    };
    let control = Control::default()
        .on_threads(threads)
        .stopped_by(&stop)
        .reporting_to(&mut report);
    let ended = run_study(folder, shard, control);
    line.keep();
    let ended = ended?;
    if !ended.progress.is_complete() {
        let StudyProgress { done, total, .. } = ended.progress;
        let stopped = format!(
            "stopped: {done} of {total} records are complete; the same command continues the study"
        );
        return Err(watch.interrupted(stopped));
    }
    Ok(ended)
}
