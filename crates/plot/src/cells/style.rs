//! Appearance of charts in terminal cells: inks, colours, characters of signs.

use crate::chart::Sign;
use crate::colour::{Ink, Rgb};
use ratatui::style::{Color, Style};

/// Appearance of a chart in terminal cells: the style of each ink, and the colours of the terminal.
pub struct CellStyle<'a> {
    /// Style of each ink.
    pub ink: &'a dyn Fn(Ink) -> Style,
    /// Colours of the terminal.
    pub colours: Colours,
}

/// Colours that a terminal has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// No colours. Shades are characters.
    None,
    /// 256 fixed colours of a palette.
    Palette,
    /// All 24-bit colours.
    All,
}

impl Colours {
    /// Returns the colour that the terminal has and that is nearest to `Rgb`.
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
