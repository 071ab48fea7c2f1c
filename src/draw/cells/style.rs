//! Appearance of charts in cells: inks, colours, characters of signs.

use crate::draw::chart::Sign;
use crate::draw::colour::{Ink, Rgb};
use ratatui::style::{Color, Style};

pub struct CellStyle<'a> {
    pub ink: &'a dyn Fn(Ink) -> Style,
    pub colours: Colours,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// No colours: shades are characters.
    None,
    /// 256 fixed colours.
    Palette,
    All,
}

impl Colours {
    /// A colour in the palette of the terminal.
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
    }
}
