//! The state of the explorer: changed by `update` alone, drawn by the views.

use super::parameters::{Parameter, parameters};
use super::snapshot::{Loop, Moment};
use super::text_line::TextLine;
use super::theme::Theme;
use super::worker::Focus;
use crate::contact::LegRecord;
use crate::scene::Document;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// What the keys mean at the moment.
#[derive(Clone, Debug, PartialEq)]
pub enum Mode {
    /// Exploring.
    Explore,
    /// Typing the value of the selected parameter.
    Edit(TextLine),
    /// Typing the name of the file to save to.
    SaveAs {
        /// The name.
        line: TextLine,
        /// Whether to leave afterwards.
        then_quit: bool,
    },
    /// Asked whether to overwrite a file.
    Overwrite {
        /// The file.
        path: PathBuf,
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

/// A mode without what it holds: what the table of keys refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeKind {
    /// See [`Mode::Explore`].
    Explore,
    /// See [`Mode::Edit`].
    Edit,
    /// See [`Mode::SaveAs`].
    SaveAs,
    /// See [`Mode::Overwrite`].
    Overwrite,
    /// See [`Mode::Help`].
    Help,
    /// See [`Mode::Quit`].
    Quit,
}

impl ModeKind {
    /// All modes.
    pub const ALL: [ModeKind; 6] = [
        ModeKind::Explore,
        ModeKind::Edit,
        ModeKind::SaveAs,
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
            Mode::SaveAs { .. } => ModeKind::SaveAs,
            Mode::Overwrite { .. } => ModeKind::Overwrite,
            Mode::Help { .. } => ModeKind::Help,
            Mode::Quit => ModeKind::Quit,
        }
    }
}

/// The panes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pane {
    /// The force curve.
    Force,
    /// The profile with the histogram of its heights.
    Profile,
    /// The close-up of fragments.
    CloseUp,
    /// The list of parameters.
    Parameters,
}

impl Pane {
    /// All panes, the most important first: the order in which they stay when the window shrinks.
    pub const ALL: [Pane; 4] = [Pane::Force, Pane::Profile, Pane::Parameters, Pane::CloseUp];
}

/// Where the animation stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Player {
    /// Index of the leg.
    pub leg: usize,
    /// How much of it is done, 0 to 1.
    pub done: f64,
    /// Whether time moves it on.
    pub playing: bool,
}

/// What the close-up looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Where.
    pub focus: Focus,
    /// Springs it shows.
    pub springs: usize,
}

impl Look {
    /// Springs shown when a scene opens: a small part of the line, but several asperities.
    #[must_use]
    pub fn springs_shown(document: &Document) -> usize {
        (document.scene().numerics.points / 32).max(64) as usize
    }
}

/// A line for the user, below the panes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Notice {
    /// Something went as wanted.
    Done(String),
    /// Something did not.
    Error(String),
}

/// The state of the explorer.
#[derive(Clone, Debug)]
pub struct Model {
    /// The scene as edited.
    pub document: Document,
    /// The text that is on disk or was opened, for each scene by its name.
    pub saved_texts: BTreeMap<String, String>,
    /// Documents before each edit, and those taken back.
    pub undo: Vec<Document>,
    /// See `undo`.
    pub redo: Vec<Document>,
    /// Number of the newest scene asked for.
    pub generation: u64,
    /// The parameters of the scene.
    pub parameters: Vec<Parameter>,
    /// Index of the selected parameter.
    pub selected: usize,
    /// What is wrong with a value that was refused, and the index of its parameter.
    pub refused: Option<(usize, String)>,
    /// What the keys mean.
    pub mode: Mode,
    /// The newest scene that has been computed.
    pub computed: Option<Arc<Loop>>,
    /// The newest moment of its animation.
    pub moment: Option<Arc<Moment>>,
    /// Legs done of the scene that is being computed.
    pub progress: Option<usize>,
    /// Where the animation stands.
    pub player: Player,
    /// What the close-up looks at.
    pub look: Look,
    /// The chosen pane.
    pub pane: Pane,
    /// Whether it has the whole screen.
    pub zoomed: bool,
    /// Columns and rows of the terminal.
    pub size: (u16, u16),
    /// Colours.
    pub theme: Theme,
    /// A line for the user.
    pub notice: Option<Notice>,
    /// Whether the explorer is to end.
    pub finished: bool,
}

/// Share of the whole range of indentations by which the body is lifted before it first touches.
const LIFT: f64 = 0.12;

impl Model {
    /// The explorer as it opens on a scene.
    #[must_use]
    pub fn new(document: Document, size: (u16, u16), theme: Theme) -> Self {
        let springs = Look::springs_shown(&document);
        Model {
            saved_texts: BTreeMap::from([(document.name().to_owned(), document.text().to_owned())]),
            parameters: parameters(&document),
            document,
            undo: Vec::new(),
            redo: Vec::new(),
            generation: 1,
            selected: 0,
            refused: None,
            mode: Mode::Explore,
            computed: None,
            moment: None,
            progress: Some(0),
            player: Player { leg: 0, done: 0.0, playing: true },
            look: Look { focus: Focus::Summit, springs },
            pane: Pane::Force,
            zoomed: false,
            size,
            theme,
            notice: None,
            finished: false,
        }
    }

    /// Whether the scene differs from what is saved.
    #[must_use]
    pub fn is_unsaved(&self) -> bool {
        self.saved_texts.get(self.document.name()).is_none_or(|saved| saved != self.document.text())
    }

    /// Takes the scene as it stands for saved.
    pub fn set_saved(&mut self) {
        self.saved_texts.insert(self.document.name().to_owned(), self.document.text().to_owned());
    }

    /// Whether what has been computed is the scene as it stands: neither computing nor failed.
    #[must_use]
    pub fn is_current(&self) -> bool {
        self.computed.as_ref().is_some_and(|computed| computed.generation == self.generation)
    }

    /// Whether a newer scene than the one shown is being computed.
    #[must_use]
    pub fn is_computing(&self) -> bool {
        self.progress.is_some()
    }

    /// The legs of the scene that is shown.
    #[must_use]
    pub fn legs(&self) -> &[LegRecord] {
        self.computed.as_ref().map_or(&[], |computed| &computed.outcome.history.legs)
    }

    /// The selected parameter.
    #[must_use]
    pub fn parameter(&self) -> Option<&Parameter> {
        self.parameters.get(self.selected)
    }

    /// Lowest and highest indentation of the curves shown, m; `None` when there is no curve.
    #[must_use]
    pub fn indentations(&self) -> Option<(f64, f64)> {
        let points = self.legs().iter().flat_map(|leg| &leg.curve).map(|point| point.indentation);
        points.fold(None, |range: Option<(f64, f64)>, d| {
            Some(range.map_or((d, d), |(low, high)| (low.min(d), high.max(d))))
        })
    }

    /// The indentation at which the animation stands, m. The first leg begins a little above the
    /// foundation.
    #[must_use]
    pub fn indentation(&self) -> f64 {
        let Some(leg) = self.legs().get(self.player.leg) else { return 0.0 };
        let (low, high) = self.indentations().unwrap_or((0.0, 0.0));
        let lift = if self.player.leg == 0 { LIFT * (high - low) } else { 0.0 };
        let start = leg.start() - lift;
        match leg.curve.last() {
            // There the contact is still held, and below it gone.
            Some(end) if self.player.done >= 1.0 && end.springs == 0 => end.indentation.next_down(),
            _ if self.player.done >= 1.0 => leg.end(),
            _ => start + (leg.end() - start) * self.player.done,
        }
    }
}
