//! List of the values in RON text and of their positions.
//!
//! Each value has a path of names and, in lists and tuples, of indices: `roughness.hurst`,
//! `loading.0`, `roughness.modes.1`. The whole text has the empty path. Names of structs and
//! variants are not part of a path, and neither is `Some(…)`: in
//! `roughness: Some(SelfAffine(hurst: 0.7))` the number 0.7 has the path `roughness.hurst`. In
//! `form: Spheres([(radius: 1.0)])` the number 1.0 has the path `form.0.radius`.

use std::ops::Range;

use super::scan::{Kind, Scan, Token, Unreadable, scan};

/// Values inside a value are listed only if the path of the outer value is shorter than this number
/// of bytes. No scene has longer paths.
const LONGEST_PATH: usize = 100;

/// RON text with the positions of its values. A value is found by its path, such as
/// `roughness.hurst` or `loading.0`. A path consists of names of fields, and of indices in lists,
/// from 0. The empty path means the whole text.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    pub(super) source: String,
    spans: Vec<TextSpan>,
    /// Byte range of each comment.
    pub(super) comments: Vec<Range<usize>>,
}

/// Byte ranges of one value in a [`Text`]: of the value alone, and of the entry `name: value`.
#[derive(Clone, Debug, PartialEq)]
pub struct TextSpan {
    /// Path of the value, such as `roughness.hurst`.
    pub path: String,
    /// Byte range of the whole entry `name: value`. For an element of a list, which has no name, it
    /// is the range of the value.
    pub entry: Range<usize>,
    /// Byte range of the value alone.
    pub value: Range<usize>,
    /// Byte range of the value without `Some(…)` around it.
    bare: Range<usize>,
    /// Byte range between the brackets of the value; `None` if the value has no brackets.
    pub(super) inside: Option<Range<usize>>,
    /// Offset of the byte after the comma that follows the entry; `None` if no comma follows.
    pub(super) comma: Option<usize>,
}

/// Returns the line and the column, both from 1, of a byte offset in a text. The column is in
/// characters.
pub fn line_column(text: &str, offset: usize) -> (usize, usize) {
    let mut end = offset.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let before = &text[..end];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.matches('\n').count() + 1;
    let column = before[line_start..].chars().count() + 1;
    (line, column)
}

/// Returns the byte offset of a line and a column. If the line or the text ends before this column,
/// returns the offset of the end.
pub(in crate::scene) fn offset_of(text: &str, line: usize, column: usize) -> usize {
    let mut lines = text.split_inclusive('\n');
    let mut start = 0;
    for line in lines.by_ref().take(line.saturating_sub(1)) {
        start += line.len();
    }
    let line = lines.next().unwrap_or_default().trim_end_matches('\n');
    let character = line.char_indices().nth(column.saturating_sub(1));
    start + character.map_or(line.len(), |(place, _)| place)
}

