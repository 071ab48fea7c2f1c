//! The progress of a study, and of the processes that compute it.

use super::cells::{Cells, Streak};
use super::error::StudyError;
use super::shard::Shard;
use super::store::{Folder, ShardFile};
use asperity_data::{path_name, printable};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Progress of the study in a [`Folder`], counted in records. A record has the values of one
/// [cell](crate::Plan) on one random profile.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Status {
    /// Number of records in the files of the study. A repeated record is counted once.
    pub done: u64,
    /// Number of records that the study has once it is complete.
    pub total: u64,
    /// Number of records of the complete study that do not exist yet.
    pub missing: u64,
    /// Number of records in the files of the study that have a reason instead of values, because
    /// they cannot be computed.
    pub failed: u64,
    /// Number of incomplete or damaged lines in the files of the study, which are ignored.
    pub damaged: u64,
    /// Progress of each [`Shard`], a part of the plan, on which at least one process has worked.
    pub shards: Vec<ShardStatus>,
}

/// Progress of one part of a plan, a [`Shard`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShardStatus {
    /// Name of the part of the plan: `3/8` for part 3 of 8.
    pub shard: String,
    /// Number of records that this part of the plan has once it is complete. A record has the
    /// results of one [cell](crate::Plan) on one random profile.
    pub total: u64,
    /// Number of records of this part that are already in files of the study. A record has the
    /// results of one [cell](crate::Plan) on one random profile.
    pub done: u64,
    /// Processes that have worked on this part, each with the records that it wrote.
    pub attempts: Vec<Attempt>,
}

/// Work of one process on a part of a plan: the process, and the records in the file that it wrote.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Attempt {
    /// Name of the file that the process wrote.
    pub file: String,
    /// Name of the machine on which the process ran.
    pub host: String,
    /// Number of the process (PID) on the machine [`Attempt::host`].
    pub process: u32,
    /// Time at which the process began, in s since 1970.
    pub started: u64,
    /// Time of the last write of the process, in s since 1970.
    pub written: f64,
    /// Number of records that this process wrote.
    pub records: u64,
    /// Mean number of records that the process wrote per second from its beginning to its last
    /// write; `None` if both times are equal.
    pub rate: Option<f64>,
}

impl Status {
    /// Counts the records that the folder of a study has now.
    ///
    /// # Errors
    /// Returns an error if a file of the folder cannot be read or belongs to another plan.
    pub fn of(folder: &Folder) -> Result<Status, StudyError> {
        let total = folder.plan().records_in_all();
        let mut done = vec![false; total as usize];
        let mut damaged = 0;
        let mut failed = 0;
        let mut attempts: BTreeMap<Shard, Vec<Attempt>> = BTreeMap::new();
        for file in folder.files()? {
            let mut records = 0;
            for record in folder.records(&file)? {
                match record? {
                    Some((place, record)) => {
                        records += 1;
                        failed += u64::from(record.is_err() && !done[place as usize]);
                        done[place as usize] = true;
                    }
                    None => damaged += 1,
                }
            }
            let ShardFile {
                path,
                header,
                written,
            } = file;
            attempts.entry(header.shard).or_default().push(Attempt {
                file: path
                    .file_name()
                    .map_or_else(String::new, |name| path_name(Path::new(name))),
                host: printable(&header.host).into_owned(),
                process: header.process,
                started: header.begun as u64,
                written,
                records,
                rate: rate(records, written - header.begun),
            });
        }
        let cells = Cells::of(folder.plan());
        let mut shards = Vec::with_capacity(attempts.len());
        for (shard, attempts) in attempts {
            let (total, there) = count(folder, &cells, &done, shard);
            shards.push(ShardStatus {
                shard: shard.to_string(),
                total,
                done: there,
                attempts,
            });
        }
        let found = done.iter().filter(|done| **done).count() as u64;
        Ok(Status {
            done: found,
            total,
            missing: total - found,
            failed,
            damaged,
            shards,
        })
    }
}

/// Returns the number of records per second over a time in s; `None` for a time of zero.
pub(super) fn rate(records: u64, seconds: f64) -> Option<f64> {
    (seconds > 0.0).then(|| records as f64 / seconds)
}

/// Returns two numbers for a shard, which is a part of the plan: the number of all records of the
/// shard, and the number of the existing ones. Only the records of this shard are counted, so that
/// counting all shards takes as long as counting the whole study once.
pub(super) fn count(folder: &Folder, cells: &Cells<'_>, done: &[bool], shard: Shard) -> (u64, u64) {
    let mut total = 0;
    let mut there = 0;
    for Streak { cells, line } in shard
        .units(cells.units())
        .flat_map(|unit| cells.streaks(unit))
    {
        total += cells.end - cells.start;
        there += cells
            .filter(|cell| done[(cell * folder.plan().lines + line) as usize])
            .count() as u64;
    }
    (total, there)
}
