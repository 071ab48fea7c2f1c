//! Copies of unsaved changes, in case the process or its connection ends first: one file for each session, locked while
//! the session runs. Files of the user are never written.

use crate::io::read_regular_text;
use crate::scene::Document;
use etcetera::{BaseStrategy, choose_base_strategy};
use serde::{Deserialize, Serialize};
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf, absolute};
use std::time::{SystemTime, UNIX_EPOCH};

/// Largest size of a file, bytes: many scenes of a few hundred bytes each.
const LONGEST: usize = 1 << 24;

/// A scene with unsaved changes. The explored scene is the first of a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Copy {
    /// Whole path of the file, or name of a built-in scene.
    name: String,
    opened: String,
    text: String,
    overrides: Vec<(String, String)>,
}

pub struct Autosave {
    path: PathBuf,
    /// The file, locked; `None` without unsaved changes.
    own: Option<File>,
}

/// Returns the folder of the files; `None` where the system has none.
pub fn folder() -> Option<PathBuf> {
    let strategy = choose_base_strategy().ok()?;
    let state = strategy.state_dir().unwrap_or_else(|| strategy.data_dir());
    Some(state.join("asperity").join("unsaved"))
}

/// Returns the newest file of an ended session.
pub fn newest(folder: &Path) -> Option<PathBuf> {
    let is_ended = |path: &PathBuf| {
        path.extension().is_some_and(|extension| extension == "ron")
            && File::open(path).is_ok_and(|file| !matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
    };
    let files = fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path()).filter(is_ended);
    files.max_by_key(|path| fs::metadata(path).and_then(|found| found.modified()).ok())
}

/// Returns the message that offers the newest unsaved changes of an ended session.
pub fn offer(folder: &Path) -> Option<String> {
    let documents = read(&newest(folder)?).ok()?;
    let name = |document: &Document| Some(Path::new(document.name()).file_name()?.display().to_string());
    let names: Vec<String> = documents.iter().filter_map(name).collect();
    Some(format!("unsaved changes of {} are kept: asperity --restore opens them", names.join(", ")))
}

/// Reads the scenes of a file, the explored one first.
pub fn read(path: &Path) -> Result<Vec<Document>, String> {
    let wrong = |why: &dyn ToString| format!("{}: {}", path.display(), why.to_string());
    let text = read_regular_text(path, LONGEST).map_err(|error| wrong(&error))?;
    let copies: Vec<Copy> = ron::from_str(&text).map_err(|error| wrong(&error))?;
    let document = |copy: Copy| {
        let document = Document::parse(&copy.text, &copy.name).map_err(|errors| wrong(&errors))?;
        Ok(document.resumed(copy.opened, copy.overrides))
    };
    copies.into_iter().map(document).collect()
}

impl Autosave {
    /// Creates the copies of a session, without a file or with the file of an ended session.
    pub fn new(folder: &Path, restored: Option<PathBuf>) -> Self {
        let now = || SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
        let path = restored.unwrap_or_else(|| folder.join(format!("{}-{}.ron", std::process::id(), now())));
        let own = File::open(&path).ok();
        // A file system without locks offers the copies to other sessions too early, which harms nobody.
        own.iter().for_each(|file| drop(file.try_lock()));
        Autosave { path, own }
    }

    /// Keeps these scenes in place of all before; without any, there is no file. The file is whole at every moment.
    pub fn keep(&mut self, documents: &[&Document]) -> io::Result<()> {
        if documents.is_empty() {
            return self.own.take().map_or(Ok(()), |_| fs::remove_file(&self.path));
        }
        let copy = |document: &&Document| {
            let file = absolute(document.name()).ok().filter(|path| path.is_file());
            let whole = file.is_none().then(|| with_whole_paths(document)).flatten();
            let document = whole.as_ref().unwrap_or(document);
            Copy {
                name: file.map_or_else(|| document.name().to_owned(), |path| path.display().to_string()),
                opened: document.opened().to_owned(),
                text: document.text().to_owned(),
                overrides: document.overrides().to_vec(),
            }
        };
        let copies: Vec<Copy> = documents.iter().map(copy).collect();
        let text = ron::to_string(&copies).map_err(io::Error::other)?;
        fs::create_dir_all(self.path.parent().unwrap_or(Path::new("")))?;
        let unfinished = self.path.with_extension("new");
        let mut file = File::create(&unfinished)?;
        let _ = file.try_lock();
        file.write_all(text.as_bytes())?;
        self.own = Some(file);
        fs::rename(&unfinished, &self.path)
    }
}

/// The document with whole paths of its measured files in place of those from the working folder.
fn with_whole_paths(document: &Document) -> Option<Document> {
    let files = document.scene().measured_files();
    let mut roughness = document.value("roughness").filter(|_| !files.is_empty())?.to_owned();
    for file in files {
        let whole = absolute(document.resolve(file)).ok()?;
        roughness = roughness.replace(&format!("{file:?}"), &format!("{:?}", whole.to_str()?));
    }
    document.set("roughness", &roughness).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open;

    #[test]
    fn copies_are_read_back_as_they_were_once_their_session_has_ended() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("state/unsaved");
        assert_eq!(newest(&folder), None);
        let changed = open("pressure-sensitive").unwrap().set("adhesion.kappa", "3.0").unwrap();
        let other = open("rough-sphere").unwrap().set("length", "2.0e-4").unwrap();
        let mut session = Autosave::new(&folder, None);
        session.keep(&[&changed]).unwrap();
        session.keep(&[&changed, &other]).unwrap();
        assert_eq!(newest(&folder), None, "the session runs");
        drop(session);
        let file = newest(&folder).unwrap();
        let documents = read(&file).unwrap();
        assert_eq!(documents, [changed.clone(), other]);
        assert_eq!(documents[0].overrides(), changed.overrides());
        // A measured file is found from any folder.
        let measured = changed.set("roughness", "Measured(file: \"map.txt\")").unwrap();
        let mut next = Autosave::new(&folder, Some(file.clone()));
        next.keep(&[&measured]).unwrap();
        let whole = absolute("map.txt").unwrap();
        assert_eq!(read(&file).unwrap()[0].scene().measured_files(), [whole.to_str().unwrap()]);
        assert_eq!(newest(&folder), None, "the session that opened the scenes continues their file");
        next.keep(&[&changed]).unwrap();
        next.keep(&[]).unwrap();
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "nothing is unsaved any more");
        for (text, reason) in [("(", "1:1"), ("[(name: \"a\")]", "opened"), ("[(name", "1:")] {
            fs::write(&file, text).unwrap();
            let why = read(&file).unwrap_err();
            assert!(why.contains(reason) && why.contains(file.to_str().unwrap()), "{why}");
        }
    }
}
