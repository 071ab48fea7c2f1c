//! Prompts: a line that the user types, with or without a list of matching entries; a question to
//! the user; or the help.

use super::action::OutputFile;
use super::editor::Editor;
use super::keys::bindings::{Binding, Context, Row};
use super::openable::Openable;
use super::opening::CurveQuestion;
use super::pane::Pane;
use super::parameters::Parameter;
use super::search::{Search, find};
use super::text_line::TextLine;
use asperity_scene::{Document, Preset};
use std::path::{Path, is_separator};

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
    /// Typed words that the list does not contain.
    pub unknown: Vec<String>,
    /// Paths that begin with the typed path, if there are several.
    pub paths: Vec<String>,
    pub refused: Option<String>,
}

#[derive(Clone, Debug)]
pub enum Purpose {
    Value,
    /// Target of the next move of the body.
    Move,
    /// Target of an inverse question: a quantity and the value that it is to have.
    Target,
    /// Quantity and two numbers of the scene, over which it is mapped.
    Map,
    /// Relative error that is to be reached by the choice of the number of springs.
    Tolerance,
    /// Names of the parameters to be fitted to the measured curve.
    Fit,
    Save {
        then_quit: bool,
    },
    Export,
    /// File for the plan of the live map.
    SavePlan,
    /// Words of a search in this list of what can be opened, or a path.
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
    /// The question whether to overwrite a file that exists. `is_changed` is true if another
    /// program has changed the file of the scene.
    Overwrite {
        file: OutputFile,
        is_changed: bool,
    },
    Leave,
}

/// Name of the list of commands.
pub const COMMANDS: &str = "Commands";

/// Version of the program, and what to cite.
const ABOUT: &str = concat!(
    "version ",
    env!("CARGO_PKG_VERSION"),
    "; CITATION.cff is the reference of the program, and V. L. Popov, A. E. Filippov: Physical \
     Mesomechanics 15 (2012) that of the model",
);

/// Entry in the help, or in the list of commands, parameters or scenes.
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
    /// Selects the parameter with this index among the parameters that a search can find.
    Parameter(usize),
    Show(Pane),
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

    /// Creates the entry that names the version of the program and what to cite.
    pub fn about() -> Self {
        Topic {
            words: "version about cite citation reference licence license author".to_owned(),
            ..Topic::read_only("Asperity", ABOUT)
        }
    }

    /// Creates an entry that shows a pane.
    pub fn of_pane(pane: Pane, name: &str, text: &str) -> Self {
        Topic {
            section: "Panes",
            aim: Aim::Show(pane),
            ..Topic::read_only(name, text)
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
            words: format!(
                "{} {}",
                parameter.texts()[..3].join(" "),
                parameter.field.words
            ),
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
    pub fn texts(&self) -> Vec<String> {
        let mut texts: Vec<String> = self.name.split(' ').map(str::to_owned).collect();
        texts.push(self.name.clone());
        texts.push(self.words.clone());
        texts.push(self.text.clone());
        texts.push(self.section.to_owned());
        texts
    }
}

impl Prompt {
    /// Creates a prompt whose line contains this text. `edit` has the parameters of the scene. If
    /// the text is a value or the name of a file, the first character that the user types replaces
    /// the text.
    pub fn new(purpose: Purpose, text: &str, edit: &Editor) -> Self {
        let is_replaced = matches!(
            purpose,
            Purpose::Value
                | Purpose::Target
                | Purpose::Map
                | Purpose::Save { .. }
                | Purpose::SavePlan
        );
        let line = if matches!(purpose, Purpose::Export) {
            TextLine::offered(text)
        } else if is_replaced {
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
            unknown: Vec::new(),
            paths: Vec::new(),
            refused: None,
        };
        prompt.search(edit);
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
            Purpose::Overwrite { .. } => Context::Overwrite,
            Purpose::Leave => Context::Leave,
            _ => Context::Line,
        }
    }

    /// Finds the list entries that match the typed line, and selects the best one.
    pub fn search(&mut self, edit: &Editor) {
        let query = self.line.text();
        let search = match &self.purpose {
            Purpose::Open(entries) => Search {
                found: found_openables(entries, query),
                ..Search::default()
            },
            // Without words, the list has only the rows that it also has without a search.
            Purpose::Parameter { .. } if query.trim().is_empty() => Search {
                found: (0..edit.parameters.len()).collect(),
                ..Search::default()
            },
            Purpose::Parameter { .. } => {
                let texts: Vec<_> = edit.searchable().map(Parameter::texts).collect();
                Search::new(&texts, query)
            }
            Purpose::Topics { topics, .. } => {
                let texts: Vec<_> = topics.iter().map(Topic::texts).collect();
                Search::new(&texts, query)
            }
            _ => Search::default(),
        };
        self.selected = 0;
        self.found = search.found;
        self.unknown = search.unknown;
        self.corrected = search.corrected;
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

/// Returns the indices of the entries that match a typed text, the best first.
fn found_openables(entries: &[Openable], typed: &str) -> Vec<usize> {
    // A text with a separator is a path, so it is not compared with names.
    if typed.contains(is_separator) {
        return Vec::new();
    }
    let texts = entries.iter().enumerate().map(|(index, entry)| {
        let mut texts = entry.texts(index);
        // The name of a file is compared only with names. Otherwise a scene whose title contains
        // the name would be opened in place of the file.
        if is_file_name(typed) {
            texts.truncate(2);
        }
        texts
    });
    find(texts, typed)
}

/// Returns true if a text is the name of a file with an extension.
fn is_file_name(text: &str) -> bool {
    let has_blank = text.trim().contains(char::is_whitespace);
    match Path::new(text.trim()).extension() {
        Some(extension) => !has_blank && !extension.is_empty(),
        None => false,
    }
}
