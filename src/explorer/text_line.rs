//! A line of text being typed.

use crate::text::is_control;

/// Longest line, characters.
const LONGEST: usize = 4096;

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
}

impl TextLine {
    /// A line with this text, the cursor at its end.
    #[must_use]
    pub fn new(text: &str) -> Self {
        let characters: Vec<char> = text.chars().filter(|c| !is_control(*c)).take(LONGEST).collect();
        TextLine { cursor: characters.len(), characters, selected: false }
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

    /// Inserts a character before the cursor, or in place of the selected text.
    pub fn insert(&mut self, character: char) {
        if self.selected && !is_control(character) {
            self.clear();
        }
        if !is_control(character) && self.characters.len() < LONGEST {
            self.characters.insert(self.cursor, character);
            self.cursor += 1;
        }
    }

    /// Removes the character before the cursor, or the one under it, or the selected text.
    pub fn delete(&mut self, backwards: bool) {
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
        self.selected = false;
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
        line.insert('\n');
        assert_eq!((line.text().as_str(), line.is_selected()), ("1.5 µm", true));
        line.insert('2');
        line.insert('3');
        assert_eq!((line.text().as_str(), line.is_selected()), ("23", false));
        let mut line = TextLine::selected("1.5 µm");
        line.delete(true);
        assert_eq!((line.text().as_str(), line.is_selected()), ("", false));
        let mut line = TextLine::selected("1.5 µm");
        line.go(Motion::Left);
        line.insert('m');
        assert_eq!((line.text().as_str(), line.is_selected()), ("1.5 µmm", false));
    }

    #[test]
    fn edits_anywhere_in_the_line() {
        let mut line = TextLine::new("1.5 µm");
        line.go(Motion::Start);
        line.insert('2');
        line.delete(false);
        assert_eq!(line.text(), "2.5 µm");
        line.go(Motion::End);
        line.delete(true);
        line.delete(true);
        assert_eq!(line.parts(), ("2.5 ".to_owned(), String::new(), String::new()));
        line.go(Motion::Start);
        line.delete(true);
        line.insert('\n');
        assert_eq!(line.text(), "2.5 ");
        line.clear();
        line.delete(false);
        assert_eq!(line.text(), "");
    }
}
