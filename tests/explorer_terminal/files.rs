//! Saved, exported and copied texts.

use crate::common::deadline::within;
use crate::common::terminal::{Program, Terminal};
use crate::driving::{
    ASPERITY, CLEAR_LINE, ENTER, ESCAPE, SCENE, answer, explorer, headline, last_place, paused, quit,
    row_with, select, wait_for_another,
};
use asperity::scene::Document;
use std::fs;
use std::path::Path;
use std::process::Command;

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
        terminal.wait_for("! there is no folder no/folder: no/folder/mine.ron");
        terminal.send(ESCAPE);
        terminal.wait_without("no folder");
        quit(&mut terminal);
        let mut names: Vec<_> =
            fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, [".local", "mine.ron", "scene.ron"], "beside the folder of unsaved changes");
    });
}

/// Output of the program on a scene file, and true if the file is accepted.
fn check(path: &Path) -> (bool, String) {
    let mut command = Command::new(ASPERITY);
    command.current_dir(path.parent().unwrap()).args(["presets", "check"]).arg(path.file_name().unwrap());
    let output = command.output().unwrap();
    (output.status.success(), String::from_utf8(output.stdout).unwrap())
}

/// The screen at the start of the loading, except for the line with the times.
#[track_caller]
fn at_the_start(terminal: &mut Terminal) -> Vec<String> {
    terminal.send("<<");
    terminal.settle();
    let mut rows = terminal.rows();
    rows.retain(|row| !row.contains("F_a "));
    rows
}

#[test]
fn a_saved_scene_opens_as_it_was_left() {
    within(60, || {
        let (program, folder) = explorer();
        let mut terminal = paused(program);
        let before = headline(&terminal.rows()).unwrap();
        select(&mut terminal, "κ");
        terminal.send("h");
        let force = wait_for_another(&mut terminal, &before);
        select(&mut terminal, "seed");
        terminal.send("l");
        let force = wait_for_another(&mut terminal, &force);
        terminal.send("s");
        answer(&mut terminal, "Save as: ", "mine.ron");
        terminal.wait_for("saved to mine.ron");
        terminal.send("g");
        let left = at_the_start(&mut terminal);
        quit(&mut terminal);

        let text = fs::read_to_string(folder.path().join("mine.ron")).unwrap();
        assert!(text.contains("(effective_modulus: 2.0e6), // soft"), "{text}");
        let differing = text.lines().zip(SCENE.lines()).filter(|(now, before)| now != before).count();
        assert_eq!((text.lines().count(), differing), (SCENE.lines().count(), 2), "{text}");
        let mut terminal = paused(Program::new(ASPERITY).argument("mine.ron").folder(folder.path()));
        assert_eq!(headline(&terminal.rows()), Some(force));
        assert_eq!(at_the_start(&mut terminal), left);
        quit(&mut terminal);
    });
}

