//! The edited scene: its parameters, the history of its edits, and whether it is saved.

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

/// Scene and measured curve at one place in the history, before or after an edit.
#[derive(Clone, Debug)]
pub struct Edited {
    pub document: Document,
    pub measured: Option<Measured>,
}

/// Returns true if a row of the list of parameters has this path. A loading stage with a number is
/// shown by the row of its number, whose path ends in `.0`.
fn is_at(parameter: &Parameter, path: &str) -> bool {
    parameter.path == path || parameter.path.strip_suffix(".0") == Some(path)
}

impl Edited {
    /// Returns true if the scenes, or the sources of the curves, differ.
    fn differs(&self, other: &Edited) -> bool {
        self.document.name() != other.document.name()
            || self.document.text() != other.document.text()
            || self.curve_source() != other.curve_source()
    }

    /// Returns the file of the measured curve, and the options with which the curve was read.
    fn curve_source(&self) -> Option<(&Path, &CurveOptions)> {
        let measured = self.measured.as_ref()?;
        Some((&measured.path, &measured.options))
    }
}

/// The edited scene, the history of its edits, and the list of its parameters.
#[derive(Clone, Debug)]
pub struct Editor {
    pub document: Document,
    /// The measured curve that is compared with the scene; `None` if there is none.
    pub measured: Option<Measured>,
    /// The checked scene of the document. The paths of its files are relative to the working
    /// folder.
    pub scene: Arc<CheckedScene>,
    /// Scene and measured curve before each edit that can be undone. The state before the newest
    /// edit is the last element.
    pub past: Vec<Edited>,
    future: Vec<Edited>,
    /// Documents as they were last saved or opened, by the names of the scenes.
    pub saved: BTreeMap<String, Document>,
    /// Number of times that a scene has been saved or opened.
    pub saves: u64,
    /// Other scenes that still have unsaved changes, by their names.
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

    /// Selects the parameter in row number `row`, or in the last row if there are fewer rows.
    pub fn select(&mut self, row: usize) {
        self.selected = row.min(self.parameters.len().saturating_sub(1));
    }

    /// Selects the row of a stage of the loading. Does nothing if there is no such row.
    pub fn select_stage(&mut self, stage: usize) {
        let mut rows = self.parameters.iter();
        if let Some(row) = rows.position(|parameter| parameter.leg == Some(stage)) {
            self.select(row);
        }
    }

    /// Moves the selection by a number of rows, downwards if the number is positive. The selection
    /// stays between the first and the last row.
    pub fn move_selection(&mut self, rows: i32) {
        self.select(self.selected.saturating_add_signed(rows as isize));
    }

    /// Returns the row of the field with this path. If there is none, returns the row of the
    /// nearest group that contains the field; if there is no such group either, returns the
    /// selected row. As a result, the selection stays in place when rows appear or disappear, and
    /// after a row has switched an effect off, the same row can switch it on again.
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

    /// Makes the scene in a document the explored scene. Undo returns to the previous document. If
    /// the two documents are the same, nothing is added to the history.
    pub fn adopt(&mut self, document: Document) {
        self.adopt_all(Edited {
            document,
            measured: self.measured.clone(),
        });
    }

    /// Makes a document the explored scene and a curve the measured curve, in one edit.
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

    /// Replaces the present document and the present curve, and returns the previous ones.
    fn exchange(&mut self, Edited { document, measured }: Edited) -> Edited {
        Edited {
            document: replace(&mut self.document, document),
            measured: replace(&mut self.measured, measured),
        }
    }

    /// Extends the last edit, so that it results in `document`. One undo then reverts both changes.
    pub fn replace(&mut self, document: Document) {
        self.document = document;
        self.future.clear();
        self.renew();
    }

    /// Undoes the last edit if `back` is true. Otherwise redoes the edit that was undone last.
    /// Returns a text that states what has changed; `None` if there is no edit to undo or redo.
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

    /// Stores a document with unsaved changes, because another scene takes the place of its scene.
    pub fn leave(&mut self, document: Document) {
        if self.is_changed(&document) {
            self.left.insert(document.name().to_owned(), document);
        }
    }

    /// Updates everything that follows from the document and the measured curve.
    fn renew(&mut self) {
        let selected = self
            .parameter()
            .map(|parameter| parameter.path.clone())
            .unwrap_or_default();
        // The user may have left the present scene earlier, with the same content as now. Then its
        // unsaved changes need not be stored twice.
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

    /// Returns true if a document differs from its saved version in a value or a comment. Another
    /// notation of the same number does not count as a change.
    fn is_changed(&self, document: &Document) -> bool {
        let Some(saved) = self.saved.get(document.name()) else {
            return true;
        };
        let has_same_content =
            saved.scene() == document.scene() && saved.comments() == document.comments();
        saved.text() != document.text() && !has_same_content
    }

    /// Returns all scenes with unsaved changes. If the explored scene has unsaved changes, it is
    /// the first.
    pub fn unsaved(&self) -> Vec<&Document> {
        let mut unsaved = vec![&self.document];
        unsaved.extend(self.left.values());
        unsaved.retain(|document| self.is_changed(document));
        unsaved
    }

    /// Restores the unsaved changes of another session. The first document becomes the explored
    /// scene.
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

    /// Adds the measured curve that the user named when starting the explorer. Undo does not remove
    /// this curve.
    pub fn begin_with(&mut self, measured: Measured) {
        self.measured = Some(measured);
        self.renew();
    }

    /// Selects the row of the measured curve, if there is such a row.
    pub fn select_measured(&mut self) {
        self.select(self.row_of(curve_options::GROUP));
    }

    /// Marks the scene as saved in a file. From now on, this file is the file of the scene.
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

/// Returns the changes from one measured curve to another as text.
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

/// Returns the checked scene of a document. The paths of its files are relative to the working
/// folder.
pub fn scene_of(document: &Document) -> Arc<CheckedScene> {
    let scene = document.scene().with_files_named(|file: &str| {
        let path = document.resolve(file);
        path.to_string_lossy().into_owned()
    });
    Arc::new(scene)
}
