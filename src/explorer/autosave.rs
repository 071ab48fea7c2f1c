//! Copies of unsaved changes, in case the process or its connection ends before the user saves the
//! changes. Each session has its own file, which is locked while the session runs. Files of the
//! user are never changed.

use super::manual_path::ManualPath;
use asperity_data::{into_text, open_regular, path_name, read_limited};
use asperity_scene::Document;
use etcetera::{BaseStrategy, choose_base_strategy};
use serde::{Deserialize, Serialize};
use std::fs::{File, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf, absolute};
use std::time::{SystemTime, UNIX_EPOCH};
use std::{fs, io};

/// Largest size of a file in bytes. This is enough for many scenes, which have a few hundred bytes
/// each.
const LONGEST: usize = 1 << 24;

/// Scene with unsaved changes, as it is stored in a file. The first scene in the file is the scene
/// that the user was exploring.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Copy {
    /// Absolute path of the scene file, or name of a built-in scene.
    name: String,
    opened: String,
    text: String,
    overrides: Vec<(String, String)>,
    /// Path along which the user has moved the body by hand. Only the first scene has one.
    path: Option<ManualPath>,
}

/// What a session keeps for another session.
#[derive(Clone, Debug, Default)]
pub struct Unsaved<'a> {
    /// Scenes with unsaved changes. If there is a path, the first one is the scene of the path,
    /// which may itself have no changes.
    pub documents: Vec<&'a Document>,
    /// Path by hand in the first scene; `None` if the user has not moved the body.
    pub path: Option<&'a ManualPath>,
}

impl Unsaved<'_> {
    pub fn is_empty(&self) -> bool {
        self.documents.is_empty()
    }

    fn copies(&self) -> Vec<Copy> {
        let mut copies: Vec<Copy> = self
            .documents
            .iter()
            .map(|document| Copy::of(document))
            .collect();
        if let Some(first) = copies.first_mut() {
            first.path = self.path.cloned();
        }
        copies
    }
}

impl Copy {
    fn of(document: &Document) -> Self {
        let name = match absolute(document.name()) {
            Ok(path) if path.is_file() => path.display().to_string(),
            _ => document.name().to_owned(),
        };
        Copy {
            name,
            opened: document.opened().to_owned(),
            text: document.text().to_owned(),
            overrides: document.overrides().to_vec(),
            path: None,
        }
    }
}

/// File with the unsaved changes of a session.
pub struct Autosave {
    path: PathBuf,
    /// The locked file; `None` if there are no unsaved changes.
    own: Option<File>,
}

/// Returns the folder for copies of unsaved changes; `None` if the system has no such folder.
pub fn folder() -> Option<PathBuf> {
    let strategy = choose_base_strategy().ok()?;
    let state = strategy.state_dir().unwrap_or_else(|| strategy.data_dir());
    Some(state.join("asperity").join("unsaved"))
}

/// Unsaved changes of an ended session. The first document is the scene that the user was
/// exploring. The file with the changes is locked while this value exists, so that no other process
/// can restore the same changes.
pub struct Kept {
    path: PathBuf,
    lock: File,
    pub documents: Vec<Document>,
    /// Path along which the user had moved the body by hand in the first document.
    pub by_hand: Option<ManualPath>,
}

/// Content of a file with unsaved changes.
struct Content {
    documents: Vec<Document>,
    by_hand: Option<ManualPath>,
}

/// Result of a search for the unsaved changes of ended sessions.
#[derive(Default)]
pub struct Newest {
    /// The newest unsaved changes that can be read; `None` if there are none.
    pub kept: Option<Kept>,
    /// Names of files that are newer than [`Newest::kept`] but cannot be read, each with the
    /// reason, the newest first. A power cut may have damaged these files.
    pub unreadable: Vec<String>,
}

/// Returns the newest unsaved changes of an ended session that can be read, and the names of newer
/// files that cannot be read.
pub fn newest(folder: &Path) -> Newest {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|extension| extension == "ron") {
            files.push(path);
        }
    }
    files.sort_by_key(|path| fs::metadata(path).and_then(|found| found.modified()).ok());
    let mut newest = Newest::default();
    while let Some(path) = files.pop() {
        match open(path.clone()) {
            Ok(Some(kept)) => {
                newest.kept = Some(kept);
                break;
            }
            Ok(None) => {}
            Err(why) => {
                let name = path_name(&path);
                newest.unreadable.push(format!("{name}: {why}"));
            }
        }
    }
    newest
}