/// Returns true if a path equals another path or lies inside it.
pub(in crate::scene) fn is_within(path: &str, other: &str) -> bool {
    path.strip_prefix(other)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

impl Text {
    /// Reads a text and finds the positions of its values.
    ///
    /// # Errors
    /// Returns an error if brackets do not match, or if a quote or a comment is not closed.
    pub fn new(source: impl Into<String>) -> Result<Text, Unreadable> {
        let source = source.into();
        let Scan { tokens, comments } = scan(&source)?;
        let tokens = Tokens {
            source: &source,
            tokens,
        };
        let mut spans = Vec::new();
        if let Some(root) = tokens.root() {
            tokens.add(String::new(), root, root, &mut spans);
        }
        Ok(Text {
            source,
            spans,
            comments,
        })
    }

    /// Returns the whole text.
    pub fn as_str(&self) -> &str {
        &self.source
    }

    /// Returns the position of the value at a path; `None` if there is no such value.
    pub fn span(&self, path: &str) -> Option<&TextSpan> {
        self.spans.iter().find(|span| span.path == path)
    }

    /// Returns the offset of the first byte of the value at a path. If there is no such value,
    /// returns the offset of the innermost group around the path.
    pub(in crate::scene) fn nearest_value(&self, path: &str) -> usize {
        let mut around = path;
        while !around.is_empty() {
            if let Some(span) = self.span(around) {
                return span.value.start;
            }
            around = around.rsplit_once('.').map_or("", |(group, _)| group);
        }
        let root = self.spans.first().and_then(|root| root.inside.as_ref());
        root.map_or(0, |inside| inside.start - 1)
    }

    /// Returns the value at a path as written, including `Some(…)` around it; `None` if there is no
    /// value at this path.
    pub(in crate::scene) fn written(&self, path: &str) -> Option<&str> {
        self.source.get(self.span(path)?.value.clone())
    }

    /// Returns the value at a path, without `Some(…)` around it; `None` if there is no value at
    /// this path.
    pub(in crate::scene) fn value(&self, path: &str) -> Option<&str> {
        self.source.get(self.span(path)?.bare.clone())
    }

    /// Returns the name of the variant at a path: `Cone` for `Some(Cone(angle: 0.1))`. Returns
    /// `None` if there is no value at this path, or if it does not begin with a name.
    pub(in crate::scene) fn variant(&self, path: &str) -> Option<&str> {
        let name = self.value(path)?.split(['(', '[', '{', '"']).next()?.trim();
        Some(name.strip_prefix("r#").unwrap_or(name)).filter(|name| !name.is_empty())
    }

    /// Returns the values directly inside the group or list at a path, in their order in the text.
    pub(super) fn inside(&self, path: &str) -> Vec<&TextSpan> {
        let is_inside = |span: &&TextSpan| !span.path.is_empty() && span.group() == path;
        self.spans.iter().filter(is_inside).collect()
    }

    pub(in crate::scene) fn comments(&self) -> usize {
        self.comments.len()
    }

    /// Returns the path of the innermost value whose entry contains a byte offset. The path is
    /// empty if no entry contains the offset.
    pub(in crate::scene) fn path_at(&self, offset: usize) -> &str {
        self.spans
            .iter()
            .filter(|span| span.entry.contains(&offset))
            .max_by_key(|span| span.entry.start)
            .map_or("", |span| &span.path)
    }
}

impl TextSpan {
    /// Returns the path of the group or list around the value.
    fn group(&self) -> &str {
        self.path.rsplit_once('.').map_or("", |(group, _)| group)
    }

    /// Returns the last part of the path: a name, or an index in a list.
    pub(super) fn name(&self) -> &str {
        self.path.rsplit('.').next().unwrap_or_default()
    }
}

struct Tokens<'t> {
    source: &'t str,
    tokens: Vec<Token>,
}

