//! Processes that are killed, stopped, or out of disk space: no record is lost or counted twice.

use super::{cases, plan, tables, undisturbed};
use asperity::study::Folder;
use asperity::study::folders::Status;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Long enough for a kill in the middle.
fn text() -> String {
    super::SMALL
        .replace("count: 4", "count: 6")
        .replace("profiles: 3", "profiles: 6")
        .replace("points: 256", "points: 2048")
        .replace("modes: (1, 64)", "modes: (1, 512)")
}

fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command
        .arg("sweep")
        .arg(folder.join("plan-of-test.ron"))
        .arg("-o")
        .arg(folder.join("study"));
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn place() -> tempfile::TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("plan-of-test.ron"), text()).unwrap();
    place
}

fn done(place: &Path) -> u64 {
    Folder::open(&place.join("study")).map_or(0, |folder| Status::of(&folder).unwrap().done)
}

/// Waits until a study has this number of records, or its process has ended.
fn wait_for(child: &mut Child, place: &Path, records: u64) {
    let clock = Instant::now();
    while done(place) < records && child.try_wait().unwrap().is_none() {
        assert!(clock.elapsed() < Duration::from_secs(120));
        sleep(Duration::from_millis(2));
    }
}

fn check_whole(place: &Path) {
    let folder = Folder::open(&place.join("study")).unwrap();
    assert_eq!(tables(&folder), undisturbed(&plan(&text())));
}

#[test]
fn killed_at_random_moments_it_goes_on() {
    // Kills that must hit a running process.
    let most = cases(6);
    let expected = undisturbed(&plan(&text()));
    // Time of an undisturbed process.
    let calm = place();
    let clock = Instant::now();
    assert!(command(calm.path()).output().unwrap().status.success());
    let whole = clock.elapsed();
    let mut random = ChaCha8Rng::seed_from_u64(rand::random());
    let (mut kills, mut after_records) = (0, 0);
    while kills < most {
        // A study is killed and continued until it is whole; then another one begins.
        let place = place();
        let mut there = 0;
        loop {
            let mut child = command(place.path()).spawn().unwrap();
            if kills == most {
                let output = child.wait_with_output().unwrap();
                assert!(
                    output.status.success(),
                    "{}",
                    String::from_utf8_lossy(&output.stderr)
                );
                break;
            }
            sleep(whole.mul_f64(random.random_range(0.0..0.5)));
            child.kill().unwrap();
            let status = child.wait().unwrap();
            if status.success() {
                break;
            }
            assert_eq!(status.signal(), Some(9), "{status}");
            kills += 1;
            // Earlier records are still there.
            let now = done(place.path());
            assert!(now >= there, "{now} {there}");
            after_records += u32::from(now > there);
            there = now;
        }
        let folder = Folder::open(&place.path().join("study")).unwrap();
        assert_eq!(tables(&folder), expected);
    }
    // Some hit before the first record, most between records.
    assert!(after_records >= most / 4, "{after_records} of {kills}");
}

#[test]
fn asked_to_stop_it_ends_cleanly() {
    for (signal, code) in [
        (rustix::process::Signal::INT, 130),
        (rustix::process::Signal::TERM, 143),
    ] {
        let place = place();
        let mut child = command(place.path()).spawn().unwrap();
        wait_for(&mut child, place.path(), 20);
        rustix::process::kill_process(rustix::process::Pid::from_child(&child), signal).unwrap();
        let output = child.wait_with_output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{message}");
        assert!(
            message.contains("records are complete; the same command continues the study"),
            "{message}"
        );
        let folder = Folder::open(&place.path().join("study")).unwrap();
        assert_eq!(Status::of(&folder).unwrap().damaged, 0);
        assert!(command(place.path()).output().unwrap().status.success());
        check_whole(place.path());
    }
}

#[test]
fn two_processes_may_be_given_the_same_shard() {
    let place = place();
    let shard = |name: &str| {
        let mut command = command(place.path());
        command.args(["--shard", name]);
        command.spawn().unwrap()
    };
    let children: Vec<_> = ["1/2", "2/2", "1/2"].into_iter().map(shard).collect();
    for child in children {
        let output = child.wait_with_output().unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    let study = place.path().join("study");
    let merge = Command::new(env!("CARGO_BIN_EXE_asperity"))
        .args(["sweep", "merge"])
        .arg(&study)
        .output()
        .unwrap();
    assert!(
        merge.status.success(),
        "{}",
        String::from_utf8_lossy(&merge.stderr)
    );
    let shards = Status::of(&Folder::open(&study).unwrap()).unwrap().shards;
    assert_eq!(
        shards
            .iter()
            .map(|shard| shard.shard.as_str())
            .collect::<Vec<_>>(),
        ["1/2", "2/2"]
    );
    check_whole(place.path());
}

#[test]
fn a_full_disk_is_stated_and_loses_nothing() {
    let place = place();
    // A file may not grow beyond 16 blocks of 512 bytes; its signal is ignored, so that writes fail
    // as on a full disk.
    let inner = command(place.path());
    let mut words = vec![inner.get_program().to_owned()];
    words.extend(inner.get_args().map(std::ffi::OsStr::to_owned));
    let mut limited = Command::new("sh");
    limited
        .arg("-c")
        .arg("trap '' XFSZ; ulimit -f 16; exec \"$@\"")
        .arg("sh")
        .args(words);
    let output = limited.output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(
        message.contains(".shard: cannot be written: File too large"),
        "{message}"
    );
    let there = done(place.path());
    assert!(
        there > 10 && there < plan(&text()).records_in_all(),
        "{there}"
    );
    let folder = Folder::open(&place.path().join("study")).unwrap();
    assert!(Status::of(&folder).unwrap().damaged <= 1);
    assert!(command(place.path()).output().unwrap().status.success());
    check_whole(place.path());
}

#[test]
fn too_little_memory_is_refused() {
    let place = place();
    let words = [
        "sweep",
        "plan-of-test.ron",
        "-o",
        "study",
        "--jobs",
        "1024",
        "--set",
        "numerics.points=1048576",
    ];
    let mut limited = Command::new("sh");
    limited
        .args([
            "-c",
            "ulimit -v 4000000; exec \"$@\"",
            "sh",
            env!("CARGO_BIN_EXE_asperity"),
        ])
        .args(words);
    let output = limited.current_dir(place.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(
        message.contains("not enough memory: on 1024 threads the study takes up to"),
        "{message}"
    );
    assert!(!place.path().join("study").exists());
}
