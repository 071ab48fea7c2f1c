//! Computation of the records of a plan that a folder lacks, on all processor cores. The results do
//! not depend on the number of threads.

use super::cells::{Cells, Streak};
use super::compute::Streaks;
use super::error::StudyError;
use super::measured::profile;
use super::recorder::Recorded;
use super::shard::Shard;
use super::status::{count, rate};
use super::store::{Folder, encode};
use std::fs::File;
use std::io;
use std::io::Write;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread::Builder;
use std::time::{Duration, Instant};

/// Longest time that written records wait for the disk. A power cut loses waiting records, which
/// are computed again. One sync takes tenths of a millisecond, and many on network file systems. On
/// a local disk 100 000 records of 256 springs take 11 s with this wait, 12 s if each sync takes
/// all records since the one before, and 190 s with a sync for each record. For cells of thousands
/// of springs there is no difference.
const SYNC: Duration = Duration::from_millis(50);
/// Number of records that may wait between computation and file.
const WAITING: usize = 4096;
const TICK: Duration = Duration::from_millis(200);

/// Progress of [`run_study`], counted in records of the [`Shard`] that it computes. A record has
/// the values of one [cell](crate::Plan) on one random profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StudyProgress {
    /// Number of records of the shard that exist now.
    pub done: u64,
    /// Number of records of the shard that existed before this run.
    pub before: u64,
    /// Number of records that the shard has once it is complete.
    pub total: u64,
    /// Time from the beginning of this run of [`run_study`] to the last records that it wrote.
    pub elapsed: Duration,
}

impl StudyProgress {
    /// Returns true if every record of the shard exists.
    pub fn is_complete(&self) -> bool {
        self.done == self.total
    }

    /// Returns how many records this run of [`run_study`] has computed per second so far; `None`
    /// before the first record.
    pub fn rate(&self) -> Option<f64> {
        rate(self.done - self.before, self.elapsed.as_secs_f64())
    }

    /// Returns the estimated time for the missing records of the shard at [`StudyProgress::rate`];
    /// `None` before the first record.
    pub fn left(&self) -> Option<Duration> {
        let seconds = (self.total - self.done) as f64 / self.rate()?;
        Duration::try_from_secs_f64(seconds).ok()
    }
}

/// Computes the missing results of one [`Shard`] of the study in a folder, and writes them to a new
/// file in the folder. `threads` is the number of threads. `stop` is called after each loading. If
/// it returns true, the computation ends without an error. `report` receives the progress several
/// times a second and at the end.
///
/// # Errors
/// Returns an error if `threads` is zero, if the memory does not suffice for a record, or if a file
/// cannot be read or written. Records written before the error are kept.
pub fn run_study(
    folder: &Folder,
    shard: Shard,
    threads: usize,
    stop: &(dyn Fn() -> bool + Sync),
    report: &mut dyn FnMut(&StudyProgress),
) -> Result<StudyProgress, StudyError> {
    StudyError::check_threads(threads)?;
    let plan = folder.plan();
    let cells = Cells::of(plan);
    let done = folder.done()?;
    let (total, before) = count(folder, &cells, &done, shard);
    let mut progress = StudyProgress {
        done: before,
        before,
        total,
        elapsed: Duration::ZERO,
    };
    report(&progress);
    if progress.is_complete() {
        return Ok(progress);
    }
    // Read once, so that all threads compute from the same bytes, even if the file changes
    // meanwhile.
    let profile = profile(plan, folder.path())?;
    let clock = Instant::now();
    let (path, mut file) = folder.new_file(shard)?;
    let units: &[u64] = &shard.units(cells.units()).collect::<Vec<u64>>();
    let (done, plan) = (&done, plan);
    let is_missing = |streak: &Streak| {
        streak
            .cells
            .clone()
            .any(|cell| !done[(cell * plan.lines + streak.line) as usize])
    };
    let streaks = Streaks {
        cells: &cells,
        units,
        is_missing: &is_missing,
        profile: profile.as_ref(),
    };
    let (sender, receiver) = sync_channel(WAITING);
    let work = move || {
        let send = move |streak: Streak, records: Vec<Recorded>| {
            let (seed, mut text) = (plan.seed_of(streak.line), String::new());
            let is_new = |cell: &u64| !done[(cell * plan.lines + streak.line) as usize];
            for (cell, record) in streak.cells.zip(&records).filter(|(cell, _)| is_new(cell)) {
                encode(cell, seed, record, &mut text);
            }
            // The text has no receiver once the file cannot be written.
            sender.send(text).is_ok()
        };
        streaks.compute(plan, threads, stop, &send)
    };
    std::thread::scope(|scope| {
        let threads = Builder::new()
            .spawn_scoped(scope, work)
            .map_err(StudyError::NoThread)?;
        let written = write((&path, &mut file), receiver, clock, &mut progress, report);
        threads
            .join()
            .unwrap_or_else(|panic| resume_unwind(panic))?;
        written.map_err(StudyError::unwritable(&path))
    })?;
    report(&progress);
    Ok(progress)
}

/// Writes records as they arrive. Syncs with the disk after the longest wait and at the end. The
/// progress counts only records that have reached the disk.
fn write(
    (path, file): (&Path, &mut File),
    receiver: Receiver<String>,
    clock: Instant,
    progress: &mut StudyProgress,
    report: &mut dyn FnMut(&StudyProgress),
) -> io::Result<()> {
    let (mut synced, mut reported) = (Instant::now(), Instant::now());
    let (mut pending, mut elapsed) = (0, Duration::ZERO);
    loop {
        let wait = if pending > 0 {
            SYNC.saturating_sub(synced.elapsed())
        } else {
            TICK
        };
        let first = receiver.recv_timeout(wait);
        let ended = first == Err(RecvTimeoutError::Disconnected);
        if let Ok(first) = first {
            let text: String = std::iter::once(first)
                .chain(receiver.try_iter().take(WAITING))
                .collect();
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
            if !path.exists() {
                return Err(io::Error::other(
                    "the file has been removed while the study was computed",
                ));
            }
            report(progress);
            reported = Instant::now();
        }
        if ended {
            return Ok(());
        }
    }
}
