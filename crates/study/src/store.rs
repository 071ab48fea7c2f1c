//! The folder of a study on disk. It contains the plan and one shard file for each process that has
//! computed a part of the study.
//!
//! A process only appends lines to its own shard file. Each record is a line with a checksum. If a
//! process is killed, its complete lines remain valid, and an incomplete last line is ignored.

use super::error::StudyError;
use super::measured::{changed, file_of, with_hash};
use super::plan::{PLAN_FILE, Plan};
use super::plan_text::Changes;
use super::recorder::Recorded;
use super::shard::Shard;
use asperity_data::{
    WriteError, open_regular, path_name, printable, read_regular_text, remove_abandoned,
    sync_folder, write_new,
};
use asperity_scene::text::LONGEST_TEXT;
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::hash::{BuildHasher, RandomState};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};
use std::{fs, io};

/// Version of the file format of a [`ShardFile`], which contains the results of one process.
pub const STORE_VERSION: u32 = 1;
/// Largest length in bytes of a line of a shard file or a table, as a protection against damaged
/// files. Lines of records are much shorter.
const LONGEST_LINE: u64 = 1 << 16;

const SHARDS: &str = "shards";
const ENDING: &str = "shard";

/// Separator between the seed and the reason in a record that has a reason instead of values.
const FAILED: &str = ",:";

/// Number of characters of the checksum of a line, including the comma after it.
const CHECKSUM: usize = 9;

/// Folder of a study on disk, with the plan and one file of results for each process that has
/// worked on the study.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    plan: Plan,
}

/// First line of a file of results, [`ShardFile`], which states the process that wrote the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShardHeader {
    /// Version of the format of the file.
    pub format: u32,
    /// Checksum (CRC-32) of the text of the plan as 8 hexadecimal digits.
    pub plan: String,
    /// Part of the plan that the process computes.
    pub shard: Shard,
    /// Name of the machine on which the process ran.
    pub host: String,
    /// Number of the process (PID) on the machine [`ShardHeader::host`].
    pub process: u32,
    /// Time at which the process began, in s since 1970.
    pub begun: f64,
    /// Version of the program with which the process wrote the file.
    pub program: String,
}

/// File in the folder of a study with the results of one process.
#[derive(Clone, Debug, PartialEq)]
pub struct ShardFile {
    /// Path of the file with the results of the process.
    pub path: PathBuf,
    /// First line of the file, which states the process that wrote it.
    pub header: ShardHeader,
    /// Time at which the file was last written, in s since 1970.
    pub written: f64,
}

/// Record of a study: its index, and one value for each quantity of the plan (NaN if missing) or
/// the reason why it has no values. Records are numbered by cell and then by profile.
pub(super) type Record = (u64, Recorded);

