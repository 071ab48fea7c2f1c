//! Foreign content in the folder of a study, or in its name: nothing hangs, panics, or reaches a
//! terminal except as text.

use super::{SMALL, compute, computed, plan, shard_files, study, tables};
use asperity::study::folders::Status;
use asperity::study::{Folder, Shard, merge};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// Runs the program, and fails if it does not end.
fn asperity(arguments: &[&str]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_asperity"))
        .args(arguments)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let clock = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if clock.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
            panic!("{arguments:?} hangs");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    child.wait_with_output().unwrap()
}

fn fifo(path: &Path) {
    use rustix::fs::{CWD, FileType, Mode, mknodat};
    mknodat(CWD, path, FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
}

/// A line with its checksum.
fn sealed(payload: &str) -> String {
    format!("{:08x},{payload}\n", crc32fast::hash(payload.as_bytes()))
}

/// The payload of the header of a shard file.
fn header_of(folder: &Folder) -> String {
    let text = fs::read_to_string(&shard_files(folder)[0]).unwrap();
    text.lines().next().unwrap()[9..].to_owned()
}

/// Characters that act on a terminal.
fn acts(c: char) -> bool {
    c != '\n'
        && (c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{61c}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{2028}' | '\u{2029}'))
}

#[test]
fn a_header_that_no_program_wrote_is_an_error() {
    let (_place, folder) = study(&plan(SMALL));
    compute(
        &folder,
        1,
        Shard {
            number: 1,
            count: 2,
        },
    );
    let header = header_of(&folder);
    let stray = folder.path().join("shards/stray.shard");
    for (from, to, expected) in [
        (
            "\"count\":2",
            "\"count\":0",
            "shard 1/0: allowed: K/N with K from 1 to N",
        ),
        ("\"number\":1", "\"number\":3", "shard 3/2: allowed: K/N"),
        ("\"number\":1", "\"number\":0", "shard 0/2: allowed: K/N"),
        (
            "\"format\":1",
            "\"format\":2",
            "its format is 2; this program reads 1",
        ),
        (
            "\"format\":1,",
            "",
            "its first line is not the header of a shard file",
        ),
    ] {
        let other = header.replace(from, to);
        assert_ne!(other, header);
        fs::write(&stray, sealed(&other)).unwrap();
        for message in [
            Status::of(&folder).unwrap_err().to_string(),
            merge(&folder).unwrap_err().to_string(),
        ] {
            assert!(
                message.contains("stray.shard: ") && message.contains(expected),
                "{message}"
            );
        }
    }
}

#[test]
fn records_that_do_not_belong_to_the_plan_are_left_out_and_computed_again() {
    let plan = plan(SMALL);
    let (_place, folder) = computed(&plan);
    let whole = tables(&folder);
    let file = &shard_files(&folder)[0];
    let text = fs::read_to_string(file).unwrap();
    let payload = text.lines().nth(1).unwrap()[9..].to_owned();
    let (short, _) = payload.rsplit_once(',').unwrap();
    let word = format!("{short},x");
    let values = payload.splitn(3, ',').nth(2).unwrap();
    let [no_cell, no_seed] = [
        format!("{},{},{values}", plan.cells(), plan.seed),
        format!("0,7,{values}"),
    ];
    for other in [
        short.to_owned(),
        format!("{payload},1.0"),
        word,
        "0,0".into(),
        String::new(),
        no_cell,
        no_seed,
    ] {
        let changed = text.replacen(&sealed(&payload), &sealed(&other), 1);
        assert_ne!(changed, text);
        fs::write(file, changed).unwrap();
        let status = Status::of(&folder).unwrap();
        assert_eq!((status.missing, status.damaged), (1, 1), "{other}");
        compute(&folder, 1, Shard::WHOLE);
        let merged = merge(&folder).unwrap();
        assert_eq!((merged.records, merged.damaged), (96, 1), "{other}");
        assert_eq!(tables(&folder), whole, "{other}");
        for file in &shard_files(&folder)[..] {
            fs::remove_file(file).unwrap();
        }
        fs::write(file, &text).unwrap();
    }
}

#[test]
fn pipes_and_devices_are_refused_at_once() {
    let plan = plan(SMALL);
    let (_place, folder) = computed(&plan);
    let path = folder.path().to_str().unwrap();
    let refused = |arguments: &[&str], expected: &str| {
        let output = asperity(arguments);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {message}");
        assert!(message.contains(expected), "{arguments:?}: {message}");
    };
    let pipe = folder.path().join("shards/pipe.shard");
    for make in [
        |path: &Path| fifo(path),
        |path: &Path| symlink("/dev/zero", path).unwrap(),
    ] {
        make(&pipe);
        refused(
            &["sweep", "status", path],
            "pipe.shard: this is not a regular file",
        );
        refused(
            &["sweep", "merge", path],
            "pipe.shard: this is not a regular file",
        );
        fs::remove_file(&pipe).unwrap();
    }
    for name in ["summary.csv", "results.csv"] {
        let table = folder.path().join(name);
        for make in [
            |path: &Path| fifo(path),
            |path: &Path| symlink("/dev/zero", path).unwrap(),
        ] {
            fs::remove_file(&table).unwrap();
            make(&table);
            let expected = format!("{name}: this is not a regular file");
            if name == "results.csv" {
                refused(&["sweep", "plot", path], &expected);
            }
            refused(&["sweep", "merge", path], &expected);
        }
        fs::remove_file(&table).unwrap();
        merge(&folder).unwrap();
    }
    // A line without an end.
    let table = fs::canonicalize(folder.path().join("results.csv")).unwrap();
    fs::OpenOptions::new()
        .write(true)
        .open(table)
        .unwrap()
        .set_len(1 << 40)
        .unwrap();
    refused(&["sweep", "plot", path], "is not a row of this study");
}

#[test]
fn nothing_that_is_named_acts_on_a_terminal() {
    const EVIL: &str = "e\u{1b}]52;c;eA==\u{7}\u{9b}2J\u{202e}\u{2066}\u{200f}\u{2028}\r";
    let place = tempfile::tempdir().unwrap();
    let root = place.path();
    let at = |name: &str| root.join(name).to_str().unwrap().to_owned();
    let evil = at(EVIL);
    let plan_file = at(&format!("{EVIL}.ron"));
    fs::write(&plan_file, SMALL).unwrap();
    let wrong = at(&format!("{EVIL}wrong.ron"));
    fs::write(
        &wrong,
        SMALL.replace("\"adhesion.kappa\"", "\"ka\\u{1b}[2Jppa\\u{202e}\""),
    )
    .unwrap();
    let other = at("other.ron");
    fs::write(&other, SMALL.replace("Small", "Sm\u{1b}all")).unwrap();
    let mut outputs = Vec::new();
    let mut run = |arguments: &[&str]| {
        let output = asperity(arguments);
        let shown = [output.stdout, output.stderr]
            .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
            .concat();
        assert!(!shown.contains(acts), "{arguments:?}: {shown:?}");
        assert!(!shown.is_empty(), "{arguments:?}");
        outputs.push(shown);
    };
    let (new, none, map) = (
        at("new"),
        at(&format!("{EVIL}.none")),
        at(&format!("{EVIL}/map.svg")),
    );
    let (title, nowhere) = (format!("title=\"{EVIL}\""), format!("{evil}/none/x"));
    for arguments in [
        &["sweep", "merge", &evil][..],
        &["sweep", &plan_file, "-o", &evil, "--shard", "1/2"],
        &["sweep", "plot", &evil],
        &["sweep", &plan_file, "-o", &evil],
        &["sweep", "plot", &evil],
        &["sweep", "plot", &evil, "--at", EVIL],
        &["sweep", "plot", &evil, "--x", EVIL],
        &[
            "sweep",
            "plot",
            &evil,
            "--at",
            "preload=0.01",
            "--quantity",
            "regime",
            "-o",
            &map,
        ],
        &["sweep", &wrong, "-o", &new],
        &["sweep", &other, "-o", &new],
        &[
            "sweep", "submit", &plan_file, "-o", &new, "--jobs", "2", "--check", "--", EVIL,
        ],
        &["run", &evil],
        &["run", &none],
        &["run", "jkr-sphere", "--set", &title],
        &["run", "jkr-sphere", "-o", &nowhere],
        &["presets", "check", &wrong, &evil],
        &["presets", "show", EVIL],
        &["check", EVIL],
        &[EVIL],
        &["sweep", "plans", EVIL, EVIL],
    ] {
        run(arguments);
    }
    // A header that claims another origin, and a different plan.
    let folder = Folder::open(Path::new(&evil)).unwrap();
    let payload = header_of(&folder);
    let start = payload.find("\"host\":\"").unwrap() + 8;
    let end = start + payload[start..].find('"').unwrap();
    let stray = format!(
        "{}\\u001b]52;c;eA==\\u0007\u{9b}\u{202e}{}",
        &payload[..start],
        &payload[end..]
    );
    let file = format!("{EVIL}.shard");
    fs::write(folder.path().join("shards").join(&file), sealed(&stray)).unwrap();
    run(&["sweep", "status", &evil]);
    run(&["sweep", "status", &evil, "--format", "json"]);
    fs::write(
        folder.path().join("shards").join(&file),
        sealed(&stray.replace("\"format\":1", "\"format\":9")),
    )
    .unwrap();
    run(&["sweep", "status", &evil]);
    let text = fs::read_to_string(folder.path().join("plan.ron")).unwrap();
    fs::write(
        folder.path().join("plan.ron"),
        text.replace("Small", "Sm\u{1b}[2J\u{202e}all"),
    )
    .unwrap();
    run(&["sweep", &plan_file, "-o", &evil]);
    run(&["sweep", "status", &evil]);
    assert!(
        outputs
            .iter()
            .any(|shown| shown.contains("\\u{1b}]52;c;eA==\\u{7}\\u{9b}2J\\u{202e}"))
    );
}