/// Standard output of the program in a folder, for a command line of a shell.
fn shell(folder: &Path, line: &str) -> Vec<u8> {
    let programs = Path::new(ASPERITY).parent().unwrap().display().to_string();
    let path = format!("{programs}:/usr/bin:/bin");
    let output = Command::new("/bin/sh").current_dir(folder).env("PATH", path).arg("-c").arg(line).output();
    let output = output.unwrap();
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

/// Bytes from their base64.
fn from_base64(text: &[u8]) -> Vec<u8> {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut bytes = Vec::new();
    let (mut bits, mut count) = (0_u32, 0);
    for digit in text.iter().filter(|byte| **byte != b'=') {
        let value = DIGITS.iter().position(|one| one == digit).expect("a digit of base64");
        (bits, count) = ((bits << 6 | value as u32) & 0xffff, count + 6);
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    bytes
}

/// The last text sent to the clipboard of the terminal.
fn copied(terminal: &Terminal) -> Option<String> {
    let bytes = terminal.written();
    let start = last_place(bytes, b"\x1b]52;c;")? + b"\x1b]52;c;".len();
    let rest = &bytes[start..];
    let end = rest.iter().position(|byte| matches!(byte, 0x1b | 0x07))?;
    Some(String::from_utf8(from_base64(&rest[..end])).unwrap())
}

#[test]
fn the_command_that_is_copied_gives_the_same_curve() {
    within(60, || {
        let (program, folder) = explorer();
        // A name that a shell would split into words.
        fs::rename(folder.path().join("scene.ron"), folder.path().join("my 'scene' $1.ron")).unwrap();
        let home = folder.path().to_str().unwrap();
        drop(program);
        let program =
            Program::new(ASPERITY).argument("my 'scene' $1.ron").folder(folder.path()).env("HOME", home);
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
        assert!(row_with(&terminal, "copied: ").starts_with(&format!("copied: {command}")), "{command}");
        terminal.send("E");
        answer(&mut terminal, "Export to (.csv .npy .json .svg .png .txt): ", "curve.csv");
        terminal.wait_for("exported to curve.csv");
        quit_anyway(&mut terminal);

        let arguments = command.strip_prefix("asperity ").expect("it is a command of asperity");
        assert!(arguments.contains("--set adhesion.kappa="), "{command}");
        let curve = shell(folder.path(), &format!("asperity run {arguments} --format csv"));
        assert_eq!(fs::read(folder.path().join("curve.csv")).unwrap(), curve);
    });
}

/// Leaves without saving a changed scene.
fn quit_anyway(terminal: &mut Terminal) {
    terminal.send("q");
    terminal.wait_for("unsaved changes");
    quit(terminal);
}

#[test]
fn curve_figures_and_panes_are_exported() {
    within(60, || {
        let (program, folder) = explorer();
        let mut terminal = paused(program);
        terminal.send("<");
        terminal.settle();
        for name in ["out.csv", "out.json", "out.svg", "out.txt"] {
            terminal.send("E");
            answer(&mut terminal, "Export to (.csv .npy .json .svg .png .txt): ", name);
            terminal.wait_for(&format!("exported to {name}"));
        }
        let file = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
        assert_eq!(file("out.csv").into_bytes(), shell(folder.path(), "asperity run scene.ron --format csv"));
        let json = |text: &str| serde_json::from_str::<serde_json::Value>(text).unwrap();
        let run = String::from_utf8(shell(folder.path(), "asperity run scene.ron --format json")).unwrap();
        let (exported, run) = (json(&file("out.json")), json(&run));
        for part in ["adhesion_force", "regime", "legs", "curve", "scene"] {
            assert_eq!(exported.get(part), run.get(part), "{part}");
        }
        assert!(exported["adhesion_force"].as_f64().is_some_and(|force| force > 0.0));

        // The panes are those on the screen, except for the line with the notice of the export.
        let screen = terminal.rows();
        let text = file("out.txt");
        let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
        assert_eq!(lines.len(), screen.len());
        for (row, (line, shown)) in lines.iter().zip(&screen).enumerate() {
            assert!(line == shown || row == screen.len() - 2, "{row}\n{line}\n{shown}");
        }
        assert!(lines[screen.len() - 2].starts_with("F_a "), "{}", lines[screen.len() - 2]);
        let picture = file("out.svg");
        assert!(picture.trim_start().starts_with("<svg") && picture.trim_end().ends_with("</svg>"));
        assert!(picture.contains("<title>Rough line</title>"), "{}", &picture[..300]);

        // An existing file is not overwritten without a question, and the name must have a known extension.
        terminal.send("E");
        answer(&mut terminal, "Export to (.csv .npy .json .svg .png .txt): ", "out.csv");
        terminal.wait_for("out.csv exists. Overwrite it?");
        terminal.send("n");
        terminal.wait_without("Overwrite");
        terminal.send("E");
        answer(&mut terminal, "Export to (.csv .npy .json .svg .png .txt): ", "out.pdf");
        terminal.wait_for("unsupported file extension .pdf; use .csv, .npy, .json, .svg, .png or .txt");
        terminal.send(ESCAPE);
        terminal.wait_without("unsupported");
        quit(&mut terminal);
        assert!(!folder.path().join("out.pdf").exists());
    });
}
