//! Studies and saved files on a disk of which each operation fails, is torn, or is the last one before the process or
//! the machine ends: all work reported as done is present, and the continued study has the bytes of an undisturbed one.
mod disk;

use asperity::io::{Disk, write_new_on};
use asperity::study::{
    Changes, Folder, Options, Plan, RESULTS, SIDECAR, SUMMARY, Shard, Status, StudyError, merge, run,
};
use disk::{Fault, SimulatedDisk, Survival};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use tempfile::TempDir;

const PLAN: &str = r#"(
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
    axes: [Linear(path: "kappa", from: 0.5, to: 2.0, count: 2)],
    preloads: [0.01, 0.3],
    lines: 2,
    record: [adhesion_force, regime],
)"#;

/// Records of each half of the plan.
const HALF: u64 = 4;

const SURVIVALS: [Survival; 9] = [
    Survival::Nothing,
    Survival::Everything,
    Survival::Names,
    Survival::Content,
    Survival::Half,
    Survival::Zeros,
    Survival::Random(1),
    Survival::Random(2),
    Survival::Random(3),
];

fn plan() -> &'static Plan {
    static PARSED: LazyLock<Plan> = LazyLock::new(|| Plan::parse(PLAN, "test", &Changes::default()).unwrap());
    &PARSED
}

fn place() -> (TempDir, PathBuf) {
    let place = tempfile::tempdir().unwrap();
    let path = fs::canonicalize(place.path()).unwrap();
    (place, path)
}

/// Work reported as done before a failure.
#[derive(Clone, Copy, Debug, Default)]
struct Reported {
    folder: bool,
    /// Records of each half.
    records: [u64; 2],
    partial: bool,
    whole: bool,
}

/// A study from beginning to end, by two processes in turn.
fn study(disk: &Arc<dyn Disk>, root: &Path, reported: &mut Reported) -> Result<(), StudyError> {
    let folder = Folder::create_on(Arc::clone(disk), &root.join("study"), plan())?;
    reported.folder = true;
    for number in [1, 2] {
        let shard = Shard { number, count: 2 };
        let reported_done = &mut reported.records[number as usize - 1];
        let ended = run(&folder, Options { jobs: 1, shard }, &|| false, &mut |progress| {
            *reported_done = (*reported_done).max(progress.done);
        })?;
        assert!(ended.complete);
        assert_eq!(reported.records[number as usize - 1], HALF);
        if number == 1 {
            merge(&folder, true)?;
            reported.partial = true;
        }
    }
    merge(&folder, false)?;
    reported.whole = true;
    Ok(())
}

/// Results and summary, where present, and the number of records counted by the sidecar.
type Tables = (Option<String>, Option<String>, Option<u64>);

fn tables(folder: &Path) -> Tables {
    let read = |name: &str| fs::read_to_string(folder.join(name)).ok();
    let sidecar = read(SIDECAR).map(|text| {
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        value["records"].as_u64().unwrap()
    });
    (read(RESULTS), read(SUMMARY), sidecar)
}

/// The tables of a half and of the whole study, undisturbed.
struct Expected {
    partial: Tables,
    whole: Tables,
}

impl Expected {
    fn new() -> Expected {
        let (_place, root) = place();
        let folder = Folder::create(&root, plan()).unwrap();
        let compute = |shard| {
            assert!(run(&folder, Options { jobs: 1, shard }, &|| false, &mut |_| ()).unwrap().complete);
            merge(&folder, true).unwrap();
            tables(&root)
        };
        let expected =
            Expected { partial: compute(Shard { number: 1, count: 2 }), whole: compute(Shard::WHOLE) };
        assert_eq!((expected.partial.2, expected.whole.2), (Some(HALF), Some(2 * HALF)));
        assert_ne!(expected.partial.0, expected.whole.0);
        expected
    }

