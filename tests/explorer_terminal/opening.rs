//! Opening the explorer, and refusals to open.

use crate::common::terminal::{BEGIN_FRAME, END_FRAME, Program};
use crate::driving::{
    ASPERITY, ESCAPE, SCENE, assert_given_back, count, explorer, paused, place, quit, row_with,
};
use std::fs;
use std::process::{Command, Stdio};

#[test]
fn the_first_frame_has_all_panes_and_the_next_the_curve() {
    // Without a scene the explorer opens a built-in one.
    // A terminal whose background is known is not asked for it before the first frame.
    let mut terminal = Program::new(ASPERITY).env("COLORFGBG", "15;0").start();
    for pane in [
        "Force",
        "Profile",
        "Patch",
        "Parameters",
        "work of adhesion",
        "q quit",
    ] {
        terminal.wait_for(pane);
    }
    assert!(terminal.screen().alternate_screen() && terminal.screen().hide_cursor());
    assert!(!terminal.is_as_before(), "keys come one by one");
    terminal.wait_for("F_a ");
    let bytes = terminal.written();
    let computing = place(bytes, "computing".as_bytes()).expect("it says that it computes");
    assert!(computing < place(bytes, b"F_a ").unwrap());
    let frame = place(bytes, END_FRAME).unwrap();
    assert!(
        place(&bytes[..frame], b"Parameters").is_some(),
        "the panes are in the first frame"
    );
    quit(&mut terminal);
}

#[test]
fn whatever_is_drawn_is_drawn_in_whole_frames() {
    let (program, _folder) = explorer();
    let mut terminal = paused(program);
    terminal.send("?");
    terminal.settle();
    terminal.send(ESCAPE);
    terminal.settle();
    quit(&mut terminal);
    let bytes = terminal.written();
    let (mut rest, mut frames) = (&bytes[place(bytes, BEGIN_FRAME).unwrap()..], 0);
    while let Some(after) = rest.strip_prefix(BEGIN_FRAME) {
        let end = place(after, END_FRAME).expect("a frame ends");
        assert_eq!(count(&after[..end], BEGIN_FRAME), 0);
        rest = &after[end + END_FRAME.len()..];
        frames += 1;
    }
    assert!(frames > 3, "{frames} frames");
    // After the frames the terminal is restored, and the summary is on its own screen.
    let rest = String::from_utf8_lossy(rest);
    let (given_back, summary) = rest.split_once("Rough line").expect("there is a summary");
    assert!(
        given_back.len() < 64 && given_back.contains("\x1b[?1049l"),
        "{given_back:?}"
    );
    assert!(!summary.contains('\x1b'), "{summary:?}");
}

#[test]
fn keys_typed_before_the_first_frame_are_not_lost() {
    let (program, _folder) = explorer();
    let mut terminal = program.start();
    terminal.send(".jjj?");
    terminal.wait_for("What you see");
    terminal.send("?");
    terminal.wait_without("What you see");
    let rows = terminal.rows();
    let place = |text: &str| {
        rows.iter()
            .position(|row| row.contains(text))
            .expect("it is in the list")
    };
    assert_eq!(
        place("›"),
        place("roughness-adhesion parameter κ") + 1,
        "{}",
        terminal.text()
    );
    // Keys typed before the terminal was taken are echoed; nothing else remains.
    terminal.send("q");
    assert!(terminal.wait_end().success());
    assert_given_back(&terminal);
}

#[test]
fn a_misspelt_scene_is_stated_without_taking_the_terminal() {
    for (name, expected) in [
        ("jkr-spere", "did you mean jkr-sphere?"),
        ("none.ron", "none.ron"),
    ] {
        let home = tempfile::tempdir().unwrap();
        let program = Program::new(ASPERITY)
            .argument(name)
            .env("HOME", home.path().to_str().unwrap());
        let mut terminal = program.start();
        let status = terminal.wait_end();
        assert_eq!(status.exit_code(), 1);
        let screen = terminal.rows().concat();
        assert!(screen.contains(expected), "{screen}");
        assert!(!terminal.written().contains(&0x1b), "{}", terminal.text());
        assert!(terminal.is_as_before());
    }
}

#[test]
fn without_a_terminal_it_says_what_to_do() {
    let output = Command::new(ASPERITY)
        .arg("jkr-sphere")
        .stdin(Stdio::null())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(
        message.contains("asperity run jkr-sphere") && !message.contains('\x1b'),
        "{message}"
    );
    assert!(output.stdout.is_empty());
    // One end alone is not enough.
    for ends in ["</dev/null", ">written"] {
        let folder = tempfile::tempdir().unwrap();
        let mut terminal = Program::new("/bin/sh")
            .argument("-c")
            .argument(format!("'{ASPERITY}' jkr-sphere {ends}"))
            .folder(folder.path())
            .start();
        assert_eq!(terminal.wait_end().exit_code(), 1);
        assert!(
            terminal.text().contains("asperity run jkr-sphere"),
            "{}",
            terminal.text()
        );
        assert!(!terminal.written().contains(&0x1b), "{}", terminal.text());
        assert!(
            fs::read(folder.path().join("written"))
                .unwrap_or_default()
                .is_empty()
        );
    }
}

#[test]
fn terminals_without_braille_get_ascii() {
    let is_drawn = |text: &str| text.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c));
    for (name, value, ascii) in [
        ("TERM", "linux", true),
        ("LANG", "C", true),
        ("LC_ALL", "POSIX", true),
        ("LANG", "de_DE.UTF-8", false),
    ] {
        let (program, _folder) = explorer();
        let mut terminal = paused(program.env(name, value));
        let text = terminal.text();
        assert_eq!(is_drawn(&text), !ascii, "{name}={value}\n{text}");
        assert!(!ascii || text.is_ascii(), "{name}={value}\n{text}");
        quit(&mut terminal);
    }
}

#[test]
fn a_terminal_that_places_nothing_is_refused() {
    let (program, _folder) = explorer();
    let mut terminal = program.env("TERM", "dumb").start();
    assert!(!terminal.wait_end().success());
    let text = String::from_utf8_lossy(terminal.written()).into_owned();
    assert!(
        text.contains("TERM=dumb") && text.contains("asperity run scene.ron"),
        "{text}"
    );
    assert!(!text.contains('\x1b'), "{text:?}");
}

#[test]
fn an_own_scene_opens_by_its_name_with_other_values() {
    let config = tempfile::tempdir().unwrap();
    let folder = config.path().join("asperity").join("presets");
    fs::create_dir_all(&folder).unwrap();
    fs::write(
        folder.join("tape.ron"),
        SCENE.replace("Rough line", "Sticky tape"),
    )
    .unwrap();
    let program = Program::new(ASPERITY)
        .argument("tape")
        .argument("--set")
        .argument("roughness.hurst=0.61");
    let mut terminal = paused(program.env("XDG_CONFIG_HOME", config.path().to_str().unwrap()));
    assert!(
        terminal.rows()[0].starts_with("Sticky tape"),
        "{}",
        terminal.text()
    );
    assert!(row_with(&terminal, "Hurst exponent").contains("0.61"));
    terminal.send("o");
    for listed in ["pressure-sensitive  built-in", "tape  own"] {
        terminal.wait_for(listed);
    }
    terminal.send(ESCAPE);
    terminal.wait_without("Search:");
    quit(&mut terminal);
}
