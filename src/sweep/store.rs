//! The folder of a study: its plan, and one file for each process that has worked on it.
//!
//! A shard file is only ever appended to, by the one process that made it; each record is a line with a
//! checksum. So whatever ends a process, what it wrote before stays, and a line torn by that is left out. What
//! ends the machine takes what had not reached the disk as well: the records of a moment, which are computed again.

use super::SweepError;
use super::plan::{Changes, Plan};
use super::record::{Key, key_of, seal, unseal, values_of};
use super::shard::Shard;
use crate::export::{WriteError, write_new};
use crate::scene::read_file;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Version of the shard files.
pub const STORE_VERSION: u32 = 1;
/// Longest line of a shard file; records are much shorter.
const LONGEST_LINE: u64 = 1 << 16;

pub(super) const PLAN: &str = "plan.ron";
const SHARDS: &str = "shards";
/// Ending of a shard file.
const ENDING: &str = "shard";

/// The folder of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Folder {
    path: PathBuf,
    plan: Plan,
}

/// What a shard file says of itself, on its first line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// [`STORE_VERSION`].
    pub format: u32,
    /// Checksum of the plan.
    pub plan: String,
    /// The part of the plan that the process was given.
    pub shard: Shard,
    /// Name of the machine.
    pub host: String,
    /// Number of the process on it.
    pub process: u32,
    /// When it began, s since 1970.
    pub started: u64,
    /// Version of the program.
    pub program: String,
}

/// A shard file.
#[derive(Clone, Debug, PartialEq)]
pub struct ShardFile {
    /// Its path.
    pub path: PathBuf,
    /// What it says of itself; `None` where the process ended before that was written.
    pub header: Option<Header>,
    /// When something was last written to it, s since 1970.
    pub written: f64,
}

/// A record as it was found.
pub(super) struct Found<'l> {
    pub key: Key,
    /// Place of its line in the file.
    pub offset: u64,
    payload: &'l str,
    values: usize,
}

impl Found<'_> {
    pub fn values(&self) -> Option<Vec<f64>> {
        values_of(key_of(self.payload)?.1, self.values)
    }
}

impl Folder {
    /// Makes the folder of a plan, or opens it where it has the same plan already.
    ///
    /// # Errors
    /// Where another plan stands in it, or it cannot be written.
    pub fn create(path: &Path, plan: &Plan) -> Result<Folder, SweepError> {
        let failed = |path: &Path| {
            let path = path.to_path_buf();
            move |reason| SweepError::Write(WriteError::Failed { path, reason })
        };
        fs::create_dir_all(path).map_err(failed(path))?;
        let shards = path.join(SHARDS);
        let file = path.join(PLAN);
        let text = plan.to_ron();
        if !file.exists() {
            match write_new(&file, false, |out| out.write_all(text.as_bytes())) {
                // Another process was faster.
                Ok(()) | Err(WriteError::Exists { .. }) => {}
                Err(error) => return Err(error.into()),
            }
        }
        let there = read_file(&file).map_err(|reason| SweepError::Folder { path: file.clone(), reason })?;
        if there != text {
            return Err(SweepError::OtherPlan {
                path: path.to_path_buf(),
                difference: difference(&there, &text),
            });
        }
        fs::create_dir_all(&shards).map_err(failed(&shards))?;
        Ok(Folder { path: path.to_path_buf(), plan: plan.clone() })
    }

    /// Whether a path is the folder of a study, sound or not.
    #[must_use]
    pub fn is_at(path: &Path) -> bool {
        path.join(PLAN).is_file()
    }

