//! A line of text that the user is typing.

use super::theme::{Appearance, Meaning};
use asperity_data::is_control;
use ratatui::style::Modifier;
use ratatui::text::Span;
use tui_input::{Input, InputRequest};

/// Largest length of a line in characters.
const LONGEST: usize = 4096;

const TOO_LONG: &str = "a line has at most 4096 characters; the rest is left out";

#[derive(Clone, Debug, Default)]
pub struct TextLine {
    input: Input,
    /// True if the text is selected, so that the next typed character replaces it.
    selected: bool,
    /// True if a typed text that begins with a blank is appended although the line is selected.
    appends_words: bool,
    /// Message that the last insertion was incomplete; `None` if it was complete.
    left_out: Option<&'static str>,
}

impl TextLine {
    /// Creates a line with this text and the cursor at its end.
    pub fn new(text: &str) -> Self {
        let text: String = text
            .chars()
            .filter(|c| !is_control(*c))
            .take(LONGEST)
            .collect();
        TextLine {
            input: Input::new(text),
            ..TextLine::default()
        }
    }

    pub fn selected(text: &str) -> Self {
        TextLine {
            selected: true,
            ..TextLine::new(text)
        }
    }

    /// Creates a selected line to which the user can also append a word, such as the width of a
    /// figure after its name. The blank before the word appends it.
    pub fn offered(text: &str) -> Self {
        TextLine {
            appends_words: true,
            ..TextLine::selected(text)
        }
    }

    pub fn is_selected(&self) -> bool {
        self.selected
    }

    pub fn text(&self) -> &str {
        self.input.value()
    }

    /// Returns the text before the cursor, the character under the cursor, and the text after this
    /// character.
    fn parts(&self) -> (String, String, String) {
        let mut characters = self.text().chars();
        let before = characters.by_ref().take(self.input.cursor()).collect();
        let under = characters.by_ref().take(1).collect();
        (before, under, characters.collect())
    }

    /// Returns a message if the last inserted text was not inserted completely; otherwise `None`.
    pub fn left_out(&self) -> Option<&'static str> {
        self.left_out
    }

    /// Inserts a text into the typed line, before the cursor. If the line is selected, the text
    /// replaces the line, or is appended as a word. Control characters are left out. If the line
    /// would become too long, the end of the text is left out too.
    pub fn insert(&mut self, text: &str) {
        let inserted: String = text.chars().filter(|c| !is_control(*c)).collect();
        let is_appended = self.appends_words && inserted.starts_with(' ');
        if self.selected && !inserted.is_empty() && !is_appended {
            *self = TextLine::default();
        }
        self.selected &= inserted.is_empty();
        let room = LONGEST - self.text().chars().count();
        for character in inserted.chars().take(room) {
            self.input.handle(InputRequest::InsertChar(character));
        }
        self.left_out = if inserted.chars().nth(room).is_some() {
            Some(TOO_LONG)
        } else if text.contains(is_control) {
            Some("control characters are left out")
        } else {
            None
        };
    }

    /// Moves the cursor in the typed line, or deletes text. If the line is selected, a deletion
    /// removes the whole line. The line is not selected afterwards.
    pub fn edit(&mut self, request: InputRequest) {
        use InputRequest::{DeleteLine, DeleteNextChar, DeletePrevChar, DeletePrevWord};
        let deletes = matches!(request, DeletePrevChar | DeleteNextChar | DeletePrevWord);
        let request = if self.selected && deletes {
            DeleteLine
        } else {
            request
        };
        self.input.handle(request);
        self.selected = false;
        self.left_out = None;
    }

    /// Returns the text in at most this number of columns. If the text is too long, its middle is
    /// left out, because the exponent and the unit at the end of a number are more important than
    /// the digits in its middle.
    fn shortened(&self, columns: usize) -> String {
        let characters: Vec<char> = self.text().chars().collect();
        let kept = columns.saturating_sub(1);
        if Span::raw(self.text()).width() <= columns || characters.len() <= kept {
            return self.text().to_owned();
        }
        let of_end = kept / 2;
        let start = characters[..kept - of_end].iter().collect::<String>();
        let end = characters[characters.len() - of_end..]
            .iter()
            .collect::<String>();
        format!("{start}…{end}")
    }

    /// Returns the part of the line around the cursor that fits into this number of columns.
    pub fn spans(&self, columns: usize, look: Appearance) -> Vec<Span<'static>> {
        let reversed = look.style(Meaning::Text).add_modifier(Modifier::REVERSED);
        if self.selected && !self.text().is_empty() {
            return vec![Span::styled(self.shortened(columns), reversed)];
        }
        let (before, mut under, after) = self.parts();
        if under.is_empty() {
            under.push(' ');
        }
        let room = columns.saturating_sub(Span::raw(under.as_str()).width());
        vec![
            Span::raw(end_within(&before, room)),
            Span::styled(under, reversed),
            Span::raw(after),
        ]
    }
}

/// Returns the longest end of a text that fits into this number of columns.
fn end_within(text: &str, columns: usize) -> String {
    let mut room = columns;
    let mut end = Vec::new();
    for character in text.chars().rev() {
        let width = Span::raw(character.to_string()).width();
        if width > room {
            break;
        }
        room -= width;
        end.push(character);
    }
    end.into_iter().rev().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use InputRequest::{DeletePrevChar, GoToPrevChar, GoToStart};

    #[test]
    fn a_selected_text_is_replaced_or_kept_as_a_whole() {
        for (request, text, expected) in [
            (None, "\n", "1.5 µm"),
            (None, "23", "23"),
            (Some(DeletePrevChar), "", ""),
            (Some(GoToPrevChar), "m", "1.5 µmm"),
            (Some(GoToStart), "2", "21.5 µm"),
        ] {
            let mut line = TextLine::selected("1.5 µm");
            request.into_iter().for_each(|request| line.edit(request));
            line.insert(text);
            assert_eq!(
                (line.text(), line.is_selected()),
                (expected, text == "\n"),
                "{request:?}"
            );
        }
    }

    #[test]
    fn an_insertion_states_what_it_leaves_out() {
        let mut line = TextLine::new("ab");
        line.edit(GoToPrevChar);
        line.insert("1\n2\u{1b}");
        assert_eq!(
            (line.text(), line.left_out()),
            ("a12b", Some("control characters are left out"))
        );
        line.insert("3");
        assert_eq!((line.text(), line.left_out()), ("a123b", None));
        line.insert(&"µ".repeat(20_000));
        assert_eq!(
            (line.text().chars().count(), line.left_out()),
            (LONGEST, Some(TOO_LONG))
        );
        assert!(line.text().ends_with("µb") && TOO_LONG.contains(&LONGEST.to_string()));
        line.edit(DeletePrevChar);
        assert_eq!(
            (line.text().chars().count(), line.left_out()),
            (LONGEST - 1, None)
        );
    }
}
