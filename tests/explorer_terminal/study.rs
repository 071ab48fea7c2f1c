//! A folder without a map is refused with its kind.

use crate::common::study::{PLAN, begun, merged};
use crate::driving::ASPERITY;
use std::path::Path;
use std::process::{Command, Stdio};

/// Message of the program about a folder, without a terminal.
fn message(folder: &Path, name: &str) -> String {
    let mut command = Command::new(ASPERITY);
    let output = command
        .current_dir(folder)
        .arg(name)
        .stdin(Stdio::null())
        .output()
        .unwrap();
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
    let axes = PLAN.find("    axes:").unwrap()..PLAN.find("    profiles:").unwrap();
    merged(&at("one cell"), &PLAN.replace(&PLAN[axes], ""));
    std::fs::create_dir(at("notes")).unwrap();
    std::fs::create_dir(at("jkr-sphere")).unwrap();
    for (name, expected) in [
        (
            "begun",
            "begun: the study has not been merged yet; asperity sweep merge begun does it",
        ),
        (
            "notes",
            "notes: this is not the folder of a study: there is no plan.ron in it; allowed",
        ),
        (
            "one cell",
            "one cell: this study has one cell and no map; a curve needs an axis",
        ),
        (
            "whole",
            "the explorer needs a terminal; asperity sweep plot whole draws the study without one",
        ),
        // A folder with the name of a built-in scene does not hide the scene.
        (
            "jkr-sphere",
            "asperity run jkr-sphere computes the scene without one",
        ),
    ] {
        let message = message(folder.path(), name);
        assert!(
            message.starts_with(expected) || message.ends_with(&format!("{expected}\n")),
            "{name}: {message}"
        );
        assert_eq!(message.lines().count(), 1, "{message}");
    }
}
