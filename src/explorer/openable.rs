//! List of what the user can open: scenes, and the studies, plans and measured files of the working
//! folder.

use super::recognition::{MeasuredFile, lacks_options};
use asperity_data::{is_control, printable, read_regular_text};
use asperity_scene::library::{Entry, Source, is_plan, scenes};
use asperity_study::Folder;
use std::fs::read_dir;
use std::path::{Path, PathBuf};

/// Largest number of entries of the working folder that are examined.
const MOST_ENTRIES: usize = 1_000;
/// Largest size in bytes of all files together that are read to recognise what they contain.
/// Further files are not listed, so that the list appears soon.
const MOST_READ: u64 = 16 << 20;
/// Largest number of characters of a file that are shown beside the list.
const SHOWN: usize = 4_000;

/// Entry in the list of what the user can open.
#[derive(Clone, Debug, PartialEq)]
pub enum Openable {
    Scene(Box<Entry>),
    File(ListedFile),
}

/// File or folder of the working folder that can be opened and is not a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedFile {
    pub name: String,
    pub path: PathBuf,
    pub kind: FileKind,
    /// Beginning of the text of the file; empty for a folder or a binary file.
    pub text: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    Study,
    Plan,
    Curve,
    Surface,
}

impl FileKind {
    /// Returns the word that the list shows for this kind of file.
    pub fn word(self) -> &'static str {
        match self {
            FileKind::Study => "study",
            FileKind::Plan => "plan",
            FileKind::Curve => "force curve",
            FileKind::Surface => "surface",
        }
    }

    /// Returns a sentence that states what happens when a file of this kind is opened.
    pub fn effect(self) -> &'static str {
        match self {
            FileKind::Study => "Enter shows the maps of the study and its scene.",
            FileKind::Plan => {
                "Enter opens the scene of the plan; asperity sweep computes the plan."
            }
            FileKind::Curve => "Enter shows the force curve beside the present scene.",
            FileKind::Surface => {
                "Enter makes the surface the roughness of the present scene, whose length stays; u undoes it."
            }
        }
    }
}

impl Openable {
    pub fn name(&self) -> &str {
        match self {
            Openable::Scene(entry) => &entry.name,
            Openable::File(file) => &file.name,
        }
    }

    /// Returns the texts in which a search looks for words. For a scene, these are its name, its
    /// title and its notice, and for a built-in scene also its number. For another file, these are
    /// its name and its kind. `index` is the index of the entry in the list. The number of a
    /// built-in scene follows from it, because built-in scenes come first.
    pub fn texts(&self, index: usize) -> Vec<String> {
        match self {
            Openable::Scene(entry) => {
                let number = match entry.origin {
                    Source::BuiltIn => (index + 1).to_string(),
                    _ => String::new(),
                };
                let title = entry.title().to_owned();
                vec![number, entry.name.clone(), title, entry.notice().to_owned()]
            }
            Openable::File(file) => vec![file.name.clone(), file.kind.word().to_owned()],
        }
    }
}

/// Lists what the user can open: first all scenes, then the studies, plans, force curves and
/// surfaces of the folder `working`, sorted by kind and name. `own` is the folder of the user's own
/// scenes.
pub fn openables(own: Option<&Path>, working: &Path) -> Vec<Openable> {
    let mut list: Vec<Openable> = Vec::new();
    list.extend(
        scenes(own, working)
            .into_iter()
            .map(|entry| Openable::Scene(Box::new(entry))),
    );
    let mut files = Vec::new();
    let mut read = 0;
    let entries = read_dir(working).into_iter().flatten();
    for entry in entries.take(MOST_ENTRIES).flatten() {
        files.extend(listed(&entry.path(), &mut read));
    }
    files.sort_by_key(|file| (file.kind as usize, file.name.clone()));
    list.extend(files.into_iter().map(Openable::File));
    list
}

/// Returns the entry for a path; `None` if the path is hidden or not recognised. Adds the size of
/// the file to `read` if the file is read.
fn listed(path: &Path, read: &mut u64) -> Option<ListedFile> {
    let name = path.file_name()?.to_str()?;
    if name.starts_with('.') || name.contains(is_control) {
        return None;
    }
    let file = |kind: FileKind, text: String| ListedFile {
        name: printable(name).into_owned(),
        path: path.strip_prefix(".").unwrap_or(path).to_owned(),
        kind,
        text,
    };
    if path.is_dir() {
        return Folder::is_at(path).then(|| file(FileKind::Study, String::new()));
    }
    let metadata = path.metadata().ok()?;
    *read = read.saturating_add(metadata.len());
    if !metadata.is_file() || *read > MOST_READ {
        return None;
    }
    let text = read_regular_text(path, MOST_READ as usize).unwrap_or_default();
    if path.extension().is_some_and(|extension| extension == "ron") {
        return is_plan(&text).then(|| file(FileKind::Plan, text));
    }
    let kind = match MeasuredFile::of(path) {
        Some(MeasuredFile::Curve) => FileKind::Curve,
        Some(MeasuredFile::Surface) => FileKind::Surface,
        None if lacks_options(path) => FileKind::Curve,
        None => return None,
    };
    Some(file(kind, text.chars().take(SHOWN).collect()))
}
