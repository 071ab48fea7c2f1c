//! Appearance of charts in cells: markers, inks, colours, characters of signs.

use crate::draw::chart::Sign;
use crate::draw::colour::{Ink, Rgb};
use ratatui::style::{Color, Style};
use ratatui::symbols::Marker;

/// Appearance of charts in cells.
pub struct CellStyle<'a> {
    /// Marker of lines.
    pub marker: Marker,
    /// Style of each ink.
    pub ink: &'a dyn Fn(Ink) -> Style,
    /// Colours of heat maps.
    pub colours: Colours,
}

/// Colours of a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// No colours: shades are characters.
    None,
    /// 256 fixed colours.
    Palette,
    /// Any colour.
    All,
}

impl Colours {
    /// A colour in the palette of the terminal.
    #[must_use]
    pub fn colour(self, [red, green, blue]: Rgb) -> Color {
        // The cube of 6 × 6 × 6 colours: 0, 95, 135, … 255.
        let level = |value: u8| value.saturating_sub(35) / 40;
        match self {
            Colours::None => Color::Reset,
            Colours::Palette => Color::Indexed(16 + 36 * level(red) + 6 * level(green) + level(blue)),
            Colours::All => Color::Rgb(red, green, blue),
        }
    }
}

/// Character of a sign.
#[must_use]
pub fn glyph(sign: Sign) -> &'static str {
    match sign {
        Sign::Dot => "●",
        Sign::Square => "■",
        Sign::Up => "▲",
        Sign::Diamond => "◆",
        Sign::Ring => "○",
        Sign::Down => "▼",
        Sign::Cross => "×",
        Sign::HollowDiamond => "◇",
    }
}