    /// Checks the found study, continues it, and checks the result; the error names the loss.
    fn check(&self, root: &Path, reported: Reported) -> Result<(), String> {
        let message = |error: StudyError| error.to_string();
        let path = root.join("study");
        if reported.folder {
            let done = Status::of(&Folder::open(&path).map_err(message)?).map_err(message)?.done;
            let records: u64 = reported.records.iter().sum();
            if done < records {
                return Err(format!("{done} of {records} records that were reported"));
            }
        }
        let found = tables(&path);
        let sound = found == self.whole
            || (found == self.partial && !reported.whole)
            || (found == (None, None, None) && !reported.partial);
        if !sound {
            return Err(format!("{reported:?}: {found:?}"));
        }
        // The disk is simulated so that waits are short.
        let folder = Folder::create_on(SimulatedDisk::new(root).shared(), &path, plan()).map_err(message)?;
        let options = Options { jobs: 1, shard: Shard::WHOLE };
        assert!(run(&folder, options, &|| false, &mut |_| ()).map_err(message)?.complete);
        let merged = merge(&folder, false).map_err(message)?;
        if (merged.records, merged.missing_cells) != (2 * HALF, 0) || tables(&path) != self.whole {
            return Err(format!("{merged:?}: {:?}", tables(&path)));
        }
        let current = fs::read_link(path.join("tables")).ok();
        let names =
            fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let remains: Vec<_> = names
            .filter(|name| name.starts_with(".tables-") && current.as_deref() != Some(Path::new(name)))
            .collect();
        if remains.is_empty() { Ok(()) } else { Err(format!("unpublished tables are left: {remains:?}")) }
    }

    /// Checks, and reports the operation before a loss.
    fn hold(&self, root: &Path, reported: Reported, what: &str) {
        self.check(root, reported).unwrap_or_else(|lost| panic!("{what}: {lost}"));
    }
}

/// Content of a folder: files by their paths, links with their targets.
type Content = BTreeMap<PathBuf, Result<Vec<u8>, PathBuf>>;

fn content(root: &Path) -> Content {
    let (mut found, mut folders) = (Content::new(), vec![root.to_path_buf()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let kind = fs::symlink_metadata(&path).unwrap();
            let name = path.strip_prefix(root).unwrap().to_path_buf();
            if kind.is_symlink() {
                found.insert(name, Err(fs::read_link(&path).unwrap()));
            } else if kind.is_dir() {
                found.insert(name.join(""), Ok(Vec::new()));
                folders.push(path);
            } else {
                found.insert(name, Ok(fs::read(&path).unwrap()));
            }
        }
    }
    found
}

/// Checks the content of a disk after power cuts with these survivals; of several with the same content one is checked.
/// Returns the number of the cuts.
fn hold_after_power_cuts(
    expected: &Expected,
    disk: &SimulatedDisk,
    survivals: &[Survival],
    reported: Reported,
    what: &str,
) -> usize {
    let mut checked: Vec<Content> = Vec::new();
    for survival in survivals {
        let (_place, found) = place();
        disk.after_power_cut(*survival, &found);
        let content = content(&found);
        if !checked.contains(&content) {
            expected.hold(&found, reported, &format!("{what}, {survival:?} survives"));
            checked.push(content);
        }
    }
    survivals.len()
}

/// Operations of an undisturbed study.
fn operations() -> Vec<String> {
    let (_place, root) = place();
    let disk = SimulatedDisk::new(&root);
    study(&disk.shared(), &root, &mut Reported::default()).unwrap();
    disk.operations()
}

/// Runs a study with a fault at each operation; threads may join two writes into one, so the loop ends with the last
/// operation.
fn each_operation(
    nameless: bool,
    fault: Fault,
    mut each: impl FnMut(&SimulatedDisk, &Path, Reported, &str),
) -> usize {
    for number in 0.. {
        let (_place, root) = place();
        let disk = SimulatedDisk::with_fault(&root, number, fault);
        let disk = if nameless { disk.with_nameless_files() } else { disk };
        let mut reported = Reported::default();
        let ended = study(&disk.shared(), &root, &mut reported);
        let operations = disk.operations();
        let Some(operation) = operations.get(number) else {
            ended.unwrap();
            return number;
        };
        let what = format!("{fault:?} at operation {number}, {operation}");
        each(&disk, &root, reported, &what);
    }
    unreachable!()
}

/// Operations of a study at least, for any division of writes among threads: with and without nameless files.
fn operations_at_least(nameless: bool) -> usize {
    if nameless { 84 } else { 94 }
}

#[test]
fn a_study_outlives_each_failure() {
    let expected = Expected::new();
    let ways = [(false, Fault::Failure), (true, Fault::Failure), (true, Fault::Torn)];
    for (nameless, fault) in ways {
        let tried =
            each_operation(nameless, fault, |_, root, reported, what| expected.hold(root, reported, what));
        assert!(tried >= operations_at_least(nameless), "{tried} of {nameless}: {:#?}", operations());
    }
}