impl Tokens<'_> {
    /// Adds the value that starts at the token `first`, and the values inside it, to the list
    /// `spans`. The entry of the value starts at the token `start`. Returns the index of the token
    /// after the value.
    fn add(
        &self,
        path: String,
        start: usize,
        first: usize,
        spans: &mut Vec<TextSpan>,
    ) -> Option<usize> {
        let end = self.value_end(first)?;
        let inner = self.inside_some(first);
        let brackets = self.brackets(inner);
        spans.push(TextSpan {
            path: path.clone(),
            entry: self.bytes(start, end),
            value: self.bytes(first, end),
            bare: self.bytes(inner, self.value_end(inner)?),
            inside: brackets.map(|(open, close)| self.tokens[open].end..self.tokens[close].start),
            comma: self.is(end, Kind::Comma).then(|| self.tokens[end].end),
        });
        // Each level of brackets makes the path longer, so the limit of the length of paths also
        // limits the number of levels.
        if let Some((open, close)) = brackets
            && path.len() < LONGEST_PATH
        {
            self.add_inside(&path, open, close, spans)?;
        }
        Some(end)
    }

    /// Adds the values between two brackets to the list `spans`.
    fn add_inside(
        &self,
        group: &str,
        open: usize,
        close: usize,
        spans: &mut Vec<TextSpan>,
    ) -> Option<()> {
        let mut start = open + 1;
        for position in 0.. {
            let name = if self.is(start + 1, Kind::Colon) {
                self.word(start)
            } else {
                None
            };
            let first = if name.is_some() { start + 2 } else { start };
            if self.value_end(first).is_none_or(|end| end > close) {
                break;
            }
            let name = name.map_or_else(|| position.to_string(), str::to_owned);
            let path = if group.is_empty() {
                name
            } else {
                format!("{group}.{name}")
            };
            let end = self.add(path, start, first, spans)?;
            // If no comma follows, this is the last entry, whatever text comes after it.
            if !self.is(end, Kind::Comma) {
                break;
            }
            start = end + 1;
        }
        Some(())
    }

    /// Returns the token indices of the two brackets of the value that starts at the token `first`.
    /// If the value is a variant that contains only a list, these are the brackets of the list.
    fn brackets(&self, first: usize) -> Option<(usize, usize)> {
        let has_name = self.is(first, Kind::Word);
        let open = if has_name { first + 1 } else { first };
        match self.tokens.get(open)?.kind {
            Kind::Open('(', close) if has_name => {
                Some(self.only_list(open, close).unwrap_or((open, close)))
            }
            Kind::Open('(', close) => Some((open, close)),
            Kind::Open('[', close) if !has_name => Some((open, close)),
            _ => None,
        }
    }

    /// Returns the token indices of the brackets of a list, if this list is all that is between the
    /// brackets `open` and `close`.
    fn only_list(&self, open: usize, close: usize) -> Option<(usize, usize)> {
        let Kind::Open('[', end) = self.tokens.get(open + 1)?.kind else {
            return None;
        };
        let after = if self.is(end + 1, Kind::Comma) {
            end + 2
        } else {
            end + 1
        };
        (after == close).then_some((open + 1, end))
    }

    /// Returns the byte range from the token `first` to the token before `end`.
    fn bytes(&self, first: usize, end: usize) -> Range<usize> {
        self.tokens[first].start..self.tokens[end - 1].end
    }

    /// Returns the index of the first token of the whole value. Attributes before it, such as
    /// `#![enable(…)]`, are skipped.
    fn root(&self) -> Option<usize> {
        let mut index = 0;
        loop {
            let token = self.tokens.get(index)?;
            let text = &self.source[token.start..token.end];
            if !(text.starts_with('#') || index > 0 && text == "!") {
                return Some(index);
            }
            index += 1;
            if let Some(Token {
                kind: Kind::Open('[', close),
                ..
            }) = self.tokens.get(index)
            {
                index = close + 1;
            }
        }
    }

    /// Returns the index of the token after the value that starts at the token `first`.
    fn value_end(&self, first: usize) -> Option<usize> {
        match (
            self.tokens.get(first)?.kind,
            self.tokens.get(first + 1).map(|token| token.kind),
        ) {
            (Kind::Open(_, close), _) | (Kind::Word, Some(Kind::Open('(', close))) => {
                Some(close + 1)
            }
            (Kind::Quoted | Kind::Word, _) => Some(first + 1),
            (Kind::Close | Kind::Comma | Kind::Colon, _) => None,
        }
    }

    /// Returns the index of the first token of the value inside `Some(…)`, for any number of nested
    /// `Some(…)`.
    fn inside_some(&self, mut first: usize) -> usize {
        while self.word(first) == Some("Some")
            && matches!(self.tokens.get(first + 1), Some(Token { kind: Kind::Open('(', _), .. }))
            // If the text enables the extension that unwraps variants, `Some(work: 0.1)` is itself
            // a struct.
            && !self.is(first + 3, Kind::Colon)
            && self.value_end(first + 2).is_some()
        {
            first += 2;
        }
        first
    }

    fn is(&self, index: usize, kind: Kind) -> bool {
        self.tokens
            .get(index)
            .is_some_and(|token| token.kind == kind)
    }

    /// Returns the word at a token, without the prefix `r#` of a raw identifier.
    fn word(&self, index: usize) -> Option<&str> {
        let token = self
            .tokens
            .get(index)
            .filter(|token| token.kind == Kind::Word)?;
        let word = &self.source[token.start..token.end];
        Some(word.strip_prefix("r#").unwrap_or(word))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let text = "a\nκκ x\r\n";
        assert_eq!(line_column(text, 0), (1, 1));
        assert_eq!(line_column(text, text.find('x').unwrap()), (2, 4));
        assert_eq!(line_column(text, text.len() + 5), (3, 1));
        assert_eq!(line_column(text, 3), (2, 1));
        assert_eq!(offset_of(text, 2, 4), text.find('x').unwrap());
        assert_eq!(offset_of(text, 9, 9), text.len());
    }
}
