//! What the keys mean at the moment.

use super::action::Content;
use super::finder::Finder;
use super::text_line::TextLine;
use crate::scene::Entry;
use std::path::PathBuf;

/// What the keys mean at the moment.
#[derive(Clone, Debug, PartialEq)]
pub enum Mode {
    /// Exploring.
    Explore,
    /// Typing the value of the selected parameter.
    Edit(TextLine),
    /// Typing the force to move the body to.
    Force(TextLine),
    /// Typing a tolerance.
    Tolerance(TextLine),
    /// Choosing a scene from the library.
    Library(Library),
    /// Searching the list of parameters.
    Find(Finder),
    /// Choosing a command from the list of all.
    Palette(Finder),
    /// Typing the name of the file to save the scene to.
    SaveAs {
        /// The name.
        line: TextLine,
        /// Whether to leave afterwards.
        then_quit: bool,
    },
    /// Typing the name of the file to export to.
    Export(TextLine),
    /// Asked whether to overwrite a file.
    Overwrite {
        /// The file.
        path: PathBuf,
        /// What is to be written to it.
        content: Content,
        /// Whether to leave afterwards.
        then_quit: bool,
    },
    /// Reading the help.
    Help {
        /// Lines scrolled down.
        scroll: u16,
    },
    /// Asked whether to leave with unsaved changes.
    Quit,
}

/// The library as one looks through it.
#[derive(Clone, Debug, PartialEq)]
pub struct Library {
    /// All scenes; `None` until they have been listed.
    pub entries: Option<Vec<Entry>>,
    /// The search among them.
    pub finder: Finder,
}

impl Library {
    /// The selected entry.
    #[must_use]
    pub fn entry(&self) -> Option<&Entry> {
        self.entries.as_ref()?.get(self.finder.choice()?)
    }
}

/// A mode without what it holds: what the table of keys refers to.
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
    /// See [`Mode::Edit`].
    Edit,
    /// See [`Mode::Force`].
    Force,
    /// See [`Mode::Tolerance`].
    Tolerance,
    /// See [`Mode::Library`].
    Library,
    /// See [`Mode::Find`].
    Find,
    /// See [`Mode::Palette`].
    Palette,
    /// See [`Mode::SaveAs`].
    SaveAs,
    /// See [`Mode::Export`].
    Export,
    /// See [`Mode::Overwrite`].
    Overwrite,
    /// See [`Mode::Help`].
    Help,
    /// See [`Mode::Quit`].
    Quit,
}

impl ModeKind {
    /// All modes.
    pub const ALL: [ModeKind; 15] = [
        ModeKind::Explore,
        ModeKind::Chart,
        ModeKind::Crosshair,
        ModeKind::Parameters,
        ModeKind::Edit,
        ModeKind::Force,
        ModeKind::Tolerance,
        ModeKind::Library,
        ModeKind::Find,
        ModeKind::Palette,
        ModeKind::SaveAs,
        ModeKind::Export,
        ModeKind::Overwrite,
        ModeKind::Help,
        ModeKind::Quit,
    ];
}

impl Mode {
    /// Which mode it is.
    #[must_use]
    pub fn kind(&self) -> ModeKind {
        match self {
            Mode::Explore => ModeKind::Explore,
            Mode::Edit(_) => ModeKind::Edit,
            Mode::Force(_) => ModeKind::Force,
            Mode::Tolerance(_) => ModeKind::Tolerance,
            Mode::Library(_) => ModeKind::Library,
            Mode::Find(_) => ModeKind::Find,
            Mode::Palette(_) => ModeKind::Palette,
            Mode::SaveAs { .. } => ModeKind::SaveAs,
            Mode::Export(_) => ModeKind::Export,
            Mode::Overwrite { .. } => ModeKind::Overwrite,
            Mode::Help { .. } => ModeKind::Help,
            Mode::Quit => ModeKind::Quit,
        }
    }

    /// The line that is being typed.
    pub fn line_mut(&mut self) -> Option<&mut TextLine> {
        match self {
            Mode::Edit(line)
            | Mode::Force(line)
            | Mode::Tolerance(line)
            | Mode::Export(line)
            | Mode::SaveAs { line, .. } => Some(line),
            Mode::Library(Library { finder, .. }) | Mode::Find(finder) | Mode::Palette(finder) => {
                Some(&mut finder.query)
            }
            Mode::Explore | Mode::Overwrite { .. } | Mode::Help { .. } | Mode::Quit => None,
        }
    }
}