#[test]
fn a_study_outlives_a_kill_or_a_power_cut_after_each_operation() {
    let expected = Expected::new();
    let mut points = 0;
    for nameless in [false, true] {
        each_operation(nameless, Fault::Kill, |disk, root, reported, what| {
            points += hold_after_power_cuts(&expected, disk, &SURVIVALS, reported, what);
            expected.hold(root, reported, what);
            points += 1;
        });
    }
    println!("{points} crash points");
    assert!(
        points >= (operations_at_least(false) + operations_at_least(true)) * (SURVIVALS.len() + 1),
        "{points}: {:#?}",
        operations()
    );
}

#[test]
fn what_a_killed_process_left_in_memory_is_not_counted_on() {
    let expected = Expected::new();
    let mut points = 0;
    each_operation(true, Fault::Kill, |disk, root, _, what| {
        disk.go_on();
        let mut reported = Reported::default();
        study(&disk.shared(), root, &mut reported).unwrap_or_else(|error| panic!("{what}: {error}"));
        let survivals = [Survival::Nothing, Survival::Names, Survival::Random(4)];
        let what = format!("{what}, gone on from");
        points += hold_after_power_cuts(&expected, disk, &survivals, reported, &what);
    });
    assert!(points >= operations_at_least(true) * 3, "{points}");
}

#[test]
fn a_disk_that_does_not_keep_its_word_is_found_out() {
    let expected = Expected::new();
    let lost = |disk: &SimulatedDisk, root: &Path| {
        let mut reported = Reported::default();
        study(&disk.shared(), root, &mut reported).unwrap();
        let (_place, found) = place();
        disk.after_power_cut(Survival::Names, &found);
        expected.check(&found, reported).is_err()
    };
    for kind in ["sync", "sync folder"] {
        let (_place, root) = place();
        let disk = SimulatedDisk::deceiving(&root, kind);
        let mut reported = Reported::default();
        study(&disk.shared(), &root, &mut reported).unwrap();
        let (_found, found) = place();
        disk.after_power_cut(Survival::Nothing, &found);
        assert!(expected.check(&found, reported).is_err(), "{kind}");
    }
    // Writes of a killed process: with a reliable disk nothing is lost; with a deceiving one records are. The first
    // write of a shard is its header, the second its first records.
    for (kind, loses) in [("none", false), ("sync file", true)] {
        let (_place, root) = place();
        let disk = SimulatedDisk::deceiving(&root, kind);
        disk.kill_at_nth("write study/shards/1-of-2", 2);
        study(&disk.shared(), &root, &mut Reported::default()).unwrap_err();
        disk.go_on();
        assert_eq!(lost(&disk, &root), loses, "{kind}");
    }
}

#[test]
fn a_saved_scene_is_the_old_or_the_new_one() {
    let (old, new) = ("(version: 1, title: \"old\")", "(version: 1, title: \"a new one\")");
    let save = |disk: &SimulatedDisk, path: &Path, overwrite: bool| {
        write_new_on(disk, path, overwrite, |out| {
            new.as_bytes().chunks(8).try_for_each(|part| out.write_all(part))
        })
    };
    let mut points = 0;
    for (overwrite, nameless) in [(false, false), (false, true), (true, false), (true, true)] {
        for fault in [Fault::Failure, Fault::Torn, Fault::Kill] {
            for number in 0.. {
                let (_place, root) = place();
                let path = root.join("scene.ron");
                if overwrite {
                    fs::write(&path, old).unwrap();
                }
                let before = overwrite.then(|| old.to_owned());
                let disk = SimulatedDisk::with_fault(&root, number, fault);
                let disk = if nameless { disk.with_nameless_files() } else { disk };
                let saved = save(&disk, &path, overwrite).is_ok();
                let Some(operation) = disk.operations().get(number).cloned() else {
                    assert!(saved && number > 3, "{number}");
                    break;
                };
                let mut check = |root: &Path, how: &str| {
                    let found = fs::read_to_string(root.join("scene.ron")).ok();
                    let sound = found.as_deref() == Some(new) || (found == before && !saved);
                    assert!(sound, "{fault:?} at {operation}, {how}: saved {saved}, found {found:?}");
                    points += 1;
                };
                check(&root, "as it is");
                for survival in SURVIVALS {
                    let (_place, found) = place();
                    disk.after_power_cut(survival, &found);
                    check(&found, &format!("{survival:?} survives"));
                }
            }
        }
    }
    println!("{points} crash points");
    assert!(points >= 780, "{points}");
}
