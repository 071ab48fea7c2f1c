//! Tokens of RON text, with only as much detail as the search for values needs.
//!
//! The package `ron` reports invalid text. This scanner finds the positions of values, for error
//! messages and for edits that keep comments. Brackets may be nested to any depth.

use std::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// An opening bracket, with the index of the token that closes it.
    Open(char, usize),
    Close,
    Comma,
    Colon,
    /// An identifier or a number.
    Word,
    /// A string, byte string, character or byte.
    Quoted,
}

/// A token with its byte range in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) start: usize,
    pub(super) end: usize,
}

/// Reason why a text cannot be divided into tokens, and the position of the problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unreadable {
    /// Byte offset of a bracket, quote or comment that has no matching end or beginning.
    pub offset: usize,
    /// Reason in words, such as `this bracket is not closed`.
    pub reason: &'static str,
}

/// Tokens of a text, and the byte ranges of the comments between them.
#[derive(Debug)]
pub(super) struct Scan {
    pub(super) tokens: Vec<Token>,
    pub(super) comments: Vec<Range<usize>>,
}

const BLANKS: [char; 11] = [
    ' ', '\t', '\n', '\r', '\x0B', '\x0C', '\u{85}', '\u{200E}', '\u{200F}', '\u{2028}', '\u{2029}',
];

/// Divides a text into tokens. The brackets of the text must match.
pub(super) fn scan(text: &str) -> Result<Scan, Unreadable> {
    let mut tokens: Vec<Token> = Vec::new();
    let mut comments = Vec::new();
    // Brackets that are still open, each with the index of its token.
    let mut open: Vec<(usize, char)> = Vec::new();
    let mut at = skip_blank(text, 0, &mut comments)?;
    while let Some(c) = text[at..].chars().next() {
        let start = at;
        at += c.len_utf8();
        let kind = match c {
            '(' | '[' | '{' => {
                open.push((tokens.len(), c));
                Kind::Open(c, 0)
            }
            ')' | ']' | '}' => {
                let Some((opener, bracket)) =
                    open.pop().filter(|(_, bracket)| closing(*bracket) == c)
                else {
                    return Err(unreadable(start, "this bracket closes nothing"));
                };
                tokens[opener].kind = Kind::Open(bracket, tokens.len());
                Kind::Close
            }
            ',' => Kind::Comma,
            ':' => Kind::Colon,
            _ => match quoted_end(text, start) {
                Some(Ok(end)) => {
                    at = end;
                    Kind::Quoted
                }
                Some(Err(reason)) => return Err(unreadable(start, reason)),
                None => {
                    at = word_end(text, start);
                    Kind::Word
                }
            },
        };
        tokens.push(Token {
            kind,
            start,
            end: at,
        });
        at = skip_blank(text, at, &mut comments)?;
    }
    match open.last() {
        Some((opener, _)) => {
            let offset = tokens[*opener].start;
            Err(unreadable(offset, "this bracket is not closed"))
        }
        None => Ok(Scan { tokens, comments }),
    }
}

fn unreadable(offset: usize, reason: &'static str) -> Unreadable {
    Unreadable { offset, reason }
}

fn closing(bracket: char) -> char {
    match bracket {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

/// Returns the offset of the first byte, at `start` or later, that is neither blank nor part of a
/// comment. Adds the comments before it to `comments`.
fn skip_blank(
    text: &str,
    start: usize,
    comments: &mut Vec<Range<usize>>,
) -> Result<usize, Unreadable> {
    let mut start = start;
    loop {
        let rest = &text[start..];
        let blanks = rest.find(|sign| !BLANKS.contains(&sign));
        let next = start + blanks.unwrap_or(rest.len());
        let Some(end) = comment_end(text, next)? else {
            return Ok(next);
        };
        comments.push(next..end);
        start = end;
    }
}

/// Returns the end of the comment that starts at the byte `start`. For `//` it is the line break,
/// for `/* */` the byte after the comment. Block comments may be nested. Returns `None` if no
/// comment starts at this byte.
fn comment_end(text: &str, start: usize) -> Result<Option<usize>, Unreadable> {
    let rest = &text[start..];
    if rest.starts_with("//") {
        return Ok(Some(start + rest.find('\n').unwrap_or(rest.len())));
    }
    if !rest.starts_with("/*") {
        return Ok(None);
    }
    let bytes = rest.as_bytes();
    let mut level = 0_usize;
    let mut index = 0;
    while index + 1 < bytes.len() {
        match &bytes[index..index + 2] {
            b"/*" => {
                level += 1;
                index += 2;
            }
            b"*/" => {
                level -= 1;
                index += 2;
                if level == 0 {
                    return Ok(Some(start + index));
                }
            }
            _ => index += 1,
        }
    }
    Err(unreadable(start, "this comment is not closed"))
}

/// Returns the end of the string or character that starts at the byte `start`. Returns `None` if
/// none starts at this byte.
fn quoted_end(text: &str, start: usize) -> Option<Result<usize, &'static str>> {
    let rest = &text[start..];
    let unprefixed = rest.strip_prefix('b').unwrap_or(rest);
    let inside = start + rest.len() - unprefixed.len() + 1;
    if unprefixed.starts_with('"') {
        return Some(escaped_end(text, inside, '"'));
    }
    if unprefixed.starts_with('\'') {
        return Some(escaped_end(text, inside, '\''));
    }
    let raw = unprefixed.strip_prefix('r')?;
    let hashes = raw.len() - raw.trim_start_matches('#').len();
    let content = raw[hashes..].strip_prefix('"')?;
    let closing = format!("\"{}", &raw[..hashes]);
    let end = content.find(&closing).ok_or("this string is not closed");
    Some(end.map(|end| text.len() - content.len() + end + closing.len()))
}

fn escaped_end(text: &str, inside: usize, quote: char) -> Result<usize, &'static str> {
    let mut escaped = false;
    for (offset, c) in text[inside..].char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            // A quote directly after the opening quote of a character, as in ''', is the character
            // itself and does not end it.
            c if c == quote && !(quote == '\'' && offset == 0) => return Ok(inside + offset + 1),
            _ => {}
        }
    }
    Err("this string is not closed")
}

/// Returns the end of the identifier or number that starts at the byte `start`.
fn word_end(text: &str, start: usize) -> usize {
    let rest = &text[start..];
    let mut characters = rest.char_indices().skip(1);
    let end = characters.find(|(_, c)| {
        BLANKS.contains(c)
            || matches!(
                c,
                '(' | ')' | '[' | ']' | '{' | '}' | ',' | ':' | '"' | '\'' | '/'
            )
    });
    start + end.map_or(rest.len(), |(end, _)| end)
}
