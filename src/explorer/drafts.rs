//! Unsaved changes, kept in the state folder in case the process or the connection ends before they are saved. One
//! file for each process; files of the user are never written.

use super::action::Action;
use crate::io::{read_regular_text, write_new};
use crate::scene::Document;
use etcetera::{BaseStrategy, choose_base_strategy};
use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Version of the files.
const VERSION: u32 = 1;
/// Largest size of a file, bytes: many scenes of a few hundred bytes each.
const LONGEST: usize = 1 << 24;
/// Most files read from the folder.
const MOST_FILES: usize = 1000;
/// Changes are written after a pause of this length.
const QUIET: Duration = Duration::from_millis(300);
/// Longest wait for the last file on leaving: a disk that does not answer must not keep the terminal.
const PATIENCE: Duration = Duration::from_secs(1);

/// Content of a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DraftFile {
    version: u32,
    /// The explored scene first.
    scenes: Vec<Draft>,
}

/// A scene with unsaved changes.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Draft {
    name: String,
    opened: String,
    text: String,
    overrides: Vec<(String, String)>,
}

/// Scenes read back.
pub struct Restored {
    /// Their file, to be removed once they are kept anew.
    path: PathBuf,
    /// The scenes, starting with the explored one.
    pub documents: Vec<Document>,
}

/// The folder of the files; `None` where the system has none.
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let strategy = choose_base_strategy().ok()?;
    let state = strategy.state_dir().unwrap_or_else(|| strategy.data_dir());
    Some(state.join("asperity").join("unsaved"))
}

fn file_of(folder: &Path, process: u32) -> PathBuf {
    folder.join(format!("{}-{process}.ron", machine()))
}

/// The newest file of an ended process in a folder.
fn newest(folder: &Path) -> Option<PathBuf> {
    let of_ended = |path: &PathBuf| {
        let owner = path.file_stem()?.to_str()?.strip_prefix(&machine())?.strip_prefix('-')?;
        let process = owner.parse().ok()?;
        (path.extension()? == "ron" && is_gone(process)).then_some(())
    };
    let files = fs::read_dir(folder).ok()?.take(MOST_FILES).flatten().map(|entry| entry.path());
    let written = |path: &PathBuf| fs::metadata(path).and_then(|found| found.modified()).ok();
    files.filter(|path| of_ended(path).is_some()).max_by_key(written)
}

/// Reads back the newest unsaved changes of an ended process from a folder; `None` where there are none.
///
/// # Errors
/// The unreadable file and the reason.
pub fn restore(folder: &Path) -> Result<Option<Restored>, String> {
    let Some(path) = newest(folder) else { return Ok(None) };
    let wrong = |why: String| format!("{}: {why}", path.display());
    let text = read_regular_text(&path, LONGEST).map_err(|error| wrong(error.to_string()))?;
    let file: DraftFile = ron::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    if file.version != VERSION {
        return Err(wrong(format!("version = {}: allowed: {VERSION}", file.version)));
    }
    let document = |draft: Draft| {
        let document =
            Document::parse(&draft.text, &draft.name).map_err(|errors| wrong(errors.to_string()))?;
        Ok(document.resumed(draft.opened, draft.overrides))
    };
    let documents: Vec<Document> = file.scenes.into_iter().map(document).collect::<Result<_, String>>()?;
    Ok(Some(Restored { path, documents }).filter(|restored| !restored.documents.is_empty()))
}

/// The text of the file of these documents.
fn text_of(documents: &[Document]) -> Result<String, ron::Error> {
    let draft = |document: &Document| Draft {
        name: document.name().to_owned(),
        opened: document.opened().to_owned(),
        text: document.text().to_owned(),
        overrides: document.overrides().to_vec(),
    };
    let file = DraftFile { version: VERSION, scenes: documents.iter().map(draft).collect() };
    ron::ser::to_string_pretty(&file, PrettyConfig::default())
}

/// Request to the thread.
enum Request {
    /// Keep these documents, in place of all before.
    Keep(Vec<Document>),
    /// Write the newest documents at once, and confirm.
    Flush(Sender<()>),
}

/// Thread that keeps unsaved changes of this process in a file.
pub struct Drafts {
    requests: Sender<Request>,
}

impl Drafts {
    /// Starts the thread on a folder. The file of `restored` is removed once its scenes are written anew; without
    /// `restored`, unsaved changes of another session are reported.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(
        folder: PathBuf,
        restored: Option<Restored>,
        report: impl Fn(Action) + Send + 'static,
    ) -> std::io::Result<Drafts> {
        let (requests, inbox) = channel();
        std::thread::Builder::new().name("unsaved".to_owned()).spawn(move || {
            if restored.is_none()
                && let Ok(Some(left)) = restore(&folder)
            {
                let names = left.documents.iter().map(|document| document.name().to_owned());
                report(Action::Offered(names.collect()));
            }
            serve(&folder, restored.map(|restored| restored.path), &inbox, &report);
        })?;
        Ok(Drafts { requests })
    }

    /// Keeps these documents in place of all before; without any the file is removed.
    pub fn keep(&self, documents: Vec<Document>) {
        // The thread only ends with the explorer.
        let _ = self.requests.send(Request::Keep(documents));
    }

    /// Waits for at most a second until the newest documents are written.
    pub fn flush(&self) {
        let (done, is_done) = channel();
        if self.requests.send(Request::Flush(done)).is_ok() {
            let _ = is_done.recv_timeout(PATIENCE);
        }
    }
}

