//! A finished study opens as a map; another folder is refused with its kind.

use crate::common::study::{PLAN, begun, merged};
use crate::common::terminal::Program;
use crate::driving::{ASPERITY, paused, quit};
use std::path::Path;
use std::process::{Command, Stdio};

#[test]
fn a_folder_opens_as_the_map_of_its_study() {
    let folder = tempfile::tempdir().unwrap();
    merged(&folder.path().join("small"), PLAN);
    let home = folder.path().to_str().unwrap();
    let program = Program::new(ASPERITY).argument("small/").folder(folder.path()).env("HOME", home);
    let mut terminal = paused(program);
    for message in [
        "Small study",
        "Study small: regime (touch) over H, κ, 12 profiles",
        "F_n/(E* h L) = 0.01",
        "◆ H 0.5, κ 1",
    ] {
        terminal.wait_for(message);
    }
    // Browsing is no change that anyone has to save.
    terminal.send("P");
    terminal.wait_for("F_n/(E* h L) = 0.1");
    quit(&mut terminal);
}

/// Message of the program about a folder, without a terminal.
fn message(folder: &Path, name: &str) -> String {
    let mut command = Command::new(ASPERITY);
    let output = command.current_dir(folder).arg(name).stdin(Stdio::null()).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(output.stdout.is_empty());
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn a_folder_without_a_map_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    begun(&at("begun"), PLAN);
    merged(&at("whole"), PLAN);
    let axes = PLAN.find("    axes:").unwrap()..PLAN.find("    lines:").unwrap();
    merged(&at("one cell"), &PLAN.replace(&PLAN[axes], ""));
    std::fs::create_dir(at("notes")).unwrap();
    std::fs::create_dir(at("jkr-sphere")).unwrap();
    for (name, expected) in [
        ("begun", "begun: the study has not been merged yet; asperity sweep merge begun does it"),
        ("notes", "notes: this folder is not that of a study: there is no plan.ron in it; allowed"),
        ("one cell", "one cell: this study has one cell and no map; a curve needs an axis"),
        ("whole", "the explorer needs a terminal; asperity sweep plot whole draws the study without one"),
        // A folder with the name of a built-in scene does not hide the scene.
        ("jkr-sphere", "asperity run jkr-sphere computes the scene without one"),
    ] {
        let message = message(folder.path(), name);
        assert!(
            message.starts_with(expected) || message.ends_with(&format!("{expected}\n")),
            "{name}: {message}"
        );
        assert_eq!(message.lines().count(), 1, "{message}");
    }
}
