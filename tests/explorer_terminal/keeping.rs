//! Files that outlive a session: unsaved changes and the configuration, in the folders of a
//! separate user.

use crate::common::terminal::{Program, Terminal};
use crate::driving::{ASPERITY, SCENE, explorer, paused, quit, select};
use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// Files of unsaved changes in a home folder, without one that is being written.
fn kept(home: &Path) -> Vec<PathBuf> {
    let folder = home.join(".local/state/asperity/unsaved");
    let files = fs::read_dir(folder).into_iter().flatten();
    files
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "ron"))
        .collect()
}

/// The program outside a terminal, with this home folder.
fn command(home: &Path) -> Command {
    let mut command = Command::new(ASPERITY);
    command.env_clear().env("HOME", home);
    command
}

/// Another explorer with the same home folder.
fn again(home: &Path, argument: &str) -> Program {
    let program = Program::new(ASPERITY)
        .folder(home)
        .env("HOME", home.to_str().unwrap());
    program.argument(argument)
}

/// The explorer with a changed scene, after the change is kept.
fn changed(program: Program, home: &Path) -> Terminal {
    let mut terminal = paused(program);
    assert!(kept(home).is_empty(), "nothing is written unasked");
    select(&mut terminal, "κ");
    terminal.send("h");
    terminal.wait_for("[changed]");
    terminal.wait_until("file of unsaved changes", || !kept(home).is_empty());
    terminal
}

#[test]
fn unsaved_changes_outlive_a_killed_explorer_and_a_lost_connection() {
    for is_killed in [true, false] {
        let (program, folder) = explorer();
        let home = folder.path();
        let mut terminal = changed(program, home);
        if is_killed {
            let status = Command::new("kill")
                .args(["-KILL", &terminal.pid().to_string()])
                .status();
            assert!(status.unwrap().success());
        } else {
            terminal.hang_up();
        }
        terminal.wait_process();
        assert_eq!(fs::read_to_string(home.join("scene.ron")).unwrap(), SCENE);
        // The next explorer reports the kept change in a line that ends with the next key.
        let mut terminal = again(home, "scene.ron").start();
        terminal.wait_for("asperity --restore opens the unsaved changes of scene.ron");
        terminal.send(">");
        terminal.wait_without("unsaved changes");
        quit(&mut terminal);
        let mut terminal = again(home, "--restore").start();
        terminal.wait("changed scene", |rows| {
            rows[0].starts_with("Rough line [changed]")
        });
        terminal.wait_until("own file", || kept(home).len() == 1);
        terminal.send("u");
        terminal.send("q");
        terminal.wait_for("unsaved changes");
        quit(&mut terminal);
        assert!(kept(home).is_empty(), "the question was answered");
        let output = command(home).arg("--restore").output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(
            message.contains("--restore: no unsaved changes are kept"),
            "{message}"
        );
        let folder = home.join(".local/state/asperity/unsaved");
        fs::write(folder.join("1-1.ron"), "[(name").unwrap();
        let output = command(home).arg("--restore").output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains("--restore: ") && message.contains("1-1.ron: 1:"));
    }
}

/// The force at the body, and the point of the path, are those of the killed explorer.
#[test]
fn a_path_by_hand_outlives_a_killed_explorer() {
    let (program, folder) = explorer();
    let home = folder.path();
    let mut terminal = paused(program);
    let shown = |rows: &[String]| {
        let row = rows.iter().find(|row| row.contains("Force F"))?;
        let (_, after) = row.split_once('◆')?;
        Some(after.to_owned())
    };
    terminal.send("d");
    terminal.send("LLLHHHl");
    terminal.settle_for(Duration::from_millis(300));
    let before = shown(&terminal.rows());
    assert!(before.is_some(), "{}", terminal.text());
    terminal.wait_until("file of the path", || !kept(home).is_empty());
    let text = fs::read_to_string(&kept(home)[0]).unwrap();
    assert!(text.contains("ToIndentation"), "{text}");
    let pid = terminal.pid().to_string();
    let status = Command::new("kill").args(["-KILL", &pid]).status();
    assert!(status.unwrap().success());
    terminal.wait_process();
    let mut terminal = again(home, "--restore").start();
    terminal.wait("the same point", |rows| shown(rows) == before);
    assert!(
        !terminal.rows()[0].contains("[changed]"),
        "{}",
        terminal.text()
    );
    terminal.wait_until("own file", || kept(home).len() == 1);
    assert_eq!(fs::read_to_string(&kept(home)[0]).unwrap(), text);
    // Without the path, nothing is unsaved.
    terminal.send("\x1b");
    terminal.wait_until("no file", || kept(home).is_empty());
    quit(&mut terminal);
}

