//! Edits of one value in a text. All comments stay.

use std::ops::Range;

use super::index::{Text, TextSpan};

/// Characters that can separate the entries on one line.
const BLANKS: [char; 2] = [' ', '\t'];

/// Error message for a new value whose text is not exactly one value in RON.
pub(in crate::scene) const NOT_ONE_VALUE: &str =
    "not one RON value by itself, such as 1.0e-3 or (1, 512)";

impl Text {
    /// Returns the text with `value` in place of the present value at a path.
    ///
    /// # Errors
    /// Returns an error if the text has no value at the path, or if `value` is not exactly one
    /// value.
    pub fn replace(&self, path: &str, value: &str) -> Result<Text, String> {
        let entry = self.span(path).ok_or("there is no such element")?;
        self.spliced(vec![(entry.value.clone(), value.to_string())], path, value)
    }

    /// Returns the text with a new entry `name: value` in the group at the path `group`. An empty
    /// path means the whole text. `order` lists names in the order of their entries: the new entry
    /// comes after the entries whose names are before `name` in this list.
    ///
    /// # Errors
    /// Returns an error if there is no group at the path, or if `value` is not exactly one value.
    pub fn insert(
        &self,
        group: &str,
        name: &str,
        value: &str,
        order: &[&str],
    ) -> Result<Text, String> {
        let inside = self.span(group).and_then(|entry| entry.inside.clone());
        let inside = inside.ok_or_else(|| format!("{group} has no fields here"))?;
        let entries = self.inside(group);
        let new = format!("{name}: {value}");
        let splices = match entry_before(&entries, name, order).or(entries.last().copied()) {
            None => vec![(inside.start..inside.start, new)],
            Some(anchor) => {
                let after = anchor.comma.unwrap_or(anchor.value.end);
                let next = entries
                    .iter()
                    .map(|entry| entry.entry.start)
                    .find(|start| *start >= after);
                self.splices_after(anchor, after..next.unwrap_or(inside.end), &new)
            }
        };
        let path = if group.is_empty() {
            name.to_string()
        } else {
            format!("{group}.{name}")
        };
        self.spliced(splices, &path, value)
    }

    /// Returns the text with other elements in the list at the path `list`. Each item of `elements`
    /// is an index and a text. If an item has an index, the text and the comments of the present
    /// element with this index are kept. If it has none, the element is new and has the text of the
    /// item. Returns `None` if the present list is empty or missing, or if a comment would make the
    /// new text unreadable.
    pub fn arrange(&self, list: &str, elements: &[(Option<usize>, String)]) -> Option<Text> {
        let inside = self.span(list)?.inside.clone()?;
        let present = self.inside(list);
        let has_last_comma = present.last()?.comma.is_some();
        let parts = self.parts(&present, &inside);
        let first_blank = blank_start(parts.first()?.before);
        let further_blank = match parts.get(1) {
            Some(part) => blank_start(part.before),
            None if first_blank.contains('\n') => first_blank,
            None => " ",
        };
        let mut new = String::new();
        for (place, (kept, written)) in elements.iter().enumerate() {
            new += if place == 0 {
                first_blank
            } else {
                further_blank
            };
            let comma = if place + 1 < elements.len() || has_last_comma {
                ","
            } else {
                ""
            };
            if let Some(index) = kept {
                let part = parts.get(*index)?;
                new += part.before.trim_start();
                new += part.value;
                new += comma;
                new += &part.after;
            } else {
                new += written;
                new += comma;
            }
        }
        let end = parts.last()?.end;
        let mut source = self.source.clone();
        source.replace_range(inside.start..end, &new);
        Text::new(source).ok()
    }

