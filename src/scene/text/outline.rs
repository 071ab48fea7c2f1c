//! Places of values in RON text.
//!
//! Paths consist of names and, in lists and tuples, of positions: `roughness.hurst`, `loading.0`, `roughness.modes.1`.
//! Names of structs and variants and `Some(…)` are transparent: `roughness: Some(SelfAffine(hurst: 0.7))` has its 0.7
//! at `roughness.hurst`.

use std::ops::Range;

use super::scan::{Kind, Scan, Token, Unreadable, scan};

/// Place of an entry, in bytes of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Span {
    /// The whole entry, `name: value`; equal to `value` in a list.
    pub entry: Range<usize>,
    /// The value alone.
    pub value: Range<usize>,
}

/// Line and column of a byte, both from 1, columns counted in characters.
pub fn line_column(text: &str, offset: usize) -> (usize, usize) {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    let before = &text[..offset];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

/// The byte at a line and column, or the end of the line or text before it.
pub(in crate::scene) fn offset_of(text: &str, line: usize, column: usize) -> usize {
    let mut start = 0;
    for _ in 1..line {
        match text[start..].find('\n') {
            Some(newline) => start += newline + 1,
            None => return text.len(),
        }
    }
    let line = text[start..].split('\n').next().unwrap_or("");
    let within = line.char_indices().nth(column.saturating_sub(1));
    start + within.map_or(line.len(), |(offset, _)| offset)
}

/// Returns true if a path equals another path or lies inside it.
pub(in crate::scene) fn is_within(path: &str, other: &str) -> bool {
    path.strip_prefix(other).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// RON text whose brackets and quotes match.
pub struct Text<'t> {
    pub(super) text: &'t str,
    tokens: Vec<Token>,
    /// Bytes of the comments.
    pub(super) comments: Vec<Range<usize>>,
}

/// The inside of two brackets: the indices of their tokens.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    open: usize,
    close: usize,
}

/// One entry of a body.
#[derive(Clone, Debug)]
pub(super) struct Entry<'t> {
    /// Name, for `name: value`.
    pub(super) name: Option<&'t str>,
    /// Bytes of the entry and of its value.
    pub(super) span: Span,
    /// Byte after the comma that follows.
    pub(super) comma: Option<usize>,
    /// Token with which the value starts.
    first: usize,
}

impl<'t> Text<'t> {
    /// Reads a text as tokens.
    ///
    /// # Errors
    /// A bracket, quote or comment that does not close.
    pub fn new(text: &'t str) -> Result<Text<'t>, Unreadable> {
        let Scan { tokens, comments } = scan(text)?;
        Ok(Text { text, tokens, comments })
    }

    /// Place of the entry at a path.
    pub fn span(&self, path: &str) -> Option<Span> {
        self.entry(path).map(|entry| entry.span)
    }

    /// Place of the entry at a path, or of the nearest group around it.
    fn nearest(&self, path: &str) -> Option<Span> {
        let mut around =
            std::iter::successors(Some(path), |path| path.rsplit_once('.').map(|(group, _)| group));
        around.find_map(|path| self.span(path))
    }

    /// First byte of the value at a path, or of the nearest group around it.
    pub(in crate::scene) fn nearest_value(&self, path: &str) -> Option<usize> {
        self.nearest(path).map(|span| span.value.start).or_else(|| self.opening(""))
    }

    /// The value at a path as written, with any `Some(…)` around it.
    pub(in crate::scene) fn written(&self, path: &str) -> Option<&'t str> {
        self.text.get(self.span(path)?.value)
    }

