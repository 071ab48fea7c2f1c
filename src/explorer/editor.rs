//! The scene as edited: its list of parameters, its history, and whether it is saved.

use super::measured::Measured;
use super::parameters::{Parameter, parameters};
use super::reading;
use asperity_scene::{CheckedScene, Document};
use std::collections::BTreeMap;
use std::iter::successors;
use std::mem::replace;
use std::path::Path;
use std::sync::Arc;

const UNDO_DEPTH: usize = 1000;

/// The scene and the measured curve before or after an edit.
#[derive(Clone, Debug)]
pub struct Edited {
    pub document: Document,
    pub measured: Option<Measured>,
}

impl Edited {
    /// Returns true if an edit from one to the other changes something that an undo restores.
    fn differs(&self, other: &Edited) -> bool {
        let options = |one: &Edited| {
            one.measured
                .as_ref()
                .map(|measured| (measured.path.clone(), measured.options.clone()))
        };
        self.document.name() != other.document.name()
            || self.document.text() != other.document.text()
            || options(self) != options(other)
    }
}

/// The scene as edited, its history, and its list of parameters.
#[derive(Clone, Debug)]
pub struct Editor {
    pub document: Document,
    /// The measured curve beside the scene.
    pub measured: Option<Measured>,
    /// The checked scene of the document, with its files named from the working folder.
    pub scene: Arc<CheckedScene>,
    /// What was edited before each edit, the newest last.
    pub past: Vec<Edited>,
    future: Vec<Edited>,
    /// For each scene by its name, the document on disk or as opened.
    pub saved: BTreeMap<String, Document>,
    /// Number of times that a scene was saved or opened.
    pub saves: u64,
    /// Scenes by their names that were left with unsaved changes.
    left: BTreeMap<String, Document>,
    pub generation: u64,
    pub parameters: Vec<Parameter>,
    pub selected: usize,
}

impl Editor {
    pub fn new(document: Document) -> Self {
        let mut editor = Editor {
            parameters: parameters(&document, None),
            measured: None,
            scene: scene_of(&document),
            document,
            past: Vec::new(),
            future: Vec::new(),
            saved: BTreeMap::new(),
            saves: 0,
            left: BTreeMap::new(),
            generation: 1,
            selected: 0,
        };
        editor.set_saved();
        editor
    }

    pub fn parameter(&self) -> Option<&Parameter> {
        self.parameters.get(self.selected)
    }

    /// Selects the parameter in a row, or the last one.
    pub fn select(&mut self, row: usize) {
        self.selected = row.min(self.parameters.len().saturating_sub(1));
    }

    /// Moves the selection by a number of rows, up to the first or last row.
    pub fn move_selection(&mut self, rows: i32) {
        self.select(self.selected.saturating_add_signed(rows as isize));
    }

    /// Row of the field at a path, or of the group around it. So the selection stays in place when
    /// rows come and go, and the row that switched an effect off can switch it on again.
    fn row_of(&self, path: &str) -> usize {
        // A loading stage with a number has its row at the path of the number.
        let is_at = |one: &Parameter, path: &str| {
            one.path == path || one.path.strip_suffix(".0") == Some(path)
        };
        let row = |path: &str| {
            self.parameters
                .iter()
                .position(|parameter| is_at(parameter, path))
        };
        let around = successors(Some(path), |path| {
            path.rsplit_once('.').map(|(group, _)| group)
        });
        around.filter_map(row).next().unwrap_or(self.selected)
    }

    /// Makes a document the explored one; an undo returns to the former document, unless both are
    /// the same.
    pub fn adopt(&mut self, document: Document) {
        self.adopt_all(Edited {
            document,
            measured: self.measured.clone(),
        });
    }

    /// Makes a document and a measured curve the explored ones, in one edit.
    pub fn adopt_all(&mut self, edited: Edited) {
        let before = self.exchange(edited);
        if before.differs(&self.edited()) {
            self.past.push(before);
        }
        if self.past.len() > UNDO_DEPTH {
            self.past.remove(0);
        }
        self.future.clear();
        self.renew();
    }

    fn edited(&self) -> Edited {
        Edited {
            document: self.document.clone(),
            measured: self.measured.clone(),
        }
    }

    /// Puts document and measured curve in the place of the present ones, which are returned.
    fn exchange(&mut self, Edited { document, measured }: Edited) -> Edited {
        Edited {
            document: replace(&mut self.document, document),
            measured: replace(&mut self.measured, measured),
        }
    }

