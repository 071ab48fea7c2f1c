//! Looking through the library.

use super::{Effect, edit};
use crate::explorer::finder::Finder;
use crate::explorer::mode::{Library, Mode};
use crate::explorer::model::Model;
use crate::scene::{Entry, typed_path};

/// Most springs for a preview in the list: its curve is complete before the next row.
const MOST_SPRINGS_SEEN: u64 = 1 << 17;

/// Opens the library.
pub fn open(model: &mut Model) -> Vec<Effect> {
    model.mode = Mode::Library(Library { entries: None, finder: Finder::default() });
    vec![Effect::List]
}

/// Stores the entries of the library.
pub fn listed(model: &mut Model, entries: Vec<Entry>) -> Vec<Effect> {
    if let Mode::Library(library) = &mut model.mode {
        library.entries = Some(entries);
    }
    search(model)
}

/// Searches the library again.
pub fn search(model: &mut Model) -> Vec<Effect> {
    let Mode::Library(library) = &mut model.mode else { return Vec::new() };
    let Some(entries) = &library.entries else { return Vec::new() };
    // A text with a separator is a path, not a name to search for.
    if library.finder.query.text().contains(std::path::is_separator) {
        library.finder.search([]);
    } else {
        library.finder.search(entries.iter().map(Library::candidate));
    }
    preview(model)
}

/// Opens the selected scene, or the typed path where no scene fits.
pub fn accept(model: &mut Model, library: &Library) -> Vec<Effect> {
    let Some(entry) = library.entry() else {
        let typed = library.finder.query.text().trim().to_owned();
        if typed.is_empty() {
            return Vec::new();
        }
        model.mode = Mode::Explore;
        let path = typed_path(&typed).into_os_string().into_string();
        return vec![Effect::Open(path.unwrap_or(typed))];
    };
    model.mode = Mode::Explore;
    edit::open_read(model, entry.document.clone())
}

/// Requests the curve of the selected scene.
pub fn preview(model: &mut Model) -> Vec<Effect> {
    let Mode::Library(library) = &model.mode else { return Vec::new() };
    let Some(entry) = library.entry() else { return Vec::new() };
    if model.preview.as_ref().is_some_and(|preview| preview.text == entry.text) {
        return Vec::new();
    }
    match entry.document.clone() {
        Ok(document) if edit::is_previewed(&document, MOST_SPRINGS_SEEN) => {
            vec![Effect::Preview(Box::new(document))]
        }
        _ => Vec::new(),
    }
}
