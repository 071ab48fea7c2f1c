//! The program in a terminal, as it is used: keys are typed, the screen is read, the window changes its
//! size or goes away, and in the end the terminal is as it was.
//!
//! The engine that panics is the example `panicking_engine`, which stands in `examples/` beside the
//! program: `cargo test` builds both, `cargo test --test explorer_terminal` builds the example only
//! after `cargo build --examples`.
#![cfg(target_os = "linux")]

mod common {
    pub mod deadline;
    pub mod terminal;
}

use asperity::scene::{Document, presets};
use common::deadline::within;
use common::terminal::{BEGIN_FRAME, END_FRAME, Program, Terminal};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

const ASPERITY: &str = env!("CARGO_BIN_EXE_asperity");

const ENTER: &str = "\r";
const ESCAPE: &str = "\x1b";
const CLEAR_LINE: &str = "\x15";
const INTERRUPT: &str = "\x03";

const ENTER_ALTERNATE_SCREEN: &[u8] = b"\x1b[?1049h";
const LEAVE_ALTERNATE_SCREEN: &[u8] = b"\x1b[?1049l";
const SHOW_CURSOR: &[u8] = b"\x1b[?25h";
const HIDE_CURSOR: &[u8] = b"\x1b[?25l";

/// A scene that is computed at once and whose fields are few.
const SCENE: &str = r#"(
    version: 1,
    title: "Rough line",
    material: (effective_modulus: 2.0e6), // soft
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (8, 256), seed: 1),
    adhesion: (kappa: 8.0),
    loading: [ToForce(2.0e-5), ToSeparation],
    numerics: (points: 1024, samples: 64),
)
"#;

/// The explorer on the scene above, in a folder of its own, and the scene's file.
fn explorer() -> (Program, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.ron"), SCENE).unwrap();
    (Program::new(ASPERITY).argument("scene.ron").folder(folder.path()), folder)
}

/// The explorer once it shows its curve, its animation paused.
fn paused(program: Program) -> Terminal {
    let mut terminal = program.start();
    terminal.wait_for("F_a ");
    terminal.send(".");
    terminal.settle();
    terminal
}

/// The row in which a text stands.
fn row_with(terminal: &Terminal, text: &str) -> String {
    terminal
        .rows()
        .into_iter()
        .find(|row| row.contains(text))
        .unwrap_or_else(|| panic!("no {text}:\n{}", terminal.text()))
}

/// The adhesion force as the screen tells it: a number and its unit.
fn headline(rows: &[String]) -> Option<String> {
    let after = rows.iter().find_map(|row| row.split_once("F_a "))?.1;
    let words: Vec<&str> = after.split_whitespace().take(2).collect();
    Some(words.join(" "))
}

/// Waits for another adhesion force than this one, and gives it.
#[track_caller]
fn wait_for_another(terminal: &mut Terminal, force: &str) -> String {
    terminal.wait("other force", |rows| headline(rows).is_some_and(|now| now != force));
    headline(&terminal.rows()).expect("a force is shown")
}

/// Selects a parameter by its name, by keys.
#[track_caller]
fn select(terminal: &mut Terminal, name: &str) {
    let marked = |rows: &[String]| rows.iter().find(|row| row.contains('›')).cloned();
    terminal.send("g");
    terminal.settle();
    for _ in 0..40 {
        let before =
            marked(&terminal.rows()).unwrap_or_else(|| panic!("nothing selected:\n{}", terminal.text()));
        if before.split('›').nth(1).is_some_and(|row| row.contains(name)) {
            return;
        }
        terminal.send("j");
        terminal.wait("other row selected", |rows| marked(rows).is_some_and(|now| now != before));
    }
    panic!("no parameter {name}:\n{}", terminal.text());
}

fn count(bytes: &[u8], part: &[u8]) -> usize {
    bytes.windows(part.len()).filter(|window| *window == part).count()
}

fn place(bytes: &[u8], part: &[u8]) -> Option<usize> {
    bytes.windows(part.len()).position(|window| window == part)
}

fn last_place(bytes: &[u8], part: &[u8]) -> Option<usize> {
    bytes.windows(part.len()).rposition(|window| window == part)
}