/// Writes the newest documents after a pause.
fn serve(folder: &Path, mut restored: Option<PathBuf>, inbox: &Receiver<Request>, report: &dyn Fn(Action)) {
    let path = file_of(folder, std::process::id());
    let (mut wanted, mut has_failed) = (None, false);
    loop {
        let request = match &wanted {
            None => inbox.recv().map_err(|_| RecvTimeoutError::Disconnected),
            Some(_) => inbox.recv_timeout(QUIET),
        };
        let done = match request {
            Ok(Request::Keep(documents)) => {
                wanted = Some(documents);
                continue;
            }
            Ok(Request::Flush(done)) => Some(done),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        if let Some(documents) = wanted.take() {
            match write(folder, &path, &documents) {
                Ok(()) => {
                    // The file of this process has its scenes now.
                    if let Some(old) = restored.take() {
                        let _ = fs::remove_file(old);
                    }
                }
                Err(why) if !has_failed => {
                    has_failed = true;
                    report(Action::NotKept(why));
                }
                Err(_) => {}
            }
        }
        if let Some(done) = done {
            let _ = done.send(());
        }
    }
}

fn write(folder: &Path, path: &Path, documents: &[Document]) -> Result<(), String> {
    let in_folder = |error: std::io::Error| format!("{}: {error}", folder.display());
    if documents.is_empty() {
        return match fs::remove_file(path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(in_folder(error)),
            _ => Ok(()),
        };
    }
    fs::create_dir_all(folder).map_err(in_folder)?;
    let text = text_of(documents).map_err(|error| error.to_string())?;
    write_new(path, true, |file| file.write_all(text.as_bytes())).map_err(|error| error.to_string())
}

/// Identifier of this machine, and of this container on it, among the users of a folder: a checksum of its name and
/// of its process namespace.
#[cfg(unix)]
fn machine() -> String {
    let mut hash = crc32fast::Hasher::new();
    hash.update(rustix::system::uname().nodename().to_bytes());
    let numbering = fs::read_link("/proc/self/ns/pid").unwrap_or_default();
    hash.update(numbering.as_os_str().as_encoded_bytes());
    format!("{:08x}", hash.finalize())
}

#[cfg(not(unix))]
fn machine() -> String {
    "0".into()
}

/// Returns true for a process id that is unused on this machine.
#[cfg(unix)]
fn is_gone(process: u32) -> bool {
    use rustix::process::{Pid, test_kill_process};
    let process = i32::try_from(process).ok().and_then(Pid::from_raw);
    process.is_some_and(|process| test_kill_process(process) == Err(rustix::io::Errno::SRCH))
}

/// Elsewhere no process is known to have ended.
#[cfg(not(unix))]
fn is_gone(_: u32) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open;

    /// A process that has ended.
    fn ended() -> u32 {
        let mut child = std::process::Command::new(std::env::current_exe().unwrap())
            .args(["--list", "--quiet"])
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap();
        child.wait().unwrap();
        child.id()
    }

    #[cfg(unix)]
    #[test]
    fn unsaved_changes_are_read_back_as_they_were() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("state/unsaved");
        assert!(restore(&folder).unwrap().is_none());
        let changed = open("pressure-sensitive").unwrap().set("adhesion.kappa", "3.0").unwrap();
        let other = open("rough-sphere").unwrap().set("length", "2.0e-4").unwrap();
        let documents = vec![changed, other];
        let (reports, reported) = channel();
        let drafts = Drafts::start(folder.clone(), None, move |report| drop(reports.send(report))).unwrap();
        drafts.keep(documents[..1].to_vec());
        drafts.keep(documents.clone());
        drafts.flush();
        // A running process keeps its own file.
        assert!(restore(&folder).unwrap().is_none());
        let own = file_of(&folder, std::process::id());
        let left = file_of(&folder, ended());
        fs::copy(&own, &left).unwrap();
        let restored = restore(&folder).unwrap().unwrap();
        assert_eq!(restored.documents, documents);
        assert_eq!(restored.documents[0].overrides(), documents[0].overrides());
        drafts.keep(Vec::new());
        drafts.flush();
        assert!(!own.exists(), "nothing is unsaved any more");
        drop(drafts);
        assert!(reported.recv().is_err(), "there was nothing to report");
        // Another session offers the scenes; a session that has restored them keeps them under its own name.
        let (reports, reported) = channel();
        let drafts = Drafts::start(folder.clone(), None, move |report| drop(reports.send(report))).unwrap();
        let Ok(Action::Offered(names)) = reported.recv() else { panic!("nothing is offered") };
        assert_eq!(names, ["pressure-sensitive", "rough-sphere"]);
        drop(drafts);
        let drafts = Drafts::start(folder.clone(), Some(restored), |_| ()).unwrap();
        drafts.keep(documents.clone());
        drafts.flush();
        assert!(own.exists() && !left.exists());
    }

    #[cfg(unix)]
    #[test]
    fn a_file_that_cannot_be_read_or_written_is_stated() {
        let folder = tempfile::tempdir().unwrap();
        let left = file_of(folder.path(), ended());
        for (text, said) in
            [("(version: 2, scenes: [])", "version = 2: allowed: 1"), ("(", "1:2"), ("", "1:1")]
        {
            fs::write(&left, text).unwrap();
            let why = restore(folder.path()).err().unwrap();
            assert!(why.contains(said) && why.contains(left.to_str().unwrap()), "{why}");
        }
        let (reports, reported) = channel();
        let drafts =
            Drafts::start(left.join("below"), None, move |report| drop(reports.send(report))).unwrap();
        for _ in 0..2 {
            drafts.keep(vec![open("rough-sphere").unwrap()]);
            drafts.flush();
        }
        drop(drafts);
        let all: Vec<Action> = reported.iter().collect();
        assert!(matches!(all[..], [Action::NotKept(_)]), "stated once");
    }
}
