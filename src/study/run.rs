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
use std::io::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};
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
    /// Records on the disk so far, and their time since the file was made, ns.
    written: AtomicU64,
    elapsed: AtomicU64,
    failed: AtomicBool,
    error: Mutex<Option<StudyError>>,
    stop: &'a (dyn Fn() -> bool + Sync),
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
    let progress = |written: u64, elapsed: u64| Progress {
        done: before + written,
        before,
        total,
        elapsed: Duration::from_nanos(elapsed),
    };
    report(&progress(0, 0));
    if before == total {
        return Ok(progress(0, 0));
    }
    // Read once, so that all threads compute from the same bytes, even if the file changes meanwhile.
    let profile = profile(folder.plan(), folder.path())?;
    let clock = Instant::now();
    let (path, file) = folder.new_file(options.shard)?;
    let units = options.shard.units(cells.units()).map(|unit| cells.unit(unit));
    let work = &SharedWork::new(&cells, units);
    let (written, elapsed) = (AtomicU64::new(0), AtomicU64::new(0));
    let (failed, error) = (AtomicBool::new(false), Mutex::new(None));
    let shared = &Shared { folder, done, written, elapsed, failed, error, stop };
    let now = || progress(shared.written.load(Ordering::SeqCst), shared.elapsed.load(Ordering::SeqCst));
    std::thread::scope(|scope| {
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
        if let Err(error) = begun {
            shared.fail(StudyError::NoThread(error));
        }
        shared.write((path.as_path(), file), clock, receiver, &mut || report(&now()));
    });
    let error = shared.error.lock().unwrap_or_else(PoisonError::into_inner).take();
    if let Some(error) = error {
        return Err(error);
    }
    let progress = now();
    report(&progress);
    Ok(progress)
}

impl Shared<'_> {
    fn fail(&self, error: StudyError) {
        self.failed.store(true, Ordering::SeqCst);
        self.error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }

    fn ends(&self) -> bool {
        self.failed.load(Ordering::SeqCst) || (self.stop)()
    }

    /// Writes records as they arrive. Syncs with the disk after the longest wait and at the end. Counts only
    /// records that have reached the disk.
    fn write(
        &self,
        (path, mut file): (&Path, File),
        clock: Instant,
        receiver: Receiver<String>,
        report: &mut dyn FnMut(),
    ) {
        let mut synced = Instant::now();
        let mut reported = Instant::now();
        let (mut pending, mut elapsed) = (0, Duration::ZERO);
        let mut text = String::with_capacity(BUFFER);
        let failed = StudyError::unwritable(path);
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
                if let Err(reason) = file.write_all(text.as_bytes()) {
                    return self.fail(failed(reason));
                }
                elapsed = clock.elapsed();
                pending += text.bytes().filter(|&byte| byte == b'\n').count() as u64;
            }
            if pending > 0 && (ended || synced.elapsed() >= SYNC) {
                if let Err(reason) = file.sync_all() {
                    return self.fail(failed(reason));
                }
                self.written.fetch_add(pending, Ordering::SeqCst);
                self.elapsed.store(elapsed.as_nanos() as u64, Ordering::SeqCst);
                (synced, pending) = (Instant::now(), 0);
            }
            if reported.elapsed() >= TICK {
                report();
                reported = Instant::now();
            }
            if ended {
                return;
            }
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
            true if self.shared.ends() => Next::End,
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
                self.shared.fail(StudyError::Run { cell, coordinates, seed, error });
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
