//! JSON written on one line.

use crate::text::is_control;
use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};
use std::io;
use std::io::Write;

/// Writes a value as JSON on one line. `head` contains further entries, each with a key and a text.
/// If the value is an object, these entries are written at the beginning of the object.
///
/// # Errors
/// Returns an error if the value cannot be converted to JSON, or if `out` cannot be written.
pub fn write_json(
    out: &mut (impl Write + ?Sized),
    value: &impl Serialize,
    head: &[(&str, &str)],
) -> io::Result<()> {
    let mut entries = Vec::new();
    for (name, text) in head {
        let separator = if entries.is_empty() { "" } else { "," };
        write!(entries, "{separator}\"{name}\":")?;
        text.serialize(&mut Serializer::with_formatter(
            &mut entries,
            Printable::default(),
        ))?;
    }
    let format = Printable {
        head: entries,
        follows: false,
    };
    value.serialize(&mut Serializer::with_formatter(&mut *out, format))?;
    writeln!(out)
}

/// JSON format that also escapes control characters that JSON allows unescaped, because a terminal
/// might obey them.
#[derive(Default)]
struct Printable {
    /// Entries to be written at the beginning of the outermost object. The list is empty as soon as
    /// the entries are written.
    head: Vec<u8>,
    /// True if the next key needs a comma before it because the entries of `head` precede it.
    follows: bool,
}

impl Formatter for Printable {
    fn write_string_fragment<W: ?Sized + Write>(
        &mut self,
        out: &mut W,
        fragment: &str,
    ) -> io::Result<()> {
        let mut rest = fragment;
        while let Some((place, c)) = rest.char_indices().find(|(_, c)| is_control(*c)) {
            write!(out, "{}\\u{:04x}", &rest[..place], u32::from(c))?;
            rest = &rest[place + c.len_utf8()..];
        }
        out.write_all(rest.as_bytes())
    }

    fn begin_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.head.clear();
        out.write_all(b"[")
    }

    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        let head = std::mem::take(&mut self.head);
        self.follows = !head.is_empty();
        out.write_all(b"{")?;
        out.write_all(&head)
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        let follows = std::mem::take(&mut self.follows);
        if first && !follows {
            Ok(())
        } else {
            out.write_all(b",")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn control_characters_are_escaped_and_read_back() {
        let value = json!({"a": "\u{9b}2J\u{7f} κ \u{202e}\u{1b}\n", "b": [{"c": 1}], "d": {}});
        let mut text = Vec::new();
        write_json(&mut text, &value, &[]).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(
            text.contains(r#""\u009b2J\u007f κ \u202e\u001b\n""#) && text.lines().count() == 1,
            "{text}"
        );
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
    }

    #[test]
    fn an_object_begins_with_its_head() {
        for (value, expected) in [
            (
                json!({"a": {"b": 1}}),
                "{\"x\":\"1\\n\",\"y\":\"2\",\"a\":{\"b\":1}}\n",
            ),
            (json!({}), "{\"x\":\"1\\n\",\"y\":\"2\"}\n"),
            (json!([{"a": 1}]), "[{\"a\":1}]\n"),
        ] {
            let mut text = Vec::new();
            write_json(&mut text, &value, &[("x", "1\n"), ("y", "2")]).unwrap();
            assert_eq!(String::from_utf8(text).unwrap(), expected);
        }
    }
}
