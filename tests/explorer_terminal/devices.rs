//! Anything but a regular file is neither read nor written, and no step waits for it.

use crate::common::deadline::within;
use crate::common::terminal::Terminal;
use crate::driving::{CLEAR_LINE, ESCAPE, SCENE, answer, explorer, paused, quit};
use rustix::fs::{CWD, FileType, Mode, mknodat};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Makes a named pipe without reader or writer.
fn make_pipe(path: &Path) {
    mknodat(CWD, path, FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
}

/// Opens the typed path in the library.
#[track_caller]
fn open(terminal: &mut Terminal, path: &str) {
    terminal.send("o");
    answer(terminal, "Search: ", path);
}

/// Asserts that keys are answered soon.
#[track_caller]
fn assert_answers(terminal: &mut Terminal) {
    let asked = Instant::now();
    terminal.send("?");
    terminal.wait_for("What you see");
    terminal.send("?");
    terminal.wait_without("What you see");
    assert!(asked.elapsed() < Duration::from_secs(5), "{:?}", asked.elapsed());
}

#[test]
fn a_pipe_or_a_device_is_not_opened_as_a_scene() {
    within(60, || {
        let (program, folder) = explorer();
        make_pipe(&folder.path().join("pipe.ron"));
        let mut terminal = paused(program);
        for path in ["./pipe.ron", "/dev/tty", "/dev/zero"] {
            open(&mut terminal, path);
            terminal.wait_for("! this is not a regular file");
            terminal.send(ESCAPE);
            terminal.wait_without("this is not");
            assert_answers(&mut terminal);
        }
        // A regular file to the system; its permissions and content differ between machines.
        open(&mut terminal, "/proc/kmsg");
        terminal.wait_for(": /proc/kmsg");
        terminal.send(ESCAPE);
        terminal.wait_without("kmsg");
        assert_answers(&mut terminal);
        // The list shows the file with its error.
        terminal.send("o");
        terminal.send("pipe");
        terminal.wait_for("! pipe.ron  here");
        terminal.wait_for("not a regular file");
        terminal.send(ESCAPE);
        terminal.wait_without("Search:");
        quit(&mut terminal);
    });
}

#[test]
fn a_scene_is_not_saved_to_a_pipe_or_a_device() {
    within(60, || {
        let (program, folder) = explorer();
        make_pipe(&folder.path().join("pipe.ron"));
        make_pipe(&folder.path().join("pipe"));
        std::os::unix::fs::symlink("/dev/tty", folder.path().join("tty.ron")).unwrap();
        let before = fs::read_dir(folder.path()).unwrap().count();
        let mut terminal = paused(program);
        for (path, why) in [
            ("pipe.ron", "this is not a regular file"),
            ("tty.ron", "this is not a regular file"),
            // An extension is added only to the name of a file.
            ("pipe", "this is not a regular file; allowed: the name of a file"),
            ("/dev/tty", "this is not a regular file; allowed: the name of a file"),
            ("/dev/", "this is not the name of a file"),
            ("/dev", "this is not the name of a file"),
        ] {
            terminal.send("s");
            terminal.wait_for("Save as: ");
            terminal.send(CLEAR_LINE);
            answer(&mut terminal, "Save as: ", path);
            terminal.wait_for(&format!("! {why}"));
            terminal.wait_for(&format!(": {path}"));
            terminal.send(ESCAPE);
            terminal.wait_without("this is not");
            assert_answers(&mut terminal);
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), before, "nothing is written");
        quit(&mut terminal);
    });
}

#[test]
fn a_measured_file_that_is_a_pipe_stops_no_computation() {
    within(60, || {
        let (program, folder) = explorer();
        make_pipe(&folder.path().join("pipe"));
        let roughness = "SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (8, 256), seed: 1)";
        assert!(SCENE.contains(roughness));
        for (name, file) in [("piped.ron", "pipe"), ("endless.ron", "/dev/zero")] {
            let scene = SCENE.replace(roughness, &format!("Measured(file: \"{file}\")"));
            fs::write(folder.path().join(name), scene).unwrap();
        }
        let mut terminal = paused(program);
        // On opening, this is an error of the scene.
        open(&mut terminal, "./piped.ron");
        terminal.wait_for("not a regular file");
        assert_answers(&mut terminal);
        quit(&mut terminal);
    });
}