    /// Divides the text inside the brackets of a list into its elements.
    fn parts(&self, elements: &[&TextSpan], inside: &Range<usize>) -> Vec<Part<'_>> {
        let mut parts = Vec::new();
        let mut start = inside.start;
        for (place, TextSpan { value, comma, .. }) in elements.iter().enumerate() {
            let after = comma.unwrap_or(value.end);
            let next = elements
                .get(place + 1)
                .map_or(inside.end, |next| next.value.start);
            let end = self.line_break_in(after..next).unwrap_or(after);
            let before_comma = &self.source[value.end..after - usize::from(comma.is_some())];
            parts.push(Part {
                before: &self.source[start..value.start],
                value: &self.source[value.clone()],
                after: format!("{before_comma}{}", &self.source[after..end]),
                end,
            });
            start = end;
        }
        parts
    }

    /// Returns the text without the entry at a path. The line of the entry is removed too if
    /// nothing else is on it. If there is no such entry, the text does not change.
    pub(in crate::scene) fn without_entry(&self, path: &str) -> Text {
        let Some(TextSpan { entry, comma, .. }) = self.span(path) else {
            return self.clone();
        };
        let before = self.source[..entry.start].trim_end_matches(BLANKS);
        let end = comma.unwrap_or(entry.end);
        let after = self.source[end..].trim_start_matches(BLANKS);
        let mut removed = entry.start..self.source.len() - after.len();
        let line_break = ["\r\n", "\n"]
            .into_iter()
            .find(|line_break| after.starts_with(line_break));
        if let Some(line_break) = line_break
            && (before.is_empty() || before.ends_with('\n'))
        {
            removed = before.len()..removed.end + line_break.len();
        }
        self.without(removed)
    }

    /// Returns the text without the comments that follow the entry at a path on the last line of
    /// the entry.
    pub(in crate::scene) fn without_comments_beside(&self, path: &str) -> Text {
        let mut text = self.clone();
        while let Some(range) = text.comment_beside(path) {
            let before = text.source[..range.start].trim_end_matches(BLANKS).len();
            let shorter = text.without(before..range.end);
            if shorter == text {
                break;
            }
            text = shorter;
        }
        text
    }

    fn comment_beside(&self, path: &str) -> Option<Range<usize>> {
        let end = self.span(path)?.value.end;
        let following = self.comments.iter().find(|comment| comment.start >= end)?;
        let between = &self.source[end..following.start];
        let is_beside = between.chars().all(|sign| matches!(sign, ' ' | '\t' | ','));
        is_beside.then(|| following.clone())
    }

    /// Returns the text without a range of bytes. If the remaining text cannot be read, the text
    /// does not change.
    fn without(&self, range: Range<usize>) -> Text {
        let mut source = self.source.clone();
        source.replace_range(range, "");
        Text::new(source).unwrap_or_else(|_| self.clone())
    }

    /// Returns the insertions that put a new entry after the entry `anchor`. The style of the text
    /// decides whether the new entry has its own line, after any comment on the line of `anchor`,
    /// or is on the same line.
    fn splices_after(
        &self,
        anchor: &TextSpan,
        gap: Range<usize>,
        new: &str,
    ) -> Vec<(Range<usize>, String)> {
        let has_comma = anchor.comma.is_some();
        let indentation = indentation(&self.source, anchor.entry.start);
        let line_break = self.line_break_in(gap.clone());
        let (Some(indentation), Some(line_break)) = (indentation, line_break) else {
            let on_same_line = if has_comma {
                format!(" {new},")
            } else {
                format!(", {new}")
            };
            return vec![(gap.start..gap.start, on_same_line)];
        };
        let newline = if self.source[..line_break].ends_with('\r') {
            "\r\n"
        } else {
            "\n"
        };
        let end = line_break + 1 - newline.len();
        let on_next_line = format!("{newline}{indentation}{new}");
        if has_comma {
            vec![(end..end, on_next_line + ",")]
        } else {
            let value_end = anchor.value.end;
            vec![
                (value_end..value_end, ",".to_owned()),
                (end..end, on_next_line),
            ]
        }
    }

    /// Returns the offset of the first line break in a range of blanks and comments. Line breaks
    /// inside block comments do not count.
    fn line_break_in(&self, gap: Range<usize>) -> Option<usize> {
        for (offset, _) in self.source[gap.clone()].match_indices('\n') {
            let place = gap.start + offset;
            if !self.comments.iter().any(|comment| comment.contains(&place)) {
                return Some(place);
            }
        }
        None
    }

    /// Returns the text after replacements, which must be in ascending order. Returns an error
    /// unless the value at the path is then exactly `value`, because a comment inside `value` could
    /// hide the text after it.
    fn spliced(
        &self,
        splices: Vec<(Range<usize>, String)>,
        path: &str,
        value: &str,
    ) -> Result<Text, String> {
        let mut source = self.source.clone();
        for (range, new) in splices.into_iter().rev() {
            source.replace_range(range, &new);
        }
        match Text::new(source) {
            Ok(text) if text.written(path) == Some(value) => Ok(text),
            _ => Err(NOT_ONE_VALUE.to_owned()),
        }
    }
}

