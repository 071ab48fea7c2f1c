//! Merge of all records of a study into tables: each record once, sorted, with statistics over the profiles.

use super::StudyError;
use super::cell_summary::CellSummary;
use super::plan::Plan;
use super::plan_check::MOST_RECORDS;
use super::publish::publish;
use super::record::{Key, key_of, values_into};
use super::statistics::StudentT;
use super::store::{Folder, Lines, ShardFile};
use super::tables::{
    Merged, RESULTS, SIDECAR, SUMMARY, header, number, regime_name, row_start, sidecar, summary_row,
};
use crate::io::{WriteError, open_regular, write_json_value, write_new_on};
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::Path;

/// Most missing cells that are named.
const MOST_NAMED: usize = 8;
/// Bits of a place for the number of the file; the others hold the place in that file.
const FILE_BITS: u32 = 24;
const NOWHERE: u64 = u64::MAX;

/// Place of every record.
struct Index {
    files: Vec<ShardFile>,
    places: Vec<u64>,
    merged: Merged,
}

/// Merges the shard files of a study and publishes its tables, all or none: after any end of the process or the
/// machine, a reader finds those of this merge or those of the one before. With `partial`, tables of the existing
/// records. Removes [`super::PARQUET`] of an earlier merge.
///
/// # Errors
/// [`StudyError::Missing`] if records are missing and `partial` is not set; [`StudyError::Disagree`] if two records
/// of one cell and profile differ.
pub fn merge(folder: &Folder, partial: bool) -> Result<Merged, StudyError> {
    let index = Index::of(folder)?;
    if index.merged.records < index.merged.total && !partial {
        let plan = folder.plan();
        let cells = index.merged.first_missing.iter();
        let named = cells.map(|&cell| format!("cell {cell} ({})", plan.coordinates(cell))).collect();
        return Err(StudyError::Missing {
            records: index.merged.total - index.merged.records,
            total: index.merged.total,
            cells: index.merged.missing_cells,
            named,
        });
    }
    index.publish(folder)?;
    Ok(index.merged)
}

impl Index {
    fn of(folder: &Folder) -> Result<Index, StudyError> {
        let plan = folder.plan();
        let total = plan.records_in_all();
        debug_assert!(total <= MOST_RECORDS);
        let mut places = Vec::new();
        places.try_reserve_exact(total as usize).map_err(|_| StudyError::OutOfMemory { records: total })?;
        places.resize(total as usize, NOWHERE);
        let files = folder.files()?;
        let (mut records, mut duplicates, mut damaged, mut holding) = (0, 0, 0, 0);
        let mut programs = BTreeSet::new();
        // Repeated records of a file are mostly in one other file.
        let mut others = OneOpen::new(&files, plan.record.len());
        for (number, file) in files.iter().enumerate() {
            let mut here = 0;
            damaged += folder.records(file, &mut |found| {
                here += 1;
                let Some(place) = folder.place(found.key).map(|place| &mut places[place as usize]) else {
                    return Ok(());
                };
                if *place == NOWHERE {
                    *place = place_of(number, found.offset).ok_or_else(|| too_large(&file.path))?;
                    records += 1;
                    return Ok(());
                }
                duplicates += 1;
                if same(others.values(*place)?, found.values) {
                    return Ok(());
                }
                Err(StudyError::Disagree {
                    key: found.key,
                    coordinates: plan.coordinates(found.key.cell),
                    one: files[file_of(*place)].path.clone(),
                    other: file.path.clone(),
                })
            })?;
            if here > 0 {
                holding += 1;
                programs.extend(file.header.as_ref().map(|header| header.program.clone()));
            }
        }
        let lines = plan.lines as usize;
        let (mut missing_cells, mut first_missing) = (0, Vec::new());
        for (cell, places) in places.chunks(lines).enumerate() {
            if places.contains(&NOWHERE) {
                missing_cells += 1;
                if first_missing.len() < MOST_NAMED {
                    first_missing.push(cell as u64);
                }
            }
        }
        let merged = Merged {
            records,
            total,
            duplicates,
            damaged,
            missing_cells,
            first_missing,
            files: holding,
            programs: programs.into_iter().collect(),
        };
        Ok(Index { files, places, merged })
    }

