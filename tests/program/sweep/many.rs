//! Studies of many shards: few files are open at a time, and tables appear together.

use super::{SMALL, compute, plan, shard_files, study, tables, undisturbed};
use asperity::study::{Folder, RESULTS, SIDECAR, SUMMARY, Shard, Status, merge};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Divides the records of a study among this number of files, as from that many processes.
fn scatter(folder: &Folder, files: usize) {
    let file = shard_files(folder).remove(0);
    let text = fs::read_to_string(&file).unwrap();
    let (header, records) = text.split_once('\n').unwrap();
    let records: Vec<_> = records.lines().collect();
    fs::remove_file(&file).unwrap();
    for number in 0..files {
        let of_shard = header[9..]
            .replace("\"number\":1,\"count\":1", &format!("\"number\":{},\"count\":{files}", number + 1));
        let mut text = format!("{:08x},{of_shard}\n", crc32fast::hash(of_shard.as_bytes()));
        for record in records.iter().skip(number).step_by(files) {
            text += record;
            text.push('\n');
        }
        fs::write(file.with_file_name(format!("{number:06}.shard")), text).unwrap();
    }
}

fn limited(files: u32, arguments: &[&str]) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", &format!("ulimit -n {files}; exec \"$@\""), "sh", env!("CARGO_BIN_EXE_asperity")]);
    command.args(arguments);
    command
}

