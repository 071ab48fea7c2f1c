//! Colours and text styles of the explorer. Characters and bold text distinguish the same things,
//! so that colours are not necessary. The colours themselves are in the table of [`asperity_plot`].

use asperity_plot::{Background, ColourRole, Colours, Ink, Palette};
use clap::ValueEnum;
use ratatui::style::{Modifier, Style};
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Appearance {
    pub theme: Theme,
    pub colours: Colours,
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
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
pub enum Marker {
    /// Braille dots, 2 × 4 in a cell
    Braille,
    /// Nothing but ASCII, in the text too
    Ascii,
}

/// Meaning of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    Cursor,
    /// Frames, axes and less important text.
    Quiet,
    Title,
    /// Heading of a group of rows.
    Heading,
    Selected,
    Error,
    Key,
    Text,
}

impl Appearance {
    /// Returns the appearance that suits the environment. `COLORFGBG` determines the theme, and
    /// the terminal which colours it has. Plots are drawn in ASCII on the Linux console
    /// (`TERM=linux`) and in a locale without Unicode (`C`, `POSIX`), because these cannot show
    /// Braille characters. The Linux console is dark.
    pub fn of_environment() -> Self {
        let is_console = variable("TERM").is_some_and(|term| term == "linux");
        let theme = match variable("COLORFGBG") {
            Some(colours) => Theme::on_background(&colours),
            None if is_console => Theme::Dark,
            None => Theme::Neutral,
        };
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"]
            .into_iter()
            .find_map(variable);
        let is_ascii = locale.is_some_and(|locale| locale == "C" || locale == "POSIX");
        Appearance {
            theme,
            colours: Colours::of_environment(variable),
            marker: if is_ascii || is_console {
                Marker::Ascii
            } else {
                Marker::Braille
            },
        }
    }

    pub fn palette(self) -> Palette {
        Palette {
            colours: self.colours,
            background: self.theme.background(),
        }
    }

    pub fn style(self, meaning: Meaning) -> Style {
        let palette = self.palette();
        match meaning {
            Meaning::Text => palette.style(ColourRole::Text),
            Meaning::Title => palette.style(ColourRole::Text).add_modifier(Modifier::BOLD),
            Meaning::Heading => palette
                .style(ColourRole::Accent)
                .add_modifier(Modifier::BOLD),
            Meaning::Cursor => palette.ink(Ink::Cursor),
            Meaning::Quiet => palette.style(ColourRole::Quiet),
            Meaning::Error => palette.style(ColourRole::Error),
            Meaning::Key => palette.style(ColourRole::Key),
            Meaning::Selected => match palette.ground(ColourRole::SelectionGround) {
                Some(ground) => Style::new().bg(ground),
                None => Style::new().add_modifier(Modifier::REVERSED),
            },
        }
    }
}

/// Returns the value of an environment variable; `None` if it is missing or empty.
pub fn variable(name: &str) -> Option<String> {
    let value = std::env::var_os(name)?;
    if value.is_empty() {
        return None;
    }
    Some(value.to_string_lossy().into_owned())
}

impl Theme {
    /// Returns the background for which the colours of the theme are chosen.
    pub fn background(self) -> Background {
        match self {
            Theme::Neutral => Background::Unknown,
            Theme::Dark => Background::Dark,
            Theme::Light => Background::Light,
        }
    }

    /// Returns the theme for a background.
    pub fn for_background(background: Background) -> Self {
        match background {
            Background::Unknown => Theme::Neutral,
            Background::Dark => Theme::Dark,
            Background::Light => Theme::Light,
        }
    }

    /// Returns the theme that suits a value of `COLORFGBG`. The last number in this value is the
    /// colour of the background.
    fn on_background(colours: &str) -> Self {
        match colours.rsplit(';').next().map(str::parse::<u8>) {
            Some(Ok(7 | 9..=15)) => Theme::Light,
            Some(Ok(0..=6 | 8)) => Theme::Dark,
            _ => Theme::Neutral,
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
}
