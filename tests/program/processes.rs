//! Processes of the program: killed, left by their readers, asked for help, and playing a demo.

use super::common::deadline::within;
use super::program::{program, text};
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::Stdio;

#[cfg(unix)]
#[test]
fn a_process_that_is_killed_while_it_writes_leaves_a_whole_file_or_none() {
    within(120, || {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out.csv");
        let arguments = [
            "run",
            "jkr-sphere",
            "--set",
            "numerics.samples=20000",
            "--force",
            "-o",
        ];
        let clock = std::time::Instant::now();
        assert!(
            program()
                .args(arguments)
                .arg(&out)
                .status()
                .unwrap()
                .success()
        );
        let (whole, time) = (fs::read(&out).unwrap(), clock.elapsed());
        for (round, share) in (0..6).map(|round| (round, 0.1 + 0.16 * f64::from(round))) {
            if round % 2 == 0 {
                fs::remove_file(&out).unwrap();
            }
            let mut run = program().args(arguments).arg(&out).spawn().unwrap();
            std::thread::sleep(time.mul_f64(share));
            run.kill().unwrap();
            run.wait().unwrap();
            assert!(
                !out.exists() || fs::read(&out).unwrap() == whole,
                "a file is whole or not there"
            );
            fs::write(&out, &whole).unwrap();
        }
    });
}

#[test]
fn a_reader_may_leave_at_any_time() {
    for arguments in [
        // More than a pipe holds, and less.
        &["profile", "pressure-sensitive"][..],
        &[
            "run",
            "jkr-sphere",
            "--format",
            "json",
            "--set",
            "numerics.samples=20000",
        ],
        &["run", "jkr-sphere"],
        &["demo"],
        &["--help"],
    ] {
        let mut child = program()
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (mut first, mut stderr) = (String::new(), String::new());
        BufReader::new(child.stdout.take().unwrap())
            .read_line(&mut first)
            .unwrap();
        child
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut stderr)
            .unwrap();
        assert_eq!(
            (child.wait().unwrap().code(), stderr.as_str()),
            (Some(0), ""),
            "{arguments:?}"
        );
    }
}

/// Commands listed in a help.
fn commands(help: &str) -> impl Iterator<Item = &str> {
    let listed = help
        .split_once("Commands:\n")
        .map_or("", |(_, rest)| rest.split("\n\n").next().unwrap());
    let names = listed
        .lines()
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    names.filter(|name| !name.is_empty() && *name != "help")
}

/// Largest number of options of all commands together: a new one takes the place of another, or
/// serves several commands.
const MOST_OPTIONS: usize = 68;

#[test]
fn help_is_for_reading() {
    let mut left: Vec<Vec<String>> = vec![Vec::new()];
    let (mut seen, mut options) = (0, BTreeSet::new());
    while let Some(command) = left.pop() {
        seen += 1;
        for flag in ["-h", "--help"] {
            let help = text(&[command.iter().map(String::as_str).collect(), vec![flag]].concat());
            assert!(help.contains("Usage: asperity"), "{help}");
            assert!(
                help.contains("Examples:") || command.first().is_some_and(|room| room == "presets"),
                "{help}"
            );
            assert!(
                help.lines().all(|line| line.chars().count() <= 100),
                "{help}"
            );
            let listed = help
                .lines()
                .map(str::trim_start)
                .filter(|line| line.starts_with('-'));
            let names =
                listed.filter_map(|line| line.split(' ').find(|word| word.starts_with("--")));
            options.extend(names.map(str::to_owned));
            if flag == "-h" {
                left.extend(
                    commands(&help).map(|name| [&command[..], &[name.to_owned()]].concat()),
                );
            }
        }
    }
    assert!(seen >= 20, "{seen} commands");
    options.retain(|name| name != "--help" && name != "--version");
    assert!(
        (40..=MOST_OPTIONS).contains(&options.len()),
        "{} options: {options:?}",
        options.len()
    );
}

#[test]
fn a_demo_is_text_in_a_pipe() {
    within(60, || {
        let demo = |more: &[&str]| text(&[&["demo", "jkr-sphere"], more].concat());
        let frames = demo(&["--size", "100x30"]);
        let heads: Vec<&str> = frames
            .lines()
            .filter(|line| line.starts_with("== "))
            .collect();
        assert_eq!(
            (heads.len(), heads[0], heads[12]),
            (13, "== 0.00 s ==", "== 12.00 s ==")
        );
        assert!(
            !frames.contains(['\u{1b}', '\r'])
                && frames.contains("Force F (")
                && frames.contains('⠒')
        );
        assert!(
            frames.lines().count() == 13 * 31
                && frames.lines().all(|line| line.chars().count() <= 100)
        );
        assert_eq!(frames, demo(&["--size", "100x30"]), "the same every time");
        let ascii = demo(&["--size", "100x30", "--marker", "ascii"]);
        assert!(
            ascii
                .bytes()
                .all(|byte| byte == b'\n' || (b' '..=b'~').contains(&byte))
        );
        assert!(
            demo(&["--set", "adhesion.work=0.06", "--at", "1"]).contains("60 mJ/m²"),
            "overrides have an effect"
        );
        assert_ne!(demo(&["--at", "3"]), demo(&["--at", "9"]));
    });
}
