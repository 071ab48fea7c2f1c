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
    /// Records there are.
    pub done: u64,
    /// Records there are to be.
    pub total: u64,
    /// Records that are missing.
    pub missing: u64,
    /// Lines of shard files that are torn or damaged.
    pub damaged: u64,
    /// The parts that processes were given.
    pub shards: Vec<ShardStatus>,
}

/// Progress of one part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShardStatus {
    /// Part, as `3/8`.
    pub shard: String,
    /// Records there are to be in it.
    pub total: u64,
    /// Records of it that are there, whoever wrote them.
    pub done: u64,
    /// The processes that were given it.
    pub attempts: Vec<Attempt>,
}

/// One process and its file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Attempt {
    /// Name of the file.
    pub file: String,
    /// Name of the machine.
    pub host: String,
    /// Number of the process on it.
    pub process: u32,
    /// When it began, s since 1970.
    pub started: u64,
    /// When it last wrote, s since 1970.
    pub written: f64,
    /// Records it wrote.
    pub records: u64,
    /// Records each second, from its beginning to what it last wrote.
    pub rate: Option<f64>,
}

impl Status {
    /// Of the present content of the folder.
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

/// Records each second, of a process that began this time, s, before it last wrote; `None` for no time.
pub(super) fn rate(records: u64, seconds: f64) -> Option<f64> {
    (seconds > 0.0).then(|| records as f64 / seconds)
}

/// The records of a part of a plan, and those of them that are there. All parts of a division together take as
/// long as the whole plan.
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
