//! Prompts: a line being typed for a purpose, with a list of what fits.

use super::palette::{self, Entry as Listed};
use super::panes::Pane;
use super::parameters::Parameter;
use super::search::find;
use super::text_line::TextLine;
use crate::scene::Entry;
use std::path::is_separator;

/// A line being typed.
#[derive(Clone, Debug, PartialEq)]
pub struct Prompt {
    /// Purpose.
    pub purpose: Purpose,
    /// The line.
    pub line: TextLine,
    /// Indices of the rows of the list that fit the line, the best first.
    pub found: Vec<usize>,
    /// Place of the selected row among them.
    pub selected: usize,
    /// Paths that begin as typed, as far as several were asked for.
    pub paths: Vec<String>,
    /// Reason why the typed text was refused.
    pub refused: Option<String>,
}

/// Purpose of a typed line.
#[derive(Clone, Debug, PartialEq)]
pub enum Purpose {
    /// Value of the selected parameter.
    Value,
    /// Force to move the body to.
    Force,
    /// Relative error for a choice of springs.
    Tolerance,
    /// File to save the scene to.
    Save {
        /// True to leave afterwards.
        then_quit: bool,
    },
    /// File to export to.
    Export,
    /// Search of a scene, or path of a scene or a study.
    Scene(Vec<Entry>),
    /// Search of a parameter.
    Parameter {
        /// Pane selected before.
        before: Pane,
    },
    /// Search of a command.
    Command(Vec<Listed>),
}

impl Purpose {
    /// Returns true if a list shows what fits the line.
    #[must_use]
    pub fn has_list(&self) -> bool {
        matches!(self, Purpose::Scene(_) | Purpose::Parameter { .. } | Purpose::Command(_))
    }
}

impl Prompt {
    /// A prompt with this line, for a scene with these parameters.
    #[must_use]
    pub fn new(purpose: Purpose, line: TextLine, parameters: &[Parameter]) -> Self {
        let (found, paths) = (Vec::new(), Vec::new());
        let mut prompt = Prompt { purpose, line, found, selected: 0, paths, refused: None };
        prompt.search(parameters);
        prompt
    }

    /// A prompt with a refused text: the reason, which may begin with the text.
    #[must_use]
    pub fn refused(purpose: Purpose, text: &str, why: &str, parameters: &[Parameter]) -> Self {
        let reason = why.strip_prefix(text).and_then(|rest| rest.strip_prefix(": ")).unwrap_or(why);
        Prompt { refused: Some(reason.to_owned()), ..Prompt::new(purpose, TextLine::new(text), parameters) }
    }

    /// Finds the rows of the list that fit the line, and selects the best.
    pub fn search(&mut self, parameters: &[Parameter]) {
        let query = self.line.text();
        self.selected = 0;
        self.found = match &self.purpose {
            // A text with a separator is a path, not a name to search for.
            Purpose::Scene(_) if query.contains(is_separator) => Vec::new(),
            Purpose::Scene(entries) => find(entries.iter().map(scene_texts), &query),
            Purpose::Parameter { .. } => find(parameters.iter().map(Parameter::texts), &query),
            Purpose::Command(entries) => find(entries.iter().map(palette::Entry::texts), &query),
            _ => Vec::new(),
        };
    }

    /// Moves the selection by so many rows.
    pub fn select(&mut self, rows: i32) {
        let last = self.found.len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(rows as isize).min(last);
    }

    /// Index of the selected row of the list.
    #[must_use]
    pub fn choice(&self) -> Option<usize> {
        self.found.get(self.selected).copied()
    }

    /// The selected scene.
    #[must_use]
    pub fn scene(&self) -> Option<&Entry> {
        if let Purpose::Scene(entries) = &self.purpose { entries.get(self.choice()?) } else { None }
    }
}

/// Name, title and notice.
fn scene_texts(entry: &Entry) -> Vec<String> {
    vec![entry.name.clone(), entry.title.clone(), entry.notice.clone()]
}