impl Folder {
    /// Creates the folder of a study with a plan. If a folder with the same plan already exists, it
    /// is opened without a change.
    ///
    /// # Errors
    /// Returns an error if the folder has another plan or cannot be written, or if a measured file
    /// has changed or cannot be read.
    ///
    /// ```
    /// use asperity_study::folders::Status;
    /// use asperity_data::Control;
    /// use asperity_study::{Folder, Plan, Quantity, Results, Shard, merge, run_study};
    ///
    /// let scene = asperity_scene::open("jkr-sphere")?.set("numerics.points", "256")?;
    /// let plan = Plan::new(
    ///     &scene,
    ///     &[("adhesion.work", &[0.01, 0.02])],
    ///     1,
    ///     &[Quantity::PullOffForce],
    /// )?;
    /// let place = tempfile::tempdir()?;
    /// let folder = Folder::create(place.path(), &plan)?;
    /// run_study(&folder, Shard::WHOLE, Control::default().on_threads(2))?;
    /// assert_eq!(
    ///     (Status::of(&folder)?.missing, merge(&folder)?.records),
    ///     (0, 2)
    /// );
    /// assert_eq!(Results::open(place.path())?.plan().cells(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn create(path: &Path, plan: &Plan) -> Result<Folder, StudyError> {
        let plan = with_hash(plan)?;
        let shards = path.join(SHARDS);
        if path.exists() && !path.is_dir() {
            return Err(StudyError::folder(
                path,
                "this is not a folder; allowed: a new one, or that of this study",
            ));
        }
        for folder in [path, &shards] {
            fs::create_dir_all(folder).map_err(StudyError::unwritable(folder))?;
        }
        remove_abandoned(path);
        let file = path.join(PLAN_FILE);
        let text = plan.to_ron();
        if !file.exists() {
            match write_new(&file, false, |out| out.write_all(text.as_bytes())) {
                // Another process may have written the plan between the check and this write.
                Ok(()) | Err(WriteError::Exists { .. }) => {}
                Err(error) => return Err(error.into()),
            }
        }
        let there = text_of(&file)?;
        if there != text {
            return Err(refusal(path, &there, &plan));
        }
        for folder in [path.parent().unwrap_or(path), path] {
            sync_folder(folder).map_err(StudyError::unwritable(folder))?;
        }
        Ok(Folder {
            path: path.to_path_buf(),
            plan,
        })
    }

    /// Returns true if `path` is the folder of a study, even if the plan in the folder has errors.
    pub fn is_at(path: &Path) -> bool {
        path.join(PLAN_FILE).is_file()
    }

    /// Opens an existing folder of a study.
    ///
    /// # Errors
    /// Returns an error if the folder contains no study, or if its plan cannot be read.
    pub fn open(path: &Path) -> Result<Folder, StudyError> {
        let file = path.join(PLAN_FILE);
        if !file.is_file() {
            let reason =
                format!("this is not the folder of a study: there is no {PLAN_FILE} in it");
            return Err(StudyError::folder(path, reason));
        }
        let plan = Plan::read(
            &text_of(&file)?,
            &file.display().to_string(),
            &Changes::default(),
        )?;
        Ok(Folder {
            path: path.to_path_buf(),
            plan,
        })
    }

    /// Returns the path of the folder on disk.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the plan of the study in this folder.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    fn checksum(&self) -> String {
        format!("{:08x}", crc32fast::hash(self.plan.to_ron().as_bytes()))
    }

    pub(super) fn new_file(&self, shard: Shard) -> Result<(PathBuf, File), StudyError> {
        let begun = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default();
        let started = begun.as_secs();
        let host = host();
        let process = std::process::id();
        let header = ShardHeader {
            format: STORE_VERSION,
            plan: self.checksum(),
            shard,
            host: host.clone(),
            process,
            begun: begun.as_secs_f64(),
            program: env!("CARGO_PKG_VERSION").into(),
        };
        let random = RandomState::new().hash_one(started) as u32;
        let Shard { number, count } = shard;
        let name = format!("{number}-of-{count}-{host}-{process}-{started}-{random:08x}.{ENDING}");
        let path = self.path.join(SHARDS).join(name);
        let file = self
            .begun_file(&path, &header)
            .map_err(StudyError::unwritable(&path))?;
        Ok((path, file))
    }

    /// Creates a file with its header, and syncs both to the disk, so that a power cut cannot lose
    /// the header later.
    fn begun_file(&self, path: &Path, header: &ShardHeader) -> io::Result<File> {
        let mut text = String::new();
        seal(&serde_json::to_string(header)?, &mut text);
        let mut file = File::create_new(path)?;
        file.write_all(text.as_bytes())?;
        file.sync_all()?;
        // The folder is synced too, so that a power cut cannot lose the name of the file.
        sync_folder(&self.path.join(SHARDS))?;
        Ok(file)
    }

    /// Returns the files with the results of all processes, sorted by name.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read, or if it belongs to another plan or has another
    /// version of the format.
    pub fn files(&self) -> Result<Vec<ShardFile>, StudyError> {
        let shards = self.path.join(SHARDS);
        let listed = fs::read_dir(&shards)
            .and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect());
        let mut paths: Vec<PathBuf> = match listed {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            listed => listed.map_err(StudyError::unreadable(&shards))?,
        };
        paths.retain(|path| path.extension().is_some_and(|ending| ending == ENDING));
        paths.sort();
        let checksum = self.checksum();
        paths
            .into_iter()
            .filter_map(|path| file_of_plan(path, &checksum).transpose())
            .collect()
    }

    /// Returns the records of a file in the order in which they were written. A record is `None` if
    /// its line is incomplete, was changed later, or is not a record of this plan.
    pub(super) fn records<'f>(
        &'f self,
        file: &'f ShardFile,
    ) -> Result<impl Iterator<Item = Result<Option<Record>, StudyError>> + 'f, StudyError> {
        let opened =
            open_regular(&file.path).map_err(|error| StudyError::folder(&file.path, error))?;
        // Most files of a study are small, so the buffer is not larger than the file.
        let size = opened
            .metadata()
            .map_err(StudyError::unreadable(&file.path))?
            .len();
        let lines = lines(BufReader::with_capacity(
            size.clamp(1 << 10, 1 << 18) as usize,
            opened,
        ));
        Ok(lines.skip(1).map(move |line| {
            let line = line.map_err(StudyError::unreadable(&file.path))?;
            Ok(line.and_then(|line| self.read_record(&line)))
        }))
    }

    /// Reads a line of a shard file; `None` if the line is not a record of this plan.
    fn read_record(&self, line: &str) -> Option<Record> {
        let (cell, seed, record) = decode(unseal(line)?, self.plan.record.len())?;
        let profile = seed.wrapping_sub(self.plan.seed);
        let is_of_plan = cell < self.plan.cells() && profile < self.plan.lines;
        is_of_plan.then_some((cell * self.plan.lines + profile, record))
    }

    /// Returns whether each record exists, in the order of the indices of the records. Before that,
    /// all files are synced to the disk. Otherwise a power cut could lose records of a killed
    /// process after they were counted as existing, and these records would never be computed
    /// again.
    pub(super) fn done(&self) -> Result<Vec<bool>, StudyError> {
        let mut done = vec![false; self.plan.records_in_all() as usize];
        for file in self.files()? {
            for record in self.records(&file)? {
                record?
                    .into_iter()
                    .for_each(|(place, _)| done[place as usize] = true);
            }
            // Windows syncs only files that were opened for writing.
            let open = OpenOptions::new()
                .read(true)
                .write(cfg!(windows))
                .open(&file.path);
            open.and_then(|file| file.sync_all())
                .map_err(StudyError::unwritable(&file.path))?;
        }
        let shards = self.path.join(SHARDS);
        sync_folder(&shards).map_err(StudyError::unwritable(&shards))?;
        Ok(done)
    }
}