    fn publish(&self, folder: &Folder) -> Result<(), StudyError> {
        // A study with a summary counts as merged, so the summary is last where files are published one by one.
        publish(folder.disk(), folder.path(), &[RESULTS, SIDECAR, SUMMARY], &mut |place| {
            let [results, summary] = [RESULTS, SUMMARY].map(|name| place.join(name));
            write_new_on(folder.disk(), &results, false, |results| {
                let written = write_new_on(folder.disk(), &summary, false, |summary| {
                    let plan = folder.plan();
                    let cells = cells_at_once(plan.lines as usize, plan.record.len());
                    self.write_tables(plan, cells, results, summary)
                });
                written.map_err(|error| match error {
                    WriteError::Failed { reason, .. } => reason,
                    other => io::Error::other(other.to_string()),
                })
            })?;
            let sidecar = sidecar(folder.plan(), &self.merged);
            Ok(write_new_on(folder.disk(), &place.join(SIDECAR), false, |out| {
                write_json_value(out, &sidecar)
            })?)
        })
    }

    /// Writes results and summary together, so that each record is read once, `cells` cells at a time. The records
    /// of these cells are read in file order: a single file is open at a time.
    fn write_tables(
        &self,
        plan: &Plan,
        cells: usize,
        results: &mut dyn Write,
        summary: &mut dyn Write,
    ) -> io::Result<()> {
        writeln!(results, "{}", header(plan, true))?;
        writeln!(summary, "{}", header(plan, false))?;
        let (lines, columns) = (plan.lines as usize, plan.record.len());
        let mut quantiles = StudentT::default();
        let mut files = OneOpen::new(&self.files, columns);
        let (mut values, mut order) = (Vec::new(), Vec::new());
        for (block, places) in self.places.chunks(cells * lines).enumerate() {
            order.clear();
            order.extend((0..places.len()).filter(|&row| places[row] != NOWHERE));
            // A place is the number of the file, then the offset in it.
            order.sort_unstable_by_key(|&row| places[row]);
            values.clear();
            values.resize(places.len() * columns, f64::NAN);
            for &row in &order {
                values[row * columns..][..columns].copy_from_slice(files.values(places[row])?);
            }
            let rows = places.chunks(lines).zip(values.chunks(lines * columns));
            for (cell, (places, values)) in ((block * cells) as u64..).zip(rows) {
                let start = row_start(plan, cell);
                let mut there = Vec::with_capacity(places.len());
                for (line, (&place, values)) in (0..).zip(places.iter().zip(values.chunks(columns))) {
                    if place == NOWHERE {
                        continue;
                    }
                    write!(results, "{start},{}", plan.seed_of(line))?;
                    for (quantity, value) in plan.record.iter().zip(values) {
                        match regime_name(*quantity, *value) {
                            Some(name) => write!(results, ",{name}")?,
                            None => write!(results, ",{}", number(Some(*value)))?,
                        }
                    }
                    writeln!(results)?;
                    there.push(values);
                }
                if !there.is_empty() {
                    let cell = CellSummary::new(cell, &plan.record, &there, &mut quantiles);
                    writeln!(summary, "{start},{}", summary_row(plan, &cell))?;
                }
            }
        }
        Ok(())
    }
}

/// Bytes of the records held while tables are written; at least those of one cell.
const HELD: usize = 8 << 20;

fn cells_at_once(lines: usize, columns: usize) -> usize {
    // The values of a row, its place in the order, and the place of the values in the summary.
    let row = size_of::<f64>() * columns + size_of::<usize>() + size_of::<&[f64]>();
    (HELD / (row * lines)).max(1)
}

/// Reader of records from any of many files; only the last file is open.
struct OneOpen<'f> {
    files: &'f [ShardFile],
    open: Option<(usize, Lines)>,
    columns: usize,
    values: Vec<f64>,
}

impl<'f> OneOpen<'f> {
    fn new(files: &'f [ShardFile], columns: usize) -> Self {
        OneOpen { files, open: None, columns, values: Vec::with_capacity(columns) }
    }

    /// The values of the record at a place.
    fn values(&mut self, place: u64) -> Result<&[f64], StudyError> {
        let number = file_of(place);
        let file = &self.files[number];
        let unreadable = StudyError::unreadable(&file.path);
        if self.open.as_ref().is_none_or(|(open, _)| *open != number) {
            // The previous file is closed first.
            self.open = None;
        }
        let (_, lines) = match &mut self.open {
            Some(open) => open,
            None => {
                let opened = open_regular(&file.path).map_err(|error| unreadable(io::Error::other(error)))?;
                self.open.insert((number, Lines::new(opened, 1 << 14)))
            }
        };
        let payload = lines.at(offset_of(place)).map_err(&unreadable)?;
        let sound =
            key_of(payload).is_some_and(|(_, text)| values_into(text, self.columns, &mut self.values));
        if sound { Ok(&self.values) } else { Err(unreadable(changed())) }
    }
}

