//! The scene as edited: its list of parameters, its history, and whether it is saved.

use super::curve_options;
use super::measured::Measured;
use super::parameters::{Parameter, parameters};
use asperity_experiment::CurveOptions;
use asperity_scene::{CheckedScene, Document};
use std::collections::BTreeMap;

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

/// Returns true if a row has this path. A loading stage with a number has its row at the path of
/// the number.
fn is_at(parameter: &Parameter, path: &str) -> bool {
    parameter.path == path || parameter.path.strip_suffix(".0") == Some(path)
}

impl Edited {
    /// Returns true if an edit from one to the other changes something that an undo restores.
    fn differs(&self, other: &Edited) -> bool {
        self.document.name() != other.document.name()
            || self.document.text() != other.document.text()
            || self.curve_source() != other.curve_source()
    }

    /// File of the measured curve, and the options of reading it.
    fn curve_source(&self) -> Option<(&Path, &CurveOptions)> {
        let measured = self.measured.as_ref()?;
        Some((&measured.path, &measured.options))
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

    /// Selects the row of a loading stage, if there is one.
    pub fn select_stage(&mut self, stage: usize) {
        let mut rows = self.parameters.iter();
        if let Some(row) = rows.position(|parameter| parameter.leg == Some(stage)) {
            self.select(row);
        }
    }

    /// Moves the selection by a number of rows, up to the first or last row.
    pub fn move_selection(&mut self, rows: i32) {
        self.select(self.selected.saturating_add_signed(rows as isize));
    }

    /// Row of the field at a path, or of the group around it; the selected row if there is neither.
    /// So the selection stays in place when rows come and go, and the row that switched an effect
    /// off can switch it on again.
    fn row_of(&self, path: &str) -> usize {
        let mut path = path;
        loop {
            let mut rows = self.parameters.iter();
            if let Some(row) = rows.position(|parameter| is_at(parameter, path)) {
                return row;
            }
            let Some((group, _)) = path.rsplit_once('.') else {
                return self.selected;
            };
            path = group;
        }
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
        if back {
            self.future.push(before.clone());
        } else {
            self.past.push(before.clone());
        }
        let mut changes = Vec::new();
        if before.document.name() == self.document.name() {
            for change in before.document.changes_to(&self.document) {
                changes.push(change.to_string());
            }
        } else {
            changes.push(self.document.name().to_owned());
            self.leave(before.document);
        }
        changes.extend(changes_of_curve(
            before.measured.as_ref(),
            self.measured.as_ref(),
        ));
        self.renew();
        Some(changes.join(", "))
    }

    /// Keeps a document if it has unsaved changes, since another scene replaces it.
    pub fn leave(&mut self, document: Document) {
        if self.is_changed(&document) {
            self.left.insert(document.name().to_owned(), document);
        }
    }

    /// Renews what follows from document and measured curve after an edit.
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
        let Some(saved) = self.saved.get(document.name()) else {
            return true;
        };
        let has_same_content =
            saved.scene() == document.scene() && saved.comments() == document.comments();
        saved.text() != document.text() && !has_same_content
    }

    /// All scenes with unsaved changes, the explored one first if it has any.
    pub fn unsaved(&self) -> Vec<&Document> {
        let mut unsaved = vec![&self.document];
        unsaved.extend(self.left.values());
        unsaved.retain(|document| self.is_changed(document));
        unsaved
    }

    /// Takes scenes as the unsaved changes of another session; the first is the explored scene.
    pub fn restore(&mut self, documents: &[Document]) {
        for (number, document) in documents.iter().enumerate() {
            let name = document.name().to_owned();
            match Document::parse(document.opened(), document.name()) {
                Ok(opened) => self.saved.insert(name.clone(), opened),
                Err(_) => self.saved.remove(&name),
            };
            if number > 0 {
                self.left.insert(name, document.clone());
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
        self.select(self.row_of(curve_options::GROUP));
    }

    /// Marks the scene as saved to a file, which becomes its own file.
    pub fn set_saved_as(&mut self, path: &Path) {
        let text = self.document.text_for_own_file();
        if let Ok(document) = Document::parse(&text, &path.to_string_lossy()) {
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

/// Changes from one measured curve to another, in words.
fn changes_of_curve(before: Option<&Measured>, present: Option<&Measured>) -> Vec<String> {
    match (before, present) {
        (None, None) => Vec::new(),
        (Some(before), Some(present)) if before.path == present.path => {
            curve_options::changes(&before.options, &present.options)
        }
        (_, Some(present)) => vec![format!("measured curve {}", present.name)],
        (Some(before), None) => vec![format!("without the measured curve {}", before.name)],
    }
}

/// The checked scene of a document, with its files named from the working folder.
pub fn scene_of(document: &Document) -> Arc<CheckedScene> {
    let scene = document.scene().with_files_named(|file: &str| {
        let path = document.resolve(file);
        path.to_string_lossy().into_owned()
    });
    Arc::new(scene)
}