/// Returns the shard file at `path`; `None` if the file has no header yet. Returns an error if the
/// checksum in the header shows that the file belongs to another plan.
fn file_of_plan(path: PathBuf, checksum: &str) -> Result<Option<ShardFile>, StudyError> {
    let file = open_regular(&path).map_err(|error| StudyError::folder(&path, error))?;
    let written = file
        .metadata()
        .and_then(|found| found.modified())
        .map_err(StudyError::unreadable(&path))?;
    let written = written
        .duration_since(UNIX_EPOCH)
        .unwrap_or_default()
        .as_secs_f64();
    // A folder may have thousands of files, so only the first line of each is read here.
    let first = lines(BufReader::with_capacity(1 << 10, file))
        .next()
        .transpose();
    let first = first.map_err(StudyError::unreadable(&path))?.flatten();
    let Some(payload) = first.as_deref().and_then(unseal) else {
        return Ok(None);
    };
    let header =
        header_of(payload, checksum).map_err(|reason| StudyError::folder(&path, reason))?;
    Ok(Some(ShardFile {
        header,
        written,
        path,
    }))
}

/// Reads the header of a shard file. A crash leaves an incomplete header or none, so a complete but
/// wrong header is refused as an error.
fn header_of(payload: &str, checksum: &str) -> Result<ShardHeader, String> {
    let header: ShardHeader = serde_json::from_str(payload).map_err(|error| {
        format!(
            "its first line is not the header of a shard file ({error}); remove the file or bring back another"
        )
    })?;
    if header.format != STORE_VERSION {
        return Err(format!(
            "its format is {}; this program reads {STORE_VERSION}",
            header.format
        ));
    }
    if header.plan != checksum {
        return Err("this file belongs to another plan".into());
    }
    Ok(ShardHeader {
        shard: Shard::new(header.shard.number, header.shard.count)?,
        ..header
    })
}