    /// Name of the variant at a path: `Cone` for `Some(Cone(angle: 0.1))`.
    pub(in crate::scene) fn variant(&self, path: &str) -> Option<&'t str> {
        let first = self.inside_some(self.entry(path)?.first);
        self.word(first)
    }

    /// The value at a path without any `Some(…)` around it.
    pub(in crate::scene) fn value(&self, path: &str) -> Option<&'t str> {
        let first = self.inside_some(self.entry(path)?.first);
        let end = self.value_end(first)?;
        self.text.get(self.tokens[first].start..self.tokens[end - 1].end)
    }

    /// Byte of the opening bracket of the value at a path, of the whole for an empty path; `None` for a value
    /// without brackets.
    pub(in crate::scene) fn opening(&self, path: &str) -> Option<usize> {
        self.body(path).map(|body| self.tokens[body.open].start)
    }

    /// Number of comments.
    pub(in crate::scene) fn comments(&self) -> usize {
        self.comments.len()
    }

    /// Comments about the entries at these paths: behind an entry on its last line, and on lines of their own above
    /// it. For a missing entry, the comments about its group.
    pub(in crate::scene) fn comments_about<'p>(
        &self,
        paths: impl Iterator<Item = &'p str>,
    ) -> Vec<Range<usize>> {
        let mut about = vec![false; self.comments.len()];
        for path in paths {
            let Some(Span { entry, .. }) = self.nearest(path) else { continue };
            for (comment, about) in self.comments.iter().zip(&mut about) {
                let between = self.text.get(entry.end..comment.start);
                *about |= between.is_some_and(|between| !between.contains('\n'));
            }
            // From the entry upwards.
            let line_start = |at: usize| self.text[..at].rfind('\n').map_or(0, |line_break| line_break + 1);
            let mut line = line_start(entry.start);
            for (comment, about) in self.comments.iter().zip(&mut about).rev() {
                let is_above = comment.end <= line && self.text[comment.end..line].trim().is_empty();
                let is_alone = self.text[line_start(comment.start)..comment.start].trim().is_empty();
                if is_above && is_alone {
                    (*about, line) = (true, line_start(comment.start));
                }
            }
        }
        let chosen = self.comments.iter().zip(about).filter(|(_, about)| *about);
        chosen.map(|(comment, _)| comment.clone()).collect()
    }

    /// The elements of a text that is one list, as written; `None` for any other value.
    pub(in crate::scene) fn elements(&self) -> Option<Vec<&'t str>> {
        self.whole('[')?.map(|entry| self.text.get(entry.span.value)).collect()
    }

    /// The names of the fields of a text that is one group; `None` for any other value.
    pub(in crate::scene) fn names(&self) -> Option<Vec<&'t str>> {
        self.whole('(')?.map(|entry| entry.name).collect()
    }

    /// The entries of a text that is one value and opens with this bracket.
    fn whole(&self, bracket: char) -> Option<impl Iterator<Item = Entry<'t>>> {
        let body = self.body("").filter(|_| self.text.starts_with(bracket) && self.is_one_value())?;
        Some(self.entries(body))
    }

    /// Returns true if the text is exactly one value.
    pub(super) fn is_one_value(&self) -> bool {
        let ends = self.tokens.first().zip(self.tokens.last());
        let fills = ends.is_some_and(|(first, last)| first.start == 0 && last.end == self.text.len());
        fills && self.value_end(0) == Some(self.tokens.len())
    }

    /// The body of the value at a path; of the whole for an empty path.
    pub(super) fn body(&self, path: &str) -> Option<Body> {
        let first = if path.is_empty() { self.root()? } else { self.entry(path)?.first };
        self.body_of(first)
    }

    /// The entries of a body, up to the first unreadable one.
    pub(super) fn entries(&self, body: Body) -> impl Iterator<Item = Entry<'t>> {
        let mut next = body.open + 1;
        std::iter::from_fn(move || {
            if next >= body.close {
                return None;
            }
            let name = self.word(next).filter(|_| self.is(next + 1, Kind::Colon));
            let first = if name.is_some() { next + 2 } else { next };
            let end = self.value_end(first).filter(|end| *end <= body.close)?;
            let value = self.tokens[first].start..self.tokens[end - 1].end;
            let entry = self.tokens[next].start..value.end;
            let comma = self.is(end, Kind::Comma).then(|| self.tokens[end].end);
            // Without a comma this is the last entry, regardless of the text after it.
            next = if comma.is_some() { end + 1 } else { body.close };
            Some(Entry { name, span: Span { entry, value }, comma, first })
        })
    }

    /// Range from the byte after the opening bracket to the closing one.
    pub(super) fn inside(&self, body: Body) -> Range<usize> {
        self.tokens[body.open].end..self.tokens[body.close].start
    }

    /// Path of the innermost entry that contains a byte; empty if there is none.
    pub(in crate::scene) fn path_at(&self, offset: usize) -> String {
        let mut path = String::new();
        let mut body = self.root().and_then(|root| self.body_of(root));
        while let Some(here) = body {
            let mut entries = self.entries(here).enumerate();
            let inside = entries.find(|(_, Entry { span: Span { entry, .. }, .. })| {
                entry.start <= offset && offset < entry.end
            });
            let Some((index, entry)) = inside else {
                break;
            };
            if !path.is_empty() {
                path.push('.');
            }
            path.push_str(&entry.name.map_or_else(|| index.to_string(), str::to_string));
            body = self.body_of(entry.first);
        }
        path
    }

    fn entry(&self, path: &str) -> Option<Entry<'t>> {
        let mut body = self.body_of(self.root()?)?;
        let mut components = path.split('.').peekable();
        loop {
            let component = components.next()?;
            let mut entries = self.entries(body);
            let entry = match component.parse::<usize>() {
                Ok(index) => entries.nth(index).filter(|entry| entry.name.is_none()),
                Err(_) => entries.find(|entry| entry.name == Some(component)),
            }?;
            if components.peek().is_none() {
                return Some(entry);
            }
            body = self.body_of(entry.first)?;
        }
    }

    /// The token with which the value starts, after attributes such as `#![enable(…)]`.
    fn root(&self) -> Option<usize> {
        let mut index = 0;
        loop {
            let token = self.tokens.get(index)?;
            let text = &self.text[token.start..token.end];
            let attribute = text.starts_with('#') || index > 0 && text == "!";
            if !attribute {
                return Some(index);
            }
            index += 1;
            if let Some(Token { kind: Kind::Open('[', close), .. }) = self.tokens.get(index) {
                index = close + 1;
            }
        }
    }

    /// The token after the value that starts at a token.
    fn value_end(&self, first: usize) -> Option<usize> {
        match self.tokens.get(first)?.kind {
            Kind::Open(_, close) => Some(close + 1),
            Kind::Quoted => Some(first + 1),
            Kind::Word => match self.tokens.get(first + 1) {
                Some(Token { kind: Kind::Open('(', close), .. }) => Some(close + 1),
                _ => Some(first + 1),
            },
            Kind::Close | Kind::Comma | Kind::Colon => None,
        }
    }

    /// The body of the value that starts at a token.
    fn body_of(&self, first: usize) -> Option<Body> {
        let first = self.inside_some(first);
        let open = if self.is(first, Kind::Word) { first + 1 } else { first };
        match self.tokens.get(open)?.kind {
            Kind::Open('(', close) => Some(Body { open, close }),
            Kind::Open('[', close) if open == first => Some(Body { open, close }),
            _ => None,
        }
    }

    /// The value inside any number of `Some(…)`.
    fn inside_some(&self, first: usize) -> usize {
        let mut first = first;
        while self.word(first) == Some("Some")
            && matches!(self.tokens.get(first + 1), Some(Token { kind: Kind::Open('(', _), .. }))
            // With the extension that unwraps variants, `Some(work: 0.1)` is itself a struct.
            && !self.is(first + 3, Kind::Colon)
        {
            first += 2;
        }
        first
    }

    fn is(&self, index: usize, kind: Kind) -> bool {
        self.tokens.get(index).is_some_and(|token| token.kind == kind)
    }

    /// The word at a token, without the mark of a raw identifier.
    fn word(&self, index: usize) -> Option<&'t str> {
        let token = self.tokens.get(index).filter(|token| token.kind == Kind::Word)?;
        let word = &self.text[token.start..token.end];
        Some(word.strip_prefix("r#").unwrap_or(word))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r##"#![enable(implicit_some)]
