//! Edits of one entry in a text, with every comment preserved.

use std::ops::Range;

use super::outline::{Entry, Text};

const NOT_ONE_VALUE: &str = "not one RON value by itself, such as 1.0e-3 or (1, 512)";

/// A value without the surrounding blanks, if it is exactly one RON value.
///
/// # Errors
/// The reason why the text is not one value.
pub(in crate::scene) fn one_value(value: &str) -> Result<&str, String> {
    let value = value.trim();
    if value.is_empty() {
        return Err("a value is missing".into());
    }
    let text = Text::new(value).map_err(|unreadable| format!("not one RON value: {}", unreadable.reason))?;
    if text.is_one_value() { Ok(value) } else { Err(NOT_ONE_VALUE.into()) }
}

impl Text<'_> {
    /// The text with another value at a path.
    ///
    /// # Errors
    /// No entry with this path, or text that is not one value.
    pub fn replace(&self, path: &str, value: &str) -> Result<String, String> {
        let span = self.span(path).ok_or("there is no such element")?;
        checked(apply(self.text, vec![(span.value, value.to_string())]), path, value)
    }

    /// The text with the entry `name: value` in the group at a path, empty for the whole: after the last of the
    /// entries that precede the name in this order.
    ///
    /// # Errors
    /// No group with this path, or text that is not one value.
    pub fn insert(&self, group: &str, name: &str, value: &str, order: &[&str]) -> Result<String, String> {
        let body = self.body(group).ok_or_else(|| format!("{group} has no fields here"))?;
        let rank = |name: &str| order.iter().position(|other| *other == name);
        let entries: Vec<Entry> = self.entries(body).collect();
        let ranked = |entry: &&Entry| entry.name.and_then(rank);
        let before = entries.iter().filter(|entry| ranked(entry) < rank(name)).max_by_key(ranked);
        let entry = format!("{name}: {value}");
        let inside = self.inside(body);
        let edits = match before.or(entries.last()) {
            None => vec![(inside.start..inside.start, entry)],
            Some(anchor) => {
                let after = anchor.comma.unwrap_or(anchor.span.value.end);
                let next = entries.iter().map(|entry| entry.span.entry.start).find(|start| *start >= after);
                self.edits_after(anchor, after..next.unwrap_or(inside.end), &entry)
            }
        };
        let path = if group.is_empty() { name.to_string() } else { format!("{group}.{name}") };
        checked(apply(self.text, edits), &path, value)
    }

    /// The text without the entry at a path: undoes [`Text::insert`].
    ///
    /// # Errors
    /// No entry with this path.
    pub fn remove(&self, path: &str) -> Result<String, String> {
        let missing = "there is no such element";
        let group = path.rsplit_once('.').map_or("", |(group, _)| group);
        let body = self.body(group).ok_or(missing)?;
        let entries: Vec<Entry> = self.entries(body).collect();
        let span = self.span(path).ok_or(missing)?;
        let index = entries.iter().position(|entry| entry.span == span).ok_or(missing)?;
        let (entry, before) = (&entries[index], index.checked_sub(1).map(|before| &entries[before]));
        let end = entry.comma.unwrap_or(span.value.end);
        let comma = before.and_then(|before| before.comma);
        let next = entries.get(index + 1).map_or(self.inside(body).end, |next| next.span.entry.start);
        let start = match (comma, self.line_of_its_own(span.entry.start, end..next)) {
            (Some(_), Some(line_break)) => line_break,
            (Some(comma), None) if self.text[comma..span.entry.start].trim().is_empty() => comma,
            _ => span.entry.start,
        };
        // Without the first entry the next one begins at its place.
        let blanks = &self.text[end..next];
        let is_same_line = index + 1 < entries.len() && blanks.trim().is_empty() && !blanks.contains('\n');
        let end = if before.is_none() && is_same_line { next } else { end };
        let mut edits = vec![(start..end, String::new())];
        // The last entry without a comma leaves the previous one without a comma.
        if let (None, Some(comma)) = (entry.comma, comma) {
            edits.push((comma - 1..comma, String::new()));
        }
        Ok(apply(self.text, edits))
    }

    /// The text without these comments, and without lines that hold nothing else.
    pub(in crate::scene) fn without_comments(&self, comments: &[Range<usize>]) -> String {
        let stretch = |comment: &Range<usize>| {
            let before = self.text[..comment.start].trim_end_matches([' ', '\t']).len();
            let has_own_line = self.text[..before].ends_with('\n');
            let rest = &self.text[comment.end..];
            let is_last = rest.trim_start_matches([' ', '\t', '\r']).starts_with('\n');
            let end = match rest.find('\n').filter(|_| has_own_line && is_last) {
                Some(line_break) => comment.end + line_break + 1,
                None => comment.end,
            };
            (before..end, String::new())
        };
        apply(self.text, comments.iter().map(stretch).collect())
    }

    /// The line break before an entry, if only comments share its line; `gap` is the stretch after it.
    fn line_of_its_own(&self, start: usize, gap: Range<usize>) -> Option<usize> {
        let line_break = start - indentation(self.text, start)?.len() - 1;
        self.line_break_in(gap)?;
        Some(if self.text[..line_break].ends_with('\r') { line_break - 1 } else { line_break })
    }

    /// Edits that put an entry after another one, in the same style: on a line of its own, after the comment on the
    /// line before, or on the same line.
    fn edits_after(&self, anchor: &Entry, gap: Range<usize>, new: &str) -> Vec<(Range<usize>, String)> {
        let comma = if anchor.comma.is_some() { "," } else { "" };
        let at = |offset: usize, text: String| (offset..offset, text);
        let own_line = indentation(self.text, anchor.span.entry.start);
        match (own_line, self.line_break_in(gap.clone())) {
            (Some(indentation), Some(end)) => {
                let newline = if self.text[..end].ends_with('\r') { "\r\n" } else { "\n" };
                let end = end + 1 - newline.len();
                let missing_comma = if anchor.comma.is_some() { "" } else { "," };
                vec![
                    at(anchor.span.value.end, missing_comma.into()),
                    at(end, format!("{newline}{indentation}{new}{comma}")),
                ]
            }
            _ if anchor.comma.is_some() => vec![at(gap.start, format!(" {new},"))],
            _ => vec![at(gap.start, format!(", {new}"))],
        }
    }

    /// The first line break in a stretch of blanks and comments that is not inside a block comment.
    fn line_break_in(&self, gap: Range<usize>) -> Option<usize> {
        let mut breaks = self.text[gap.clone()].match_indices('\n').map(|(at, _)| gap.start + at);
        let is_outside = |at: &usize| !self.comments.iter().any(|comment| comment.contains(at));
        breaks.find(is_outside)
    }
}

