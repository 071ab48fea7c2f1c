//! The screen as plain text.

use super::glyphs;
use ratatui::buffer::Buffer;
use ratatui::style::Color;

/// The rows of a screen without the blanks at their ends, each closed by a line feed.
pub fn text(buffer: &Buffer) -> String {
    let mut rows = vec![String::new(); usize::from(buffer.area.height)];
    for glyph in glyphs(buffer) {
        let Some(row) = rows.get_mut(usize::from(glyph.row)) else { break };
        match glyph.symbol() {
            " " => row.extend(std::iter::repeat_n(' ', usize::from(glyph.width))),
            // The other half is filled by the colour of the background, which a text does not have.
            "▀" | "▄" if glyph.cell.bg != Color::Reset => row.push('█'),
            symbol => row.push_str(symbol),
        }
    }
    rows.iter().map(|row| row.trim_end().to_owned() + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::layout::Rect;
    use ratatui::style::Style;

    #[test]
    fn rows_lose_the_blanks_at_their_ends() {
        let buffer = Buffer::with_lines(["  a b  ", "", "⠒ ⠒▌ "]);
        assert_eq!(text(&buffer), "  a b\n\n⠒ ⠒▌\n");
    }

    #[test]
    fn wide_characters_and_marks_stand_once() {
        let mut buffer = Buffer::empty(Rect::new(3, 2, 8, 1));
        buffer.set_string(3, 2, "漢字e\u{301}x", Style::new());
        assert_eq!(text(&buffer), "漢字e\u{301}x\n");
    }

    #[test]
    fn halves_in_two_colours_are_whole() {
        let mut buffer = Buffer::with_lines(["▀▄▀"]);
        buffer[(0, 0)].set_bg(Color::Red);
        buffer[(1, 0)].set_bg(Color::Red);
        assert_eq!(text(&buffer), "██▀\n");
    }

    #[test]
    fn an_empty_screen_has_no_rows() {
        assert_eq!(text(&Buffer::empty(Rect::ZERO)), "");
        assert_eq!(text(&Buffer::empty(Rect::new(0, 0, 0, 2))), "\n\n");
    }
}
