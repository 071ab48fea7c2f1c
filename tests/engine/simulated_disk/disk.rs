//! A disk of which any operation can fail, be torn, or be the last one before the process or the machine ends.
//!
//! Operations are done in a real folder, the process's view: the system's memory of the disk. Besides, the disk knows
//! the synchronised content. After a power cut it makes the folder that would be found: the synchronised part, and of
//! the rest a chosen part. No order is assumed between two changes of which none was synchronised.

use asperity::io::{Disk, DiskFile};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;
use std::fs::{self, File, Permissions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard};

/// Fault of an operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// The operation fails; those after it do not.
    Failure,
    /// Half of the bytes are written, then the write fails. Other operations fail whole.
    Torn,
    /// The operation is done, and is the last one of this process.
    Kill,
}

/// Survivors of a power cut among changes that were not synchronised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Survival {
    Nothing,
    Everything,
    /// All names, and the synchronised content of files.
    Names,
    /// All content, under the synchronised names.
    Content,
    /// All names, and half of the bytes of each file.
    Half,
    /// All names, and zeros in place of the bytes of each file.
    Zeros,
    /// Each change or not, each file in one of these ways.
    Random(u64),
}

enum Node {
    Folder,
    File { synced: Vec<u8>, now: Vec<u8> },
    Link(PathBuf),
}

/// A change of the names in a folder.
#[derive(Clone)]
enum Change {
    Add(PathBuf, usize),
    Remove(PathBuf),
    Rename(PathBuf, PathBuf, usize),
}

type Names = BTreeMap<PathBuf, usize>;

impl Change {
    fn apply(&self, names: &mut Names) {
        match self {
            Change::Add(path, node) => drop(names.insert(path.clone(), *node)),
            // The content of a folder goes with it.
            Change::Remove(path) => names.retain(|name, _| !name.starts_with(path)),
            Change::Rename(from, to, node) => {
                names.remove(from);
                names.insert(to.clone(), *node);
            }
        }
    }
}

#[derive(Default)]
struct State {
    nodes: Vec<Node>,
    names: Names,
    synced: Names,
    /// Each with its folder.
    pending: Vec<(PathBuf, Change)>,
    operations: Vec<String>,
    fault: Option<(usize, Fault)>,
    /// Prefix of the names of operations, and the number, from 1, of the one that ends the process.
    kill_at: Option<(&'static str, usize)>,
    ended: bool,
    /// The kind of operation that reports a synchronisation and omits it.
    deceit: Option<&'static str>,
    /// Folder for files without a name; `None` on a disk without such files.
    nameless: Option<tempfile::TempDir>,
}

#[derive(Clone)]
pub struct SimulatedDisk {
    root: PathBuf,
    state: Arc<Mutex<State>>,
}

impl std::fmt::Debug for SimulatedDisk {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "SimulatedDisk({})", self.root.display())
    }
}

fn failure(what: &str) -> io::Error {
    io::Error::other(format!("simulated: {what}"))
}

