//! Colours and text styles for each kind of content, such as the curve of loading. Different
//! characters distinguish the kinds too, so that colours are not necessary.

use clap::ValueEnum;
use ratatui::style::{Color, Modifier, Style};
use serde::{Deserialize, Serialize};
use std::ffi::OsString;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Appearance {
    pub theme: Theme,
    pub marker: Marker,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
pub enum Theme {
    /// Colours that read on dark and on light backgrounds
    Neutral,
    /// Bright colours for a dark background
    Dark,
    /// Dark colours for a light background
    Light,
    /// No colours, only bold, dim and reverse
    Plain,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
pub enum Marker {
    /// Braille dots, 2 × 4 in a cell
    Braille,
    /// Nothing but ASCII, in the text too
    Ascii,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    Line,
    Surface,
    Contact,
    Approach,
    Retraction,
    Manual,
    Ghost,
    Cursor,
    /// Frames, axes and less important text.
    Quiet,
    Title,
    Selected,
    Error,
    Key,
    Text,
}

impl Appearance {
    /// Returns the appearance that suits the environment. `NO_COLOR` and `COLORFGBG` determine the
    /// colours. Plots are drawn in ASCII on the Linux console (`TERM=linux`) and in a locale
    /// without Unicode (`C`, `POSIX`), because these cannot show Braille characters.
    pub fn of_environment() -> Self {
        let theme = match variable("COLORFGBG") {
            _ if variable("NO_COLOR").is_some() => Theme::Plain,
            Some(colours) => Theme::on_background(&colours.to_string_lossy()),
            None => Theme::Neutral,
        };
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"]
            .into_iter()
            .find_map(variable);
        let is_ascii = locale.is_some_and(|locale| locale == "C" || locale == "POSIX");
        let is_console = variable("TERM").is_some_and(|term| term == "linux");
        Appearance {
            theme,
            marker: if is_ascii || is_console {
                Marker::Ascii
            } else {
                Marker::Braille
            },
        }
    }
}

/// Returns the value of an environment variable; `None` if it is missing or empty.
fn variable(name: &str) -> Option<OsString> {
    let value = std::env::var_os(name)?;
    if value.is_empty() { None } else { Some(value) }
}

impl Theme {
    /// Returns the theme that suits a value of `COLORFGBG`. The last number in this value is the
    /// colour of the background.
    fn on_background(colours: &str) -> Self {
        match colours.rsplit(';').next().map(str::parse::<u8>) {
            Some(Ok(7 | 9..=15)) => Theme::Light,
            Some(Ok(0..=6 | 8)) => Theme::Dark,
            _ => Theme::Neutral,
        }
    }

    pub fn colour(self, meaning: Meaning) -> Color {
        use Meaning::{
            Approach, Contact, Cursor, Error, Ghost, Key, Line, Manual, Quiet, Retraction,
            Selected, Surface, Text, Title,
        };
        match (self, meaning) {
            // In every theme with colours, only the contact is red. Marks and errors have no colour
            // and are bold instead.
            (Theme::Plain, _) | (_, Line | Text | Selected | Title | Key | Cursor | Error) => {
                Color::Reset
            }
            (Theme::Neutral | Theme::Light, Quiet | Ghost) => Color::DarkGray,
            (Theme::Dark, Quiet | Ghost) => Color::Gray,
            (Theme::Neutral | Theme::Light, Surface) => Color::Blue,
            (Theme::Neutral | Theme::Light, Contact) => Color::Red,
            (Theme::Neutral | Theme::Light, Approach) => Color::Green,
            (Theme::Neutral | Theme::Light, Retraction) => Color::Magenta,
            (Theme::Neutral | Theme::Light, Manual) => Color::Cyan,
            (Theme::Dark, Surface) => Color::LightBlue,
            (Theme::Dark, Contact) => Color::LightRed,
            (Theme::Dark, Approach) => Color::LightGreen,
            (Theme::Dark, Retraction) => Color::LightMagenta,
            (Theme::Dark, Manual) => Color::LightYellow,
        }
    }

    pub fn style(self, meaning: Meaning) -> Style {
        let style = Style::new().fg(self.colour(meaning));
        match meaning {
            Meaning::Title | Meaning::Key | Meaning::Error | Meaning::Cursor => {
                style.add_modifier(Modifier::BOLD)
            }
            Meaning::Selected => style.add_modifier(Modifier::REVERSED),
            // Without colours, the surface is dim and the contact bold, so that profile, surface
            // and contact can be distinguished.
            Meaning::Quiet | Meaning::Ghost | Meaning::Surface if self == Theme::Plain => {
                style.add_modifier(Modifier::DIM)
            }
            Meaning::Contact if self == Theme::Plain => style.add_modifier(Modifier::BOLD),
            _ => style,
        }
    }
}

/// Option with several values, through which a key steps one by one.
pub trait Cycle: ValueEnum + PartialEq + 'static {
    /// Returns the next value. The first value follows the last one.
    fn next(self) -> Self {
        let all = Self::value_variants();
        let place = all.iter().position(|other| *other == self).unwrap_or(0);
        all[(place + 1) % all.len()].clone()
    }

    fn name(self) -> String {
        self.to_possible_value()
            .map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

impl Cycle for Theme {}
impl Cycle for Marker {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_background_is_read_from_its_number() {
        assert_eq!(Theme::on_background("0;15"), Theme::Light);
        assert_eq!(Theme::on_background("15;0"), Theme::Dark);
        assert_eq!(Theme::on_background("12;default;8"), Theme::Dark);
        assert_eq!(Theme::on_background("default"), Theme::Neutral);
    }

    #[test]
    fn every_theme_with_colours_separates_profile_surface_and_contact() {
        for theme in Theme::value_variants()
            .iter()
            .filter(|theme| **theme != Theme::Plain)
        {
            let [line, surface, contact] = [Meaning::Line, Meaning::Surface, Meaning::Contact]
                .map(|meaning| theme.colour(meaning));
            assert!(
                line != surface && surface != contact && line != contact,
                "{theme:?}"
            );
        }
    }
}
