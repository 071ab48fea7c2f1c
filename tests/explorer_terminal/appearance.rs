//! Colours and markers.

use crate::common::deadline::within;
use crate::common::terminal::Terminal;
use crate::driving::{ESCAPE, explorer, paused, quit};

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

/// True if a rendition sets a colour; a reset to the default of the terminal does not.
fn is_colour(rendition: &[u16]) -> bool {
    rendition.iter().any(|number| matches!(number, 30..=38 | 40..=48 | 58 | 90..=97 | 100..=107))
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
        assert!(plain.iter().any(|one| one.contains(&7)), "the selected row is reversed");
        // An empty variable counts as unset.
        for (name, value) in [("NO_COLOR", ""), ("COLUMNS", "1")] {
            assert!(shown(name, value).iter().any(|one| is_colour(one)), "{name}={value}");
        }
    });
}

/// The explorer on its scene, paused, with an argument or two.
fn opened(arguments: &[&str], environment: &[(&str, &str)]) -> (Terminal, tempfile::TempDir) {
    let (mut program, folder) = explorer();
    for argument in arguments {
        program = program.argument(argument);
    }
    for (name, value) in environment {
        program = program.env(name, value);
    }
    (paused(program), folder)
}

fn is_braille(character: char) -> bool {
    ('\u{2801}'..='\u{28ff}').contains(&character)
}

fn is_octant(character: char) -> bool {
    ('\u{1cd00}'..='\u{1cde5}').contains(&character)
}

fn is_half_block(character: char) -> bool {
    "▀▄█".contains(character)
}

/// A marker, and a function that is true for its characters.
type Made = (&'static str, fn(char) -> bool);

const MARKERS: [Made; 3] = [("braille", is_braille), ("octant", is_octant), ("half-block", is_half_block)];

#[test]
fn plots_are_made_of_the_marker_that_is_wanted() {
    within(60, || {
        for (name, is_of_it) in MARKERS {
            let (mut terminal, _folder) = opened(&["--marker", name], &[]);
            // The bars of the histogram are blocks with every marker, so the force curve is examined.
            let curve = |terminal: &Terminal| {
                let rows = terminal.rows();
                let columns = rows[4..18].iter().map(|row| row.chars().skip(80).collect::<String>());
                columns.collect::<Vec<_>>().join("\n")
            };
            let curve = curve(&terminal);
            assert!(curve.chars().any(is_of_it), "{name}:\n{curve}");
            let others = MARKERS.iter().filter(|(other, _)| *other != name);
            for (other, is_of_other) in others {
                // The legend of the branches and full blocks are the same with every marker.
                let found = curve.chars().filter(|c| is_of_other(*c) && !"⠒⠂█▀▄".contains(*c)).count();
                assert_eq!(found, 0, "{name} shows {other}:\n{curve}");
            }
            quit(&mut terminal);
        }
    });
}

#[test]
fn ascii_is_ascii_to_the_last_cell() {
    within(60, || {
        let (mut terminal, _folder) = opened(&["--marker", "ascii"], &[]);
        let check = |terminal: &Terminal, what: &str| {
            assert!(terminal.text().is_ascii(), "{what}:\n{}", terminal.text());
        };
        check(&terminal, "panes");
        for (key, what) in
            [("?", "What you see"), ("o", "Search:"), ("F", "Go to the force:"), ("E", "Export")]
        {
            terminal.send(key);
            terminal.wait_for(what);
            terminal.settle();
            check(&terminal, what);
            terminal.send(ESCAPE);
            terminal.wait_without(what);
        }
        terminal.send("}");
        terminal.wait_for("manual");
        check(&terminal, "manual loading");
        quit(&mut terminal);
    });
}

#[test]
fn a_key_goes_through_markers_and_colours() {
    within(60, || {
        let (mut terminal, _folder) = opened(&[], &[]);
        let before = terminal.text();
        for name in ["octant", "half-block", "ascii", "braille"] {
            terminal.send("M");
            terminal.wait_for(&format!("markers: {name}"));
        }
        for name in ["dark", "light", "high-contrast", "plain", "neutral"] {
            terminal.send("T");
            terminal.wait_for(&format!("colours: {name}"));
        }
        // The next key removes the line, and the screen is as before.
        terminal.send("k");
        terminal.wait("screen as before", |rows| rows.join("\n") == before);
        quit(&mut terminal);
    });
}

/// True if any bright colour is used, and true if any colour is.
fn brightness(terminal: &Terminal) -> (bool, bool) {
    let all = renditions(terminal.written());
    let bright = all.iter().any(|one| {
        one.windows(3).any(|part| part[..2] == [38, 5] && (9..=15).contains(&part[2]))
            || one.iter().any(|number| (91..=97).contains(number))
    });
    (bright, all.iter().any(|one| is_colour(one)))
}

#[test]
fn colours_suit_the_background_and_the_wishes_of_the_user() {
    within(90, || {
        let light = (false, true);
        let dark = (true, true);
        let none = (false, false);
        let (to_light, to_dark) = (("COLORFGBG", "0;15"), ("COLORFGBG", "15;0"));
        let without = ("NO_COLOR", "1");
        let check = |arguments: &[&str], environment: &[(&str, &str)], wanted: (bool, bool)| {
            let (mut terminal, _folder) = opened(arguments, environment);
            quit(&mut terminal);
            assert_eq!(brightness(&terminal), wanted, "{arguments:?} {environment:?}");
        };
        check(&[], &[to_dark], dark);
        check(&[], &[to_light], light);
        check(&["--theme", "dark"], &[to_light], dark);
        check(&["--theme", "light"], &[to_dark], light);
        check(&["--theme", "plain"], &[to_dark], none);
        check(&["--theme", "high-contrast"], &[], dark);
        // NO_COLOR is obeyed, unless an argument sets a theme.
        check(&[], &[to_dark, without], none);
        check(&["--theme", "dark"], &[without], dark);
    });
}