    /// Continues the last edit: the new document replaces the result of the edit.
    pub fn replace(&mut self, document: Document) {
        self.document = document;
        self.future.clear();
        self.renew();
    }

    /// Undoes the last edit or, unless `back`, redoes the last undone edit. Returns the change in
    /// words; `None` without such an edit.
    pub fn undo(&mut self, back: bool) -> Option<String> {
        let next = if back {
            self.past.pop()?
        } else {
            self.future.pop()?
        };
        let before = self.exchange(next);
        let to = if back {
            &mut self.future
        } else {
            &mut self.past
        };
        to.push(before.clone());
        let changes = before.document.changes_to(&self.document);
        let mut changes: Vec<String> = changes.iter().map(ToString::to_string).collect();
        if before.document.name() != self.document.name() {
            changes = vec![self.document.name().to_owned()];
            self.leave(before.document);
        }
        changes.extend(match (&before.measured, &self.measured) {
            (Some(before), Some(now)) if before.path == now.path => {
                reading::changes(&before.options, &now.options)
            }
            (None, None) => Vec::new(),
            (_, Some(now)) => vec![format!("measured curve {}", now.name)],
            (Some(before), None) => vec![format!("without the measured curve {}", before.name)],
        });
        let what = changes.join(", ");
        self.renew();
        Some(what)
    }

    /// Keeps a document if it has unsaved changes, since another scene replaces it.
    pub fn leave(&mut self, document: Document) {
        if self.is_changed(&document) {
            self.left.insert(document.name().to_owned(), document);
        }
    }

    fn renew(&mut self) {
        let selected = self
            .parameter()
            .map(|parameter| parameter.path.clone())
            .unwrap_or_default();
        // A scene left before is the present one again.
        let document = &self.document;
        self.left
            .retain(|_, left| left.name() != document.name() || left.scene() != document.scene());
        self.parameters = parameters(&self.document, self.measured.as_ref());
        self.scene = scene_of(&self.document);
        self.select(self.row_of(&selected));
        self.generation += 1;
    }

    pub fn is_unsaved(&self) -> bool {
        self.is_changed(&self.document)
    }

    /// Returns true if a document differs from the saved one by a value or a comment; another
    /// notation of a number is no change.
    fn is_changed(&self, document: &Document) -> bool {
        let is_same = |saved: &Document| {
            saved.text() == document.text()
                || saved.scene() == document.scene() && saved.comments() == document.comments()
        };
        !self.saved.get(document.name()).is_some_and(is_same)
    }

    /// All scenes with unsaved changes, the explored one first if it has any.
    pub fn unsaved(&self) -> Vec<&Document> {
        let all = [&self.document].into_iter().chain(self.left.values());
        all.filter(|document| self.is_changed(document)).collect()
    }

    /// Takes scenes as the unsaved changes of another session; the first is the explored scene.
    pub fn restore(&mut self, documents: &[Document]) {
        for (number, document) in documents.iter().enumerate() {
            match Document::parse(document.opened(), document.name()) {
                Ok(opened) => drop(self.saved.insert(document.name().to_owned(), opened)),
                Err(_) => drop(self.saved.remove(document.name())),
            }
            if number > 0 {
                self.left
                    .insert(document.name().to_owned(), document.clone());
            }
        }
    }

    /// Shows a measured curve from the beginning, which no undo removes.
    pub fn begin_with(&mut self, measured: Measured) {
        self.measured = Some(measured);
        self.renew();
    }

    /// Selects the row of the measured curve, if there is one.
    pub fn select_measured(&mut self) {
        self.select(self.row_of(reading::GROUP));
    }

    /// Marks the scene as saved to a file, which becomes its own file.
    pub fn set_saved_as(&mut self, path: &Path) {
        if let Ok(document) =
            Document::parse(&self.document.text_for_own_file(), &path.to_string_lossy())
        {
            self.scene = scene_of(&document);
            self.document = document;
        }
        self.set_saved();
    }

    pub fn set_saved(&mut self) {
        self.saves += 1;
        self.saved
            .insert(self.document.name().to_owned(), self.document.clone());
    }
}

/// The checked scene of a document, with its files named from the working folder.
pub fn scene_of(document: &Document) -> Arc<CheckedScene> {
    let named = |file: &str| document.resolve(file).to_string_lossy().into_owned();
    Arc::new(document.scene().with_files_named(named))
}