/// Appends a line to `into`: the checksum of `payload`, a comma, and `payload`, which has no line
/// break.
pub(super) fn seal(payload: &str, into: &mut String) {
    // Writing to a string cannot fail.
    let _ = writeln!(
        into,
        "{:08x},{payload}",
        crc32fast::hash(payload.as_bytes())
    );
}

/// Returns the text of a line without the checksum before it; `None` if the checksum is missing or
/// wrong.
pub(super) fn unseal(line: &str) -> Option<&str> {
    let payload = line.get(CHECKSUM..)?;
    let checksum = line.get(..CHECKSUM)?.strip_suffix(',')?;
    // The checksum is compared as text, so that only one spelling of each line is accepted.
    let is_ours = checksum == format!("{:08x}", crc32fast::hash(payload.as_bytes()));
    is_ours.then_some(payload)
}

/// Appends the record of the cell with the number `cell` and the profile with this seed. A missing
/// value (NaN) becomes an empty column. If there are no values, the reason follows after
/// [`FAILED`].
pub(super) fn encode(cell: u64, seed: u64, record: &Recorded, into: &mut String) {
    let mut payload = format!("{cell},{seed}");
    if let Err(reason) = record {
        payload.push_str(FAILED);
        payload.push_str(reason);
    }
    for value in record.iter().flatten() {
        payload.push(',');
        if !value.is_nan() {
            // `{:?}` writes the shortest text from which the same bits are read again.
            let _ = write!(payload, "{value:?}");
        }
    }
    seal(&payload, into);
}

/// Returns the cell, the seed and the values of a record, with NaN for empty columns. Returns
/// `None` if the record has neither `count` values nor a reason.
pub(super) fn decode(payload: &str, count: usize) -> Option<(u64, u64, Recorded)> {
    if let Some((place, reason)) = payload.split_once(FAILED) {
        let (cell, seed) = place.split_once(',')?;
        return Some((
            cell.parse().ok()?,
            seed.parse().ok()?,
            Err(reason.to_owned()),
        ));
    }
    let mut columns = payload.split(',');
    let cell = columns.next()?.parse().ok()?;
    let seed = columns.next()?.parse().ok()?;
    let mut values = Vec::with_capacity(count);
    for text in columns {
        values.push(if text.is_empty() {
            f64::NAN
        } else {
            text.parse().ok()?
        });
    }
    (values.len() == count).then_some((cell, seed, Ok(values)))
}

/// Returns the lines of a text without their line breaks. A line is `None` if it is too long,
/// incomplete or not UTF-8.
pub(super) fn lines(mut text: impl BufRead) -> impl Iterator<Item = io::Result<Option<String>>> {
    std::iter::from_fn(move || {
        let mut line = Vec::new();
        let read = text
            .by_ref()
            .take(LONGEST_LINE)
            .read_until(b'\n', &mut line);
        match read {
            Ok(0) => None,
            Ok(_) => Some(Ok(whole_line(line))),
            Err(error) => Some(Err(error)),
        }
    })
}

/// Returns a line without its line break; `None` if it has no line break or is not UTF-8.
fn whole_line(mut line: Vec<u8>) -> Option<String> {
    if line.pop() != Some(b'\n') {
        return None;
    }
    String::from_utf8(line).ok()
}

