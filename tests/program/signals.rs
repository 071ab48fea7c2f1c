//! Long computations that a signal ends: with its exit code, with a message, and without a file.

use rustix::process::{Pid, Signal, kill_process};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Longest wait for the beginning of a computation, and for its end after a signal.
const PATIENCE: Duration = Duration::from_secs(60);

/// Starts the program in a folder.
fn start(folder: &Path, arguments: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_asperity"))
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Returns true if a process has a handler for SIGINT.
fn watches_signals(child: &Child) -> bool {
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
    let caught = status
        .lines()
        .find_map(|line| line.strip_prefix("SigCgt:"))
        .unwrap();
    let caught = u64::from_str_radix(caught.trim(), 16).unwrap();
    caught & (1 << (Signal::INT.as_raw() - 1)) != 0
}

/// Sends a signal to a computation soon after it has begun, and returns what the process wrote.
fn interrupted(folder: &Path, arguments: &str, signal: Signal) -> Output {
    let mut child = start(folder, arguments);
    let clock = Instant::now();
    while !watches_signals(&child) {
        assert!(clock.elapsed() < PATIENCE, "{arguments}");
        assert!(child.try_wait().unwrap().is_none(), "{arguments}");
        sleep(Duration::from_millis(2));
    }
    sleep(Duration::from_millis(100));
    ended(child, signal)
}

/// Sends a signal to a process, and returns what the process wrote until its end.
fn ended(mut child: Child, signal: Signal) -> Output {
    kill_process(Pid::from_child(&child), signal).unwrap();
    let clock = Instant::now();
    while child.try_wait().unwrap().is_none() {
        assert!(clock.elapsed() < PATIENCE, "the process does not end");
        sleep(Duration::from_millis(2));
    }
    child.wait_with_output().unwrap()
}

/// Returns the rows of a table, without its head; no rows if there is no table.
fn rows(table: &Path) -> Vec<String> {
    let text = fs::read_to_string(table).unwrap_or_default();
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(str::to_owned).collect()
}

/// Each computation takes minutes.
#[test]
fn long_computations_end_by_signals_and_write_nothing() {
    let place = tempfile::tempdir().unwrap();
    let before = fs::read_dir(place.path()).unwrap().count();
    for arguments in [
        "find adhesion.work rough-sphere --where F_a=2uN --profiles 100000 -o found.json",
        "find preload rough-sphere --where F_a/F_a,max=0.2 --profiles 100000 -o found.csv",
        "sensitivity rough-sphere --set numerics.points=1048576 -o sensitivity.csv",
        "run rough-sphere --profiles 100000 -o profiles.csv",
        "run rough-sphere --preloads 0..20uN --profiles 10000 -o preloads.svg",
        "run rough-sphere --tolerance 1e-9 -o chosen.csv",
        "reversals rough-sphere --set numerics.points=1048576 --preloads :256 -o reversals.csv",
        "cost rough-sphere --budget 10min -o cost.csv",
        "reference rough-sphere --surfaces 1000 -o reference.json",
    ] {
        let output = interrupted(place.path(), arguments, Signal::INT);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(130), "{arguments}: {message}");
        assert!(message.contains("stopped"), "{arguments}: {message}");
        assert!(output.stdout.is_empty(), "{arguments}");
        assert_eq!(
            fs::read_dir(place.path()).unwrap().count(),
            before,
            "{arguments}"
        );
    }
    let arguments = "find adhesion.work rough-sphere --where F_a=2uN --profiles 100000";
    let output = interrupted(place.path(), arguments, Signal::TERM);
    assert_eq!(output.status.code(), Some(143));
}

/// The fit of many curves keeps its rows when a signal ends it. The same command with another
/// number of threads computes only the other rows: it does not open a curve whose row is kept. The
/// table of a curve that is missing is written again.
#[test]
fn an_interrupted_fit_of_many_curves_goes_on() {
    let place = tempfile::tempdir().unwrap();
    let curve = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples/rubber.csv");
    let folder = place.path().join("many");
    fs::create_dir(&folder).unwrap();
    for number in 0..4 {
        fs::copy(&curve, folder.join(format!("{number}.csv"))).unwrap();
    }
    let command = "fit many jkr-sphere --set form.radius=7.5u --set length=24u --set loading_stiffness=3.01 \
                   --set numerics.points=256 --free work,offset -o table.csv --curves models";
    let table = place.path().join("table.csv");
    let child = start(place.path(), &format!("{command} --jobs 1"));
    let clock = Instant::now();
    while rows(&table).is_empty() {
        assert!(clock.elapsed() < PATIENCE);
        sleep(Duration::from_millis(2));
    }
    let output = ended(child, Signal::INT);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{message}");
    let kept = rows(&table);
    assert!((1..4).contains(&kept.len()), "{kept:?}");
    let last = format!(
        "stopped: {} of 4 curves done; the same command goes on",
        kept.len()
    );
    assert_eq!(message.lines().last(), Some(&*last));
    let models = place.path().join("models");
    assert!(fs::read_dir(&models).unwrap().count() >= kept.len());

    let file_of = |row: &str| row.split(',').next().unwrap().to_owned();
    for row in &kept {
        fs::write(place.path().join(file_of(row)), "no curve").unwrap();
    }
    let output = start(place.path(), &format!("{command} --jobs 2"))
        .wait_with_output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    let all = rows(&table);
    assert_eq!(all.len(), 4);
    assert!(kept.iter().all(|row| all.contains(row)));
    assert_eq!(fs::read_dir(&models).unwrap().count(), 4);
    // All curves are equal, and so are the results and the tables.
    let result_of = |row: &String| row.split_once(',').unwrap().1.to_owned();
    assert!(all.iter().all(|row| result_of(row) == result_of(&all[0])));

    let first = models.join("3.csv");
    let written = fs::read(&first).unwrap();
    fs::copy(&curve, folder.join("3.csv")).unwrap();
    fs::remove_file(&first).unwrap();
    let again = start(place.path(), command).wait_with_output().unwrap();
    assert!(again.status.success());
    assert_eq!(fs::read(&first).unwrap(), written);

    // A file that is no table of this command stays.
    fs::write(&first, "notes").unwrap();
    let refused = start(place.path(), command).wait_with_output().unwrap();
    let message = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1));
    assert!(message.starts_with("models/3.csv: this file is no table of this command; allowed:"));
    assert_eq!(message.lines().count(), 1, "{message}");
    assert_eq!(fs::read(&first).unwrap(), b"notes");
}