fn changed() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "a record has changed while it was read")
}

/// A file and an offset as one number; `None` if they are too large.
fn place_of(file: usize, offset: u64) -> Option<u64> {
    let bits = u64::BITS - FILE_BITS;
    ((file as u64) < (1 << FILE_BITS) - 1 && offset < 1 << bits).then_some((file as u64) << bits | offset)
}

fn file_of(place: u64) -> usize {
    (place >> (u64::BITS - FILE_BITS)) as usize
}

fn offset_of(place: u64) -> u64 {
    place & (u64::MAX >> FILE_BITS)
}

fn too_large(path: &Path) -> StudyError {
    let reason = format!(
        "more than can be merged; allowed: {} shard files of at most {} bytes each",
        (1_u64 << FILE_BITS) - 1,
        1_u64 << (u64::BITS - FILE_BITS)
    );
    StudyError::folder(path, reason)
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
    use super::super::{Changes, Options, Shard, run};
    use super::*;
    use proptest::prelude::*;

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
        let merged = Index::of(&empty(place.path())).unwrap().merged;
        assert_eq!((merged.records, merged.missing_cells, merged.files), (0, 12, 0));
        assert_eq!(merged.first_missing, [0, 1, 2, 3, 4, 5, 6, 7]);
    }

    #[test]
    fn tables_do_not_depend_on_the_cells_that_are_held() {
        let place = tempfile::tempdir().unwrap();
        let folder = study(place.path());
        let index = Index::of(&folder).unwrap();
        let tables = |cells| {
            let (mut results, mut summary) = (Vec::new(), Vec::new());
            assert!(index.write_tables(folder.plan(), cells, &mut results, &mut summary).is_ok());
            [results, summary].map(|table| String::from_utf8(table).unwrap())
        };
        let whole = tables(12);
        let cells = |table: &str| -> Vec<usize> {
            table.lines().skip(1).map(|row| row.split(',').next().unwrap().parse().unwrap()).collect()
        };
        assert_eq!(cells(&whole[1]), (0..12).collect::<Vec<_>>());
        assert_eq!(cells(&whole[0]), (0..36).map(|row| row / 3).collect::<Vec<_>>());
        for cells in [1, 2, 3, 5, 100] {
            assert_eq!(tables(cells), whole, "{cells}");
        }
    }

    #[test]
    fn files_count_where_they_hold_records() {
        let place = tempfile::tempdir().unwrap();
        let folder = study(place.path());
        let merged = Index::of(&folder).unwrap().merged;
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
        let again = Index::of(&folder).unwrap().merged;
        assert_eq!((again.files, again.programs), (2, merged.programs));
    }

    #[test]
    fn eight_mebibytes_are_held_and_at_least_one_cell() {
        // 32 bytes for a row of one value.
        assert_eq!(cells_at_once(1, 1), 1 << 18);
        assert_eq!(cells_at_once(1000, 1), 262);
        // 128 bytes.
        assert_eq!(cells_at_once(1 << 10, 13), 64);
        assert_eq!(cells_at_once(1 << 24, 13), 1);
    }

    proptest! {
        /// A place returns its file and offset, and places are in the order of files and offsets.
        #[test]
        fn places_are_files_and_offsets(
            files in [0_usize..(1 << FILE_BITS) - 1, 0_usize..(1 << FILE_BITS) - 1],
            offsets in [0_u64..1 << (64 - FILE_BITS), 0_u64..1 << (64 - FILE_BITS)],
        ) {
            let places = [0, 1].map(|k| place_of(files[k], offsets[k]).unwrap());
            for k in [0, 1] {
                prop_assert_eq!((file_of(places[k]), offset_of(places[k])), (files[k], offsets[k]));
                prop_assert_ne!(places[k], NOWHERE);
            }
            let order = (files[0], offsets[0]).cmp(&(files[1], offsets[1]));
            prop_assert_eq!(places[0].cmp(&places[1]), order);
        }
    }

    #[test]
    fn files_and_offsets_have_an_end() {
        let (files, bytes) = (1_usize << FILE_BITS, 1_u64 << (64 - FILE_BITS));
        assert!(place_of(files - 2, bytes - 1).is_some_and(|place| place != NOWHERE));
        assert_eq!(place_of(files - 1, 0), None);
        assert_eq!(place_of(0, bytes), None);
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