/// The terminal as a program should leave it: its own screen again, with cursor and echo.
#[track_caller]
fn assert_given_back(terminal: &Terminal) {
    let bytes = terminal.written();
    let left = last_place(bytes, LEAVE_ALTERNATE_SCREEN).expect("the alternate screen is left");
    assert!(left > last_place(bytes, ENTER_ALTERNATE_SCREEN).expect("it was entered"));
    let shown = last_place(bytes, SHOW_CURSOR).expect("the cursor is shown");
    assert!(last_place(bytes, HIDE_CURSOR).is_none_or(|hidden| hidden < shown));
    assert!(!terminal.screen().alternate_screen() && !terminal.screen().hide_cursor());
    assert!(!terminal.screen().bracketed_paste());
    assert!(terminal.is_as_before(), "line by line and with echo, as before");
}

/// Leaves the explorer as it is meant to be left.
#[track_caller]
fn quit(terminal: &mut Terminal) {
    terminal.send("q");
    assert!(terminal.wait_end().success());
    assert_given_back(terminal);
    assert_eq!(terminal.text().trim(), "", "nothing is left on the screen");
}

/// The numbers of all select-graphic-rendition sequences.
fn renditions(bytes: &[u8]) -> Vec<Vec<u16>> {
    let mut found = Vec::new();
    for part in bytes.split(|byte| *byte == 0x1b).skip(1) {
        let Some(part) = part.strip_prefix(b"[") else { continue };
        let length = part.iter().take_while(|byte| byte.is_ascii_digit() || **byte == b';').count();
        if part.get(length) == Some(&b'm') {
            let text = std::str::from_utf8(&part[..length]).unwrap();
            found.push(text.split(';').map(|number| number.parse().unwrap_or(0)).collect());
        }
    }
    found
}

/// Whether a rendition sets a colour; to go back to the terminal's own is none.
fn is_colour(rendition: &[u16]) -> bool {
    rendition.iter().any(|number| matches!(number, 30..=38 | 40..=48 | 58 | 90..=97 | 100..=107))
}

#[test]
fn the_first_frame_has_all_panes_and_the_next_the_curve() {
    within(40, || {
        // Without a scene it opens one of its own.
        let mut terminal = Program::new(ASPERITY).start();
        for pane in ["Force", "Profile", "Fragments", "Parameters", "Young's modulus", "q quit"] {
            terminal.wait_for(pane);
        }
        assert!(terminal.screen().alternate_screen() && terminal.screen().hide_cursor());
        assert!(!terminal.is_as_before(), "keys come one by one");
        terminal.wait_for("F_a ");
        let bytes = terminal.written();
        let computing = place(bytes, "computing".as_bytes()).expect("it says that it computes");
        assert!(computing < place(bytes, b"F_a ").unwrap());
        let frame = place(bytes, END_FRAME).unwrap();
        assert!(place(&bytes[..frame], b"Parameters").is_some(), "the panes are in the first frame");
        quit(&mut terminal);
    });
}

#[test]
fn whatever_is_drawn_is_drawn_in_whole_frames() {
    within(40, || {
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
        let rest = String::from_utf8_lossy(rest);
        assert!(rest.len() < 64 && rest.contains("\x1b[?1049l"), "{rest:?}");
    });
}

#[test]
fn an_edit_changes_the_adhesion_force_and_undo_brings_it_back() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let before = headline(&terminal.rows()).unwrap();
        select(&mut terminal, "κ");
        terminal.send("h");
        let after = wait_for_another(&mut terminal, &before);
        terminal.wait_for("[changed]");
        terminal.send("u");
        assert_eq!(wait_for_another(&mut terminal, &after), before);
        terminal.wait_without("[changed]");
        quit(&mut terminal);
    });
}

#[test]
fn a_value_is_typed_with_its_unit() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let before = headline(&terminal.rows()).unwrap();
        select(&mut terminal, "effective modulus");
        terminal.send("e");
        terminal.wait_for("Esc cancel");
        terminal.send(CLEAR_LINE);
        // Letters are letters while a value is typed, even those that are keys elsewhere.
        terminal.send("3 q");
        terminal.wait_for("3 q");
        terminal.send("\x7f");
        terminal.send("MPa");
        terminal.wait_for("3 MPa");
        terminal.send(ENTER);
        wait_for_another(&mut terminal, &before);
        assert!(row_with(&terminal, "effective modulus").contains("3 MPa"), "{}", terminal.text());
        terminal.send("u");
        terminal.wait_without("[changed]");
        quit(&mut terminal);
    });
}

