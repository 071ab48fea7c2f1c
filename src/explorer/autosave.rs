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

/// The copies of one session.
pub struct Autosave {
    path: PathBuf,
    /// The file, locked; `None` without unsaved changes.
    own: Option<File>,
    /// File of an ended session, removed once its scenes are in the own file.
    restored: Option<PathBuf>,
}

/// Returns the folder of the files; `None` where the system has none.
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let strategy = choose_base_strategy().ok()?;
    let state = strategy.state_dir().unwrap_or_else(|| strategy.data_dir());
    Some(state.join("asperity").join("unsaved"))
}

/// Returns the files of ended sessions, the newest first.
#[must_use]
pub fn left_behind(folder: &Path) -> Vec<PathBuf> {
    let is_ended = |path: &PathBuf| {
        path.extension().is_some_and(|extension| extension == "ron")
            && File::open(path).is_ok_and(|file| !matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
    };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_ended).collect();
    files.sort_by_key(|path| fs::metadata(path).and_then(|found| found.modified()).ok());
    files.reverse();
    files
}

/// Returns the message that offers the unsaved changes of ended sessions, the newest first.
#[must_use]
pub fn offer(folder: &Path) -> Option<String> {
    let scenes = left_behind(folder).into_iter().filter_map(|path| read(&path).ok()).flatten();
    let name =
        |document: Document| Some(Path::new(document.name()).file_name()?.to_string_lossy().into_owned());
    let mut names: Vec<String> = scenes.filter_map(name).collect();
    names.dedup();
    let names = Some(names.join(", ")).filter(|names| !names.is_empty())?;
    Some(format!("unsaved changes of {names} are kept: asperity --restore opens the newest"))
}

/// Reads the scenes of a file, the explored one first.
///
/// # Errors
/// The file and the reason why it cannot be read.
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
    /// Creates the copies of a session, without a file. `restored` is the file whose scenes the session opened.
    #[must_use]
    pub fn new(folder: &Path, restored: Option<PathBuf>) -> Self {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
        let path = folder.join(format!("{}-{now}.ron", std::process::id()));
        Autosave { path, own: None, restored }
    }

    /// Keeps these scenes in place of all before; without any, there is no file. The file is whole at every moment.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn keep(&mut self, documents: &[&Document]) -> io::Result<()> {
        if documents.is_empty() {
            return self.own.take().map_or(Ok(()), |_| fs::remove_file(&self.path));
        }
        let copy = |document: &&Document| Copy {
            name: absolute(document.name())
                .ok()
                .filter(|path| path.is_file())
                .map_or_else(|| document.name().to_owned(), |path| path.to_string_lossy().into_owned()),
            opened: document.opened().to_owned(),
            text: document.text().to_owned(),
            overrides: document.overrides().to_vec(),
        };
        let text =
            ron::to_string(&documents.iter().map(copy).collect::<Vec<_>>()).map_err(io::Error::other)?;
        fs::create_dir_all(self.path.parent().unwrap_or(Path::new("")))?;
        let unfinished = self.path.with_extension("new");
        let mut file = File::create(&unfinished)?;
        // A file system without locks offers the copies to other sessions too early, which harms nobody.
        let _ = file.try_lock();
        file.write_all(text.as_bytes())?;
        fs::rename(&unfinished, &self.path)?;
        self.own = Some(file);
        self.restored.take().map_or(Ok(()), fs::remove_file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open;

    #[test]
    fn copies_are_read_back_as_they_were_once_their_session_has_ended() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("state/unsaved");
        assert!(left_behind(&folder).is_empty());
        let changed = open("pressure-sensitive").unwrap().set("adhesion.kappa", "3.0").unwrap();
        let other = open("rough-sphere").unwrap().set("length", "2.0e-4").unwrap();
        let mut session = Autosave::new(&folder, None);
        session.keep(&[&changed]).unwrap();
        session.keep(&[&changed, &other]).unwrap();
        assert!(left_behind(&folder).is_empty(), "the session runs");
        drop(session);
        let files = left_behind(&folder);
        let documents = read(&files[0]).unwrap();
        assert_eq!(documents, [changed.clone(), other]);
        assert_eq!(documents[0].overrides(), changed.overrides());
        let mut next = Autosave::new(&folder, Some(files[0].clone()));
        assert!(files[0].exists());
        next.keep(&[&changed]).unwrap();
        assert!(!files[0].exists(), "the scenes are in the file of the session that opened them");
        next.keep(&[]).unwrap();
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "nothing is unsaved any more");
        for (text, reason) in [("(", "1:1"), ("[(name: \"a\")]", "opened"), ("[(name", "1:")] {
            fs::write(&files[0], text).unwrap();
            let why = read(&files[0]).unwrap_err();
            assert!(why.contains(reason) && why.contains(files[0].to_str().unwrap()), "{why}");
        }
    }
}