impl SimulatedDisk {
    /// A disk on which the whole content of a folder has been synchronised.
    pub fn new(root: &Path) -> SimulatedDisk {
        let mut state = State::default();
        let mut folders = vec![root.to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let kind = fs::symlink_metadata(&path).unwrap();
                let node = if kind.is_dir() {
                    folders.push(path.clone());
                    Node::Folder
                } else if kind.is_symlink() {
                    Node::Link(fs::read_link(&path).unwrap())
                } else {
                    let content = fs::read(&path).unwrap();
                    Node::File { synced: content.clone(), now: content }
                };
                state.names.insert(path.clone(), state.nodes.len());
                state.nodes.push(node);
            }
        }
        state.synced = state.names.clone();
        SimulatedDisk { root: root.to_path_buf(), state: Arc::new(Mutex::new(state)) }
    }

    /// A disk with a fault at the operation of this number, from 0.
    pub fn with_fault(root: &Path, operation: usize, fault: Fault) -> SimulatedDisk {
        let disk = SimulatedDisk::new(root);
        disk.lock().fault = Some((operation, fault));
        disk
    }

    /// A disk on which operations of a kind report a synchronisation and omit it.
    pub fn deceiving(root: &Path, kind: &'static str) -> SimulatedDisk {
        let disk = SimulatedDisk::new(root);
        disk.lock().deceit = Some(kind);
        disk
    }

    pub fn shared(&self) -> Arc<dyn Disk> {
        Arc::new(self.clone())
    }

    /// Operations so far.
    pub fn operations(&self) -> Vec<String> {
        self.lock().operations.clone()
    }

    /// The same disk with files that are nameless until linked.
    pub fn with_nameless_files(self) -> SimulatedDisk {
        self.lock().nameless = Some(tempfile::tempdir().unwrap());
        self
    }

    /// Ends the process with the operation that is the `count`-th of those whose name begins with `prefix`. A study
    /// synchronises by the clock, so that the number among all operations differs between runs.
    pub fn kill_at_nth(&self, prefix: &'static str, count: usize) {
        self.lock().kill_at = Some((prefix, count));
    }

    /// Lets another process use the disk, without faults.
    pub fn go_on(&self) {
        let mut state = self.lock();
        (state.fault, state.kill_at, state.ended) = (None, None, false);
    }

    /// Makes the folder that is found after a power cut.
    pub fn after_power_cut(&self, survival: Survival, into: &Path) {
        let state = self.lock();
        let mut random =
            ChaCha8Rng::seed_from_u64(if let Survival::Random(seed) = survival { seed } else { 0 });
        let mut names = state.synced.clone();
        for (_, change) in &state.pending {
            let survives = match survival {
                Survival::Nothing | Survival::Content => false,
                Survival::Random(_) => random.random(),
                _ => true,
            };
            if survives {
                change.apply(&mut names);
            }
        }
        for (path, &node) in &names {
            let place = into.join(path.strip_prefix(&self.root).unwrap());
            // The content of a lost folder is lost.
            if !place.parent().unwrap().is_dir() {
                continue;
            }
            match &state.nodes[node] {
                Node::Folder => fs::create_dir(place).unwrap(),
                Node::Link(target) => std::os::unix::fs::symlink(target, place).unwrap(),
                Node::File { synced, now } => {
                    let way = match survival {
                        Survival::Nothing | Survival::Names => 0,
                        Survival::Everything | Survival::Content => 1,
                        Survival::Half => 2,
                        Survival::Zeros => 3,
                        Survival::Random(_) => random.random_range(0..4),
                    };
                    let half = synced.len() + (now.len() - synced.len()).div_ceil(2);
                    let zeros = vec![0; now.len() - synced.len()];
                    let content = match way {
                        0 => synced.clone(),
                        1 => now.clone(),
                        2 => now[..half].to_vec(),
                        _ => [synced.as_slice(), &zeros].concat(),
                    };
                    fs::write(place, content).unwrap();
                }
            }
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap()
    }

    /// Begins an operation: returns true if it is the last one, or the error that prevents it.
    fn begin(&self, what: &str, path: &Path) -> io::Result<(MutexGuard<'_, State>, bool)> {
        let mut state = self.lock();
        if state.ended {
            return Err(failure("the process has ended"));
        }
        let number = state.operations.len();
        let name = path.strip_prefix(&self.root).unwrap_or(path).display().to_string();
        state.operations.push(format!("{what} {name}"));
        if let Some((prefix, count)) = state.kill_at {
            let is_one = |operation: &String| operation.starts_with(prefix);
            if state.operations.last().is_some_and(is_one)
                && state.operations.iter().filter(|operation| is_one(operation)).count() == count
            {
                state.ended = true;
                return Ok((state, true));
            }
        }
        match state.fault {
            Some((operation, Fault::Failure)) if operation == number => Err(failure("failure")),
            // A write tears by itself.
            Some((operation, Fault::Torn)) if operation == number && what != "write" => {
                Err(failure("failure"))
            }
            Some((operation, Fault::Kill)) if operation == number => {
                state.ended = true;
                Ok((state, true))
            }
            _ => Ok((state, false)),
        }
    }

    fn end<T>(last: bool, done: T) -> io::Result<T> {
        if last { Err(failure("the process ends here")) } else { Ok(done) }
    }

    /// Adds a name accepted by the system.
    fn add(state: &mut State, path: &Path, node: Node) -> usize {
        let number = state.nodes.len();
        state.nodes.push(node);
        Self::change(state, path, Change::Add(path.to_path_buf(), number));
        number
    }

    fn change(state: &mut State, path: &Path, change: Change) {
        change.apply(&mut state.names);
        state.pending.push((path.parent().unwrap().to_path_buf(), change));
    }
}

impl Disk for SimulatedDisk {
    fn make_folder(&self, path: &Path) -> io::Result<()> {
        let (mut state, last) = self.begin("make folder", path)?;
        fs::create_dir(path)?;
        Self::add(&mut state, path, Node::Folder);
        Self::end(last, ())
    }

    fn make_file(&self, path: &Path) -> io::Result<Box<dyn DiskFile>> {
        let (mut state, last) = self.begin("make file", path)?;
        let file = File::create_new(path)?;
        let node = Self::add(&mut state, path, Node::File { synced: Vec::new(), now: Vec::new() });
        let file = SimulatedFile { disk: self.clone(), path: path.to_path_buf(), node, file };
        Self::end(last, Box::new(file))
    }

