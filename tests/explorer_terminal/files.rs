//! Saved, exported and copied texts.

use crate::common::terminal::{Program, Terminal};
use crate::driving::{
    ASPERITY, ESCAPE, answer, explorer, headline, last_place, paused, quit, row_with, select,
    wait_for_another,
};
use asperity::scene::presets;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Standard output of the program in a folder, for a command line of a shell.
fn shell(folder: &Path, line: &str) -> Vec<u8> {
    let programs = Path::new(ASPERITY).parent().unwrap().display().to_string();
    let path = format!("{programs}:/usr/bin:/bin");
    let output = Command::new("/bin/sh")
        .current_dir(folder)
        .env("PATH", path)
        .arg("-c")
        .arg(line)
        .output();
    let output = output.unwrap();
    assert!(
        output.status.success(),
        "{line}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    output.stdout
}

/// The last text sent to the clipboard of the terminal, in base64.
fn copied(terminal: &Terminal) -> Option<String> {
    let bytes = terminal.written();
    let start = last_place(bytes, b"\x1b]52;c;")? + b"\x1b]52;c;".len();
    let end = bytes[start..]
        .iter()
        .position(|byte| matches!(byte, 0x1b | 0x07))?;
    let text = String::from_utf8_lossy(&bytes[start..start + end]).into_owned();
    Some(String::from_utf8(shell(Path::new("/"), &format!("echo {text} | base64 -d"))).unwrap())
}

#[test]
fn the_command_that_is_copied_gives_the_same_curve() {
    let (program, folder) = explorer();
    // A name that a shell would split into words.
    fs::rename(
        folder.path().join("scene.ron"),
        folder.path().join("my 'scene' $1.ron"),
    )
    .unwrap();
    drop(program);
    let program = Program::new(ASPERITY)
        .argument("my 'scene' $1.ron")
        .folder(folder.path());
    let mut terminal = paused(program);
    assert_eq!(copied(&terminal), None);
    select(&mut terminal, "κ");
    let before = headline(&terminal.rows()).unwrap();
    terminal.send("h");
    let force = wait_for_another(&mut terminal, &before);
    select(&mut terminal, "seed");
    terminal.send("l");
    wait_for_another(&mut terminal, &force);
    terminal.send("y");
    terminal.wait_for("copied: asperity");
    terminal.settle();
    let command = copied(&terminal).expect("it is sent to the terminal");
    assert!(
        row_with(&terminal, "copied: ").starts_with(&format!("copied: {command}")),
        "{command}"
    );
    terminal.send("E");
    answer(
        &mut terminal,
        "Export to (.csv .npy .json .svg .png .pdf .txt; 85mm: width): ",
        "curve.csv",
    );
    terminal.wait_for("exported to curve.csv");
    terminal.send("q");
    terminal.wait_for("unsaved changes");
    quit(&mut terminal);

    let arguments = command
        .strip_prefix("asperity ")
        .expect("it is a command of asperity");
    assert!(arguments.contains("--set adhesion.kappa="), "{command}");
    let curve = shell(
        folder.path(),
        &format!("asperity run {arguments} --format csv"),
    );
    assert_eq!(fs::read(folder.path().join("curve.csv")).unwrap(), curve);
}

/// The folder of one's own scenes need not exist before the first of them.
#[test]
fn the_first_own_scene_makes_its_folder() {
    let home = tempfile::tempdir().unwrap();
    let program = Program::new(ASPERITY)
        .argument("jkr-sphere")
        .env("HOME", home.path().to_str().unwrap());
    let mut terminal = paused(program);
    terminal.send("s");
    let own = home.path().join(".config/asperity/presets/mine.ron");
    answer(&mut terminal, "Save as: ", &own.display().to_string());
    terminal.wait_for("saved to ");
    assert!(own.is_file());
    terminal.send("o");
    terminal.wait_for(&format!(" of {}", presets().len() + 1));
    terminal.wait_for("mine  own");
    terminal.send(ESCAPE);
    terminal.wait_without("Search:");
    // Any other folder is still the user's affair.
    terminal.send("s");
    let other = home.path().join("other/mine.ron").display().to_string();
    answer(&mut terminal, "Save as: ", &other);
    terminal.wait_for("there is no folder");
}
