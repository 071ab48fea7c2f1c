//! A line of text being typed.

use crate::text::is_control;

/// Longest line, characters.
const LONGEST: usize = 4096;

/// Message about a longer one.
const TOO_LONG: &str = "a line has at most 4096 characters; the rest is left out";

/// A motion in a line of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// One character to the left.
    Left,
    /// One character to the right.
    Right,
    /// To the start.
    Start,
    /// To the end.
    End,
}

/// A line of text with a cursor.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextLine {
    characters: Vec<char>,
    cursor: usize,
    /// True if the text is selected: the next character replaces it.
    selected: bool,
    /// Message about the part that the last insertion left out.
    left_out: Option<&'static str>,
}

impl TextLine {
    /// A line with this text, the cursor at its end.
    #[must_use]
    pub fn new(text: &str) -> Self {
        let characters: Vec<char> = text.chars().filter(|c| !is_control(*c)).take(LONGEST).collect();
        TextLine { cursor: characters.len(), characters, ..TextLine::default() }
    }

    /// A line with this text, all of it selected.
    #[must_use]
    pub fn selected(text: &str) -> Self {
        TextLine { selected: true, ..TextLine::new(text) }
    }

    /// Returns true if the text is selected.
    #[must_use]
    pub fn is_selected(&self) -> bool {
        self.selected
    }

    /// The text.
    #[must_use]
    pub fn text(&self) -> String {
        self.characters.iter().collect()
    }

    /// The text before the cursor, under it and after it.
    #[must_use]
    pub fn parts(&self) -> (String, String, String) {
        let (before, rest) = self.characters.split_at(self.cursor);
        let (under, after) = rest.split_at(rest.len().min(1));
        (before.iter().collect(), under.iter().collect(), after.iter().collect())
    }

    /// Message about the part that the last insertion left out; `None` after a whole one.
    #[must_use]
    pub fn left_out(&self) -> Option<&'static str> {
        self.left_out
    }

    /// Inserts a text before the cursor, or in place of the selected text, as far as it fits, without its control
    /// characters.
    pub fn insert(&mut self, text: &str) {
        let mut inserted = text.chars().filter(|character| !is_control(*character)).peekable();
        if self.selected && inserted.peek().is_some() {
            self.clear();
        }
        let room = LONGEST - self.characters.len();
        let rest = self.characters.split_off(self.cursor);
        self.characters.extend(inserted.by_ref().take(room));
        self.cursor = self.characters.len();
        self.characters.extend(rest);
        self.left_out = if inserted.next().is_some() {
            Some(TOO_LONG)
        } else {
            text.contains(is_control).then_some("control characters are left out")
        };
    }

    /// Removes the character before the cursor, or the one under it, or the selected text.
    pub fn delete(&mut self, backwards: bool) {
        self.left_out = None;
        if self.selected {
            return self.clear();
        }
        if backwards && self.cursor > 0 {
            self.cursor -= 1;
        } else if backwards {
            return;
        }
        if self.cursor < self.characters.len() {
            self.characters.remove(self.cursor);
        }
    }

    /// Moves the cursor; nothing is selected any more.
    pub fn go(&mut self, motion: Motion) {
        (self.selected, self.left_out) = (false, None);
        self.cursor = match motion {
            Motion::Left => self.cursor.saturating_sub(1),
            Motion::Right => (self.cursor + 1).min(self.characters.len()),
            Motion::Start => 0,
            Motion::End => self.characters.len(),
        };
    }

    /// Empties the line.
    pub fn clear(&mut self) {
        *self = TextLine::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_selected_text_is_replaced_or_kept_as_a_whole() {
        let mut line = TextLine::selected("1.5 µm");
        line.insert("\n");
        assert_eq!((line.text().as_str(), line.is_selected()), ("1.5 µm", true));
        line.insert("2");
        line.insert("3");
        assert_eq!((line.text().as_str(), line.is_selected()), ("23", false));
        let mut line = TextLine::selected("1.5 µm");
        line.delete(true);
        assert_eq!((line.text().as_str(), line.is_selected()), ("", false));
        let mut line = TextLine::selected("1.5 µm");
        line.go(Motion::Left);
        line.insert("m");
        assert_eq!((line.text().as_str(), line.is_selected()), ("1.5 µmm", false));
    }

    #[test]
    fn an_insertion_states_what_it_leaves_out() {
        let mut line = TextLine::new("ab");
        line.go(Motion::Left);
        line.insert("1\n2\u{1b}");
        assert_eq!(
            (line.text().as_str(), line.left_out()),
            ("a12b", Some("control characters are left out"))
        );
        line.insert("3");
        assert_eq!((line.text().as_str(), line.left_out()), ("a123b", None));
        line.insert(&"µ".repeat(20_000));
        assert_eq!((line.text().chars().count(), line.left_out()), (LONGEST, Some(TOO_LONG)));
        assert!(line.text().ends_with("µb") && TOO_LONG.contains(&LONGEST.to_string()));
        line.insert("µ");
        assert_eq!((line.text().chars().count(), line.left_out()), (LONGEST, Some(TOO_LONG)));
        line.delete(true);
        assert_eq!((line.text().chars().count(), line.left_out()), (LONGEST - 1, None));
    }

    #[test]
    fn edits_anywhere_in_the_line() {
        let mut line = TextLine::new("1.5 µm");
        line.go(Motion::Start);
        line.insert("2");
        line.delete(false);
        assert_eq!(line.text(), "2.5 µm");
        line.go(Motion::End);
        line.delete(true);
        line.delete(true);
        assert_eq!(line.parts(), ("2.5 ".to_owned(), String::new(), String::new()));
        line.go(Motion::Start);
        line.delete(true);
        line.insert("\n");
        assert_eq!(line.text(), "2.5 ");
        line.clear();
        line.delete(false);
        assert_eq!(line.text(), "");
    }
}
