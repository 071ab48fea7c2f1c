//! Merge of all records of a study into tables: each record once, sorted, with statistics over the profiles.

use super::StudyError;
use super::cell_summary::CellSummary;
use super::done::Done;
use super::record::Key;
use super::statistics::StudentT;
use super::store::{Folder, ShardFile};
use super::tables::{
    Merged, PARQUET, RESULTS, SIDECAR, SUMMARY, header, number, regime_name, row_start, sidecar, summary_row,
};
use crate::io::{hexadecimal, write_json_value, write_new_file};
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::PathBuf;

/// Most missing cells that are named.
const MOST_NAMED: usize = 8;

/// All records of a study.
struct Table<'a> {
    folder: &'a Folder,
    /// Values of each record, by cell, then by profile; NaN where there are none.
    values: Vec<f64>,
    done: Done,
    merged: Merged,
}

/// Merges the shard files of a study and writes its tables, each whole; the sidecar, which is last, holds the SHA-256 of
/// the summary. With `partial`, tables of the existing records. Removes [`PARQUET`] of an earlier merge.
///
/// # Errors
/// [`StudyError::Missing`] if records are missing and `partial` is not set; [`StudyError::Disagree`] if two records
/// of one cell and profile differ.
pub fn merge(folder: &Folder, partial: bool) -> Result<Merged, StudyError> {
    let table = Table::of(folder)?;
    if table.merged.records < table.merged.total && !partial {
        let plan = folder.plan();
        let cells = table.merged.first_missing.iter();
        let named = cells.map(|&cell| format!("cell {cell} ({})", plan.coordinates(cell))).collect();
        return Err(StudyError::Missing {
            records: table.merged.total - table.merged.records,
            total: table.merged.total,
            cells: table.merged.missing_cells,
            named,
        });
    }
    let path = |name| folder.path().join(name);
    let parquet = path(PARQUET);
    if parquet.exists() {
        std::fs::remove_file(&parquet).map_err(StudyError::unwritable(&parquet))?;
    }
    write_new_file(&path(RESULTS), true, |out| table.write_results(out))?;
    let summary = table.summary();
    write_new_file(&path(SUMMARY), true, |out| out.write_all(summary.as_bytes()))?;
    let hash = hexadecimal(Sha256::new().chain_update(&summary));
    write_new_file(&path(SIDECAR), true, |out| {
        write_json_value(out, &sidecar(folder.plan(), &table.merged, &hash))
    })?;
    Ok(table.merged)
}

impl<'a> Table<'a> {
    fn of(folder: &'a Folder) -> Result<Self, StudyError> {
        let plan = folder.plan();
        let (total, columns) = (plan.records_in_all(), plan.record.len());
        let mut values = Vec::new();
        let out_of_memory = |_| StudyError::OutOfMemory { records: total };
        values.try_reserve_exact(total as usize * columns).map_err(out_of_memory)?;
        values.resize(total as usize * columns, f64::NAN);
        let mut done = Done::none(total);
        let files = folder.files()?;
        let (mut records, mut duplicates, mut damaged, mut holding) = (0, 0, 0, 0);
        let mut programs = BTreeSet::new();
        for file in &files {
            let mut here = 0;
            damaged += folder.records(file, &mut |found| {
                here += 1;
                let Some(place) = folder.place(found.key) else { return Ok(()) };
                let known = &mut values[place as usize * columns..][..columns];
                if !done.has(place) {
                    done.add(place);
                    known.copy_from_slice(found.values);
                    records += 1;
                    return Ok(());
                }
                duplicates += 1;
                if same(known, found.values) {
                    return Ok(());
                }
                Err(StudyError::Disagree {
                    key: found.key,
                    coordinates: plan.coordinates(found.key.cell),
                    one: first_with(folder, &files, found.key)?,
                    other: file.path.clone(),
                })
            })?;
            if here > 0 {
                holding += 1;
                programs.extend(file.header.as_ref().map(|header| header.program.clone()));
            }
        }
        let is_whole = |cell: &u64| (0..plan.lines).all(|line| done.has(cell * plan.lines + line));
        let missing: Vec<u64> = (0..plan.cells()).filter(|cell| !is_whole(cell)).collect();
        let merged = Merged {
            records,
            total,
            duplicates,
            damaged,
            missing_cells: missing.len() as u64,
            first_missing: missing.into_iter().take(MOST_NAMED).collect(),
            files: holding,
            programs: programs.into_iter().collect(),
        };
        Ok(Table { folder, values, done, merged })
    }

    /// Existing records of a cell: the number of the profile and the values.
    fn records_of(&self, cell: u64) -> impl Iterator<Item = (u64, &[f64])> {
        let plan = self.folder.plan();
        let columns = plan.record.len();
        (0..plan.lines).filter_map(move |line| {
            let place = cell * plan.lines + line;
            self.done.has(place).then(|| (line, &self.values[place as usize * columns..][..columns]))
        })
    }