    /// Opens the folder of a study.
    ///
    /// # Errors
    /// Where there is none, or its plan cannot be read.
    pub fn open(path: &Path) -> Result<Folder, SweepError> {
        let file = path.join(PLAN);
        if !file.is_file() {
            let reason = format!("this is not the folder of a study: there is no {PLAN} in it");
            return Err(SweepError::Folder { path: path.to_path_buf(), reason });
        }
        let text = read_file(&file).map_err(|reason| SweepError::Folder { path: file.clone(), reason })?;
        let plan = Plan::parse(&text, &file.display().to_string(), &Changes::default())?;
        Ok(Folder { path: path.to_path_buf(), plan })
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its plan.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Checksum of its plan.
    fn checksum(&self) -> String {
        format!("{:08x}", crc32fast::hash(self.plan.to_ron().as_bytes()))
    }

    /// A new shard file for this process, with its header.
    pub(super) fn new_file(&self, shard: Shard) -> Result<(PathBuf, File), WriteError> {
        let started = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs();
        let (host, process) = (host(), std::process::id());
        let header = Header {
            format: STORE_VERSION,
            plan: self.checksum(),
            shard,
            host: host.clone(),
            process,
            started,
            program: env!("CARGO_PKG_VERSION").into(),
        };
        let random = RandomState::new().hash_one(started) as u32;
        let Shard { number, count } = shard;
        let name = format!("{number}-of-{count}-{host}-{process}-{started}-{random:08x}.{ENDING}");
        let path = self.path.join(SHARDS).join(name);
        let failed = |reason| WriteError::Failed { path: path.clone(), reason };
        let mut text = String::new();
        seal(&serde_json::to_string(&header).map_err(io::Error::from).map_err(failed)?, &mut text);
        let mut file = File::create_new(&path).map_err(failed)?;
        file.write_all(text.as_bytes()).and_then(|()| file.sync_all()).map_err(failed)?;
        // The entry in the folder has to last as well; not all systems let a folder be opened.
        if let Ok(folder) = File::open(self.path.join(SHARDS)) {
            let _ = folder.sync_all();
        }
        Ok((path, file))
    }

    /// All shard files, by name.
    ///
    /// # Errors
    /// Where they cannot be read, are of another plan, or of a later version.
    pub fn files(&self) -> Result<Vec<ShardFile>, SweepError> {
        let shards = self.path.join(SHARDS);
        let failed = |path: &Path, reason: io::Error| SweepError::Folder {
            path: path.to_path_buf(),
            reason: format!("cannot be read: {reason}"),
        };
        let entries = match fs::read_dir(&shards) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            entries => entries.map_err(|error| failed(&shards, error))?,
        };
        let mut paths = Vec::new();
        for entry in entries {
            let path = entry.map_err(|error| failed(&shards, error))?.path();
            if path.extension().is_some_and(|ending| ending == ENDING) {
                paths.push(path);
            }
        }
        paths.sort();
        let checksum = self.checksum();
        let mut files = Vec::with_capacity(paths.len());
        for path in paths {
            let file = self.file(&path).map_err(|error| failed(&path, error))?;
            if let Some(header) = &file.header {
                let reason = if header.format != STORE_VERSION {
                    format!("its format is {}; this program reads {STORE_VERSION}", header.format)
                } else if header.plan != checksum {
                    "this file belongs to another plan".into()
                } else {
                    String::new()
                };
                if !reason.is_empty() {
                    return Err(SweepError::Folder { path, reason });
                }
            }
            files.push(file);
        }
        Ok(files)
    }

    fn file(&self, path: &Path) -> io::Result<ShardFile> {
        let file = File::open(path)?;
        let written = file.metadata()?.modified()?.duration_since(UNIX_EPOCH).unwrap_or_default();
        let mut line = Vec::new();
        BufReader::new(file).take(LONGEST_LINE).read_until(b'\n', &mut line)?;
        let header = line.strip_suffix(b"\n").and_then(unseal);
        let header = header.and_then(|payload| serde_json::from_str(payload).ok());
        Ok(ShardFile { path: path.to_path_buf(), header, written: written.as_secs_f64() })
    }

