//! Edits of one entry in a text, with every comment preserved.

use std::ops::Range;

use super::index::{Span, Text};

/// Message for a value that another one follows, or that ends within the text around it.
pub(in crate::scene) const NOT_ONE_VALUE: &str = "not one RON value by itself, such as 1.0e-3 or (1, 512)";

impl Text {
    /// The text with another value at a path.
    ///
    /// # Errors
    /// No entry with this path, or text that is not one value.
    pub fn replace(&self, path: &str, value: &str) -> Result<Text, String> {
        let entry = self.span(path).ok_or("there is no such element")?;
        self.spliced(vec![(entry.value.clone(), value.to_string())], path, value)
    }

    /// The text with the entry `name: value` in the group at a path, empty for the whole: after the last of the
    /// entries that precede the name in this order.
    ///
    /// # Errors
    /// No group with this path, or text that is not one value.
    pub fn insert(&self, group: &str, name: &str, value: &str, order: &[&str]) -> Result<Text, String> {
        let inside = self.span(group).and_then(|entry| entry.inside.clone());
        let inside = inside.ok_or_else(|| format!("{group} has no fields here"))?;
        let rank = |name: &str| order.iter().position(|other| *other == name);
        let ranked = |entry: &&&Span| rank(entry.path.rsplit('.').next().unwrap_or_default());
        let entries = self.inside(group);
        let before = entries.iter().filter(|entry| ranked(entry) < rank(name)).max_by_key(ranked);
        let new = format!("{name}: {value}");
        let splices = match before.or(entries.last()) {
            None => vec![(inside.start..inside.start, new)],
            Some(anchor) => {
                let after = anchor.comma.unwrap_or(anchor.value.end);
                let next = entries.iter().map(|entry| entry.entry.start).find(|start| *start >= after);
                self.splices_after(anchor, after..next.unwrap_or(inside.end), &new)
            }
        };
        let path = if group.is_empty() { name.to_string() } else { format!("{group}.{name}") };
        self.spliced(splices, &path, value)
    }

    /// Splices that put an entry after another one, in the same style: on a line of its own, after the comment on the
    /// line before, or on the same line.
    fn splices_after(&self, anchor: &Span, gap: Range<usize>, new: &str) -> Vec<(Range<usize>, String)> {
        let comma = if anchor.comma.is_some() { "," } else { "" };
        match (indentation(&self.source, anchor.entry.start), self.line_break_in(gap.clone())) {
            (Some(indentation), Some(line_break)) => {
                let newline = if self.source[..line_break].ends_with('\r') { "\r\n" } else { "\n" };
                let end = line_break + 1 - newline.len();
                let missing_comma = if anchor.comma.is_some() { "" } else { "," };
                vec![
                    (anchor.value.end..anchor.value.end, missing_comma.to_string()),
                    (end..end, format!("{newline}{indentation}{new}{comma}")),
                ]
            }
            _ if anchor.comma.is_some() => vec![(gap.start..gap.start, format!(" {new},"))],
            _ => vec![(gap.start..gap.start, format!(", {new}"))],
        }
    }

    /// The first line break in a stretch of blanks and comments that is not inside a block comment.
    fn line_break_in(&self, gap: Range<usize>) -> Option<usize> {
        let mut breaks = self.source[gap.clone()].match_indices('\n').map(|(at, _)| gap.start + at);
        let is_outside = |at: &usize| !self.comments.iter().any(|comment| comment.contains(at));
        breaks.find(is_outside)
    }

    /// The text with splices in ascending order, if the value at the path is then exactly the given one: a comment in
    /// the value must not swallow the text behind it.
    fn spliced(&self, splices: Vec<(Range<usize>, String)>, path: &str, value: &str) -> Result<Text, String> {
        let mut source = self.source.clone();
        for (range, new) in splices.into_iter().rev() {
            source.replace_range(range, &new);
        }
        let text = Text::new(source).ok().filter(|text| text.written(path) == Some(value));
        text.ok_or_else(|| NOT_ONE_VALUE.to_string())
    }
}

/// The blanks before the first byte of a line; `None` on the first line, or if other bytes precede it.
fn indentation(text: &str, offset: usize) -> Option<&str> {
    let line = text[..offset].rfind('\n')? + 1;
    let before = &text[line..offset];
    before.chars().all(|c| matches!(c, ' ' | '\t')).then_some(before)
}
