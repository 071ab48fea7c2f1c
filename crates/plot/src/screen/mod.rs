//! Converts screens of a terminal to plain text, to ASCII, or to an SVG document.

pub(crate) mod ascii;
pub(crate) mod svg;

use ratatui::buffer::{Buffer, Cell, CellWidth};

struct Glyph<'a> {
    /// Column, counted from 0 at the left edge of the screen.
    column: u16,
    /// Row, counted from 0 at the upper edge.
    row: u16,
    /// Number of columns of the symbol.
    width: u16,
    cell: &'a Cell,
}

impl<'a> Glyph<'a> {
    /// Returns the symbol in the cell, or a blank if the symbol has no width.
    fn symbol(&self) -> &'a str {
        if self.cell.symbol().cell_width() == 0 {
            " "
        } else {
            self.cell.symbol()
        }
    }

    /// Returns the character in the cell; `None` if the symbol consists of several characters.
    fn character(&self) -> Option<char> {
        let mut characters = self.symbol().chars();
        characters.next().filter(|_| characters.next().is_none())
    }
}

/// Returns the symbols of a screen, row by row, without the cells covered by wide characters.
fn glyphs(buffer: &Buffer) -> Vec<Glyph<'_>> {
    let area = buffer.area;
    let mut glyphs = Vec::new();
    for row in 0..area.height {
        let mut column = 0;
        while column < area.width {
            let Some(cell) = buffer.cell((area.x + column, area.y + row)) else {
                break;
            };
            let width = cell.symbol().cell_width().clamp(1, area.width - column);
            glyphs.push(Glyph {
                column,
                row,
                width,
                cell,
            });
            column += width;
        }
    }
    glyphs
}

/// Returns the dots of a Braille character, two in each of four rows, as bits: row by row,
/// beginning with the upper left dot. Returns `None` for other characters.
fn dots(character: char) -> Option<u8> {
    /// Place of each Unicode bit among the returned bits. Unicode first numbers the three upper
    /// dots of the left column, then the three upper dots of the right column, and then the two
    /// dots of the lowest row.
    const PLACES: [u8; 8] = [0, 2, 4, 1, 3, 5, 6, 7];
    let pattern = u32::from(character)
        .checked_sub(0x2800)
        .and_then(|bits| u8::try_from(bits).ok())?;
    let mut dots = 0;
    for (bit, place) in PLACES.iter().enumerate() {
        if pattern >> bit & 1 == 1 {
            dots |= 1 << place;
        }
    }
    Some(dots)
}

/// Returns a screen as plain text, with one line for each row. Blanks at the ends of the lines are
/// left out.
pub fn screen_text(buffer: &Buffer) -> String {
    let mut rows = vec![String::new(); usize::from(buffer.area.height)];
    for glyph in glyphs(buffer) {
        let Some(row) = rows.get_mut(usize::from(glyph.row)) else {
            break;
        };
        match glyph.symbol() {
            " " => row.extend(std::iter::repeat_n(' ', usize::from(glyph.width))),
            symbol => row.push_str(symbol),
        }
    }
    rows.iter()
        .map(|row| row.trim_end().to_owned() + "\n")
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_lose_the_blanks_at_their_ends_and_wide_characters_stand_once() {
        for (rows, expected) in [
            (&["  a b  ", "", "⠒ ⠒▌ "][..], "  a b\n\n⠒ ⠒▌\n"),
            (&["漢字e\u{301}x"], "漢字e\u{301}x\n"),
            (&["", ""], "\n\n"),
            (&[], ""),
        ] {
            assert_eq!(
                screen_text(&Buffer::with_lines(rows.iter().copied())),
                expected
            );
        }
    }
}