    /// Calls `each` with every whole record of a file, in the order in which they were written, and gives the
    /// number of lines that are damaged: torn, or changed since.
    pub(super) fn records(
        &self,
        file: &ShardFile,
        each: &mut dyn FnMut(&Found<'_>) -> Result<(), SweepError>,
    ) -> Result<u64, SweepError> {
        if file.header.is_none() {
            return Ok(0);
        }
        let failed = |error: io::Error| SweepError::Folder {
            path: file.path.clone(),
            reason: format!("cannot be read: {error}"),
        };
        let mut reader = BufReader::with_capacity(1 << 18, File::open(&file.path).map_err(failed)?);
        let (mut line, mut offset, mut damaged) = (Vec::new(), 0, 0);
        let cells = self.plan.cells();
        loop {
            line.clear();
            let read =
                reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line).map_err(failed)? as u64;
            if read == 0 {
                return Ok(damaged);
            }
            let values = self.plan.record.len();
            let found = line.strip_suffix(b"\n").and_then(unseal).and_then(|payload| {
                let (key, _) = key_of(payload)?;
                Some(Found { key, offset, payload, values })
            });
            match found {
                Some(found) if found.key.cell < cells && self.line_of(found.key.seed).is_some() => {
                    each(&found)?;
                }
                // The header.
                _ if offset == 0 => {}
                _ => damaged += 1,
            }
            offset += read;
        }
    }

    /// Which line has a seed.
    pub(super) fn line_of(&self, seed: u64) -> Option<u64> {
        let line = seed.wrapping_sub(self.plan.seed);
        (line < self.plan.lines).then_some(line)
    }

    /// Place of a record among all there are to be, by cell, then by seed.
    pub(super) fn place(&self, key: Key) -> Option<u64> {
        Some(key.cell * self.plan.lines + self.line_of(key.seed)?)
    }

    /// The records that there are.
    pub(super) fn done(&self) -> Result<Done, SweepError> {
        let mut done = Done::none(self.plan.records_in_all());
        for file in self.files()? {
            self.records(&file, &mut |found| {
                if let Some(place) = self.place(found.key) {
                    done.add(place);
                }
                Ok(())
            })?;
        }
        Ok(done)
    }
}

/// Which records there are, one bit for each.
pub(super) struct Done(Vec<u64>);

impl Done {
    fn none(count: u64) -> Done {
        Done(vec![0; count.div_ceil(64) as usize])
    }

    /// Adds one; whether it is new.
    pub fn add(&mut self, place: u64) -> bool {
        let (word, bit) = (place as usize / 64, 1 << (place % 64));
        let new = self.0[word] & bit == 0;
        self.0[word] |= bit;
        new
    }

    pub fn has(&self, place: u64) -> bool {
        self.0[place as usize / 64] & (1 << (place % 64)) != 0
    }
}

/// Reads single lines of a file from wherever they stand, cheaply where they follow each other.
pub(super) struct Lines {
    reader: BufReader<File>,
    here: u64,
    line: Vec<u8>,
}

impl Lines {
    pub fn open(path: &Path) -> io::Result<Lines> {
        Ok(Lines { reader: BufReader::with_capacity(1 << 16, File::open(path)?), here: 0, line: Vec::new() })
    }

    /// The payload of the line at an offset.
    pub fn at(&mut self, offset: u64) -> io::Result<&str> {
        // Within what has been read this moves nothing.
        let by = offset as i64 - self.here as i64;
        self.reader.seek_relative(by).or_else(|_| self.reader.seek(SeekFrom::Start(offset)).map(drop))?;
        self.line.clear();
        let read = self.reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut self.line)?;
        self.here = offset + read as u64;
        let payload = self.line.strip_suffix(b"\n").and_then(unseal);
        payload.ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "a record has changed"))
    }
}

/// Name of this machine, in letters that a file name can hold.
fn host() -> String {
    #[cfg(unix)]
    let name = rustix::system::uname().nodename().to_string_lossy().into_owned();
    #[cfg(not(unix))]
    let name = std::env::var("COMPUTERNAME").unwrap_or_default();
    let name: String = name.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '_').take(40).collect();
    if name.is_empty() { "host".into() } else { name }
}

/// The first lines in which two plans differ.
fn difference(there: &str, asked: &str) -> String {
    let pairs = there.lines().map(Some).chain(std::iter::repeat(None));
    let asked = asked.lines().map(Some).chain(std::iter::repeat(None));
    let first = pairs.zip(asked).take_while(|pair| *pair != (None, None)).find(|(a, b)| a != b);
    let shown = |line: Option<&str>| line.map_or_else(|| "nothing".into(), |line| line.trim().to_owned());
    first.map_or_else(String::new, |(a, b)| format!("there: {}\nhere:  {}", shown(a), shown(b)))
}
