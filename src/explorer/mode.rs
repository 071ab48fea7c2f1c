//! Mode: the present meaning of the keys.

use super::action::OutputFile;
use super::prompt::{Prompt, Purpose};
use super::text_line::TextLine;

/// Mode: the present meaning of the keys.
#[derive(Clone, Debug, PartialEq)]
pub enum Mode {
    /// Exploring.
    Explore,
    /// Typing a line.
    Prompt(Prompt),
    /// Asking whether to overwrite a file.
    Overwrite(OutputFile),
    /// Reading the help.
    Help {
        /// Lines scrolled down.
        scroll: u16,
    },
    /// Asking whether to leave with unsaved changes.
    Quit,
}

/// Mode without its data, for the table of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeKind {
    /// See [`Mode::Explore`].
    Explore,
    /// See [`Mode::Explore`], with the map chosen.
    Chart,
    /// See [`Mode::Explore`], with the crosshair in the chosen pane.
    Crosshair,
    /// See [`Mode::Explore`], with the list of parameters chosen.
    Parameters,
    /// See [`Mode::Prompt`], without a list.
    Prompt,
    /// See [`Mode::Prompt`], with a list.
    List,
    /// See [`Mode::Overwrite`].
    Overwrite,
    /// See [`Mode::Help`].
    Help,
    /// See [`Mode::Quit`].
    Quit,
}

impl ModeKind {
    /// All modes.
    pub const ALL: [ModeKind; 9] = [
        ModeKind::Explore,
        ModeKind::Chart,
        ModeKind::Crosshair,
        ModeKind::Parameters,
        ModeKind::Prompt,
        ModeKind::List,
        ModeKind::Overwrite,
        ModeKind::Help,
        ModeKind::Quit,
    ];
}

impl ModeKind {
    /// Returns true if keys act on scene and panes, rather than on a line, a list or a question.
    #[must_use]
    pub fn is_exploring(self) -> bool {
        matches!(self, ModeKind::Explore | ModeKind::Chart | ModeKind::Crosshair | ModeKind::Parameters)
    }
}

impl Mode {
    /// Kind of the mode.
    #[must_use]
    pub fn kind(&self) -> ModeKind {
        match self {
            Mode::Explore => ModeKind::Explore,
            Mode::Prompt(prompt) if prompt.purpose.has_list() => ModeKind::List,
            Mode::Prompt(_) => ModeKind::Prompt,
            Mode::Overwrite(_) => ModeKind::Overwrite,
            Mode::Help { .. } => ModeKind::Help,
            Mode::Quit => ModeKind::Quit,
        }
    }

    /// The line being typed and its purpose.
    #[must_use]
    pub fn prompt(&self) -> Option<&Prompt> {
        if let Mode::Prompt(prompt) = self { Some(prompt) } else { None }
    }

    /// Returns true while the value of the selected parameter is typed.
    #[must_use]
    pub fn is_typing_value(&self) -> bool {
        self.prompt().is_some_and(|prompt| prompt.purpose == Purpose::Value)
    }

    /// The line being typed.
    pub fn line_mut(&mut self) -> Option<&mut TextLine> {
        if let Mode::Prompt(prompt) = self { Some(&mut prompt.line) } else { None }
    }
}