/// One element of a list in the text.
struct Part<'t> {
    /// Blanks and comments before the value.
    before: &'t str,
    value: &'t str,
    /// Comments after the value on its line, without the comma.
    after: String,
    /// Offset of the first byte after the element.
    end: usize,
}

/// Returns the entry after which a new entry `name` belongs. Of all entries whose names are before
/// `name` in `order`, it is the one that comes last in `order`.
fn entry_before<'t>(entries: &[&'t TextSpan], name: &str, order: &[&str]) -> Option<&'t TextSpan> {
    let rank = |name: &str| order.iter().position(|other| *other == name);
    entries
        .iter()
        .copied()
        .filter(|entry| rank(entry.name()) < rank(name))
        .max_by_key(|entry| rank(entry.name()))
}

/// Returns the blanks with which a text begins.
fn blank_start(text: &str) -> &str {
    &text[..text.len() - text.trim_start().len()]
}

/// Returns the blanks before an offset in its line. Returns `None` on the first line, or if other
/// characters are before the offset in the line.
fn indentation(text: &str, offset: usize) -> Option<&str> {
    let line = text[..offset].rfind('\n')? + 1;
    let before = &text[line..offset];
    before
        .chars()
        .all(|c| matches!(c, ' ' | '\t'))
        .then_some(before)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_goes_with_its_line() {
        for (text, shorter) in [
            ("(a: 1, b: 2, c: 3)", "(a: 1, c: 3)"),
            ("(a: 1, b: 2)", "(a: 1, )"),
            (
                "(\n    a: 1,\n    b: 2, // two\n    c: 3,\n)",
                "(\n    a: 1,\n    // two\n    c: 3,\n)",
            ),
            ("(\r\n\ta: 1,\r\n\tb: \"x\ny\",\r\n)", "(\r\n\ta: 1,\r\n)"),
            ("(\n    a: 1,\n    b: 2\n)", "(\n    a: 1,\n)"),
            ("(a: 1)", "(a: 1)"),
        ] {
            assert_eq!(
                Text::new(text).unwrap().without_entry("b").as_str(),
                shorter,
                "{text}"
            );
        }
    }

    #[test]
    fn comments_beside_an_entry_are_removed_alone() {
        for (text, shorter) in [
            (
                "(\n    a: 1, // one\n    b: 2, // two\n    // three\n)",
                "(\n    a: 1, // one\n    b: 2,\n    // three\n)",
            ),
            ("(a: 1, b: 2 /* x */, /* y */ c: 3)", "(a: 1, b: 2, c: 3)"),
            (
                "(b: (2, /* in */ 3), c: 4) // end",
                "(b: (2, /* in */ 3), c: 4) // end",
            ),
            ("(b: 2) // end", "(b: 2) // end"),
            ("(a: 1) // one", "(a: 1) // one"),
        ] {
            assert_eq!(
                Text::new(text)
                    .unwrap()
                    .without_comments_beside("b")
                    .as_str(),
                shorter,
                "{text}"
            );
        }
    }

    #[test]
    fn elements_that_stay_keep_their_comments() {
        let lines = "(l: [ // all\n    A(1.0), // press\n    // then\n    B, C // end\n])";
        for (text, elements, arranged) in [
            (
                "(l: [A(1.0), /* b */ B])",
                "1 0",
                "(l: [/* b */ B, A(1.0)])",
            ),
            ("(l: [A,B,])", "0 X 1", "(l: [A,X,B,])"),
            ("(l: [A(1.0)])", "0 X", "(l: [A(1.0), X])"),
            ("(l: [A, B])", "0", "(l: [A])"),
            (
                "(l: [\n    A, // press\n    B,\n])",
                "1 0",
                "(l: [\n    B,\n    A, // press\n])",
            ),
            (
                "(l: [\n    A, // press\n    B\n])",
                "0 1 X",
                "(l: [\n    A, // press\n    B,\n    X\n])",
            ),
            (lines, "1 2", "(l: [ // then\n    B,\n    C // end\n])"),
        ] {
            let elements: Vec<_> = elements
                .split(' ')
                .map(|one| (one.parse::<usize>().ok(), one.to_owned()))
                .collect();
            let found = Text::new(text).unwrap().arrange("l", &elements);
            assert_eq!(
                found.as_ref().map(Text::as_str),
                Some(arranged),
                "{text} {elements:?}"
            );
        }
        assert_eq!(
            Text::new("(l: [])")
                .unwrap()
                .arrange("l", &[(None, "A".to_owned())]),
            None
        );
    }
}
