//! Ctrl-Z returns the terminal to the shell, and `fg` resumes.

use crate::common::deadline::within;
use crate::common::terminal::{Program, Terminal};
use crate::driving::{ASPERITY, assert_given_back, explorer, headline, row_with};
use std::path::Path;
use vt100::MouseProtocolMode;

const SUSPEND: &str = "\x1a";
const PROMPT: &str = "your turn> ";

/// Shells with job control that read their lines from the terminal unchanged.
const SHELLS: [(&str, &[&str]); 2] =
    [("/bin/sh", &["-i"]), ("/bin/bash", &["--norc", "--noprofile", "--noediting", "-i"])];

/// Runs a test in each shell with job control.
fn in_each_shell(test: impl Fn(Terminal)) {
    let mut found = 0;
    for (shell, arguments) in SHELLS.into_iter().filter(|(shell, _)| Path::new(shell).exists()) {
        let (_, folder) = explorer();
        let mut program =
            Program::new(shell).folder(folder.path()).env("PS1", PROMPT).env("PATH", "/usr/bin:/bin");
        for argument in arguments {
            program = program.argument(argument);
        }
        let mut terminal = program.start();
        terminal.wait_for(PROMPT.trim_end());
        terminal.send("set -m && echo jobs''-known || echo jobs''-unknown\r");
        terminal.wait("answer", |rows| rows.iter().any(|row| row.starts_with("jobs-")));
        if terminal.rows().iter().any(|row| row == "jobs-unknown") {
            println!("skipped in {shell}: it has no job control here");
            continue;
        }
        found += 1;
        println!("in {shell}");
        terminal.send(&format!("'{ASPERITY}' scene.ron\r"));
        terminal.wait_for("F_a ");
        terminal.send(".");
        terminal.settle();
        test(terminal);
    }
    if found == 0 {
        println!("skipped: no shell with job control");
    }
}

/// The screen except for the time of the newest run, which differs from run to run.
fn without_times(terminal: &Terminal) -> Vec<String> {
    let mut rows = terminal.rows();
    for row in &mut rows {
        if let Some((before, _)) = row.split_once("  · ") {
            *row = before.to_owned();
        }
    }
    rows
}

/// Waits until the shell has the terminal in its own mode.
#[track_caller]
fn wait_for_shell(terminal: &mut Terminal) {
    terminal.wait("prompt", |rows| rows.last_filled() == Some(PROMPT.trim_end()));
    terminal.settle();
    assert_given_back(terminal);
    assert_eq!(terminal.screen().mouse_protocol_mode(), MouseProtocolMode::None);
}

/// The last row with text.
trait LastFilled {
    fn last_filled(&self) -> Option<&str>;
}

impl LastFilled for [String] {
    fn last_filled(&self) -> Option<&str> {
        self.iter().rev().find(|row| !row.is_empty()).map(String::as_str)
    }
}

#[test]
fn suspended_and_continued_it_is_as_it_was() {
    within(120, || {
        in_each_shell(|mut terminal| {
            terminal.wait_without("± …");
            let before = without_times(&terminal);
            // Twice: the second time works like the first.
            for _ in 0..2 {
                terminal.send(SUSPEND);
                wait_for_shell(&mut terminal);
                // Text typed now goes to the shell, with echo.
                terminal.send("echo it''self\r");
                terminal.wait("answer", |rows| rows.iter().any(|row| row == "itself"));
                terminal.send("fg\r");
                terminal.wait("screen as before", |rows| rows.iter().any(|row| row.contains("F_a ")));
                terminal.settle();
                assert_eq!(without_times(&terminal), before);
                assert!(terminal.screen().alternate_screen() && terminal.screen().hide_cursor());
                assert_eq!(terminal.screen().mouse_protocol_mode(), MouseProtocolMode::ButtonMotion);
                assert!(terminal.screen().bracketed_paste() && !terminal.is_as_before());
            }
            let selected = row_with(&terminal, "›");
            terminal.send("j");
            terminal.wait("other row selected", |rows| {
                rows.iter().any(|row| row.contains('›') && *row != selected)
            });
            terminal.send("q");
            wait_for_shell(&mut terminal);
            assert!(terminal.text().contains("adhesion force F_a"), "{}", terminal.text());
            terminal.send("exit\r");
            terminal.wait_end();
        });
    });
}

#[test]
fn a_window_that_changes_meanwhile_is_filled() {
    within(120, || {
        in_each_shell(|mut terminal| {
            let force = headline(&terminal.rows());
            terminal.send(SUSPEND);
            wait_for_shell(&mut terminal);
            terminal.resize(90, 30);
            terminal.send("fg\r");
            terminal.wait("frame at the new edge", |rows| {
                rows.iter().any(|row| row.chars().nth(89) == Some('┐')) && rows[29].contains("q quit")
            });
            assert_eq!(headline(&terminal.rows()), force);
            assert_eq!(terminal.rows().len(), 30);
            terminal.send("q");
            wait_for_shell(&mut terminal);
        });
    });
}

#[test]
fn it_is_suspended_while_something_is_typed_and_while_it_plays() {
    within(120, || {
        in_each_shell(|mut terminal| {
            terminal.send("F12");
            terminal.wait_for("Go to the force: 12");
            terminal.send(SUSPEND);
            wait_for_shell(&mut terminal);
            terminal.send("fg\r");
            terminal.wait_for("Go to the force: 12");
            terminal.send("\x1b");
            terminal.wait_without("Go to the force");
            terminal.send("r");
            terminal.send(SUSPEND);
            wait_for_shell(&mut terminal);
            terminal.send("fg\r");
            terminal.wait_for("F_a ");
            // The animation continues.
            for _ in 0..3 {
                let now = terminal.text();
                terminal.wait("next snapshot", |rows| rows.join("\n") != now);
            }
            terminal.send("q");
            wait_for_shell(&mut terminal);
        });
    });
}