/// Opens the file of an ended session. Returns `None` if the session is still running, or if
/// another session has just taken the file.
fn open(path: PathBuf) -> Result<Option<Kept>, String> {
    let lock = open_regular(&path).map_err(|error| error.to_string())?;
    if matches!(lock.try_lock(), Err(TryLockError::WouldBlock)) {
        return Ok(None);
    }
    let Content { documents, by_hand } = read(&lock)?;
    if documents.is_empty() {
        return Err("there is no scene in it".to_owned());
    }
    Ok(Some(Kept {
        path,
        lock,
        documents,
        by_hand,
    }))
}

/// Returns a message that offers the newest unsaved changes of an ended session; `None` if there
/// are none.
pub fn offer(folder: &Path) -> Option<String> {
    let mut names = Vec::new();
    for document in newest(folder).kept?.documents {
        if let Some(name) = Path::new(document.name()).file_name() {
            names.push(name.display().to_string());
        }
    }
    Some(format!(
        "asperity --restore opens the unsaved changes of {}",
        names.join(", ")
    ))
}

/// Reads the scenes in a file, and the path by hand. The first scene is the one that the user was
/// exploring.
fn read(file: &File) -> Result<Content, String> {
    let text = read_limited(file, LONGEST)
        .and_then(into_text)
        .map_err(|error| error.to_string())?;
    let copies: Vec<Copy> = ron::from_str(&text).map_err(|error| error.to_string())?;
    let mut documents = Vec::new();
    let mut by_hand = None;
    for copy in copies {
        if documents.is_empty() {
            by_hand = copy.path;
        }
        let document = Document::parse(&copy.text, &copy.name);
        let document = document.map_err(|errors| errors.to_string())?;
        documents.push(document.resumed(copy.opened, copy.overrides));
    }
    Ok(Content { documents, by_hand })
}

impl Autosave {
    /// Prepares the storage of the unsaved changes of a new session. If the session continues an
    /// ended session (`restored`), it takes over the file of the ended session. Otherwise it has no
    /// file until there are unsaved changes.
    pub fn new(folder: &Path, restored: Option<Kept>) -> Self {
        if let Some(Kept { path, lock, .. }) = restored {
            return Autosave {
                path,
                own: Some(lock),
            };
        }
        let now = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default()
            .as_nanos();
        Autosave {
            path: folder.join(format!("{}-{now}.ron", std::process::id())),
            own: None,
        }
    }

    /// Returns true if there is a file with the unsaved changes of this explorer.
    pub fn has_file(&self) -> bool {
        self.own.is_some()
    }

