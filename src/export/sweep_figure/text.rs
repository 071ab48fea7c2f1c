//! Figures as text for a terminal, or for a file.

use super::label::{plain, short};
use super::{text_map, text_section};
use crate::study::figure::Figure;
use crate::text::printable;
use plotters::prelude::RGBColor;

/// Narrowest text, columns.
const NARROWEST: usize = 40;
/// Widest: beyond this a reader loses the row.
const WIDEST: usize = 160;

/// How a terminal shows colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// Not at all: shades are characters.
    None,
    /// 256 fixed ones.
    Palette,
    /// Any.
    All,
}

/// A figure as text of so many columns, one panel below the other.
#[must_use]
pub fn figure_text(figure: &Figure, columns: usize, colours: Colours) -> String {
    let columns = columns.clamp(NARROWEST, WIDEST);
    let mut text = String::new();
    for line in [&figure.title, &figure.fixed.join(", ")] {
        push_words(&mut text, &printable(line), columns);
    }
    for panel in &figure.panels {
        if !text.is_empty() {
            text.push('\n');
        }
        match &figure.up {
            Some(up) => text_map::draw(&mut text, figure, up, panel, columns, colours),
            None => text_section::draw(&mut text, figure, panel, columns),
        }
    }
    text
}

/// Adds words, on as many lines as they take.
pub(super) fn push_words(text: &mut String, words: &str, columns: usize) {
    let mut line = String::new();
    for word in words.split_whitespace() {
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > columns {
            text.push_str(&line);
            text.push('\n');
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    if !line.is_empty() {
        text.push_str(&line);
        text.push('\n');
    }
}

/// Numbers below an axis, as many as have room. `places` are columns with their numbers.
pub(super) fn numbers_below(before: usize, places: &[(usize, String)], columns: usize) -> String {
    let mut line: Vec<char> = Vec::new();
    for (place, number) in places {
        let length = number.chars().count();
        let from = (before + place).saturating_sub(length / 2);
        if (line.is_empty() || from > line.len() + 1) && from >= line.len() && from + length <= columns {
            line.resize(from, ' ');
            line.extend(number.chars());
        }
    }
    line.into_iter().collect()
}

/// A number divided for its prefix, short.
pub(super) fn scaled(value: f64, divisor: f64) -> String {
    short(value / divisor)
}

/// Text set between two ends of a line of this width.
pub(super) fn centred(label: &str, before: usize, width: usize) -> String {
    let label = plain(label);
    let blanks = before + width.saturating_sub(label.chars().count()) / 2;
    format!("{}{label}", " ".repeat(blanks))
}

/// What makes a terminal show text on a colour, and what ends that.
pub(super) fn painted(text: &str, background: RGBColor, ink: RGBColor, colours: Colours) -> String {
    let code = |RGBColor(red, green, blue): RGBColor| match colours {
        Colours::All => format!("2;{red};{green};{blue}"),
        _ => {
            // The cube of 6 × 6 × 6 colours: 0, 95, 135, … 255.
            let level = |value: u8| u32::from(value.saturating_sub(35)) / 40;
            format!("5;{}", 16 + 36 * level(red) + 6 * level(green) + level(blue))
        }
    };
    if colours == Colours::None {
        return text.to_owned();
    }
    format!("\x1b[38;{};48;{}m{text}\x1b[0m", code(ink), code(background))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_do_not_touch() {
        let places: Vec<_> =
            (0..10).map(|place| (3 * place, format!("{:.2}", f64::from(place as u32)))).collect();
        let line = numbers_below(2, &places, 40);
        assert_eq!(line, "0.00  2.00  4.00  6.00  8.00");
        assert_eq!(numbers_below(0, &[(39, "12345".into())], 40), "", "what does not fit is left out");
    }

    #[test]
    fn colours_are_those_of_the_cube() {
        let white = RGBColor(255, 255, 255);
        let black = RGBColor(0, 0, 0);
        assert_eq!(painted("x", black, white, Colours::Palette), "\x1b[38;5;231;48;5;16mx\x1b[0m");
        assert_eq!(painted("x", black, white, Colours::All), "\x1b[38;2;255;255;255;48;2;0;0;0mx\x1b[0m");
        assert_eq!(painted("x", black, white, Colours::None), "x");
    }
}
