//! The edited scene: its parameters, the history of its edits, and whether it is saved.

use super::curve_options;
use super::manual_path::{ManualPath, change_in_words};
use super::measured::Measured;
use super::parameters::{Parameter, Rows};
use super::profiles;
use asperity_contact::Direction;
use asperity_experiment::CurveOptions;
use asperity_scene::{CheckedScene, Document};
use asperity_study::Ensemble;
use std::collections::{BTreeMap, BTreeSet};

use std::mem::replace;
use std::path::Path;
use std::sync::Arc;

const UNDO_DEPTH: usize = 1000;

/// Scene, measured curve and path of manual loading, as they were before or after an edit.
#[derive(Clone, Debug)]
pub struct Edited {
    pub document: Document,
    pub measured: Option<Measured>,
    pub path: Option<Arc<ManualPath>>,
    /// Number of random profiles.
    pub profiles: u64,
}

/// Returns true if a row of the list of parameters has this path. A loading stage with a number is
/// shown by the row of its number, whose path ends in `.0`.
fn is_at(parameter: &Parameter, path: &str) -> bool {
    parameter.path == path || parameter.path.strip_suffix(".0") == Some(path)
}

impl Edited {
    /// Returns true if the scenes, the sources of the curves, or the paths differ.
    fn differs(&self, other: &Edited) -> bool {
        self.has_other_scene(other) || self.path != other.path
    }

    /// Returns true if the scenes, or the sources of the curves, differ.
    fn has_other_scene(&self, other: &Edited) -> bool {
        self.document.name() != other.document.name()
            || self.document.text() != other.document.text()
            || self.curve_source() != other.curve_source()
            || self.profiles != other.profiles
    }

    /// Returns the file of the measured curve, and the options with which the curve was read.
    fn curve_source(&self) -> Option<(&Path, &CurveOptions)> {
        let measured = self.measured.as_ref()?;
        Some((&measured.path, &measured.options))
    }
}

/// A move of which the explorer does not know yet whether the contact can follow it.
#[derive(Clone, Debug)]
struct TriedMove {
    /// Target as the user has typed it.
    typed: String,
    /// Edits that could be redone before the move.
    future: Vec<Edited>,
}

/// The edited scene, its history, and its list of parameters.
#[derive(Clone, Debug)]
pub struct Editor {
    pub document: Document,
    /// The measured curve that is compared with the scene; `None` if there is none.
    pub measured: Option<Measured>,
    /// Path along which the user moves the body; `None` without manual loading.
    pub path: Option<Arc<ManualPath>>,
    /// Direction of the last move, as long as further moves in this direction continue it. `None`
    /// if the next move is an edit of its own.
    series: Option<Direction>,
    /// The last move, as long as the solver may still refuse it and nothing has followed it.
    tried: Option<TriedMove>,
    /// Number of random profiles that the user wants. A scene with a fixed profile has one.
    pub profiles: u64,
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
    /// Parameters without a row in the list, because the scene leaves them at their defaults. A
    /// search finds them as well.
    absent: Vec<Parameter>,
    /// Paths of the parameters that got a row because the user has chosen them in a search.
    pub revealed: BTreeSet<&'static str>,
    /// Paths of the rows that the user has edited, each once, the last edited one at the end.
    pub edited_rows: Vec<String>,
    pub selected: usize,
}