#[test]
fn a_value_is_pasted_and_a_wrong_one_refused() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let before = headline(&terminal.rows()).unwrap();
        select(&mut terminal, "Hurst exponent");
        terminal.send("e");
        terminal.wait_for("Esc cancel");
        terminal.send(CLEAR_LINE);
        terminal.send("\x1b[200~1.5\r\nq\x1b[201~");
        terminal.wait_for("1.5q");
        terminal.send("\x7f");
        terminal.send(ENTER);
        terminal.wait_for("1.5: allowed: above 0 and below 1");
        assert!(row_with(&terminal, "Hurst exponent").contains("0.7"), "the last good value is kept");
        assert!(!terminal.text().contains("[changed]"));
        terminal.send("j");
        terminal.wait_without("allowed: above 0 and below 1");
        assert_eq!(headline(&terminal.rows()), Some(before));
        quit(&mut terminal);
    });
}

#[test]
fn keys_typed_before_the_first_frame_are_not_lost() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = program.start();
        terminal.send(".jjj?");
        terminal.wait_for("What you see");
        terminal.send("?");
        terminal.wait_without("What you see");
        let rows = terminal.rows();
        let place = |text: &str| rows.iter().position(|row| row.contains(text)).expect("it is in the list");
        assert_eq!(place("›"), place("effective modulus") + 2, "{}", terminal.text());
        // Typed before the terminal was taken, they were echoed; that is all that is left.
        terminal.send("q");
        assert!(terminal.wait_end().success());
        assert_given_back(&terminal);
    });
}

#[test]
fn another_size_of_the_window_is_filled() {
    within(60, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let before = terminal.text();
        for (columns, rows) in [(40, 12), (20, 5), (200, 50), (120, 40)] {
            terminal.resize(columns, rows);
            terminal.wait_for("F_a ");
            terminal.settle();
            let filled = terminal.rows().iter().filter(|row| !row.is_empty()).count();
            assert!(filled + 2 >= usize::from(rows).min(40), "{columns} × {rows}:\n{}", terminal.text());
        }
        assert_eq!(terminal.text(), before);
        quit(&mut terminal);
    });
}

#[test]
fn a_window_that_shrinks_and_grows_back_at_once_is_drawn_anew() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let before = terminal.text();
        for _ in 0..30 {
            terminal.resize(40, 12);
            terminal.resize(120, 40);
            terminal.wait("screen as before", |rows| rows.join("\n") == before);
        }
        quit(&mut terminal);
    });
}

#[test]
fn a_window_of_one_cell_is_survived() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = program.size(1, 1).start();
        terminal.wait("first frame", |rows| !rows[0].is_empty());
        terminal.send(".?");
        terminal.send(ESCAPE);
        for (columns, rows) in [(2, 1), (1, 50), (300, 1), (1, 1)] {
            terminal.resize(columns, rows);
            terminal.settle();
        }
        terminal.resize(120, 40);
        terminal.wait_for("F_a ");
        quit(&mut terminal);
    });
}

#[test]
fn keys_and_changes_of_the_window_that_come_together_all_count() {
    within(60, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let marked = |rows: &[String]| rows.iter().find(|row| row.contains('›')).cloned();
        for round in 0..60 {
            let before = marked(&terminal.rows()).expect("a parameter is selected");
            let name: String = before.split('›').nth(1).expect("it has a name").chars().take(16).collect();
            // The width of this window tells on the screen that the size has come.
            terminal.resize(100 + round % 2, 40);
            terminal.send(if round / 10 % 2 == 0 { "j" } else { "k" });
            terminal.wait("other row selected", |rows| marked(rows).is_some_and(|row| !row.contains(&name)));
            let right = 99 + usize::from(round % 2);
            terminal
                .wait("frame at the edge", |rows| rows.iter().any(|row| row.chars().nth(right) == Some('┐')));
        }
        quit(&mut terminal);
    });
}

#[test]
fn a_window_that_changes_while_the_animation_plays_is_survived() {
    within(60, || {
        let (program, _folder) = explorer();
        let mut terminal = program.start();
        terminal.wait_for("F_a ");
        for round in 0..60 {
            let (columns, rows) = if round % 2 == 0 { (30 + round, 8) } else { (120, 40) };
            terminal.resize(columns, rows);
            // Two frames of the animation, or as much as fits.
            terminal.is_silent_for(Duration::from_millis(20));
            terminal.is_silent_for(Duration::from_millis(20));
        }
        terminal.wait_for("F_a ");
        quit(&mut terminal);
    });
}