    fn write_results(&self, out: &mut dyn Write) -> io::Result<()> {
        let plan = self.folder.plan();
        writeln!(out, "{}", header(plan, true))?;
        for cell in 0..plan.cells() {
            let start = row_start(plan, cell);
            for (line, values) in self.records_of(cell) {
                write!(out, "{start},{}", plan.seed_of(line))?;
                for (quantity, value) in plan.record.iter().zip(values) {
                    match regime_name(*quantity, *value) {
                        Some(name) => write!(out, ",{name}")?,
                        None => write!(out, ",{}", number(Some(*value)))?,
                    }
                }
                writeln!(out)?;
            }
        }
        Ok(())
    }

    fn summary(&self) -> String {
        let plan = self.folder.plan();
        let mut text = header(plan, false) + "\n";
        let mut quantiles = StudentT::default();
        for cell in 0..plan.cells() {
            let there: Vec<&[f64]> = self.records_of(cell).map(|(_, values)| values).collect();
            if !there.is_empty() {
                let summary = CellSummary::new(cell, &plan.record, &there, &mut quantiles);
                let _ = writeln!(text, "{},{}", row_start(plan, cell), summary_row(plan, &summary));
            }
        }
        text
    }
}

/// The first file with a record of this key.
fn first_with(folder: &Folder, files: &[ShardFile], key: Key) -> Result<PathBuf, StudyError> {
    for file in files {
        let mut has = false;
        folder.records(file, &mut |found| {
            has |= found.key == key;
            Ok(())
        })?;
        if has {
            return Ok(file.path.clone());
        }
    }
    Ok(folder.path().to_path_buf())
}

fn same(one: &[f64], other: &[f64]) -> bool {
    let equal = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    one.len() == other.len() && one.iter().zip(other).all(equal)
}

/// The key of a record, for messages.
impl std::fmt::Display for Key {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "cell {}, seed {}", self.cell, self.seed)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Changes, Options, Plan, Shard, run};
    use super::*;
    use std::path::Path;

    /// A study of twelve cells and three profiles without records.
    fn empty(place: &Path) -> Folder {
        let text = r#"(
            version: 1,
            title: "Small",
            scene: (
                version: 1,
                material: (effective_modulus: 2.0e6),
                length: 1.0e-4,
                roughness: SelfAffine(hurst: 0.5, rms_height: 2.0e-7, modes: (1, 8), seed: 1),
                adhesion: (kappa: 1.0),
                numerics: (points: 32, edges: Grid),
            ),
            axes: [Linear(path: "kappa", from: 0.5, to: 2.0, count: 12)],
            preloads: [0.01],
            lines: 3,
            record: [adhesion_force, regime],
        )"#;
        let plan = Plan::parse(text, "test", &Changes::default()).unwrap();
        Folder::create(&place.join("study"), &plan).unwrap()
    }

    /// A study with half of its records in one file and half in another.
    fn study(place: &Path) -> Folder {
        let folder = empty(place);
        for number in [1, 2] {
            let shard = Shard { number, count: 2 };
            run(&folder, Options { jobs: 1, shard }, &|| false, &mut |_| ()).unwrap();
        }
        folder
    }

    #[test]
    fn the_first_missing_cells_are_named() {
        let place = tempfile::tempdir().unwrap();
        let merged = Table::of(&empty(place.path())).unwrap().merged;
        assert_eq!((merged.records, merged.missing_cells, merged.files), (0, 12, 0));
        assert_eq!(merged.first_missing, [0, 1, 2, 3, 4, 5, 6, 7]);
    }

    #[test]
    fn files_count_where_they_hold_records() {
        let place = tempfile::tempdir().unwrap();
        let folder = study(place.path());
        let merged = Table::of(&folder).unwrap().merged;
        assert_eq!((merged.files, merged.programs.len(), merged.records), (2, 1, 36));
        // A file of another program version, stopped before its first record.
        let file = &folder.files().unwrap()[0].path;
        let text = std::fs::read_to_string(file).unwrap();
        let header = text.lines().next().unwrap().split_once(',').unwrap().1;
        let program = merged.programs[0].as_str();
        assert!(header.contains(program));
        let header = header.replace(program, "another");
        let sealed = format!("{:08x},{header}\n", crc32fast::hash(header.as_bytes()));
        std::fs::write(file.with_file_name("zz.shard"), sealed).unwrap();
        let again = Table::of(&folder).unwrap().merged;
        assert_eq!((again.files, again.programs), (2, merged.programs));
    }

    #[test]
    fn records_agree_bit_by_bit_but_for_the_kind_of_nan() {
        let other_nan = f64::from_bits(f64::NAN.to_bits() | 1);
        assert!(same(&[1.0, f64::NAN], &[1.0, other_nan]));
        for (one, other) in [(1.0, 1.0_f64.next_up()), (0.0, -0.0), (f64::NAN, 1.0), (1.0, f64::NAN)] {
            assert!(!same(&[2.0, one], &[2.0, other]), "{one} {other}");
        }
        assert!(!same(&[1.0], &[1.0, 1.0]));
    }

    #[test]
    fn keys_are_named() {
        assert_eq!(Key { cell: 3, seed: 7 }.to_string(), "cell 3, seed 7");
    }
}
