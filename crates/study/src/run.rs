//! Computation of the records of a plan that are missing in the folder of its study. The work is
//! divided among several threads, and the results do not depend on the number of threads.

use super::cells::{Cells, Streak};
use super::compute::{SolvedStreak, Streaks};
use super::error::StudyError;
use super::measured::profile;
use super::plan::Plan;
use super::recorder::Recorded;
use super::shard::Shard;
use super::status::{count, rate};
use super::store::{Folder, encode};
use asperity_data::{Control, CountedWarning};
use std::fs::File;
use std::io;
use std::io::Write;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread::Builder;
use std::time::{Duration, Instant};

/// Longest time for which written records are not yet synced to the disk. After a power cut these
/// records are lost and must be computed again. A sync takes tenths of a millisecond, and much
/// longer on network file systems. On a local disk 100 000 records of 256 springs take 11 s with
/// this time, 12 s if each sync follows the previous one at once, and 190 s with a sync after each
/// record. For cells of thousands of springs there is no difference.
const SYNC: Duration = Duration::from_millis(50);
/// Largest number of computed streaks whose records may wait until they are written to the file. A
/// streak consists of all cells that differ only in the preload, on one profile.
const WAITING: usize = 4096;
const TICK: Duration = Duration::from_millis(200);

/// Progress of a run of [`run_study`], which computes a [`Shard`], a part of the plan. The progress
/// is counted in records. A record has the values of one [cell](crate::Plan) on one random profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StudyProgress {
    /// Number of records of this part of the plan that exist now.
    pub done: u64,
    /// Number of records of this part of the plan that existed before this run.
    pub before: u64,
    /// Number of records that this part of the plan has once it is complete.
    pub total: u64,
    /// Time from the beginning of this run of [`run_study`] until it last wrote records.
    pub elapsed: Duration,
}

impl StudyProgress {
    /// Returns true if every record of this part of the plan exists.
    pub fn is_complete(&self) -> bool {
        self.done == self.total
    }

    /// Returns the number of records that this run of [`run_study`] has computed so far.
    pub fn computed(&self) -> u64 {
        self.done - self.before
    }

    /// Returns how many records this run of [`run_study`] has computed per second so far; `None`
    /// before the first record.
    pub fn rate(&self) -> Option<f64> {
        rate(self.computed(), self.elapsed.as_secs_f64())
    }

    /// Returns the estimated time until all records of this part of the plan exist. It assumes the
    /// present rate [`StudyProgress::rate`]. `None` before the first record.
    pub fn left(&self) -> Option<Duration> {
        let seconds = (self.total - self.done) as f64 / self.rate()?;
        Duration::try_from_secs_f64(seconds).ok()
    }
}

/// Result of one run of [`run_study`]: the progress and the warnings of the computed records.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyRun {
    /// Progress at the end of the run.
    pub progress: StudyProgress,
    /// Premises of the model that records of this run do not meet, each with the number of records
    /// that do not meet it.
    pub warnings: Vec<CountedWarning>,
}

/// Computes the missing results of one [`Shard`], which is a part of the plan of a study. The
/// results are written to a new file in the folder of the study. `control` receives the progress
/// several times a second and at the end. If `control` stops the computation, the function finishes
/// the present loading and returns without an error.
///
/// # Errors
/// Returns an error if zero threads are requested, if the memory does not suffice for a record, or
/// if a file cannot be read or written. Records written before the error are kept.
pub fn run_study(
    folder: &Folder,
    shard: Shard,
    mut control: Control<'_, StudyProgress>,
) -> Result<StudyRun, StudyError> {
    let threads = control.threads();
    let stop = control.stop();
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
    control.report(progress);
    let warnings = Mutex::new(Vec::new());
    if progress.is_complete() {
        let warnings = Vec::new();
        return Ok(StudyRun { progress, warnings });
    }
    // The measured files are read once. All threads then compute from the same bytes, even if a
    // file changes meanwhile.
    let profile = profile(plan, folder.path())?;
    let clock = Instant::now();
    let (path, mut file) = folder.new_file(shard)?;
    let units: Vec<u64> = shard.units(cells.units()).collect();
    let missing = MissingRecords { plan, done: &done };
    let streaks = Streaks {
        cells: &cells,
        units: &units,
        is_missing: &|streak| missing.has_any_of(streak),
        profile: profile.as_ref(),
    };
    let (sender, receiver) = sync_channel(WAITING);
    let results = StudyResults {
        missing: &missing,
        warnings: &warnings,
        sender,
    };
    let work = move || streaks.compute(plan, threads, stop, &|solved| results.send(solved));
    std::thread::scope(|scope| {
        let computing = Builder::new()
            .spawn_scoped(scope, work)
            .map_err(StudyError::NoThread)?;
        let mut written = WrittenFile::new(&path, &mut file, clock);
        let written = written.write_all(&receiver, &mut progress, &mut control);
        computing
            .join()
            .unwrap_or_else(|panic| resume_unwind(panic))?;
        written.map_err(StudyError::unwritable(&path))
    })?;
    control.report(progress);
    let warnings = warnings
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner);
    Ok(StudyRun { progress, warnings })
}