#[test]
fn help_opens_scrolls_and_closes() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let before = terminal.text();
        for (open, close) in [("?", "?"), ("?", ESCAPE), ("\x1bOP", "q")] {
            terminal.send(open);
            terminal.wait_for("play or pause");
            terminal.send("jjjjjjjjjjjjj");
            terminal.wait_without("play or pause");
            terminal.send(close);
            terminal.wait("screen as before", |rows| rows.join("\n") == before);
        }
        quit(&mut terminal);
    });
}

#[test]
fn what_is_saved_is_a_scene_and_is_overwritten_only_when_asked() {
    within(60, || {
        let (program, folder) = explorer();
        let mut terminal = paused(program);
        let save_as = |terminal: &mut Terminal, name: &str| {
            terminal.send("s");
            terminal.wait_for("Save as: ");
            terminal.send(CLEAR_LINE);
            terminal.send(name);
            terminal.wait_for(&format!("Save as: {name}"));
            terminal.send(ENTER);
        };
        select(&mut terminal, "κ");
        terminal.send("h");
        terminal.wait_for("[changed]");
        save_as(&mut terminal, "mine.ron");
        terminal.wait_for("saved to mine.ron");
        terminal.wait_without("[changed]");
        let path = folder.path().join("mine.ron");
        let first = fs::read_to_string(&path).unwrap();
        assert!(first.contains("// soft") && first != SCENE);
        assert!(Document::parse(&first, "mine.ron").is_ok());
        assert_eq!(check(&path), (true, "mine.ron: ok\n".to_owned()));

        terminal.send("h");
        terminal.wait_for("[changed]");
        save_as(&mut terminal, "mine.ron");
        terminal.wait_for("Overwrite");
        terminal.send("n");
        terminal.wait_without("Overwrite");
        assert_eq!(fs::read_to_string(&path).unwrap(), first);
        save_as(&mut terminal, "mine.ron");
        terminal.wait_for("Overwrite");
        terminal.send("y");
        terminal.wait_for("saved to mine.ron");
        assert_ne!(fs::read_to_string(&path).unwrap(), first);
        assert!(check(&path).0);

        save_as(&mut terminal, "no/folder/mine.ron");
        terminal.wait_for("not saved");
        quit(&mut terminal);
        let mut names: Vec<_> =
            fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["mine.ron", "scene.ron"], "nothing else is left behind");
    });
}

/// What the program says of a scene file, and whether it accepts it.
fn check(path: &Path) -> (bool, String) {
    let mut command = Command::new(ASPERITY);
    command.current_dir(path.parent().unwrap()).args(["presets", "check"]).arg(path.file_name().unwrap());
    let output = command.output().unwrap();
    (output.status.success(), String::from_utf8(output.stdout).unwrap())
}

#[test]
fn a_changed_scene_asks_before_it_is_left() {
    within(40, || {
        let (program, folder) = explorer();
        let mut terminal = paused(program);
        select(&mut terminal, "κ");
        terminal.send("h");
        terminal.wait_for("[changed]");
        for (ask, stay) in [("q", "n"), (INTERRUPT, ESCAPE)] {
            terminal.send(ask);
            terminal.wait_for("unsaved changes");
            terminal.send(stay);
            terminal.wait_without("unsaved changes");
        }
        terminal.send("q");
        terminal.wait_for("unsaved changes");
        terminal.send("s");
        terminal.wait_for("Save as: scene.ron");
        terminal.send(ENTER);
        terminal.wait_for("Overwrite");
        terminal.send("y");
        assert!(terminal.wait_end().success());
        assert_given_back(&terminal);
        assert_ne!(fs::read_to_string(folder.path().join("scene.ron")).unwrap(), SCENE);
    });
}

#[test]
fn a_changed_scene_can_be_left_as_it_is() {
    within(40, || {
        let (program, folder) = explorer();
        let mut terminal = paused(program);
        select(&mut terminal, "κ");
        terminal.send("h");
        terminal.wait_for("[changed]");
        terminal.send("q");
        terminal.wait_for("unsaved changes");
        quit(&mut terminal);
        assert_eq!(fs::read_to_string(folder.path().join("scene.ron")).unwrap(), SCENE);
    });
}

#[test]
fn an_interrupt_leaves_the_explorer_cleanly() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        terminal.send(INTERRUPT);
        assert!(terminal.wait_end().success());
        assert_given_back(&terminal);
    });
}

#[test]
fn number_keys_open_built_in_scenes() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        for (key, preset) in ["1", "2", "3"].iter().zip(presets()) {
            let title = Document::parse(preset.text, preset.name).unwrap().scene().title.clone();
            terminal.send(key);
            terminal.wait("title", |rows| rows[0].starts_with(&title));
            terminal.wait_without("computing");
        }
        quit(&mut terminal);
    });
}

