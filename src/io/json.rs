//! Readable JSON: outer entries on lines of their own, inner ones together.

use crate::text::is_control;
use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};
use std::io::{self, Write};

/// Nesting depth beyond which entries share one line.
const BROKEN_LEVELS: usize = 2;

/// Writes a value as JSON with a line for every entry of its two outer levels.
pub fn write_json_value(out: &mut (impl Write + ?Sized), value: &impl Serialize) -> io::Result<()> {
    let mut serializer = Serializer::with_formatter(&mut *out, Lines::default());
    value.serialize(&mut serializer)?;
    writeln!(out)
}

#[derive(Default)]
struct Lines {
    depth: usize,
    /// True if the innermost value, open or just closed, has entries.
    filled: bool,
}

impl Lines {
    fn open<W: ?Sized + Write>(&mut self, out: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth += 1;
        self.filled = false;
        out.write_all(bracket)
    }

    fn close<W: ?Sized + Write>(&mut self, out: &mut W, bracket: &[u8]) -> io::Result<()> {
        let broken = self.filled && self.depth <= BROKEN_LEVELS;
        self.depth -= 1;
        self.filled = true;
        if broken {
            self.new_line(out)?;
        }
        out.write_all(bracket)
    }

    fn entry<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.filled = true;
        match (first, self.depth <= BROKEN_LEVELS) {
            (true, true) => self.new_line(out),
            (false, true) => {
                out.write_all(b",")?;
                self.new_line(out)
            }
            (true, false) => Ok(()),
            (false, false) => out.write_all(b", "),
        }
    }

    fn new_line<W: ?Sized + Write>(&self, out: &mut W) -> io::Result<()> {
        write!(out, "\n{:width$}", "", width = 2 * self.depth)
    }
}

impl Formatter for Lines {
    fn write_string_fragment<W: ?Sized + Write>(&mut self, out: &mut W, fragment: &str) -> io::Result<()> {
        let mut rest = fragment;
        // Escapes characters that JSON allows and a terminal does not; the text is read back unchanged.
        while let Some((place, c)) = rest.char_indices().find(|(_, c)| is_control(*c)) {
            write!(out, "{}\\u{:04x}", &rest[..place], u32::from(c))?;
            rest = &rest[place + c.len_utf8()..];
        }
        out.write_all(rest.as_bytes())
    }

    fn begin_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open(out, b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.close(out, b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.entry(out, first)
    }

    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open(out, b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.close(out, b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.entry(out, first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        out.write_all(b": ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn control_characters_are_escaped_and_read_back() {
        let value = json!({"a": "\u{9b}2J\u{7f} κ \u{202e}\u{1b}\n"});
        let mut text = Vec::new();
        write_json_value(&mut text, &value).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(text.contains(r#""\u009b2J\u007f κ \u202e\u001b\n""#), "{text}");
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
    }

    #[test]
    fn outer_entries_have_lines_of_their_own() {
        let value = json!({"a": [[1, 2], [3]], "b": {}, "c": {"d": [], "e": {"f": [1]}}, "g": []});
        let mut text = Vec::new();
        write_json_value(&mut text, &value).unwrap();
        let text = String::from_utf8(text).unwrap();
        let expected = r#"{
  "a": [
    [1, 2],
    [3]
  ],
  "b": {},
  "c": {
    "d": [],
    "e": {"f": [1]}
  },
  "g": []
}
"#;
        assert_eq!(text, expected);
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
    }
}