/// Where the threads of a study send what they have computed.
struct StudyResults<'a> {
    missing: &'a MissingRecords<'a>,
    /// Warnings of all records so far.
    warnings: &'a Mutex<Vec<CountedWarning>>,
    /// Sender to the thread that writes the file.
    sender: SyncSender<String>,
}

impl StudyResults<'_> {
    /// Counts the warnings of the records, and sends their text to the file. Returns false if the
    /// file could not be written, so that the computation ends.
    fn send(&self, solved: SolvedStreak) -> bool {
        let mut warnings = self.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        self.missing.count_warnings(&solved, &mut warnings);
        drop(warnings);
        let text = self.missing.encoded(solved.streak, &solved.records);
        self.sender.send(text).is_ok()
    }
}

/// Which records of a plan its folder lacks.
struct MissingRecords<'a> {
    plan: &'a Plan,
    /// For each record of the plan, true if the folder contains it already.
    done: &'a [bool],
}

impl MissingRecords<'_> {
    fn has(&self, cell: u64, line: u64) -> bool {
        !self.done[(cell * self.plan.lines + line) as usize]
    }

    fn has_any_of(&self, streak: &Streak) -> bool {
        let mut cells = streak.cells.clone();
        cells.any(|cell| self.has(cell, streak.line))
    }

    /// Counts the premises of the model that are not met by those records of a streak that were
    /// missing.
    fn count_warnings(&self, solved: &SolvedStreak, counted: &mut Vec<CountedWarning>) {
        for (cell, warnings) in &solved.warnings {
            if self.has(*cell, solved.streak.line) {
                for warning in warnings {
                    CountedWarning::count(counted, warning);
                }
            }
        }
    }

    /// Returns the records of a streak that were missing, as lines of a shard file.
    fn encoded(&self, streak: Streak, records: &[Recorded]) -> String {
        let seed = self.plan.seed_of(streak.line);
        let mut text = String::new();
        for (cell, record) in streak.cells.zip(records) {
            if self.has(cell, streak.line) {
                encode(cell, seed, record, &mut text);
            }
        }
        text
    }
}

/// File to which this process writes records.
struct WrittenFile<'a> {
    path: &'a Path,
    file: &'a mut File,
    /// Clock since the beginning of the computation.
    clock: Instant,
    /// Number of written records that may not be on the disk yet (not synced).
    pending: u64,
    /// Time from the beginning of the computation to the last written records.
    computed: Duration,
    /// Time of the last sync.
    synced: Instant,
}

impl<'a> WrittenFile<'a> {
    fn new(path: &'a Path, file: &'a mut File, clock: Instant) -> WrittenFile<'a> {
        WrittenFile {
            path,
            file,
            clock,
            pending: 0,
            computed: Duration::ZERO,
            synced: Instant::now(),
        }
    }

    /// Writes records as they arrive. Syncs the file to the disk at the latest after the time
    /// [`SYNC`], and at the end. The progress counts only synced records.
    fn write_all(
        &mut self,
        receiver: &Receiver<String>,
        progress: &mut StudyProgress,
        control: &mut Control<'_, StudyProgress>,
    ) -> io::Result<()> {
        let mut reported = Instant::now();
        loop {
            let first = receiver.recv_timeout(self.longest_wait());
            let ended = first == Err(RecvTimeoutError::Disconnected);
            if let Ok(first) = first {
                let mut text = first;
                text.extend(receiver.try_iter().take(WAITING));
                self.write(&text)?;
            }
            if self.pending > 0 && (ended || self.synced.elapsed() >= SYNC) {
                self.sync(progress)?;
            }
            if reported.elapsed() >= TICK {
                self.check_exists()?;
                control.report(*progress);
                reported = Instant::now();
            }
            if ended {
                return Ok(());
            }
        }
    }

    fn longest_wait(&self) -> Duration {
        if self.pending > 0 {
            SYNC.saturating_sub(self.synced.elapsed())
        } else {
            TICK
        }
    }

    fn write(&mut self, text: &str) -> io::Result<()> {
        self.file.write_all(text.as_bytes())?;
        self.computed = self.clock.elapsed();
        self.pending += text.bytes().filter(|byte| *byte == b'\n').count() as u64;
        Ok(())
    }

    fn sync(&mut self, progress: &mut StudyProgress) -> io::Result<()> {
        self.file.sync_all()?;
        progress.done += self.pending;
        progress.elapsed = self.computed;
        self.synced = Instant::now();
        self.pending = 0;
        Ok(())
    }

    fn check_exists(&self) -> io::Result<()> {
        if self.path.exists() {
            return Ok(());
        }
        let removed = "the file has been removed while the study was computed";
        Err(io::Error::other(removed))
    }
}
