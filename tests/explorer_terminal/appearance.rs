//! Colours and markers.

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
}