    /// Writes these changes to the file of this explorer and replaces what the file contains. If
    /// there are no changes, the file is removed. Even if the process is killed meanwhile, the file
    /// has either its complete old content or its complete new content.
    pub fn keep(&mut self, unsaved: &Unsaved<'_>) -> io::Result<()> {
        if unsaved.is_empty() {
            return match self.own.take() {
                Some(_) => fs::remove_file(&self.path),
                None => Ok(()),
            };
        }
        let text = ron::to_string(&unsaved.copies()).map_err(io::Error::other)?;
        fs::create_dir_all(self.path.parent().unwrap_or(Path::new("")))?;
        let unfinished = self.path.with_extension("new");
        let mut file = File::create(&unfinished)?;
        // On a file system without locks, another explorer may offer these copies while this one is
        // still running. This does no harm.
        let _ = file.try_lock();
        file.write_all(text.as_bytes())?;
        // The content must be on the disk before the file gets its name, or else a power cut could
        // leave a damaged file.
        file.sync_all()?;
        self.own = Some(file);
        fs::rename(&unfinished, &self.path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::manual_path::PathStart;
    use crate::explorer::player::At;
    use asperity_contact::Move;
    use asperity_scene::open as open_scene;
    use std::time::Duration;

    fn of<'a>(documents: &[&'a Document]) -> Unsaved<'a> {
        Unsaved {
            documents: documents.to_vec(),
            path: None,
        }
    }

    #[test]
    fn copies_are_read_back_as_they_were_once_their_session_has_ended() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("state/unsaved");
        let kept = || newest(&folder).kept;
        assert!(kept().is_none());
        let changed = open_scene("pressure-sensitive")
            .unwrap()
            .set("adhesion.kappa", "3.0")
            .unwrap();
        let other = open_scene("rough-sphere")
            .unwrap()
            .set("length", "2.0e-4")
            .unwrap();
        let mut session = Autosave::new(&folder, None);
        session.keep(&of(&[&changed])).unwrap();
        session.keep(&of(&[&changed, &other])).unwrap();
        assert!(kept().is_none(), "the session runs");
        drop(session);
        let restored = kept().unwrap();
        assert_eq!(restored.documents, [changed.clone(), other]);
        assert_eq!(restored.documents[0].overrides(), changed.overrides());
        assert!(
            kept().is_none(),
            "another process that restores at the same time has nothing left to open"
        );
        let mut next = Autosave::new(&folder, Some(restored));
        next.keep(&of(&[&changed])).unwrap();
        assert!(
            kept().is_none(),
            "the session that opened the scenes continues their file"
        );
        next.keep(&Unsaved::default()).unwrap();
        assert_eq!(
            fs::read_dir(&folder).unwrap().count(),
            0,
            "nothing is unsaved any more"
        );
    }

    #[test]
    fn a_path_by_hand_is_read_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let scene = open_scene("pressure-sensitive").unwrap();
        for (at, indentation) in [
            (At::Start, 1.0 / 3.0 * 1e-6),
            (At::Indentation(-0.1 * f64::EPSILON), -5e-324),
            (At::PullOff, -0.0),
            (At::End, 0.1 + 0.2),
        ] {
            let path = ManualPath {
                start: PathStart { stage: 1, at },
                moves: vec![
                    Move::ToIndentation(indentation),
                    Move::ToForce(-indentation),
                    Move::ToDisplacement(indentation),
                    Move::ToTouch,
                    Move::ToZeroForce,
                    Move::ToSeparation,
                ],
            };
            let mut session = Autosave::new(folder.path(), None);
            session
                .keep(&Unsaved {
                    documents: vec![&scene],
                    path: Some(&path),
                })
                .unwrap();
            drop(session);
            let mut restored = newest(folder.path()).kept.unwrap();
            assert_eq!(restored.documents, std::slice::from_ref(&scene));
            // The formatted numbers also differ for 0 and -0, which are equal.
            let read = restored.by_hand.take().unwrap();
            assert_eq!(format!("{read:?}"), format!("{path:?}"));
            let mut next = Autosave::new(folder.path(), Some(restored));
            next.keep(&Unsaved::default()).unwrap();
        }
    }

    /// A file that cannot be read is reported by its name, and does not hide an older file that can
    /// be read. Such a file may have been damaged by a power cut, or may not be a copy of a scene
    /// at all.
    #[test]
    fn files_that_cannot_be_read_are_stated_and_hide_no_older_one() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let changed = open_scene("pressure-sensitive")
            .unwrap()
            .set("adhesion.kappa", "3.0")
            .unwrap();
        let mut session = Autosave::new(folder, None);
        session.keep(&of(&[&changed])).unwrap();
        drop(session);
        // The clock of files is coarse, so a file written at once may have the same time.
        let an_hour_ago = SystemTime::now() - Duration::from_secs(3600);
        for entry in fs::read_dir(folder).unwrap() {
            let older = File::options().write(true).open(entry.unwrap().path());
            older.unwrap().set_modified(an_hour_ago).unwrap();
        }
        let wrong = [
            ("a.ron", ""),
            ("b.ron", "("),
            ("c.ron", "[(name: \"a\")]"),
            ("d.ron", "[(name"),
            ("e.ron", "[]"),
        ];
        for (name, text) in wrong {
            fs::write(folder.join(name), text).unwrap();
            let Newest { kept, unreadable } = newest(folder);
            assert!(
                unreadable.len() == 1 && unreadable[0].contains(name),
                "{unreadable:?}"
            );
            assert_eq!(
                kept.expect("the older file").documents,
                std::slice::from_ref(&changed),
                "{name}"
            );
            assert!(
                offer(folder).is_some_and(|offer| offer.contains("pressure-sensitive")),
                "{name}"
            );
            fs::remove_file(folder.join(name)).unwrap();
        }
        fs::create_dir(folder.join("folder.ron")).unwrap();
        for (name, text) in wrong {
            fs::write(folder.join(name), text).unwrap();
        }
        let Newest { kept, unreadable } = newest(folder);
        assert!(
            kept.is_some() && unreadable.len() == wrong.len() + 1,
            "{unreadable:?}"
        );
    }
}
