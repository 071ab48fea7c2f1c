//! Mode: the present meaning of the keys.

use super::action::OutputFile;
use super::finder::Finder;
use super::fuzzy::Candidate;
use super::text_line::TextLine;
use crate::scene::Entry;

/// Mode: the present meaning of the keys.
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
    /// Typing title, notice and the name of the file to save the scene to.
    SaveAs(SaveForm),
    /// Typing the name of the file to export to.
    Export(TextLine),
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

/// Lines of the dialogue that saves a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SaveForm {
    /// File, title and notice, in the order of [`SaveForm::PROMPTS`].
    pub lines: [TextLine; 3],
    /// Index of the line being typed.
    pub line: usize,
    /// True to leave afterwards.
    pub then_quit: bool,
}

impl SaveForm {
    /// Prompts of the lines.
    pub const PROMPTS: [&'static str; 3] = ["Save as: ", "Title: ", "Notice: "];

    /// Goes `lines` lines on; the first follows the last.
    pub fn go(&mut self, lines: i32) {
        let count = self.lines.len() as i32;
        self.line = (self.line as i32 + lines.signum()).rem_euclid(count) as usize;
    }
}

/// Library dialogue.
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

    /// Search words of an entry: name, and as prose title and notice.
    #[must_use]
    pub fn candidate(entry: &Entry) -> Candidate {
        Candidate {
            names: vec![entry.name.clone()],
            prose: vec![entry.title().to_owned(), entry.notice().to_owned()],
        }
    }
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
            Mode::Edit(_) => ModeKind::Edit,
            Mode::Force(_) => ModeKind::Force,
            Mode::Tolerance(_) => ModeKind::Tolerance,
            Mode::Library(_) => ModeKind::Library,
            Mode::Find(_) => ModeKind::Find,
            Mode::Palette(_) => ModeKind::Palette,
            Mode::SaveAs(_) => ModeKind::SaveAs,
            Mode::Export(_) => ModeKind::Export,
            Mode::Overwrite(_) => ModeKind::Overwrite,
            Mode::Help { .. } => ModeKind::Help,
            Mode::Quit => ModeKind::Quit,
        }
    }

    /// The line being typed.
    pub fn line_mut(&mut self) -> Option<&mut TextLine> {
        match self {
            Mode::Edit(line) | Mode::Force(line) | Mode::Tolerance(line) | Mode::Export(line) => Some(line),
            Mode::SaveAs(form) => form.lines.get_mut(form.line),
            Mode::Library(Library { finder, .. }) | Mode::Find(finder) | Mode::Palette(finder) => {
                Some(&mut finder.query)
            }
            Mode::Explore | Mode::Overwrite(_) | Mode::Help { .. } | Mode::Quit => None,
        }
    }
}
