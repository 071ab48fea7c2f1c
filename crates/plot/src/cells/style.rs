//! Appearance of charts in terminal cells: inks, colours, characters of signs.

use crate::chart::Sign;
use crate::colour::{Ink, Rgb};
use ratatui::style::{Color, Style};

/// Appearance of a chart in a terminal: the style of each [`Ink`], and the colours that the terminal has.
pub struct CellStyle<'a> {
    /// Function that returns the style, such as the colour, of an ink.
    pub ink: &'a dyn Fn(Ink) -> Style,
    /// Colours that the terminal has.
    pub colours: Colours,
}

/// Colours that a terminal has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// No colours. A heat map is drawn with the characters [`SHADES`](crate::SHADES).
    None,
    /// The 256 fixed colours of a terminal of 8 bits.
    Palette,
    /// All colours of 24 bits.
    All,
}

impl Colours {
    /// Returns the colour of the terminal that is nearest to this one.
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

/// Returns the character of a sign.
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
