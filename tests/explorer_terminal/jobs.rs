//! Ctrl-Z returns the terminal to the shell, and `fg` resumes.

use crate::common::terminal::{Program, Terminal};
use crate::driving::{ASPERITY, assert_given_back, explorer, row_with};
use std::path::Path;
use vt100::MouseProtocolMode;

const SUSPEND: &str = "\x1a";
const PROMPT: &str = "your turn> ";

/// Shells with job control that read their lines from the terminal unchanged.
const SHELLS: [(&str, &[&str]); 2] = [
    ("/bin/sh", &["-i"]),
    ("/bin/bash", &["--norc", "--noprofile", "--noediting", "-i"]),
];

/// Runs a test in each shell with job control.
fn in_each_shell(test: impl Fn(Terminal)) {
    let mut found = 0;
    for (shell, arguments) in SHELLS
        .into_iter()
        .filter(|(shell, _)| Path::new(shell).exists())
    {
        let (_, folder) = explorer();
        let mut program = Program::new(shell)
            .folder(folder.path())
            .env("PS1", PROMPT)
            .env("PATH", "/usr/bin:/bin");
        for argument in arguments {
            program = program.argument(argument);
        }
        let mut terminal = program.start();
        terminal.wait_for(PROMPT.trim_end());
        terminal.send("set -m && echo jobs''-known || echo jobs''-unknown\r");
        terminal.wait("answer", |rows| {
            rows.iter().any(|row| row.starts_with("jobs-"))
        });
        if terminal.rows().iter().any(|row| row == "jobs-unknown") {
            println!("skipped in {shell}: it has no job control here");
            continue;
        }
        found += 1;
        println!("in {shell}");
        terminal.send(&format!("'{ASPERITY}' scene.ron\r"));
        terminal.wait_for("F_a ");
        terminal.send("!");
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
    let is_prompt = |row: &String| row == PROMPT.trim_end();
    terminal.wait("prompt", |rows| {
        rows.iter()
            .rfind(|row| !row.is_empty())
            .is_some_and(is_prompt)
    });
    terminal.settle();
    assert_given_back(terminal);
    assert_eq!(
        terminal.screen().mouse_protocol_mode(),
        MouseProtocolMode::None
    );
}

#[test]
fn suspended_and_continued_it_is_as_it_was() {
    in_each_shell(|mut terminal| {
        terminal.wait_without("± …");
        let before = without_times(&terminal);
        // The second time in another window, the third time as at first.
        for (columns, rows) in [(120, 40), (90, 30), (120, 40)] {
            terminal.send(SUSPEND);
            wait_for_shell(&mut terminal);
            // Text typed now goes to the shell, with echo.
            terminal.send("echo it''self\r");
            terminal.wait("answer", |rows| rows.iter().any(|row| row == "itself"));
            terminal.resize(columns, rows);
            terminal.send("fg\r");
            let edge = usize::from(columns) - 1;
            terminal.wait("title at the edge", |rows| {
                rows.iter().any(|row| row.chars().nth(edge) == Some('─'))
            });
            terminal.settle();
            assert!(
                columns == 90 || without_times(&terminal) == before,
                "{}",
                terminal.text()
            );
            assert!(terminal.screen().alternate_screen() && terminal.screen().hide_cursor());
            assert_eq!(
                terminal.screen().mouse_protocol_mode(),
                MouseProtocolMode::ButtonMotion
            );
            assert!(terminal.screen().bracketed_paste() && !terminal.is_as_before());
        }
        let selected = row_with(&terminal, "›");
        terminal.send("j");
        terminal.wait("other row selected", |rows| {
            rows.iter().any(|row| row.contains('›') && *row != selected)
        });
        terminal.send("q");
        wait_for_shell(&mut terminal);
        assert!(
            terminal.text().contains("pull-off force F_a"),
            "{}",
            terminal.text()
        );
        terminal.send("exit\r");
        terminal.wait_end();
    });
}