fn text_of(file: &Path) -> Result<String, StudyError> {
    read_regular_text(file, LONGEST_TEXT).map_err(|error| StudyError::folder(file, error))
}

/// Returns the error for a folder whose plan differs from `plan`. `there` is the text of the plan
/// in the folder.
fn refusal(path: &Path, there: &str, plan: &Plan) -> StudyError {
    let file = path.join(PLAN_FILE);
    // If only the content of a measured file has changed, the error says so.
    let of_folder = Plan::read(there, PLAN_FILE, &Changes::default());
    if let (Ok(of_folder), Some(measured), Some(found)) =
        (of_folder, file_of(plan), &plan.measured_sha256)
        && let Some(expected) = of_folder.measured_sha256.clone()
        && (Plan {
            measured_sha256: plan.measured_sha256.clone(),
            ..of_folder
        }) == *plan
    {
        return changed(&measured, found, &path_name(&file), &expected);
    }
    let difference = difference(there, &plan.to_ron());
    let other = "this folder holds a study of another plan; choose another folder, or the plan it began with";
    StudyError::folder(path, format!("{other}\n{difference}"))
}

fn difference(there: &str, asked: &str) -> String {
    let mut there = there.lines();
    let mut asked = asked.lines();
    loop {
        match (there.next(), asked.next()) {
            (None, None) => return String::new(),
            (there, here) if there != here => {
                let there = line_in_words(there);
                let here = line_in_words(here);
                return format!("there: {there}\nhere:  {here}");
            }
            _ => {}
        }
    }
}

fn line_in_words(line: Option<&str>) -> String {
    match line {
        Some(line) => printable(line.trim()).into_owned(),
        None => "nothing".to_owned(),
    }
}

/// Returns the name of this machine, reduced to characters that are allowed in a file name.
fn host() -> String {
    #[cfg(unix)]
    let name = rustix::system::uname()
        .nodename()
        .to_string_lossy()
        .into_owned();
    #[cfg(not(unix))]
    let name = std::env::var("COMPUTERNAME").unwrap_or_default();
    in_letters_for_files(&name)
}

fn in_letters_for_files(name: &str) -> String {
    let name: String = name
        .chars()
        .filter(|c| c.is_ascii_alphanumeric() || *c == '_')
        .take(40)
        .collect();
    if name.is_empty() { "host".into() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn records_read_back_bit_for_bit(
            cell: u64,
            seed: u64,
            values in prop::collection::vec(prop::option::of(any::<f64>()), 1..6),
        ) {
            let values: Vec<f64> = values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect();
            let mut text = String::new();
            encode(cell, seed, &Ok(values.clone()), &mut text);
            let line = text.trim_end_matches('\n');
            let payload = unseal(line).unwrap();
            let (of_cell, of_seed, read) = decode(payload, values.len()).unwrap();
            prop_assert_eq!((of_cell, of_seed), (cell, seed));
            prop_assert!(decode(payload, values.len() + 1).is_none());
            prop_assert!(decode(payload, values.len() - 1).is_none());
            for (read, value) in read.unwrap().iter().zip(&values) {
                prop_assert!(read.to_bits() == value.to_bits() || (read.is_nan() && value.is_nan()));
            }
            // A line that was shortened or changed at any place is refused.
            for end in 0..line.len() {
                prop_assert_eq!(unseal(&line[..end]), None);
            }
            for place in 0..line.len() {
                let mut changed = line.as_bytes().to_vec();
                changed[place] ^= 1;
                prop_assert_eq!(unseal(std::str::from_utf8(&changed).unwrap()), None);
            }
        }
    }

    #[test]
    fn names_of_machines_keep_letters_for_files() {
        let long = "n".repeat(64);
        for (name, kept) in [
            ("node_7", "node_7"),
            ("login-1.example.org", "login1exampleorg"),
            ("../Rechner ä\u{1b}", "Rechner"),
            ("-.-", "host"),
            ("", "host"),
            (&long, &long[..40]),
        ] {
            assert_eq!(in_letters_for_files(name), kept);
        }
    }
}
