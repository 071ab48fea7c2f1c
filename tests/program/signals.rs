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
    kill_process(Pid::from_child(&child), signal).unwrap();
    let clock = Instant::now();
    while child.try_wait().unwrap().is_none() {
        assert!(clock.elapsed() < PATIENCE, "{arguments} does not end");
        sleep(Duration::from_millis(2));
    }
    child.wait_with_output().unwrap()
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
        "reference rough-sphere --maps 1000 -o reference.json",
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
