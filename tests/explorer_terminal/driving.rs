//! Driving the explorer and reading its screen.

use crate::common::terminal::{Program, Terminal};
use asperity::data::parse_quantity;
use std::fs;

pub const ASPERITY: &str = env!("CARGO_BIN_EXE_asperity");

pub const ENTER: &str = "\r";
pub const ESCAPE: &str = "\x1b";
pub const CLEAR_LINE: &str = "\x15";
pub const INTERRUPT: &str = "\x03";

pub const ENTER_ALTERNATE_SCREEN: &[u8] = b"\x1b[?1049h";
pub const LEAVE_ALTERNATE_SCREEN: &[u8] = b"\x1b[?1049l";
pub const SHOW_CURSOR: &[u8] = b"\x1b[?25h";
pub const HIDE_CURSOR: &[u8] = b"\x1b[?25l";

/// A scene with few fields that is computed at once.
pub const SCENE: &str = r#"(
    version: 1,
    title: "Rough line",
    material: (modulus: 2.0e6), // soft
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (8, 256), seed: 1),
    adhesion: (kappa: 8.0),
    loading: [ToForce(2.0e-5), ToSeparation],
    numerics: (points: 1024, samples: 64),
)
"#;

/// The explorer on the scene above, in a folder of its own with the file of the scene.
pub fn explorer() -> (Program, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.ron"), SCENE).unwrap();
    // A home folder without the scenes of the user who runs the tests.
    let home = folder.path().to_str().expect("a name in Unicode");
    (
        Program::new(ASPERITY)
            .argument("scene.ron")
            .folder(folder.path())
            .env("HOME", home),
        folder,
    )
}

/// The explorer after the first curve, with its animation paused.
pub fn paused(program: Program) -> Terminal {
    let mut terminal = program.start();
    terminal.wait_for("F_a ");
    // The error appears after a short rest.
    terminal.wait_without("± …");
    terminal.send("!");
    terminal.settle();
    terminal
}

/// The row that contains a text.
pub fn row_with(terminal: &Terminal, text: &str) -> String {
    terminal
        .rows()
        .into_iter()
        .find(|row| row.contains(text))
        .unwrap_or_else(|| panic!("no {text}:\n{}", terminal.text()))
}

/// The pull-off force of the shown profile as on the screen: a number and its unit.
pub fn headline(rows: &[String]) -> Option<String> {
    let of_profile = |row: &'_ String| {
        row.split_once("this profile ")
            .map(|(_, after)| after.to_owned())
    };
    let alone = |row: &'_ String| row.split_once("F_a ").map(|(_, after)| after.to_owned());
    let after = rows
        .iter()
        .rev()
        .find_map(of_profile)
        .or_else(|| rows.iter().rev().find_map(alone))?;
    let words: Vec<&str> = after.split_whitespace().take(2).collect();
    Some(words.join(" ").trim_end_matches(',').to_owned())
}

/// Waits for another pull-off force than this one, and returns it.
#[track_caller]
pub fn wait_for_another(terminal: &mut Terminal, force: &str) -> String {
    terminal.wait("other force", |rows| {
        headline(rows).is_some_and(|now| now != force)
    });
    headline(&terminal.rows()).expect("a force is shown")
}

/// Selects a parameter by its name, by keys.
#[track_caller]
pub fn select(terminal: &mut Terminal, name: &str) {
    let marked = |rows: &[String]| rows.iter().find(|row| row.contains('›')).cloned();
    terminal.send("g");
    terminal.settle();
    for _ in 0..40 {
        let before = marked(&terminal.rows())
            .unwrap_or_else(|| panic!("nothing selected:\n{}", terminal.text()));
        let label = before
            .split('›')
            .nth(1)
            .unwrap_or_default()
            .trim_start_matches([' ', '─', '●', '○']);
        if label
            .split("  ")
            .next()
            .is_some_and(|label| label.contains(name))
        {
            return;
        }
        terminal.send("j");
        terminal.wait("other row selected", |rows| {
            marked(rows).is_some_and(|now| now != before)
        });
    }
    panic!("no parameter {name}:\n{}", terminal.text());
}

pub fn count(bytes: &[u8], part: &[u8]) -> usize {
    bytes
        .windows(part.len())
        .filter(|window| *window == part)
        .count()
}

pub fn place(bytes: &[u8], part: &[u8]) -> Option<usize> {
    bytes.windows(part.len()).position(|window| window == part)
}

pub fn last_place(bytes: &[u8], part: &[u8]) -> Option<usize> {
    bytes.windows(part.len()).rposition(|window| window == part)
}

/// Asserts the terminal as left by a program: its own screen again, with cursor and echo.
#[track_caller]
pub fn assert_given_back(terminal: &Terminal) {
    let bytes = terminal.written();
    let left = last_place(bytes, LEAVE_ALTERNATE_SCREEN).expect("the alternate screen is left");
    assert!(left > last_place(bytes, ENTER_ALTERNATE_SCREEN).expect("it was entered"));
    let shown = last_place(bytes, SHOW_CURSOR).expect("the cursor is shown");
    assert!(last_place(bytes, HIDE_CURSOR).is_none_or(|hidden| hidden < shown));
    assert!(!terminal.screen().alternate_screen() && !terminal.screen().hide_cursor());
    assert!(!terminal.screen().bracketed_paste());
    assert!(
        terminal.is_as_before(),
        "line by line and with echo, as before"
    );
}

/// Leaves the explorer by its own keys.
#[track_caller]
pub fn quit(terminal: &mut Terminal) {
    terminal.send("q");
    assert!(terminal.wait_end().success());
    assert_given_back(terminal);
}

/// Quantity beside its name on the screen, in SI units: `d 175.6 nm` is 1.756e-7.
pub fn quantity(rows: &[String], name: &str, unit: &str) -> Option<f64> {
    rows.iter().find_map(|row| {
        let mut words = row
            .split_whitespace()
            .skip_while(|word| *word != name)
            .skip(1);
        let (number, unit_shown) = (words.next()?, words.next()?);
        // Zero has no unit.
        parse_quantity(&format!("{number} {unit_shown}"), unit)
            .or_else(|_| parse_quantity(number, unit))
            .ok()
    })
}

/// Types a line into the open prompt, and accepts it.
#[track_caller]
pub fn answer(terminal: &mut Terminal, prompt: &str, text: &str) {
    terminal.wait_for(prompt.trim_end());
    terminal.send(CLEAR_LINE);
    terminal.send(text);
    terminal.wait_for(&format!("{prompt}{text}"));
    terminal.send(ENTER);
}
