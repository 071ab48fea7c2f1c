//! Screens in forms for use outside of the terminal: plain text, ASCII, a
//! picture, a recording. Nothing here depends on the panes.

mod ascii;
mod cast;
mod letters;
mod outline;
mod palette;
mod png;
mod raster;
mod sheet;
mod strokes;
mod svg;
mod text;

pub use ascii::to_ascii;
pub use cast::Cast;
pub use png::png;
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
