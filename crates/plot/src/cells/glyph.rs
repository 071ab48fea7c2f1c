//! Characters of markers in terminal cells.

use crate::chart::Sign;

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
