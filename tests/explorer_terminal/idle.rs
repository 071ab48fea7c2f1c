//! No work without events.

use crate::common::terminal::Terminal;
use crate::driving::{explorer, paused, quit};
use std::fs;
use std::time::Duration;

/// Ticks of processor time of the process, and number of wake-ups of its threads.
fn activity(pid: u32) -> (u64, u64) {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap();
    // The name of the program, in brackets, may contain any character.
    let fields: Vec<&str> = stat
        .rsplit_once(')')
        .unwrap()
        .1
        .split_whitespace()
        .collect();
    let ticks = fields[11].parse::<u64>().unwrap() + fields[12].parse::<u64>().unwrap();
    let mut switches = 0;
    for thread in fs::read_dir(format!("/proc/{pid}/task")).unwrap() {
        let status = fs::read_to_string(thread.unwrap().path().join("status")).unwrap();
        for line in status.lines().filter(|line| line.contains("ctxt_switches")) {
            switches += line
                .rsplit(char::is_whitespace)
                .next()
                .unwrap()
                .parse::<u64>()
                .unwrap();
        }
    }
    (ticks, switches)
}

#[track_caller]
pub fn assert_idle(terminal: &mut Terminal) {
    terminal.settle();
    let before = activity(terminal.pid());
    assert!(
        terminal.is_silent_for(Duration::from_millis(400)),
        "it writes:\n{}",
        terminal.text()
    );
    assert_eq!(activity(terminal.pid()), before, "it is awake");
}

#[test]
fn nothing_happens_while_nothing_happens() {
    let (program, _folder) = explorer();
    let mut terminal = paused(program.env("SSH_CONNECTION", "192.0.2.1 50000 192.0.2.2 22"));
    assert_idle(&mut terminal);
    // Also with a window open above the panes.
    terminal.send("?");
    terminal.wait_for("What you see");
    assert_idle(&mut terminal);
    terminal.send("?");
    terminal.wait_without("What you see");
    // With manual loading.
    terminal.send("dLL");
    terminal.wait_for("manual loading");
    assert_idle(&mut terminal);
    // While a scene is chosen, with its curve beside.
    terminal.send("o");
    terminal.wait_for("built-in");
    assert_idle(&mut terminal);
    terminal.send("kendall");
    terminal.wait_for("› kendall-punch");
    assert_idle(&mut terminal);
    terminal.send("\x1b");
    terminal.wait_without("Search:");
    // While a text is typed.
    terminal.send("1");
    terminal.wait_for("): 1");
    assert_idle(&mut terminal);
    terminal.send("\x1b");
    terminal.wait_without("Press or pull to");
    terminal.send("\x1b");
    terminal.wait_without("manual loading");
    // Played to its end the animation stops by itself: to the last stage, near its end, and on.
    terminal.send(">");
    terminal.settle();
    // With the timeline selected, a large step is a twelfth of the stage.
    terminal.send("\t");
    terminal.send(&"L".repeat(11));
    terminal.settle();
    let before = terminal.text();
    terminal.send(" ");
    terminal.wait("next snapshot", |rows| rows.join("\n") != before);
    assert_idle(&mut terminal);
    quit(&mut terminal);
}