/// The edited text, if the value at the path is now exactly the given one: a comment in the value must not swallow
/// the text behind it.
fn checked(text: String, path: &str, value: &str) -> Result<String, String> {
    let is_whole = Text::new(&text).is_ok_and(|text| text.written(path) == Some(value));
    if is_whole { Ok(text) } else { Err(NOT_ONE_VALUE.into()) }
}

/// The blanks before the first byte of a line; `None` on the first line, or if other bytes precede it.
fn indentation(text: &str, offset: usize) -> Option<&str> {
    let line = text[..offset].rfind('\n')? + 1;
    let before = &text[line..offset];
    before.chars().all(|c| matches!(c, ' ' | '\t')).then_some(before)
}

/// Applies edits without overlap.
fn apply(text: &str, mut edits: Vec<(Range<usize>, String)>) -> String {
    edits.sort_by_key(|(range, _)| range.start);
    let mut text = text.to_string();
    for (range, new) in edits.into_iter().rev() {
        text.replace_range(range, &new);
    }
    text
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ORDER: &[&str] = &["a", "b", "c", "d", "e"];

    fn insert(text: &str, group: &str, name: &str) -> String {
        Text::new(text).unwrap().insert(group, name, "0", ORDER).unwrap()
    }

    fn remove(text: &str, path: &str) -> Result<String, String> {
        Text::new(text).unwrap().remove(path)
    }

    #[test]
    fn entries_are_removed_with_their_commas_and_lines() {
        for (text, path, without) in [
            ("(a: 1)", "a", "()"),
            ("(a: 1, b: 2)", "b", "(a: 1)"),
            ("(a: 1, b: 2,)", "b", "(a: 1,)"),
            ("(a: 1, b: 2, c: 3)", "b", "(a: 1, c: 3)"),
            ("(a: 1, b: 2, c: 3)", "a", "(b: 2, c: 3)"),
            ("(a: 1, /* c */ b: 2)", "b", "(a: 1 /* c */ )"),
            ("(\n a: 1, // x\n b: 2, // y\n c: 3,\n)", "b", "(\n a: 1, // x // y\n c: 3,\n)"),
            ("(\n a: 1, // x\n b: 2, c: 3,\n)", "b", "(\n a: 1, // x\n  c: 3,\n)"),
            ("(a: (b: 1, c: 2))", "a.c", "(a: (b: 1))"),
        ] {
            assert_eq!(remove(text, path).as_deref(), Ok(without), "{text} {path}");
        }
        assert!(remove("(a: 1)", "b").is_err() && remove("(a: 1)", "a.b").is_err());
    }

    proptest! {
        #[test]
        fn removing_undoes_inserting(
            names in prop::sample::subsequence(ORDER, 0..4),
            name in prop::sample::select(ORDER),
            separators in prop::collection::vec(prop::sample::select(vec![", ", ",\n    ", ", // x\n    ", ",\r\n\t", ", /* y */ ", "\n  ,"]), 5),
            lead in prop::sample::select(vec!["", "\n    ", " // z\n", " /* z */ "]),
            tail in prop::sample::select(vec!["", ",", ",\n", "\n", " // end\n", ", // end\n"]),
            grouped in any::<bool>(),
        ) {
            prop_assume!(!names.contains(&name));
            prop_assume!(!names.is_empty() || !tail.contains(','));
            let entries: Vec<String> = names.iter().map(|name| format!("{name}: (1)")).collect();
            let inside = entries.iter().zip(&separators).fold(String::new(), |text, (entry, separator)| {
                if text.is_empty() { entry.clone() } else { text + separator + entry }
            });
            let body = format!("({lead}{inside}{tail})");
            let (text, group) = if grouped { (format!("(g: G{body}, h: 2)"), "g") } else { (body, "") };
            let longer = insert(&text, group, name);
            let path = if grouped { format!("g.{name}") } else { name.to_string() };
            let read = Text::new(&longer).unwrap();
            prop_assert_eq!(read.written(&path), Some("0"));
            prop_assert_eq!(read.comments(), Text::new(&text).unwrap().comments());
            prop_assert_eq!(remove(&longer, &path), Ok(text), "{}", longer);
        }
    }
}