#[test]
fn two_thousand_shards_are_merged_with_few_open_files() {
    let plan = plan(&SMALL.replace("lines: 3", "lines: 70").replace("count: 4", "count: 5"));
    assert!(plan.records_in_all() > 2000);
    let (_place, folder) = study(&plan);
    compute(&folder, 2, Shard::WHOLE);
    merge(&folder, false).unwrap();
    let whole = tables(&folder);
    scatter(&folder, 2000);
    assert_eq!(Status::of(&folder).unwrap().shards.len(), 2000);
    let path = folder.path().to_str().unwrap();
    for limit in [256, 24] {
        for name in [RESULTS, SUMMARY, SIDECAR] {
            fs::remove_file(folder.path().join(name)).unwrap();
        }
        for arguments in [["sweep", "merge", path], ["sweep", "status", path]] {
            let output = limited(limit, &arguments).output().unwrap();
            assert!(output.status.success(), "{limit}: {}", String::from_utf8_lossy(&output.stderr));
        }
        assert_eq!(tables(&folder), whole, "{limit}");
    }
    // A file that repeats the records of all others.
    let repeated: String =
        fs::read_to_string(&shard_files(&folder)[0]).unwrap().lines().next().unwrap().into();
    let all = shard_files(&folder).iter().fold(repeated + "\n", |text, file| {
        text + fs::read_to_string(file).unwrap().split_once('\n').unwrap().1
    });
    fs::write(folder.path().join("shards/zz.shard"), all).unwrap();
    let output = limited(24, &["sweep", "merge", path]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stdout);
    let repeats = format!("{} records were computed twice", plan.records_in_all());
    assert!(message.contains(&repeats), "{message}{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(tables(&folder), whole);
}

#[test]
fn the_parts_of_a_study_are_the_whole() {
    let plan = plan(SMALL);
    let (_place, folder) = study(&plan);
    compute(&folder, 2, Shard::WHOLE);
    let expected = Status::of(&folder).unwrap();
    assert_eq!((expected.total, expected.shards.len(), expected.shards[0].total), (96, 1, 96));
    for files in [2, 5, 300] {
        scatter(&folder, files);
        let status = Status::of(&folder).unwrap();
        assert_eq!((status.done, status.total, status.missing), (96, 96, 0));
        assert_eq!(status.shards.len(), files);
        let parts = status.shards.iter().map(|shard| (shard.total, shard.done));
        assert_eq!(parts.fold((0, 0), |all, part| (all.0 + part.0, all.1 + part.1)), (96, 96), "{files}");
        let all: String = shard_files(&folder)
            .iter()
            .map(|file| fs::read_to_string(file).unwrap().split_once('\n').unwrap().1.to_owned())
            .collect();
        let header = fs::read_to_string(&shard_files(&folder)[0]).unwrap();
        let header =
            header.lines().next().unwrap()[9..].replace(&format!("\"count\":{files}"), "\"count\":1");
        shard_files(&folder).iter().for_each(|file| fs::remove_file(file).unwrap());
        let sealed = format!("{:08x},{header}\n", crc32fast::hash(header.as_bytes()));
        fs::write(folder.path().join("shards/one.shard"), sealed + &all).unwrap();
    }
}

/// The generation of the tables under their public names: the merge that made them.
fn generation(folder: &Path, names: &[(String, [String; 3])]) -> Option<String> {
    let read = [RESULTS, SUMMARY, SIDECAR].map(|name| fs::read_to_string(folder.join(name)).ok());
    let [Some(results), Some(summary), Some(sidecar)] = read else {
        assert!(read.iter().all(Option::is_none), "some tables are there, others are not");
        return None;
    };
    let found = [results, summary, sidecar];
    let known = names.iter().find(|(_, tables)| *tables == found);
    Some(known.expect("tables of one merge").0.clone())
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn killed_merges_leave_the_tables_of_one_merge() {
    // Large enough for a kill while it writes.
    let plan = plan(&SMALL.replace("lines: 3", "lines: 200").replace("count: 4", "count: 8"));
    let (_place, folder) = study(&plan);
    let path = folder.path().to_str().unwrap().to_owned();
    let all =
        || [RESULTS, SUMMARY, SIDECAR].map(|name| fs::read_to_string(folder.path().join(name)).unwrap());
    compute(&folder, 2, Shard { number: 1, count: 2 });
    let arguments = ["sweep", "merge", "--partial", path.as_str()];
    let merge_once = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
        command.args(arguments).stdout(Stdio::null()).stderr(Stdio::null());
        command
    };
    assert_eq!(generation(folder.path(), &[]), None);
    assert!(merge_once().status().unwrap().success());
    let partial = ("partial".to_owned(), all());
    compute(&folder, 2, Shard { number: 2, count: 2 });
    let clock = Instant::now();
    assert!(merge_once().status().unwrap().success());
    let long = clock.elapsed();
    let known = [partial, ("whole".to_owned(), all())];
    // Old and new alternate: each merge replaces the tables of the one before.
    let second = shard_files(&folder)
        .into_iter()
        .find(|path| path.file_name().unwrap().to_str().unwrap().starts_with("2-"))
        .unwrap();
    let aside = folder.path().join("aside");
    let (mut kills, mut seen) = (0, std::collections::BTreeSet::new());
    for round in 0..60_u32 {
        if round % 2 == 0 {
            fs::rename(&second, &aside).unwrap()
        } else {
            fs::rename(&aside, &second).unwrap()
        }
        let mut child = merge_once().spawn().unwrap();
        std::thread::sleep(
            long.mul_f64(f64::from(round % 20 + 1) / 20.0) + Duration::from_micros(u64::from(round) * 37),
        );
        child.kill().unwrap();
        kills += u32::from(!child.wait().unwrap().success());
        seen.extend(generation(folder.path(), &known));
    }
    assert!(kills >= 20 && seen.len() == 2, "{kills} {seen:?}");
    assert!(merge_once().status().unwrap().success());
    assert_eq!(generation(folder.path(), &known).as_deref(), Some("whole"));
    let remains =
        fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert_eq!(remains.filter(|name| name.starts_with(".tables-")).count(), 1);
}

#[test]
fn tables_that_are_no_links_become_links() {
    let plan = plan(SMALL);
    let whole = undisturbed(&plan);
    let (place, folder) = study(&plan);
    compute(&folder, 2, Shard::WHOLE);
    // Tables of an earlier version.
    for name in [RESULTS, SUMMARY, SIDECAR] {
        fs::write(folder.path().join(name), "old").unwrap();
    }
    merge(&folder, false).unwrap();
    assert_eq!(tables(&folder), whole);
    // A copy by a program that follows links.
    let copy = place.path().join("copy");
    let copied = Command::new("cp").arg("-rL").arg(folder.path()).arg(&copy).status().unwrap();
    assert!(copied.success());
    let copy = Folder::open(&copy).unwrap();
    assert_eq!(tables(&copy), whole);
    for _ in 0..2 {
        merge(&copy, false).unwrap();
        assert_eq!(tables(&copy), whole);
    }
    for folder in [&folder, &copy] {
        assert_eq!(fs::read_link(folder.path().join(RESULTS)).unwrap(), Path::new("tables/results.csv"));
    }
    // An obstacle in place of a table is not removed.
    fs::remove_file(copy.path().join(RESULTS)).unwrap();
    fs::create_dir(copy.path().join(RESULTS)).unwrap();
    let message = merge(&copy, false).unwrap_err().to_string();
    assert!(message.contains("results.csv is in the way"), "{message}");
}
