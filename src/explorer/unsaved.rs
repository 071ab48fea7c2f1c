//! Scenes with unsaved changes: the explored one, and those left for another.

use super::app::App;
use super::autosave;
use crate::scene::Document;
use std::path::{Path, PathBuf};

impl App {
    /// Returns true if the scene differs from its saved document.
    #[must_use]
    pub fn is_unsaved(&self) -> bool {
        self.is_changed(&self.edit.document)
    }

    /// Returns true if a document differs from its saved one by a value or a comment; another notation of a number is
    /// no change.
    #[must_use]
    pub fn is_changed(&self, document: &Document) -> bool {
        let is_same = |saved: &Document| {
            saved.text() == document.text()
                || saved.scene() == document.scene() && saved.comments() == document.comments()
        };
        !self.edit.saved.get(document.name()).is_some_and(is_same)
    }

    /// All scenes with unsaved changes, starting with the explored one.
    #[must_use]
    pub fn unsaved(&self) -> Vec<&Document> {
        let present = Some(&self.edit.document).filter(|document| self.is_changed(document));
        present.into_iter().chain(self.edit.left.values().filter(|left| self.is_changed(left))).collect()
    }

    /// Registers scenes as unsaved changes of another session, the first of them as the explored scene.
    pub fn restore(&mut self, documents: &[Document]) {
        for (number, document) in documents.iter().enumerate() {
            match Document::parse(document.opened(), document.name()) {
                Ok(opened) => drop(self.edit.saved.insert(document.name().to_owned(), opened)),
                Err(_) => drop(self.edit.saved.remove(document.name())),
            }
            if number > 0 {
                self.edit.left.insert(document.name().to_owned(), document.clone());
            }
        }
    }

    /// Offers the unsaved changes in files of ended sessions, the newest first.
    pub fn offer(&mut self, files: &[PathBuf]) {
        let scenes = files.iter().filter_map(|path| autosave::read(path).ok()).flatten();
        let name =
            |document: Document| Some(Path::new(document.name()).file_name()?.to_string_lossy().into_owned());
        let mut names: Vec<String> = scenes.filter_map(name).collect();
        names.dedup();
        if !names.is_empty() {
            let of = names.join(", ");
            self.set_done(format!("unsaved changes of {of} are kept: asperity --restore opens the newest"));
        }
    }

    /// Marks the present scene as saved to a file, which becomes the file of the scene.
    pub fn set_saved_as(&mut self, path: &Path) {
        if let Ok(document) = Document::parse(self.edit.document.text(), &path.to_string_lossy()) {
            self.edit.document = document;
        }
        self.set_saved();
    }

    /// Marks the present scene as saved.
    pub fn set_saved(&mut self) {
        self.edit.saves += 1;
        self.edit.saved.insert(self.edit.document.name().to_owned(), self.edit.document.clone());
    }
}
