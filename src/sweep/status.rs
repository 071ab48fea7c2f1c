//! How far a study is, and who has worked on it.

use super::SweepError;
use super::cells::Cells;
use super::shard::Shard;
use super::store::Folder;
use serde::Serialize;
use std::collections::BTreeMap;

/// How far a study is.
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

/// How far one part is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShardStatus {
    /// Which part: `3/8`.
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
    /// Of what stands in the folder now.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn of(folder: &Folder) -> Result<Status, SweepError> {
        let plan = folder.plan();
        let mut damaged = 0;
        let mut attempts: BTreeMap<Shard, Vec<Attempt>> = BTreeMap::new();
        for file in folder.files()? {
            let mut records = 0;
            damaged += folder.records(&file, &mut |_| {
                records += 1;
                Ok(())
            })?;
            let Some(header) = file.header else { continue };
            let seconds = file.written - header.started as f64;
            attempts.entry(header.shard).or_default().push(Attempt {
                file: file
                    .path
                    .file_name()
                    .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
                host: header.host,
                process: header.process,
                started: header.started,
                written: file.written,
                records,
                rate: (seconds > 0.0).then(|| records as f64 / seconds),
            });
        }
        let done = folder.done()?;
        let cells = Cells::of(plan);
        let of_shard = |(shard, attempts): (Shard, Vec<Attempt>)| {
            let (mut total, mut there) = (0, 0);
            for unit in (0..cells.units()).filter(|&unit| shard.has(unit)) {
                let unit = cells.unit(unit);
                for run in cells.runs_of(&unit) {
                    let first = cells.first_cell(run);
                    total += cells.preloads();
                    let here = (first..first + cells.preloads()).map(|cell| cell * plan.lines + unit.line);
                    there += here.filter(|&place| done.has(place)).count() as u64;
                }
            }
            ShardStatus { shard: shard.to_string(), total, done: there, attempts }
        };
        let shards = attempts.into_iter().map(of_shard).collect();
        let total = plan.records_in_all();
        let found = (0..total).filter(|&place| done.has(place)).count() as u64;
        Ok(Status { done: found, total, missing: total - found, damaged, shards })
    }
}