#[test]
fn fields_are_overridden_from_the_command_line() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program.argument("--set").argument("roughness.hurst=0.61"));
        assert!(row_with(&terminal, "Hurst exponent").contains("0.61"));
        quit(&mut terminal);
    });
}

#[test]
fn without_colours_there_is_emphasis_and_no_colour() {
    within(60, || {
        let shown = |name: &str, value: &str| {
            let (program, _folder) = explorer();
            let mut terminal = paused(program.env(name, value));
            terminal.send("s");
            terminal.wait_for("Save as: ");
            terminal.send(ESCAPE);
            terminal.wait_without("Save as: ");
            terminal.send("?");
            terminal.wait_for("What you see");
            terminal.send("?");
            quit(&mut terminal);
            renditions(terminal.written())
        };
        let plain = shown("NO_COLOR", "1");
        let coloured: Vec<_> = plain.iter().filter(|one| is_colour(one)).collect();
        assert!(coloured.is_empty(), "{coloured:?}");
        assert!(plain.iter().any(|one| one.contains(&1)), "titles are bold");
        assert!(plain.iter().any(|one| one.contains(&7)), "what is selected is reversed");
        // An empty one counts as none.
        for (name, value) in [("NO_COLOR", ""), ("COLUMNS", "1")] {
            assert!(shown(name, value).iter().any(|one| is_colour(one)), "{name}={value}");
        }
    });
}

#[test]
fn over_a_connection_and_without_a_known_terminal_it_works_the_same() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut near = paused(program);
        for far in [
            explorer().0.env("SSH_CONNECTION", "192.0.2.1 50000 192.0.2.2 22"),
            explorer().0.env("SSH_TTY", "/dev/pts/1"),
            explorer().0.without_env("TERM"),
            explorer().0.env("TERM", "linux").env("LANG", "C"),
        ] {
            // Its own folder is gone by now, and with it its scene.
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join("scene.ron"), SCENE).unwrap();
            let mut far = paused(far.folder(folder.path()));
            assert_eq!(headline(&far.rows()), headline(&near.rows()));
            quit(&mut far);
        }
        quit(&mut near);
    });
}

/// Ticks of processor time the process has used, and how often one of its threads was woken.
fn activity(pid: u32) -> (u64, u64) {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap();
    // The name of the program, in brackets, may hold anything.
    let fields: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
    let ticks = fields[11].parse::<u64>().unwrap() + fields[12].parse::<u64>().unwrap();
    let mut switches = 0;
    for thread in fs::read_dir(format!("/proc/{pid}/task")).unwrap() {
        let status = fs::read_to_string(thread.unwrap().path().join("status")).unwrap();
        for line in status.lines().filter(|line| line.contains("ctxt_switches")) {
            switches += line.rsplit(char::is_whitespace).next().unwrap().parse::<u64>().unwrap();
        }
    }
    (ticks, switches)
}

#[track_caller]
fn assert_idle(terminal: &mut Terminal) {
    terminal.settle();
    let before = activity(terminal.pid());
    assert!(terminal.is_silent_for(Duration::from_millis(400)), "it writes:\n{}", terminal.text());
    assert_eq!(activity(terminal.pid()), before, "it is awake");
}

#[test]
fn nothing_happens_while_nothing_happens() {
    within(60, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program.env("SSH_CONNECTION", "192.0.2.1 50000 192.0.2.2 22"));
        assert_idle(&mut terminal);
        // With a window open above the panes, too.
        terminal.send("?");
        terminal.wait_for("What you see");
        assert_idle(&mut terminal);
        terminal.send("?");
        terminal.wait_without("What you see");
        // Played to its end it stops by itself: to the last leg, near its end, and on.
        terminal.send(">");
        terminal.settle();
        terminal.send(&".".repeat(110));
        terminal.settle();
        let before = terminal.text();
        terminal.send(" ");
        terminal.wait("next moment", |rows| rows.join("\n") != before);
        assert_idle(&mut terminal);
        quit(&mut terminal);
    });
}

#[test]
fn the_animation_goes_on_while_it_plays() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = program.start();
        terminal.wait_for("F_a ");
        for _ in 0..5 {
            let before = terminal.text();
            terminal.wait("next moment", |rows| rows.join("\n") != before);
        }
        terminal.send(" ");
        assert_idle(&mut terminal);
        quit(&mut terminal);
    });
}

