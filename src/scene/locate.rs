//! Where a field stands in the text of a scene.
//!
//! Paths go by names and, in lists and tuples, by position: `roughness.hurst`, `loading.0`,
//! `roughness.modes.1`. The names of structs and variants and `Some(…)` are transparent, so
//! `roughness: Some(SelfAffine(hurst: 0.7))` has its 0.7 at `roughness.hurst`.

use std::ops::Range;

use super::scan::{Bracket, Kind, Token, Unreadable, tokens};

/// Where a field stands, in bytes of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The whole entry, `name: value`; the same as `value` in a list.
    pub entry: Range<usize>,
    /// The value alone.
    pub value: Range<usize>,
}

/// Where a field stands in a text; `None` where it does not, or where brackets and quotes do not
/// match.
pub fn locate(text: &str, path: &str) -> Option<Place> {
    Outline::of(text).ok()?.find(path)
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

/// The byte at a line and column, the end of the line or of the text where there is none.
pub(super) fn offset_of(text: &str, line: usize, column: usize) -> usize {
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

/// The values of a text and how they contain each other.
pub(super) struct Outline<'t> {
    text: &'t str,
    tokens: Vec<Token>,
}

/// What stands between two brackets: the indices of their tokens.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    open: usize,
    close: usize,
}

/// One entry of a body.
#[derive(Clone, Debug)]
pub(super) struct Entry<'t> {
    /// The name, for `name: value`.
    pub(super) name: Option<&'t str>,
    /// The bytes of the entry and of its value.
    pub(super) place: Place,
    /// The byte after the comma that follows.
    pub(super) comma: Option<usize>,
    /// Token with which the value starts.
    first: usize,
}

impl<'t> Outline<'t> {
    pub(super) fn of(text: &'t str) -> Result<Outline<'t>, Unreadable> {
        Ok(Outline { text, tokens: tokens(text)? })
    }

    /// Whether the text is one value and nothing else but blanks and comments.
    pub(super) fn is_one_value(&self) -> bool {
        self.value_end(0) == Some(self.tokens.len())
    }

    /// Where a field stands.
    pub(super) fn find(&self, path: &str) -> Option<Place> {
        self.entry(path).map(|entry| entry.place)
    }

    /// The name a value starts with, that of its variant: `Cone` for `Some(Cone(angle: 0.1))`.
    pub(super) fn head(&self, path: &str) -> Option<&'t str> {
        let first = self.inside_some(self.entry(path)?.first);
        self.word(first)
    }

    /// The value at a path without any `Some(…)` around it.
    pub(super) fn inner(&self, path: &str) -> Option<&'t str> {
        let first = self.inside_some(self.entry(path)?.first);
        let end = self.value_end(first)?;
        self.text.get(self.tokens[first].start..self.tokens[end - 1].end)
    }

    /// The body of the value at a path; the scene's own for the empty path.
    pub(super) fn body(&self, path: &str) -> Option<Body> {
        let first = if path.is_empty() { self.root()? } else { self.entry(path)?.first };
        self.body_of(first)
    }

    /// The entries of a body, up to the first that cannot be read.
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
            // Without a comma this is the last entry, whatever follows it.
            next = if comma.is_some() { end + 1 } else { body.close };
            Some(Entry { name, place: Place { entry, value }, comma, first })
        })
    }

    /// The byte after the opening bracket and that of the closing one.
    pub(super) fn inside(&self, body: Body) -> Range<usize> {
        self.tokens[body.open].end..self.tokens[body.close].start
    }

    /// Path of the innermost entry that contains a byte; empty where none does.
    pub(super) fn path_at(&self, offset: usize) -> String {
        let mut path = String::new();
        let mut body = self.root().and_then(|root| self.body_of(root));
        while let Some(here) = body {
            let mut entries = self.entries(here).enumerate();
            let inside = entries.find(|(_, Entry { place: Place { entry, .. }, .. })| {
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

    /// The token with which the scene starts, after attributes such as `#![enable(…)]`.
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
            if let Some(Token { kind: Kind::Open(Bracket::Square, close), .. }) = self.tokens.get(index) {
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
                Some(Token { kind: Kind::Open(Bracket::Round, close), .. }) => Some(close + 1),
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
            Kind::Open(Bracket::Round, close) => Some(Body { open, close }),
            Kind::Open(Bracket::Square, close) if open == first => Some(Body { open, close }),
            _ => None,
        }
    }

    /// The value inside any number of `Some(…)`.
    fn inside_some(&self, first: usize) -> usize {
        let mut first = first;
        while self.word(first) == Some("Some")
            && matches!(self.tokens.get(first + 1), Some(Token { kind: Kind::Open(Bracket::Round, _), .. }))
            // With the extension that unwraps variants, `Some(work: 0.1)` is a struct itself.
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
        locate(SCENE, path).map(|place| &SCENE[place.value])
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
        let place = locate(SCENE, "roughness.seed").unwrap();
        assert_eq!(&SCENE[place.entry], "seed: 7");
        let place = locate(SCENE, "loading.2").unwrap();
        assert_eq!(place.entry, place.value);
    }

    #[test]
    fn heads_are_variants() {
        let outline = Outline::of(SCENE).unwrap();
        assert_eq!(outline.head("roughness"), Some("SelfAffine"));
        assert_eq!(outline.head("loading.0"), Some("ToForce"));
        assert_eq!(outline.head("material"), None);
        assert_eq!(outline.inner("material.youngs_modulus"), Some("2.0e6"));
        assert_eq!(outline.inner("adhesion"), Some("Some(work: 0.05)"));
    }

    #[test]
    fn bytes_know_their_paths() {
        let outline = Outline::of(SCENE).unwrap();
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
        let text = format!("(form: {}1{})", "Some(".repeat(100_000), ")".repeat(100_000));
        assert!(locate(&text, "form").is_some());
        assert_eq!(locate(&text, "form.radius"), None);
        assert_eq!(Outline::of(&text).unwrap().path_at(text.find('1').unwrap()).len(), "form".len());
    }
}
