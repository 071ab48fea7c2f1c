//! Progress of a study and of the processes that work on it.

use super::StudyError;
use super::cells::Cells;
use super::done::Done;
use super::plan::Plan;
use super::shard::Shard;
use super::store::Folder;
use crate::text::{path_name, printable};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Progress of a study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Status {
    /// Existing records.
    pub done: u64,
    /// All records of the study.
    pub total: u64,
    /// Records that are missing.
    pub missing: u64,
    /// Lines of shard files that are torn or damaged.
    pub damaged: u64,
    /// The parts assigned to processes.
    pub shards: Vec<ShardStatus>,
}

/// Progress of one part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShardStatus {
    /// Part, as `3/8`.
    pub shard: String,
    /// All records of the part.
    pub total: u64,
    /// Existing records of the part, by any process.
    pub done: u64,
    /// The processes assigned to the part.
    pub attempts: Vec<Attempt>,
}

/// One process and its file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Attempt {
    /// Name of the file.
    pub file: String,
    /// Name of the machine.
    pub host: String,
    /// Process id on that machine.
    pub process: u32,
    /// Time of the beginning, s since 1970.
    pub started: u64,
    /// Time of the last write, s since 1970.
    pub written: f64,
    /// Records written by the process.
    pub records: u64,
    /// Records per second, from the beginning to the last write.
    pub rate: Option<f64>,
}

impl Status {
    /// Status of the present content of the folder.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn of(folder: &Folder) -> Result<Status, StudyError> {
        let plan = folder.plan();
        let mut damaged = 0;
        let mut done = Done::none(plan.records_in_all());
        let mut attempts: BTreeMap<Shard, Vec<Attempt>> = BTreeMap::new();
        for file in folder.files()? {
            let mut records = 0;
            damaged += folder.records(&file, &mut |found| {
                records += 1;
                if let Some(place) = folder.place(found.key) {
                    done.add(place);
                }
                Ok(())
            })?;
            let Some(header) = file.header else { continue };
            let seconds = file.written - header.begun.unwrap_or(header.started as f64);
            attempts.entry(header.shard).or_default().push(Attempt {
                file: file.path.file_name().map_or_else(String::new, |name| path_name(Path::new(name))),
                host: printable(&header.host).into_owned(),
                process: header.process,
                started: header.started,
                written: file.written,
                records,
                rate: rate(records, seconds),
            });
        }
        let cells = Cells::of(plan);
        let of_shard = |(shard, attempts): (Shard, Vec<Attempt>)| {
            let (total, there) = count(plan, &cells, &done, shard);
            ShardStatus { shard: shard.to_string(), total, done: there, attempts }
        };
        let shards = attempts.into_iter().map(of_shard).collect();
        let (total, found) = (plan.records_in_all(), done.count());
        Ok(Status { done: found, total, missing: total - found, damaged, shards })
    }
}

/// Records per second over this time, s, from the beginning to the last write; `None` for zero time.
pub(super) fn rate(records: u64, seconds: f64) -> Option<f64> {
    (seconds > 0.0).then(|| records as f64 / seconds)
}

/// All records of a part of a plan, and the existing ones. All parts of a division together take as long as the
/// whole plan.
pub(super) fn count(plan: &Plan, cells: &Cells, done: &Done, shard: Shard) -> (u64, u64) {
    let (mut total, mut there) = (0, 0);
    for unit in shard.units(cells.units()) {
        let unit = cells.unit(unit);
        total += cells.length_of(&unit) * cells.preloads();
        for run in cells.runs_of(&unit) {
            let places = cells.cells_of(run).map(|cell| cell * plan.lines + unit.line);
            there += places.filter(|&place| done.has(place)).count() as u64;
        }
    }
    (total, there)
}
