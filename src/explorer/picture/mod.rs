//! Screens in forms for use outside of the terminal: plain text, ASCII, an SVG document, a recording. Nothing here
//! depends on the panes.

mod ascii;
mod cast;
mod palette;
mod svg;
mod text;

pub use ascii::to_ascii;
pub use cast::Cast;
pub use svg::svg;
pub use text::text;

use crate::text::is_control;
use ratatui::buffer::{Buffer, Cell, CellDiffOption, CellWidth};

/// A symbol on the screen, with its cells.
struct Glyph<'a> {
    /// Column, from 0 at the left edge of the screen.
    column: u16,
    /// Row, from 0 at the upper edge.
    row: u16,
    /// Number of cells, at least one.
    width: u16,
    cell: &'a Cell,
}

impl<'a> Glyph<'a> {
    /// Visible symbol: a blank in place of marks without a width and of control characters.
    fn symbol(&self) -> &'a str {
        let symbol = self.cell.symbol();
        if symbol.contains(is_control) || symbol.cell_width() == 0 { " " } else { symbol }
    }

    /// The character, if only one.
    fn character(&self) -> Option<char> {
        let mut characters = self.symbol().chars();
        characters.next().filter(|_| characters.next().is_none())
    }
}

/// The symbols of a screen, row by row, without the cells behind wide characters.
fn glyphs(buffer: &Buffer) -> impl Iterator<Item = Glyph<'_>> {
    let area = buffer.area;
    (0..area.height).flat_map(move |row| {
        let mut next = 0;
        std::iter::from_fn(move || {
            let column = next;
            let left = area.width.checked_sub(column).filter(|left| *left > 0)?;
            let cell = buffer.cell((area.x + column, area.y + row))?;
            let width = width_of(cell).min(left);
            next += width;
            Some(Glyph { column, row, width, cell })
        })
    })
}

/// Cells that the symbol of a cell covers.
fn width_of(cell: &Cell) -> u16 {
    match cell.diff_option {
        CellDiffOption::ForcedWidth(width) => width.get(),
        // ratatui measures no control characters.
        _ if cell.symbol().contains(is_control) => 1,
        _ => cell.cell_width().max(1),
    }
}

/// The dots of a Braille pattern, two across and four down, bits row by row from the upper left.
fn dots(character: char) -> Option<u8> {
    /// Braille numbers three dots down each side; the lowest row came later.
    const PLACES: [u8; 8] = [0, 2, 4, 1, 3, 5, 6, 7];
    let pattern = u32::from(character).checked_sub(0x2800).and_then(|bits| u8::try_from(bits).ok())?;
    let dots = PLACES.iter().enumerate().filter(|(bit, _)| pattern >> bit & 1 == 1);
    Some(dots.fold(0, |bits, (_, place)| bits | 1 << place))
}