    fn make_nameless_file(&self, folder: &Path) -> Option<Box<dyn DiskFile>> {
        self.lock().nameless.as_ref()?;
        let (mut state, last) = self.begin("make nameless file", folder).ok()?;
        let node = state.nodes.len();
        let path = state.nameless.as_ref()?.path().join(node.to_string());
        let file = File::create_new(&path).unwrap();
        state.nodes.push(Node::File { synced: Vec::new(), now: Vec::new() });
        Self::end(last, Box::new(SimulatedFile { disk: self.clone(), path, node, file }))
            .ok()
            .map(|file| file as _)
    }

    fn link(&self, file: &Path, name: &Path) -> io::Result<()> {
        let (mut state, last) = self.begin("link", name)?;
        fs::hard_link(file, name)?;
        let node = state.names[file];
        Self::change(&mut state, name, Change::Add(name.to_path_buf(), node));
        Self::end(last, ())
    }

    fn symbolic_link(&self, target: &Path, name: &Path) -> io::Result<()> {
        let (mut state, last) = self.begin("symbolic link", name)?;
        std::os::unix::fs::symlink(target, name)?;
        Self::add(&mut state, name, Node::Link(target.to_path_buf()));
        Self::end(last, ())
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        let (mut state, last) = self.begin("rename", to)?;
        fs::rename(from, to)?;
        let node = state.names[from];
        assert!(!matches!(state.nodes[node], Node::Folder), "folders stay where they are");
        if from.parent() == to.parent() {
            Self::change(&mut state, to, Change::Rename(from.to_path_buf(), to.to_path_buf(), node));
        } else {
            // Each folder has its own half.
            Self::change(&mut state, to, Change::Add(to.to_path_buf(), node));
            Self::change(&mut state, from, Change::Remove(from.to_path_buf()));
        }
        Self::end(last, ())
    }

    fn remove_file(&self, path: &Path) -> io::Result<()> {
        let (mut state, last) = self.begin("remove file", path)?;
        fs::remove_file(path)?;
        Self::change(&mut state, path, Change::Remove(path.to_path_buf()));
        Self::end(last, ())
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        let (mut state, last) = self.begin("remove folder", path)?;
        fs::remove_dir(path)?;
        Self::change(&mut state, path, Change::Remove(path.to_path_buf()));
        Self::end(last, ())
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        let (_state, last) = self.begin("list", folder)?;
        let listed = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
        Self::end(last, listed)
    }

    fn sync_file(&self, path: &Path) -> io::Result<()> {
        let (mut state, last) = self.begin("sync file", path)?;
        if state.deceit == Some("sync file") {
            return Self::end(last, ());
        }
        let node = state.names[path];
        if let Node::File { synced, now } = &mut state.nodes[node] {
            synced.clone_from(now);
        }
        Self::end(last, ())
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        let (mut state, last) = self.begin("sync folder", path)?;
        assert!(path.is_dir(), "{}", path.display());
        // Through a link to a folder, as the system does it.
        let path = fs::canonicalize(path)?;
        if state.deceit == Some("sync folder") {
            return Self::end(last, ());
        }
        let (mut synced, pending) = (state.synced.clone(), std::mem::take(&mut state.pending));
        let (reached, pending) = pending.into_iter().partition::<Vec<_>, _>(|(folder, _)| *folder == path);
        reached.iter().for_each(|(_, change)| change.apply(&mut synced));
        (state.synced, state.pending) = (synced, pending);
        Self::end(last, ())
    }
}

struct SimulatedFile {
    disk: SimulatedDisk,
    path: PathBuf,
    node: usize,
    file: File,
}

impl Write for SimulatedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let (mut state, last) = self.disk.begin("write", &self.path)?;
        let number = state.operations.len() - 1;
        let torn = state.fault == Some((number, Fault::Torn));
        let written = &bytes[..if torn { bytes.len() / 2 } else { bytes.len() }];
        self.file.write_all(written)?;
        if let Node::File { now, .. } = &mut state.nodes[self.node] {
            now.extend_from_slice(written);
        }
        if torn { Err(failure("no space")) } else { SimulatedDisk::end(last, written.len()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl DiskFile for SimulatedFile {
    fn sync(&mut self) -> io::Result<()> {
        let (mut state, last) = self.disk.begin("sync", &self.path)?;
        if state.deceit == Some("sync") {
            return SimulatedDisk::end(last, ());
        }
        if let Node::File { synced, now } = &mut state.nodes[self.node] {
            synced.clone_from(now);
        }
        SimulatedDisk::end(last, ())
    }

    fn set_permissions(&mut self, permissions: Permissions) -> io::Result<()> {
        let (_state, last) = self.disk.begin("set permissions", &self.path)?;
        self.file.set_permissions(permissions)?;
        SimulatedDisk::end(last, ())
    }

    fn give_name(&self, path: &Path) -> io::Result<()> {
        let (mut state, last) = self.disk.begin("give name", path)?;
        fs::hard_link(&self.path, path)?;
        SimulatedDisk::change(&mut state, path, Change::Add(path.to_path_buf(), self.node));
        SimulatedDisk::end(last, ())
    }
}