impl Editor {
    pub fn new(document: Document) -> Self {
        let revealed = BTreeSet::new();
        let profiles = Ensemble::PROFILES;
        let rows = Rows::of(&document, None, profiles, &revealed);
        let mut editor = Editor {
            profiles,
            parameters: rows.listed,
            absent: rows.absent,
            revealed,
            edited_rows: Vec::new(),
            measured: None,
            path: None,
            series: None,
            tried: None,
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
        if let Some(row) = rows.position(|parameter| parameter.stage == Some(stage)) {
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

    /// Stores the selected row as the row that the user has edited last.
    pub fn note_edited_row(&mut self) {
        if let Some(Parameter { path, .. }) = self.parameter() {
            let path = path.clone();
            self.edited_rows.retain(|edited| *edited != path);
            self.edited_rows.push(path);
        }
    }

    /// Makes the scene in a document the explored scene. Undo returns to the previous document. If
    /// the two documents are the same, nothing is added to the history. The path of manual loading
    /// belongs to the scene, so another scene has none.
    pub fn adopt(&mut self, document: Document) {
        let is_same_scene = document.name() == self.document.name();
        let mut edited = Edited {
            document,
            ..self.edited()
        };
        if !is_same_scene {
            edited.path = None;
        }
        self.adopt_all(edited);
    }

    /// Adopts a scene, a measured curve and a path of manual loading, in one edit.
    pub fn adopt_all(&mut self, edited: Edited) {
        let before = self.exchange(edited);
        if before.differs(&self.edited()) {
            self.remember(before);
        }
        self.future.clear();
        self.renew();
    }

    /// Adds an entry to the history. The oldest entry may be removed.
    fn remember(&mut self, before: Edited) {
        self.past.push(before);
        if self.past.len() > UNDO_DEPTH {
            self.past.remove(0);
        }
    }

    /// Begins, changes or ends the path of manual loading, in one edit. The scene stays the same.
    pub fn adopt_path(&mut self, path: Option<ManualPath>) {
        let before = self.edited();
        self.remember(before);
        self.future.clear();
        self.series = None;
        self.tried = None;
        self.path = path.map(Arc::new);
    }

    /// Moves the body on to an indentation in m. `path` is the path with this move at its end. If
    /// the move before had the same direction and ended at an indentation too, the path contains
    /// only the new one of the two moves, and both are one edit. The state at the end is the same,
    /// because the contact depends only on the indentation while the direction stays the same.
    pub fn adopt_step(&mut self, mut path: ManualPath, direction: Direction) {
        let is_next = self.path.as_ref().is_some_and(|before| {
            before.start == path.start && before.moves.len() + 1 == path.moves.len()
        });
        if is_next && self.series == Some(direction) {
            let last = path.moves.len() - 1;
            path.moves.swap_remove(last - 1);
            self.path = Some(Arc::new(path));
            self.future.clear();
        } else {
            self.adopt_path(Some(path));
        }
        self.series = Some(direction);
    }

    /// Makes the next move of the body an edit of its own.
    pub fn end_series(&mut self) {
        self.series = None;
    }

    /// Adopts a path with a new move at its end, which the contact may be unable to follow. `typed`
    /// is the text that the user has typed for this move.
    pub fn try_move(&mut self, path: ManualPath, typed: &str) {
        let future = std::mem::take(&mut self.future);
        self.adopt_path(Some(path));
        self.tried = Some(TriedMove {
            typed: typed.to_owned(),
            future,
        });
    }

    /// Marks the last move as followed by the contact.
    pub fn accept_move(&mut self) {
        self.tried = None;
    }

    /// Takes the last move back if nothing has followed it, as if the user had never typed it.
    /// Returns the text that the user has typed.
    pub fn take_back_move(&mut self) -> Option<String> {
        let TriedMove { typed, future } = self.tried.take()?;
        self.path = self.past.pop()?.path;
        self.future = future;
        Some(typed)
    }

    /// Returns what the user explores: the present document, the present curve and the number of
    /// profiles.
    pub fn edited(&self) -> Edited {
        Edited {
            document: self.document.clone(),
            measured: self.measured.clone(),
            path: self.path.clone(),
            profiles: self.profiles,
        }
    }

    /// Replaces the present scene, curve, path and number of profiles, and returns the previous
    /// ones.
    fn exchange(&mut self, edited: Edited) -> Edited {
        self.series = None;
        self.tried = None;
        Edited {
            document: replace(&mut self.document, edited.document),
            measured: replace(&mut self.measured, edited.measured),
            path: replace(&mut self.path, edited.path),
            profiles: replace(&mut self.profiles, edited.profiles),
        }
    }

    /// Extends the last edit, so that it results in `document`. One undo then reverts both changes.
    pub fn replace(&mut self, document: Document) {
        self.document = document;
        self.future.clear();
        self.series = None;
        self.tried = None;
        self.renew();
    }

    /// Undoes the last edit or move if `back` is true; otherwise redoes the one that was undone
    /// last. Returns the changes as text; `None` if there is nothing to undo or redo.
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
        let is_other_scene = before.has_other_scene(&self.edited());
        let mut changes = Vec::new();
        if before.document.name() == self.document.name() {
            for change in before.document.changes_to(&self.document) {
                changes.push(change.to_string());
            }
            changes.extend(change_in_words(
                before.path.as_deref(),
                self.path.as_deref(),
            ));
        } else {
            changes.push(self.document.name().to_owned());
            self.leave(before.document);
        }
        changes.extend(changes_of_curve(
            before.measured.as_ref(),
            self.measured.as_ref(),
        ));
        if before.profiles != self.profiles {
            changes.push(format!("profiles {} → {}", before.profiles, self.profiles));
        }
        // Moves of the body change no scene, and the solver needs not compute it again.
        if is_other_scene || before.profiles != self.profiles {
            self.renew();
        }
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
        self.list();
        self.scene = scene_of(&self.document);
        self.select(self.row_of(&selected));
        self.generation += 1;
    }

    /// Updates the list of parameters.
    fn list(&mut self) {
        let rows = Rows::of(
            &self.document,
            self.measured.as_ref(),
            self.profiles,
            &self.revealed,
        );
        self.parameters = rows.listed;
        self.absent = rows.absent;
    }

    /// Returns the parameters that a search can find: the rows of the list, followed by the
    /// parameters without a row.
    pub fn searchable(&self) -> impl Iterator<Item = &Parameter> {
        self.parameters.iter().chain(&self.absent)
    }

    /// Selects the parameter with this index among those that a search can find. A parameter
    /// without a row gets one.
    pub fn reveal(&mut self, index: usize) {
        let Some(absent) = index.checked_sub(self.parameters.len()) else {
            return self.select(index);
        };
        if let Some(Parameter { field, .. }) = self.absent.get(absent) {
            let path = field.path;
            self.revealed.insert(path);
            self.list();
            self.select(self.row_of(path));
        }
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

    /// Returns the path of manual loading if the user has moved the body along it. It has no file
    /// of its own, so it is unsaved until it becomes the loading of the scene.
    pub fn unsaved_path(&self) -> Option<&Arc<ManualPath>> {
        self.path.as_ref().filter(|path| !path.moves.is_empty())
    }

    /// Restores the unsaved changes of another session. The first document becomes the explored
    /// scene, and `path` is the path along which the user has moved its body.
    pub fn restore(&mut self, documents: &[Document], path: Option<&ManualPath>) {
        self.path = path.cloned().map(Arc::new);
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

    /// Returns the number of random profiles that are computed for the present scene.
    pub fn count_profiles(&self) -> u64 {
        profiles::count(self.profiles, &self.scene)
    }

    /// Returns the option of the command line for the number of profiles, with a blank before it;
    /// empty for the usual number.
    pub fn profiles_argument(&self) -> String {
        profiles::argument(self.profiles, &self.scene)
    }

    /// Sets the number of profiles that the user named when starting the explorer.
    pub fn begin_with_profiles(&mut self, profiles: u64) {
        self.profiles = profiles;
        self.renew();
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
