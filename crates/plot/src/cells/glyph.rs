//! Characters of markers in terminal cells.

use crate::chart::Sign;
use ratatui::buffer::Cell;

/// Returns the character with which a terminal shows a marker.
pub fn glyph(sign: Sign) -> &'static str {
    match sign {
        Sign::Dot => "●",
        Sign::Square => "■",
        Sign::Up => "▲",
        Sign::Diamond => "◆",
        Sign::Ring => "○",
        Sign::Down => "▼",
        Sign::Left => "◀",
        Sign::Right => "▶",
        Sign::Cross => "×",
        Sign::HollowDiamond => "◇",
        Sign::Point => "⠪",
    }
}

/// Returns true for a cell without content.
pub fn is_blank(cell: &Cell) -> bool {
    matches!(cell.symbol(), " " | "\u{2800}")
}
