//! Anything but a regular file is neither read nor written, and no step waits for it.

use crate::common::terminal::Terminal;
use crate::driving::{ESCAPE, SCENE, answer, explorer, paused, quit};
use rustix::fs::{CWD, FileType, Mode, mknodat};
use std::fs;
use std::path::Path;

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

#[test]
fn a_pipe_or_a_device_is_neither_opened_nor_written() {
    let (program, folder) = explorer();
    make_pipe(&folder.path().join("pipe.ron"));
    let roughness = "SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (8, 256), seed: 1)";
    let piped = SCENE.replace(roughness, "Measured(file: \"pipe.ron\")");
    fs::write(folder.path().join("piped.ron"), piped).unwrap();
    let mut terminal = paused(program);
    for path in ["./pipe.ron", "/dev/tty", "/dev/zero"] {
        open(&mut terminal, path);
        terminal.wait_for("! this is not a regular file");
        terminal.send(ESCAPE);
        terminal.wait_without("this is not");
    }
    // A regular file to the system; its permissions and content differ between machines.
    open(&mut terminal, "/proc/kmsg");
    terminal.wait_for(": /proc/kmsg");
    terminal.send(ESCAPE);
    terminal.wait_without("kmsg");
    for path in ["pipe.ron", "/dev/tty"] {
        terminal.send("s");
        answer(&mut terminal, "Save as: ", path);
        terminal.wait_for("! this is not a regular file");
        terminal.send(ESCAPE);
        terminal.wait_without("this is not");
    }
    // The file of a surface stops no computation.
    open(&mut terminal, "./piped.ron");
    terminal.wait_for("not a regular file");
    quit(&mut terminal);
}
