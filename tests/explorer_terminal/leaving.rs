//! Leaving the explorer, and the remains on the terminal.

use crate::common::terminal::{Program, Terminal};
use crate::driving::{
    ASPERITY, CLEAR_LINE, ENTER_ALTERNATE_SCREEN, ESCAPE, INTERRUPT, LEAVE_ALTERNATE_SCREEN,
    assert_given_back, explorer, headline, last_place, paused, quit, select, wait_for_another,
};
use asperity::data::{format_rounded, parse_quantity};
use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn a_terminal_that_goes_away_ends_the_explorer_even_if_hang_ups_are_ignored() {
    // Paused, and while the animation plays.
    for (trap, key) in [("", ""), ("", "."), ("trap '' HUP;", ".")] {
        let (_, folder) = explorer();
        let mut terminal = Program::new("/bin/sh")
            .argument("-c")
            .argument(format!("{trap} exec '{ASPERITY}' scene.ron"))
            .folder(folder.path())
            .start();
        terminal.wait_for("F_a ");
        terminal.send(key);
        terminal.hang_up();
        terminal.wait_end();
    }
}

fn signal(terminal: &Terminal, name: &str) {
    let kill = Command::new("/bin/sh")
        .arg("-c")
        .arg(format!("kill -{name} {}", terminal.pid()))
        .status();
    assert!(kill.unwrap().success());
}

#[test]
fn whatever_signal_ends_it_the_terminal_is_given_back() {
    for name in ["TERM", "INT", "HUP", "QUIT"] {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        signal(&terminal, name);
        assert!(
            !terminal.wait_end().success(),
            "{name}: it is seen that a signal ended it"
        );
        assert_given_back(&terminal);
    }
}

#[test]
fn a_terminal_that_reads_nothing_keeps_no_signal_from_ending_it() {
    let ends = |name| {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        terminal.rest(true);
        // Each size is a whole frame; some frames exceed the buffer of a terminal.
        for columns in (100..140).step_by(4) {
            terminal.resize(columns, 40);
            std::thread::sleep(std::time::Duration::from_millis(50));
        }
        assert!(
            is_waiting_to_write(terminal.pid()),
            "the explorer waits for the terminal"
        );
        signal(&terminal, name);
        assert!(!terminal.wait_process().success(), "{name}");
        // Line by line and with echo already, while output still waits.
        assert!(terminal.is_as_before(), "{name}");
        // Nothing leaves the alternate screen of a terminal that reads nothing.
        terminal.rest(false);
        terminal.wait_end();
    };
    std::thread::scope(|scope| {
        for name in ["TERM", "INT", "HUP", "QUIT"] {
            scope.spawn(move || ends(name));
        }
    });
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn with_whatever_memory_there_is_the_terminal_is_given_back() {
    let (_, folder) = explorer();
    let mut computed = 0;
    // Up to more than the memory of the scene and the reservations of its threads.
    for mebibytes in [40, 70, 100, 130, 160, 190, 220, 250, 280, 310, 400, 2000] {
        let limited = format!(
            "ulimit -v {}; exec '{ASPERITY}' million-springs",
            mebibytes << 10
        );
        let mut terminal = Program::new("/bin/sh")
            .argument("-c")
            .argument(limited)
            .folder(folder.path())
            .start();
        // Without an animation, which would go on for twelve seconds.
        terminal.send_if_open(".");
        terminal.settle_for(std::time::Duration::from_millis(1500));
        computed += u32::from(terminal.text().contains("F_a "));
        terminal.send_if_open("q");
        if terminal.wait_end().signal().is_some() {
            // Without memory for a small allocation the system ends the process, which restores
            // nothing.
            continue;
        }
        assert!(terminal.is_as_before(), "{mebibytes} MiB");
        if last_place(terminal.written(), ENTER_ALTERNATE_SCREEN).is_some() {
            assert_given_back(&terminal);
        }
    }
    assert!(computed > 0, "with enough of it the scene is computed");
}

/// True if the main thread of a process sleeps in a call that writes.
fn is_waiting_to_write(pid: u32) -> bool {
    let call = fs::read_to_string(format!("/proc/{pid}/syscall")).unwrap();
    // Numbers of `write` on 64-bit x86 and ARM; the first argument is standard output.
    let words: Vec<&str> = call.split_whitespace().collect();
    matches!(words[..], ["1" | "64", "0x1", ..])
}

/// The text below the last switch back to the terminal's own screen.
fn left_behind(terminal: &Terminal) -> String {
    let bytes = terminal.written();
    let place = last_place(bytes, LEAVE_ALTERNATE_SCREEN).expect("the alternate screen is left");
    String::from_utf8_lossy(&bytes[place + LEAVE_ALTERNATE_SCREEN.len()..]).replace("\r\n", "\n")
}

/// Asserts that each row below the title of a scene is the beginning of a row of the summary of
/// `asperity run`, where the pull-off force has its error.
fn assert_rows_of(left: &str, summary: &str) {
    let place = left
        .find("Rough line")
        .unwrap_or_else(|| panic!("the title is missing: {left}"));
    let rows: Vec<&str> = left[place..].lines().map(str::trim_end).collect();
    assert!((4..=10).contains(&rows.len()), "{left}");
    for row in rows {
        assert!(
            summary.lines().any(|line| line.starts_with(row)),
            "{row}\n{summary}"
        );
    }
}

/// Summary of `asperity run`.
fn summary(folder: &Path, arguments: &[&str]) -> String {
    let mut command = Command::new(ASPERITY);
    let output = command
        .current_dir(folder)
        .arg("run")
        .arg("scene.ron")
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success());
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_changed_scene_asks_before_it_is_left_and_its_summary_stays_to_be_read() {
    let (program, folder) = explorer();
    let mut terminal = paused(program);
    select(&mut terminal, "κ");
    let before = headline(&terminal.rows()).unwrap();
    terminal.send("\r");
    terminal.wait_for("Esc cancel");
    terminal.send(CLEAR_LINE);
    terminal.send("5\r");
    let force = wait_for_another(&mut terminal, &before);
    terminal.settle();
    terminal.send(INTERRUPT);
    terminal.wait_for("unsaved changes");
    terminal.send(ESCAPE);
    terminal.wait_without("unsaved changes");
    terminal.send("q");
    terminal.wait_for("unsaved changes");
    quit(&mut terminal);
    let left = left_behind(&terminal);
    assert!(
        !left[left.find("Rough line").unwrap()..].contains('\x1b'),
        "{left:?}"
    );
    let wanted = summary(folder.path(), &["--set", "adhesion.kappa=5.0"]);
    assert_rows_of(&left, &wanted);
    // The status line has the digits that are of use.
    let printed = left
        .split_once("pull-off force F_a")
        .expect("a pull-off force")
        .1;
    let printed = parse_quantity(printed.lines().next().unwrap(), "N").unwrap();
    assert_eq!(format_rounded(printed, 3, "N"), force, "{left}");
}