/// Writing a file waits for the disk, so a held key must not write one for each of its edits.
#[test]
fn unsaved_changes_are_written_once_when_the_keys_rest() {
    const KEYS: usize = 20;
    let (program, folder) = explorer();
    let home = folder.path();
    let mut terminal = paused(program);
    select(&mut terminal, "κ");
    // Each writing makes a new file in the place of the one before.
    let file = |home: &Path| Some(fs::metadata(kept(home).first()?).ok()?.ino());
    let mut written = BTreeSet::new();
    let begun = Instant::now();
    for key in 1..=KEYS {
        terminal.send("h");
        terminal.take_until(begun + Duration::from_millis(100) * key as u32);
        written.extend(file(home));
    }
    // A test that is held up may make a pause between two keys.
    assert!(written.len() <= 2, "{written:?}");
    terminal.wait_until("file of unsaved changes", || !kept(home).is_empty());
    terminal.settle_for(Duration::from_millis(1500));
    written.extend(file(home));
    println!("{} files for {KEYS} keys", written.len());
    assert!((1..=3).contains(&written.len()), "{written:?}");
    terminal.send("q");
    terminal.wait_for("unsaved changes");
    quit(&mut terminal);
}

#[test]
fn a_signal_keeps_the_changes_of_the_last_second() {
    let (program, folder) = explorer();
    let home = folder.path();
    let mut terminal = paused(program);
    select(&mut terminal, "κ");
    terminal.send("h");
    terminal.wait_for("[changed]");
    let pid = terminal.pid().to_string();
    let status = Command::new("kill").args(["-TERM", &pid]).status();
    assert!(status.unwrap().success());
    terminal.wait_end();
    assert_eq!(kept(home).len(), 1);
}

#[test]
fn a_configuration_is_read() {
    let (program, folder) = explorer();
    let home = folder.path();
    let file = home.join(".config/asperity/config.ron");
    drop(program);
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    // A default scene and a key.
    let text = "(version: 1, scene: \"scene.ron\", keys: [(action: \"quit\", keys: [\"_\"])])";
    fs::write(&file, text).unwrap();
    let mut terminal = Program::new(ASPERITY)
        .folder(home)
        .env("HOME", home.to_str().unwrap())
        .start();
    terminal.wait("default scene", |rows| rows[0].starts_with("Rough line"));
    terminal.wait_for("_ quit");
    terminal.send("_");
    assert!(terminal.wait_end().success());
    let mut terminal = paused(again(home, "--config=none"));
    assert!(
        !terminal.rows()[0].starts_with("Rough line"),
        "{}",
        terminal.text()
    );
    quit(&mut terminal);
    let run = |arguments: &[&str]| {
        let output = command(home).args(arguments).output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        (
            output.status.code(),
            text(output.stdout),
            text(output.stderr),
        )
    };
    fs::write(&file, "(version: 1, theme: Pink)").unwrap();
    let (code, _, message) = run(&["--config", file.to_str().unwrap()]);
    assert!(
        code == Some(1) && message.contains("config.ron:1:21: theme = Pink: allowed: Neutral"),
        "{message}"
    );
    // The user's own file does not keep the explorer from opening.
    let mut terminal = again(home, "--marker=braille").start();
    terminal.wait_for("config.ron:1:21: theme = Pink");
    quit(&mut terminal);
    assert_eq!(
        fs::read_to_string(&file).unwrap(),
        "(version: 1, theme: Pink)"
    );
}