#! [ enable(unwrap_newtypes) ]
// A comment with ( and "quotes".
Scene(
    version: 1, /* , title: "no" /* nested */ */
    title: r#"Rough (very "rough")"#,
    material: (youngs_modulus: Some(2.0e6), poisson_ratio: 0.5),
    roughness: Some(SelfAffine(r#hurst: 0.7, modes: (1, 512,), seed: 7)),
    loading: [ToForce(1.0e-5), ToIndentation(-1e-7), ToSeparation],
    numerics: (solver: Stepwise(step: 1e-9)),
    adhesion: Some(work: 0.05),
)
"##;

    fn value(path: &str) -> Option<&'static str> {
        Text::new(SCENE).unwrap().written(path)
    }

    #[test]
    fn values_are_found_by_path() {
        for (path, expected) in [
            ("version", Some("1")),
            ("title", Some("r#\"Rough (very \"rough\")\"#")),
            ("material", Some("(youngs_modulus: Some(2.0e6), poisson_ratio: 0.5)")),
            ("material.youngs_modulus", Some("Some(2.0e6)")),
            ("material.poisson_ratio", Some("0.5")),
            ("roughness.hurst", Some("0.7")),
            ("roughness.modes", Some("(1, 512,)")),
            ("roughness.modes.1", Some("512")),
            ("roughness.modes.2", None),
            ("loading.1", Some("ToIndentation(-1e-7)")),
            ("loading.1.0", Some("-1e-7")),
            ("loading.2", Some("ToSeparation")),
            ("loading.2.0", None),
            ("numerics.solver.step", Some("1e-9")),
            ("adhesion.work", Some("0.05")),
            ("adhesion.kappa", None),
            ("form", None),
            ("0", None),
            ("", None),
            ("version.", None),
        ] {
            assert_eq!(value(path), expected, "{path}");
        }
    }

    #[test]
    fn entries_start_with_their_names() {
        let text = Text::new(SCENE).unwrap();
        assert_eq!(&SCENE[text.span("roughness.seed").unwrap().entry], "seed: 7");
        let span = text.span("loading.2").unwrap();
        assert_eq!(span.entry, span.value);
    }

    #[test]
    fn variants_are_read_through_some() {
        let text = Text::new(SCENE).unwrap();
        assert_eq!(text.variant("roughness"), Some("SelfAffine"));
        assert_eq!(text.variant("loading.0"), Some("ToForce"));
        assert_eq!(text.variant("material"), None);
        assert_eq!(text.value("material.youngs_modulus"), Some("2.0e6"));
        assert_eq!(text.value("adhesion"), Some("Some(work: 0.05)"));
        assert_eq!(text.opening(""), SCENE.find("Scene(").map(|start| start + "Scene".len()));
        assert_eq!((text.opening("length"), text.opening("version")), (None, None));
    }

    #[test]
    fn bytes_know_their_paths() {
        let outline = Text::new(SCENE).unwrap();
        for (needle, path) in [
            ("0.7", "roughness.hurst"),
            ("512", "roughness.modes.1"),
            ("-1e-7", "loading.1.0"),
            ("r#hurst", "roughness.hurst"),
            ("nested", ""),
            ("1e-9", "numerics.solver.step"),
        ] {
            assert_eq!(outline.path_at(SCENE.find(needle).unwrap()), path, "{needle}");
        }
    }

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

    #[test]
    fn nested_somes_do_not_recurse() {
        let nested = format!("(form: {}1{})", "Some(".repeat(100_000), ")".repeat(100_000));
        let text = Text::new(&nested).unwrap();
        assert!(text.span("form").is_some());
        assert_eq!(text.span("form.radius"), None);
        assert_eq!(text.path_at(nested.find('1').unwrap()), "form");
    }
}