#[test]
fn a_terminal_that_goes_away_ends_the_explorer() {
    within(60, || {
        for keys in [".", ""] {
            let (program, _folder) = explorer();
            let mut terminal = program.start();
            terminal.wait_for("F_a ");
            terminal.send(keys);
            terminal.hang_up();
            terminal.wait_end();
        }
    });
}

#[test]
fn a_terminal_that_goes_away_ends_the_explorer_even_if_hang_ups_are_ignored() {
    within(60, || {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.ron"), SCENE).unwrap();
        let mut terminal = Program::new("/bin/sh")
            .argument("-c")
            .argument(format!("trap '' HUP; exec '{ASPERITY}' scene.ron"))
            .folder(folder.path())
            .start();
        terminal.wait_for("F_a ");
        terminal.send(".");
        terminal.settle();
        terminal.hang_up();
        terminal.wait_end();
    });
}

#[test]
fn a_hang_up_signal_ends_the_explorer() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let kill = Command::new("/bin/sh").arg("-c").arg(format!("kill -HUP {}", terminal.pid())).status();
        assert!(kill.unwrap().success());
        assert!(!terminal.wait_end().success());
    });
}

#[test]
fn a_misspelt_scene_is_told_without_taking_the_terminal() {
    within(40, || {
        for (name, said) in [("jkr-spere", "did you mean jkr-sphere?"), ("none.ron", "none.ron")] {
            let mut terminal = Program::new(ASPERITY).argument(name).start();
            let status = terminal.wait_end();
            assert_eq!(status.exit_code(), 1);
            assert!(terminal.text().contains(said), "{}", terminal.text());
            assert!(!terminal.written().contains(&0x1b), "{}", terminal.text());
            assert!(terminal.is_as_before());
        }
    });
}

#[test]
fn without_a_terminal_it_says_what_to_do() {
    within(40, || {
        let output = Command::new(ASPERITY).arg("jkr-sphere").stdin(Stdio::null()).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(told.contains("asperity run jkr-sphere") && !told.contains('\x1b'), "{told}");
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
            assert!(terminal.text().contains("asperity run jkr-sphere"), "{}", terminal.text());
            assert!(!terminal.written().contains(&0x1b), "{}", terminal.text());
            assert!(fs::read(folder.path().join("written")).unwrap_or_default().is_empty());
        }
    });
}

/// The explorer with the engine that panics on the seed 13.
fn panicking() -> Program {
    let folder = Path::new(ASPERITY).parent().expect("the program stands in a folder");
    let path: PathBuf = folder.join("examples").join("panicking_engine");
    assert!(path.exists(), "{} is not built: cargo build --examples", path.display());
    Program::new(path)
}

#[test]
fn a_panic_of_the_engine_is_a_line_and_the_explorer_goes_on() {
    within(60, || {
        let mut terminal = paused(panicking());
        let before = headline(&terminal.rows()).unwrap();
        let seed = |terminal: &mut Terminal, seed: &str| {
            terminal.send("e");
            terminal.wait_for("Esc cancel");
            terminal.send(CLEAR_LINE);
            terminal.send(seed);
            terminal.send(ENTER);
        };
        select(&mut terminal, "seed");
        seed(&mut terminal, "13");
        terminal.wait_for("thirteen is unlucky");
        assert!(row_with(&terminal, "thirteen").contains("internal error"), "{}", terminal.text());
        assert!(terminal.screen().alternate_screen(), "the explorer is still there");
        assert!(!terminal.text().contains("panicked at"), "{}", terminal.text());
        terminal.send("..");
        assert_idle(&mut terminal);
        seed(&mut terminal, "1");
        terminal.wait_without("thirteen is unlucky");
        terminal.wait("force as before", |rows| headline(rows).as_ref() == Some(&before));
        quit(&mut terminal);
    });
}

#[test]
fn a_panic_while_drawing_gives_the_terminal_back_and_tells_why() {
    within(60, || {
        let mut terminal = paused(panicking().argument("draw"));
        select(&mut terminal, "seed");
        terminal.send("e");
        terminal.wait_for("Esc cancel");
        terminal.send(CLEAR_LINE);
        terminal.send("13");
        terminal.send(ENTER);
        assert_eq!(terminal.wait_end().exit_code(), 101);
        assert_given_back(&terminal);
        // Told below one another: the terminal starts each line at its left again.
        let told = terminal.rows();
        assert!(told.iter().any(|row| row.starts_with("thirteen is unlucky")), "{}", terminal.text());
    });
}
