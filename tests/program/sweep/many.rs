//! Studies of many shards: few files are open at a time, and tables appear together.

use super::{SMALL, compute, plan, shard_files, study, tables};
use asperity::study::{Finished, Folder, RESULTS, SIDECAR, SUMMARY, Shard, Status, merge};
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

/// Checks that each table is whole, of one of these merges, and returns true if all are of one merge; others are refused.
fn are_of_one_merge(folder: &Path, known: &[[String; 3]; 2]) -> bool {
    let found = [RESULTS, SUMMARY, SIDECAR].map(|name| fs::read_to_string(folder.join(name)).unwrap());
    for (place, table) in found.iter().enumerate() {
        assert!(known.iter().any(|tables| tables[place] == *table), "torn: {table}");
    }
    let refusal = Finished::open(folder).err().map(|error| error.to_string());
    let of_one = |tables: &[String; 3]| tables[1..] == found[1..];
    assert_eq!(refusal.is_none(), known.iter().any(of_one), "{refusal:?}");
    assert!(refusal.is_none_or(|refusal| refusal.contains("are not of one merge")));
    known.contains(&found)
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn killed_merges_leave_whole_tables() {
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
    assert!(merge_once().status().unwrap().success());
    let partial = all();
    compute(&folder, 2, Shard { number: 2, count: 2 });
    let clock = Instant::now();
    assert!(merge_once().status().unwrap().success());
    let long = clock.elapsed();
    let known = [partial, all()];
    // Old and new alternate: each merge replaces the tables of the one before.
    let second = shard_files(&folder)
        .into_iter()
        .find(|path| path.file_name().unwrap().to_str().unwrap().starts_with("2-"))
        .unwrap();
    let aside = folder.path().join("aside");
    let mut kills = 0;
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
        are_of_one_merge(folder.path(), &known);
    }
    assert!(kills >= 20, "{kills}");
    assert!(merge_once().status().unwrap().success());
    assert!(are_of_one_merge(folder.path(), &known));
}

#[test]
fn tables_of_two_merges_are_refused() {
    let (place, folder) = study(&plan(SMALL));
    compute(&folder, 2, Shard::WHOLE);
    let refusal = || Finished::open(folder.path()).unwrap_err().to_string();
    assert!(refusal().contains("has not been merged yet"), "{}", refusal());
    merge(&folder, false).unwrap();
    let summary = folder.path().join(SUMMARY);
    let text = fs::read_to_string(&summary).unwrap();
    fs::write(&summary, text.lines().take(2).collect::<Vec<_>>().join("\n") + "\n").unwrap();
    assert!(refusal().contains("summary.csv and results.json are not of one merge"), "{}", refusal());
    merge(&folder, false).unwrap();
    assert!(Finished::open(folder.path()).is_ok());
    // A folder in place of a table is not removed.
    fs::remove_file(folder.path().join(RESULTS)).unwrap();
    fs::create_dir(folder.path().join(RESULTS)).unwrap();
    let message = merge(&folder, false).unwrap_err().to_string();
    assert!(message.contains("results.csv: this is not the name of a file"), "{message}");
    drop(place);
}
