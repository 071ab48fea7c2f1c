//! Prompts: a line that the user types, with or without a list of matching entries; a question to
//! the user; or the help.

use super::action::OutputFile;
use super::keys::bindings::{Binding, Context, Row};
use super::openable::Openable;
use super::opening::CurveQuestion;
use super::pane::Pane;
use super::parameters::Parameter;
use super::search::{corrected, find};
use super::text_line::TextLine;
use asperity_scene::{Document, Preset};
use std::path::is_separator;

/// Line below the panes in which the user types a text or answers a question. While the prompt is
/// open, it receives all keys.
#[derive(Clone, Debug)]
pub struct Prompt {
    pub purpose: Purpose,
    pub line: TextLine,
    /// Indices of the list entries that match the typed line, the best first.
    pub found: Vec<usize>,
    /// Index in `found` of the selected entry.
    pub selected: usize,
    /// Corrected search: the typed words, replaced by similar words of the list. `None` if the list
    /// contains the typed words.
    pub corrected: Option<String>,
    /// Paths that begin with the typed path. Empty unless there are several such paths.
    pub paths: Vec<String>,
    pub refused: Option<String>,
}

#[derive(Clone, Debug)]
pub enum Purpose {
    Value,
    Force,
    /// Target of an inverse question: a quantity and the value that the quantity should have.
    Target,
    /// Relative error of the result. The explorer then chooses the number of springs so that the
    /// error is at most this large.
    Tolerance,
    /// Names of the parameters to be fitted to the measured curve.
    Fit,
    Save {
        then_quit: bool,
    },
    Export,
    /// Path of a file to open, or words of a search in the contained list of what the user can
    /// open.
    Open(Vec<Openable>),
    /// Value of an option that is necessary to read a measured curve.
    Curve(CurveQuestion),
    Parameter {
        before: Pane,
    },
    /// The help, or the list of commands. If `is_typed` is true, the user types words to search for
    /// entries.
    Topics {
        name: &'static str,
        topics: Vec<Topic>,
        is_typed: bool,
    },
    Overwrite(OutputFile),
    Leave,
}

/// Entry in the help, or in the list of commands, parameters or scenes, that a search can find.
#[derive(Clone, Debug)]
pub struct Topic {
    pub section: &'static str,
    /// Name of the entry: its keys, or the name of a pane, a parameter or a scene.
    pub name: String,
    pub text: String,
    /// Further everyday words with which a search finds the entry.
    pub words: String,
    pub aim: Aim,
}

/// Effect of an entry of a list when the user chooses it.
#[derive(Clone, Debug)]
pub enum Aim {
    Nothing,
    Command(&'static Row),
    /// Selects the parameter in the row with this index.
    Parameter(usize),
    Open(String),
}

impl Topic {
    /// Creates an entry of the help that does nothing if the user chooses it.
    pub fn read_only(name: &str, text: &str) -> Self {
        Topic {
            section: "What you see",
            name: name.to_owned(),
            text: text.to_owned(),
            words: String::new(),
            aim: Aim::Nothing,
        }
    }

    pub fn of(binding: &Binding) -> Self {
        let row = binding.row;
        Topic {
            section: row.section,
            name: binding.names(),
            text: row.help.to_owned(),
            words: row.words.to_owned(),
            aim: Aim::Command(row),
        }
    }

    /// Creates the entry for a parameter of the scene. `row` is the index of its row in the list of
    /// parameters.
    pub fn of_parameter(row: usize, parameter: &Parameter) -> Self {
        Topic {
            section: "Parameters of this scene",
            name: parameter.name(),
            text: parameter.field.meaning.to_owned(),
            words: parameter.texts()[..3].join(" "),
            aim: Aim::Parameter(row),
        }
    }

    pub fn of_preset(preset: &Preset) -> Self {
        let text = match Document::parse(preset.text, preset.name) {
            Ok(document) => document.title().to_owned(),
            Err(_) => String::new(),
        };
        Topic {
            section: "Built-in scenes",
            name: preset.name.to_owned(),
            text,
            words: String::new(),
            aim: Aim::Open(preset.name.to_owned()),
        }
    }

    /// Returns the texts in which a search looks for words: each key, the name, the everyday words,
    /// the description and the section.
    fn texts(&self) -> Vec<String> {
        let mut texts: Vec<String> = self.name.split(' ').map(str::to_owned).collect();
        texts.push(self.name.clone());
        texts.push(self.words.clone());
        texts.push(self.text.clone());
        texts.push(self.section.to_owned());
        texts
    }
}

impl Prompt {
    /// Creates a prompt whose line contains `text`. `parameters` are the parameters of the scene.
    /// If `text` is a value or the name of a file, the first character that the user types replaces
    /// it.
    pub fn new(purpose: Purpose, text: &str, parameters: &[Parameter]) -> Self {
        let is_replaced = matches!(
            purpose,
            Purpose::Value | Purpose::Save { .. } | Purpose::Export
        );
        let line = if is_replaced {
            TextLine::selected(text)
        } else {
            TextLine::new(text)
        };
        let mut prompt = Prompt {
            purpose,
            line,
            found: Vec::new(),
            selected: 0,
            corrected: None,
            paths: Vec::new(),
            refused: None,
        };
        prompt.search(parameters);
        prompt
    }

    /// Returns the context of this prompt, which determines what the keys do. There is one context
    /// for each of the help, a list, a line and a question.
    pub fn context(&self) -> Context {
        match self.purpose {
            Purpose::Topics {
                is_typed: false, ..
            } => Context::Help,
            Purpose::Open(_) | Purpose::Parameter { .. } | Purpose::Topics { .. } => Context::List,
            Purpose::Overwrite(_) => Context::Overwrite,
            Purpose::Leave => Context::Leave,
            _ => Context::Line,
        }
    }

    /// Finds the list entries that match the typed line, and selects the best one.
    pub fn search(&mut self, parameters: &[Parameter]) {
        let query = self.line.text();
        self.selected = 0;
        self.found = match &self.purpose {
            // A text with a separator is a path, so it is not compared with names.
            Purpose::Open(_) if query.contains(is_separator) => Vec::new(),
            Purpose::Open(entries) => {
                let entries = entries.iter().enumerate();
                find(entries.map(|(index, entry)| entry.texts(index)), query)
            }
            Purpose::Parameter { .. } => find(parameters.iter().map(Parameter::texts), query),
            Purpose::Topics { topics, .. } => {
                let found = find(topics.iter().map(Topic::texts), query);
                self.corrected = if found.is_empty() {
                    corrected(topics.iter().map(Topic::texts), query)
                } else {
                    None
                };
                match &self.corrected {
                    Some(words) => find(topics.iter().map(Topic::texts), words),
                    None => found,
                }
            }
            _ => Vec::new(),
        };
    }

    pub fn choice(&self) -> Option<usize> {
        self.found.get(self.selected).copied()
    }

    /// Returns the selected entry, if this prompt has the list of what the user can open; otherwise
    /// `None`.
    pub fn openable(&self) -> Option<&Openable> {
        if let Purpose::Open(entries) = &self.purpose {
            entries.get(self.choice()?)
        } else {
            None
        }
    }
}
