//! Studies of many shards: few files are open at a time, and each table is whole.

use super::{SMALL, compute, computed, plan, shard_files, study, tables};
use asperity::study::folders::{Merged, Status};
use asperity::study::{Folder, Results, Shard, merge};
use std::fs;
use std::process::Command;

/// Divides the records of a study among this number of files, as from that many processes.
fn scatter(folder: &Folder, files: usize) {
    let file = shard_files(folder).remove(0);
    let text = fs::read_to_string(&file).unwrap();
    let (header, records) = text.split_once('\n').unwrap();
    let records: Vec<_> = records.lines().collect();
    fs::remove_file(&file).unwrap();
    for number in 0..files {
        let of_shard = header[9..].replace(
            "\"number\":1,\"count\":1",
            &format!("\"number\":{},\"count\":{files}", number + 1),
        );
        let mut text = format!("{:08x},{of_shard}\n", crc32fast::hash(of_shard.as_bytes()));
        for record in records.iter().skip(number).step_by(files) {
            text += record;
            text.push('\n');
        }
        fs::write(file.with_file_name(format!("{number:06}.shard")), text).unwrap();
    }
}

/// The program with at most 24 open files.
fn limited(arguments: &[&str]) -> Command {
    let mut command = Command::new("sh");
    command.args([
        "-c",
        "ulimit -n 24; exec \"$@\"",
        "sh",
        env!("CARGO_BIN_EXE_asperity"),
    ]);
    command.args(arguments);
    command
}

#[test]
fn two_thousand_shards_are_merged_with_few_open_files() {
    let plan = plan(
        &SMALL
            .replace("profiles: 3", "profiles: 70")
            .replace("count: 4", "count: 5"),
    );
    assert!(plan.records_in_all() > 2000);
    let (_place, folder) = computed(&plan);
    let whole = tables(&folder);
    scatter(&folder, 2000);
    assert_eq!(Status::of(&folder).unwrap().shards.len(), 2000);
    let path = folder.path().to_str().unwrap();
    for name in [Merged::RESULTS, Merged::SUMMARY, Merged::SIDECAR] {
        fs::remove_file(folder.path().join(name)).unwrap();
    }
    for arguments in [["sweep", "merge", path], ["sweep", "status", path]] {
        let output = limited(&arguments).output().unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    assert_eq!(tables(&folder), whole);
    // A file that repeats the records of all others.
    let repeated: String = fs::read_to_string(&shard_files(&folder)[0])
        .unwrap()
        .lines()
        .next()
        .unwrap()
        .into();
    let all = shard_files(&folder)
        .iter()
        .fold(repeated + "\n", |text, file| {
            text + fs::read_to_string(file)
                .unwrap()
                .split_once('\n')
                .unwrap()
                .1
        });
    fs::write(folder.path().join("shards/zz.shard"), all).unwrap();
    let output = limited(&["sweep", "merge", path]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stdout);
    let repeats = format!("{} records were computed twice", plan.records_in_all());
    assert!(
        message.contains(&repeats),
        "{message}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(tables(&folder), whole);
}

#[test]
fn rows_that_no_merge_wrote_are_refused() {
    let (_place, folder) = study(&plan(SMALL));
    compute(&folder, 2, Shard::WHOLE);
    let refusal = || Results::open(folder.path()).unwrap_err().to_string();
    assert!(
        refusal().contains("has not been merged yet"),
        "{}",
        refusal()
    );
    merge(&folder).unwrap();
    let [text, _] = tables(&folder);
    let results = folder.path().join(Merged::RESULTS);
    for (changed, expected) in [
        (
            text.replacen("\n0,0.5,", "\n0,0.6,", 1),
            "line 2 is not a row of this study",
        ),
        (
            text.replacen("\n0,", "\n99,", 1),
            "line 2 is not a row of this study",
        ),
        (
            text.replacen(",patches", ",skewness_again", 1),
            "its columns are not those of the plan",
        ),
        (
            text[..text.len() - 9].to_owned(),
            "line 97 is not a row of this study",
        ),
        (text.replacen("e-", "e-1", 1), "asperity sweep merge"),
        (
            text.trim_end().rsplit_once('\n').unwrap().0.to_owned() + "\n",
            "asperity sweep merge",
        ),
        (
            text.clone() + text.lines().last().unwrap() + "\n",
            "asperity sweep merge",
        ),
    ] {
        assert_ne!(changed, text);
        fs::write(&results, changed).unwrap();
        assert!(refusal().contains(expected), "{expected}: {}", refusal());
    }
    fs::write(&results, &text).unwrap();
    fs::rename(
        folder.path().join(Merged::SIDECAR),
        folder.path().join("aside"),
    )
    .unwrap();
    assert!(refusal().contains("missing or damaged"), "{}", refusal());
    fs::rename(
        folder.path().join("aside"),
        folder.path().join(Merged::SIDECAR),
    )
    .unwrap();
    assert!(Results::open(folder.path()).is_ok());
    // A folder in place of a table is not removed.
    fs::remove_file(&results).unwrap();
    fs::create_dir(&results).unwrap();
    let message = merge(&folder).unwrap_err().to_string();
    assert!(
        message.contains("results.csv: this is not the name of a file"),
        "{message}"
    );
}
