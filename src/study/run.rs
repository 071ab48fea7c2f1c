//! Computes what is missing of a plan: all cores, the same bits however many there are.

use super::StudyError;
use super::cells::{Cells, Unit};
use super::measure::Measurer;
use super::measured::profile;
use super::record::{Key, encode};
use super::shard::Shard;
use super::status::count;
use super::store::{Done, Folder};
use crate::disk::DiskFile;
use crate::io::WriteError;
use crate::parallel::on_this_thread;
use crate::simulation::RunError;
use crate::surface::MeasuredRoughness;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long written records wait for the disk at the most; a power cut loses them, and they are computed again.
/// Syncing each costs tenths of a millisecond or, on network file systems, many of them: on a local disk 100 000
/// records of 256 springs take 11 s with this, 12 s where each sync takes what has come during the one before,
/// and 190 s where each record has its own. Cells of thousands of springs show no difference.
const SYNC: Duration = Duration::from_millis(50);
/// Records on their way to the file.
const WAITING: usize = 4096;
/// Bytes that are gathered before they are written.
const BUFFER: usize = 1 << 16;
/// How often progress is told.
const TICK: Duration = Duration::from_millis(200);

/// How a run is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Threads.
    pub jobs: usize,
    /// The part of the plan.
    pub shard: Shard,
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Records that there are, of this part of the plan.
    pub done: u64,
    /// Those that were there before.
    pub before: u64,
    /// Those there are to be.
    pub total: u64,
    /// Time since the run began.
    pub elapsed: Duration,
}

impl Progress {
    /// Records each second.
    #[must_use]
    pub fn rate(&self) -> f64 {
        (self.done - self.before) as f64 / self.elapsed.as_secs_f64().max(1e-9)
    }

    /// Time left, by the rate so far; `None` before the first record.
    #[must_use]
    pub fn left(&self) -> Option<Duration> {
        let seconds = (self.total - self.done) as f64 / self.rate();
        Duration::try_from_secs_f64(seconds).ok()
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// How far it came.
    pub progress: Progress,
    /// Whether everything of this part of the plan is there.
    pub complete: bool,
}

/// What all threads of a run see.
struct Shared<'a> {
    folder: &'a Folder,
    cells: Cells,
    done: Done,
    shard: Shard,
    next: AtomicU64,
    /// Records that have reached the disk so far.
    written: AtomicU64,
    /// That of the study's measured file, where it has one.
    profile: Option<Arc<MeasuredRoughness>>,
    failed: AtomicBool,
    error: Mutex<Option<StudyError>>,
    stop: &'a (dyn Fn() -> bool + Sync),
}

/// Computes the records of a part of the plan that are not in the folder yet. `stop` is asked after each run;
/// `tell` is called now and then and at the end.
///
/// # Errors
/// When a record cannot be computed or written. What was written before stays.
pub fn run(
    folder: &Folder,
    options: Options,
    stop: &(dyn Fn() -> bool + Sync),
    tell: &mut dyn FnMut(&Progress),
) -> Result<Ended, StudyError> {
    let clock = Instant::now();
    let cells = Cells::of(folder.plan());
    let done = folder.done()?;
    let (total, before) = count(folder.plan(), &cells, &done, options.shard);
    let progress =
        |written: u64| Progress { done: before + written, before, total, elapsed: clock.elapsed() };
    tell(&progress(0));
    if before == total {
        return Ok(Ended { progress: progress(0), complete: true });
    }
    // Read once, so that all threads compute from the same bytes, whatever becomes of the file meanwhile.
    let profile = profile(folder.plan(), folder.path())?;
    let (path, file) = folder.new_file(options.shard)?;
    let jobs = options.jobs.max(1);
    let shared = Shared {
        folder,
        cells,
        done,
        shard: options.shard,
        next: AtomicU64::new(0),
        written: AtomicU64::new(0),
        profile,
        failed: AtomicBool::new(false),
        error: Mutex::new(None),
        stop,
    };
    let shared = &shared;
    std::thread::scope(|scope| {
        let (sender, receiver) = sync_channel(WAITING);
        let begin = || {
            let sender = sender.clone();
            std::thread::Builder::new().spawn_scoped(scope, move || on_this_thread(|| shared.work(&sender)))
        };
        // A system that gives fewer threads than asked for has those do all.
        let begun = (0..jobs).filter(|_| begin().is_ok()).count();
        if begun == 0 {
            shared.fail(StudyError::NoThread);
        }
        drop(sender);
        shared.write(&path, file, receiver, &mut |written| tell(&progress(written)));
    });
    let error = shared.error.lock().unwrap_or_else(PoisonError::into_inner).take();
    if let Some(error) = error {
        return Err(error);
    }
    let progress = progress(shared.written.load(Ordering::SeqCst));
    tell(&progress);
    Ok(Ended { progress, complete: progress.done == total })
}

