//! What each meaning looks like; a glyph carries it as well.

use ratatui::style::{Color, Modifier, Style};

/// Colours and modifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Theme {
    /// Sixteen colours that read on dark and on light backgrounds.
    Colours,
    /// No colours at all (`NO_COLOR`), only bold, dim and reverse.
    Plain,
}

/// Something that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// The rigid line.
    Line,
    /// The elastic surface.
    Surface,
    /// What is in contact.
    Contact,
    /// Forces while loading.
    Approach,
    /// Forces while unloading.
    Retraction,
    /// The moment shown.
    Cursor,
    /// Frames, axes, what stands back.
    Quiet,
    /// Titles.
    Title,
    /// What is selected.
    Selected,
    /// What is wrong.
    Error,
    /// Keys.
    Key,
    /// Text.
    Text,
}

impl Theme {
    /// The theme that the environment asks for.
    #[must_use]
    pub fn of_environment() -> Self {
        let no_colour = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        if no_colour { Theme::Plain } else { Theme::Colours }
    }

    /// The colour of a meaning.
    #[must_use]
    pub fn colour(self, meaning: Meaning) -> Color {
        if self == Theme::Plain {
            return Color::Reset;
        }
        match meaning {
            Meaning::Line | Meaning::Text | Meaning::Selected | Meaning::Title => Color::Reset,
            Meaning::Surface => Color::Blue,
            Meaning::Contact | Meaning::Error => Color::Red,
            Meaning::Approach => Color::Green,
            Meaning::Retraction | Meaning::Key => Color::Magenta,
            Meaning::Cursor => Color::Red,
            Meaning::Quiet => Color::DarkGray,
        }
    }

    /// The style of a meaning.
    #[must_use]
    pub fn style(self, meaning: Meaning) -> Style {
        let style = Style::new().fg(self.colour(meaning));
        match meaning {
            Meaning::Title | Meaning::Key | Meaning::Error => style.add_modifier(Modifier::BOLD),
            Meaning::Selected => style.add_modifier(Modifier::REVERSED),
            Meaning::Quiet if self == Theme::Plain => style.add_modifier(Modifier::DIM),
            _ => style,
        }
    }
}
