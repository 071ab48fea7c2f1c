//! Appearance of charts in terminal cells: the styles of inks, the available colours, and the
//! characters of markers. An ink is the meaning of a line, an area or a text.

use crate::chart::Sign;
use crate::colour::{Ink, Rgb};
use ratatui::style::{Color, Style};

/// Appearance of a chart in a terminal: the style of each [`Ink`], and the colours that the
/// terminal can show. An ink is the meaning of a line, an area or a text.
pub struct CellStyle<'a> {
    /// Function that returns the style of an ink, such as its colour.
    pub ink: &'a dyn Fn(Ink) -> Style,
    /// Colours that the terminal can show.
    pub colours: Colours,
}

/// Colours that a terminal can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// Terminal without colours. A heat map is drawn with the characters [`SHADES`](crate::SHADES).
    None,
    /// Terminal with 256 fixed colours (8 bits).
    Palette,
    /// Terminal with all colours of red, green and blue (24 bits).
    All,
}

impl Colours {
    /// Converts a colour to the same or a similar colour that this terminal can show. In a terminal
    /// without colours, the result is the default colour of the terminal.
    pub fn colour(self, colour: Rgb) -> Color {
        let [red, green, blue] = colour;
        // The 256 colours contain a cube of 6 × 6 × 6 colours, with the levels 0, 95, 135, 175, 215
        // and 255.
        let level = |value: u8| value.saturating_sub(35) / 40;
        match self {
            Colours::None => Color::Reset,
            Colours::Palette => {
                Color::Indexed(16 + 36 * level(red) + 6 * level(green) + level(blue))
            }
            Colours::All => Color::Rgb(red, green, blue),
        }
    }
}

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