impl Shared<'_> {
    fn fail(&self, error: StudyError) {
        self.failed.store(true, Ordering::SeqCst);
        self.error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }

    fn ends(&self) -> bool {
        self.failed.load(Ordering::SeqCst) || (self.stop)()
    }

    /// Takes one unit after the other until none is left.
    fn work(&self, sender: &SyncSender<String>) {
        let mut measurer = Measurer::new(self.folder.plan(), self.profile.as_ref());
        loop {
            let index = self.next.fetch_add(1, Ordering::Relaxed);
            let number = index * u64::from(self.shard.count) + u64::from(self.shard.number) - 1;
            if number >= self.cells.units() || self.failed.load(Ordering::SeqCst) {
                return;
            }
            let unit = self.cells.unit(number);
            if let Err(error) = self.work_on(&unit, &mut measurer, sender) {
                self.fail(error);
                return;
            }
        }
    }

    fn work_on(
        &self,
        unit: &Unit,
        measurer: &mut Measurer<'_>,
        sender: &SyncSender<String>,
    ) -> Result<(), StudyError> {
        let plan = self.folder.plan();
        let seed = plan.seed_of(unit.line);
        let mut scene = plan.prototype();
        let mut values = Vec::new();
        for run in self.cells.runs_of(unit) {
            let first = self.cells.first_cell(run);
            let missing = |cell: u64| !self.done.has(cell * plan.lines + unit.line);
            if !(first..first + self.cells.preloads()).any(missing) {
                continue;
            }
            if self.ends() {
                return Ok(());
            }
            let failed = |error: RunError| StudyError::Run {
                cell: first,
                coordinates: plan.coordinates(first),
                seed,
                error,
            };
            // The scene of every cell has been checked.
            if self.cells.shape(run, &plan.scene, &mut scene).is_err() {
                continue;
            }
            values.clear();
            measurer.run(&mut scene, seed, &mut values).map_err(failed)?;
            let mut text = String::new();
            for (cell, values) in (first..).zip(&values) {
                if missing(cell) {
                    encode(Key { cell, seed }, values, &mut text);
                }
            }
            if sender.send(text).is_err() {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Writes records as they come. It waits for the disk when it has not done so for a while, and at the end.
    /// Only what has reached the disk is counted.
    fn write(
        &self,
        path: &Path,
        mut file: Box<dyn DiskFile>,
        receiver: Receiver<String>,
        tell: &mut dyn FnMut(u64),
    ) {
        let mut synced = Instant::now();
        let mut told = Instant::now();
        let mut pending = 0;
        let mut text = String::with_capacity(BUFFER);
        let failed = |reason| StudyError::Write(WriteError::Failed { path: PathBuf::from(path), reason });
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
                pending += text.bytes().filter(|&byte| byte == b'\n').count() as u64;
            }
            if pending > 0 && (ended || synced.elapsed() >= SYNC) {
                if let Err(reason) = file.sync() {
                    return self.fail(failed(reason));
                }
                self.written.fetch_add(pending, Ordering::SeqCst);
                (synced, pending) = (Instant::now(), 0);
            }
            if told.elapsed() >= TICK {
                tell(self.written.load(Ordering::SeqCst));
                told = Instant::now();
            }
            if ended {
                return;
            }
        }
    }
}
