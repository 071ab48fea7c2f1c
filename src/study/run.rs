//! Computation of the missing records of a plan on all cores, with the same bits for any number of them.

use super::StudyError;
use super::cells::Cells;
use super::measured::profile;
use super::record::{Done, Key, encode};
use super::recorder::{Recorder, Records};
use super::shard::Shard;
use super::solve::{Case, Next, SharedWork, Sink};
use super::status::{count, rate};
use super::store::Folder;
use crate::parallel::begin_threads;
use crate::simulation::{RunError, Simulation};
use std::fs::File;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Longest wait of written records for the disk; records lost by a power cut are computed again. One sync costs
/// tenths of a millisecond or, on network file systems, many of them: on a local disk 100 000 records of 256
/// springs take 11 s with this wait, 12 s if each sync takes the records of the time of the one before, and 190 s
/// with a sync for each record. Cells of thousands of springs show no difference.
const SYNC: Duration = Duration::from_millis(50);
/// Records on their way to the file.
const WAITING: usize = 4096;
/// Bytes gathered before they are written.
const BUFFER: usize = 1 << 16;
/// Interval between reports of progress.
const TICK: Duration = Duration::from_millis(200);

/// Options of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Threads.
    pub jobs: usize,
    /// The part of the plan.
    pub shard: Shard,
}

/// Progress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Existing records of this part of the plan.
    pub done: u64,
    /// Records that existed before this run.
    pub before: u64,
    /// All records of this part of the plan.
    pub total: u64,
    /// Time from the beginning of the file of this run to the last records in it.
    pub elapsed: Duration,
}

impl Progress {
    /// Returns true if every record of this part of the plan exists.
    pub fn is_complete(&self) -> bool {
        self.done == self.total
    }

    /// Records per second, as [`super::Attempt::rate`]; `None` before the first record.
    pub fn rate(&self) -> Option<f64> {
        rate(self.done - self.before, self.elapsed.as_secs_f64())
    }

    /// Time left, at the rate so far; `None` before the first record.
    pub fn left(&self) -> Option<Duration> {
        let seconds = (self.total - self.done) as f64 / self.rate()?;
        Duration::try_from_secs_f64(seconds).ok()
    }
}

/// Shared state of all threads of a run.
struct Shared<'a> {
    folder: &'a Folder,
    done: Done,
    error: Mutex<Option<StudyError>>,
    stop: &'a (dyn Fn() -> bool + Sync),
}

impl Shared<'_> {
    fn error(&self) -> MutexGuard<'_, Option<StudyError>> {
        self.error.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Computes the missing records of a part of the plan. `stop` is polled after each run; `report` is called now and
/// then and at the end.
///
/// # Errors
/// A record that cannot be computed or written. Earlier records are kept.
pub fn run(
    folder: &Folder,
    options: Options,
    stop: &(dyn Fn() -> bool + Sync),
    report: &mut dyn FnMut(&Progress),
) -> Result<Progress, StudyError> {
    let cells = Cells::of(folder.plan());
    let done = folder.done()?;
    let (total, before) = count(folder, &cells, &done, options.shard);
    let mut progress = Progress { done: before, before, total, elapsed: Duration::ZERO };
    report(&progress);
    if progress.is_complete() {
        return Ok(progress);
    }
    // Read once, so that all threads compute from the same bytes, even if the file changes meanwhile.
    let profile = profile(folder.plan(), folder.path())?;
    let clock = Instant::now();
    let (path, mut file) = folder.new_file(options.shard)?;
    let work = &SharedWork::new(&cells, options.shard.units(cells.units()).map(|unit| cells.unit(unit)));
    let shared = &Shared { folder, done, error: Mutex::new(None), stop };
    let written = std::thread::scope(|scope| {
        let (sender, receiver) = sync_channel(WAITING);
        let begun = begin_threads(scope, options.jobs.max(1), move || {
            let simulation = Simulation::new(PathBuf::new());
            let simulation = match profile {
                Some(profile) => simulation.with_measured(profile),
                None => simulation,
            };
            let recorder = Recorder::new(folder.plan(), simulation, &|| false);
            work.solve(recorder, &mut FolderSink { shared, sender });
        });
        // If the system starts fewer threads than requested, those do all the work.
        begun.map_err(StudyError::NoThread)?;
        write(&mut file, receiver, clock, &mut progress, report).map_err(StudyError::unwritable(&path))
    });
    if let Some(error) = shared.error().take() {
        return Err(error);
    }
    written?;
    report(&progress);
    Ok(progress)
}

/// Writes records as they arrive. Syncs with the disk after the longest wait and at the end; the progress counts only
/// records that have reached the disk.
fn write(
    file: &mut File,
    receiver: Receiver<String>,
    clock: Instant,
    progress: &mut Progress,
    report: &mut dyn FnMut(&Progress),
) -> io::Result<()> {
    let (mut synced, mut reported) = (Instant::now(), Instant::now());
    let (mut pending, mut elapsed) = (0, Duration::ZERO);
    let mut text = String::with_capacity(BUFFER);
    loop {
        let wait = if pending > 0 { SYNC.saturating_sub(synced.elapsed()) } else { TICK };
        let first = receiver.recv_timeout(wait.min(TICK));
        let ended = matches!(first, Err(RecvTimeoutError::Disconnected));
        text.clear();
        if let Ok(first) = first {
            text.push_str(&first);
            while text.len() < BUFFER
                && let Ok(next) = receiver.try_recv()
            {
                text.push_str(&next);
            }
            file.write_all(text.as_bytes())?;
            elapsed = clock.elapsed();
            pending += text.bytes().filter(|&byte| byte == b'\n').count() as u64;
        }
        if pending > 0 && (ended || synced.elapsed() >= SYNC) {
            file.sync_all()?;
            (progress.done, progress.elapsed) = (progress.done + pending, elapsed);
            (synced, pending) = (Instant::now(), 0);
        }
        if reported.elapsed() >= TICK {
            report(progress);
            reported = Instant::now();
        }
        if ended {
            return Ok(());
        }
    }
}

/// Sink of one thread: lines of text for the file of the run.
struct FolderSink<'a> {
    shared: &'a Shared<'a>,
    sender: SyncSender<String>,
}

impl FolderSink<'_> {
    fn is_missing(&self, cell: u64, line: u64) -> bool {
        !self.shared.done.has(cell * self.shared.folder.plan().lines + line)
    }
}

impl Sink for FolderSink<'_> {
    fn next(&mut self, case: &Case) -> Next {
        match case.cells.clone().any(|cell| self.is_missing(cell, case.line)) {
            false => Next::Skip,
            true if (self.shared.stop)() || self.shared.error().is_some() => Next::End,
            true => Next::Solve,
        }
    }

    fn take(&mut self, case: Case, records: Result<Records, RunError>) -> ControlFlow<()> {
        let plan = self.shared.folder.plan();
        let seed = plan.seed_of(case.line);
        let records = match records {
            Ok(records) => records,
            Err(error) => {
                let (cell, coordinates) = (case.cells.start, plan.coordinates(case.cells.start));
                let error = StudyError::Run { cell, coordinates, seed, error };
                self.shared.error().get_or_insert(error);
                return ControlFlow::Break(());
            }
        };
        let mut text = String::new();
        for (cell, values) in case.cells.zip(&records).filter(|(cell, _)| self.is_missing(*cell, case.line)) {
            encode(Key { cell, seed }, values, &mut text);
        }
        // The writer has ended if the text has no receiver.
        if self.sender.send(text).is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}
