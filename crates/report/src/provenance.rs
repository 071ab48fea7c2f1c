//! Origin of a result: version, command, measured files and scene. It is written into the file of
//! the result.
//!
//! In CSV, the lines of the origin come first, each after `# `. In SVG, the same lines are
//! metadata. In JSON, the first entries are the version and the command.

use asperity_data::{path_name, printable, sha256_of};
use asperity_scene::text::to_ron;
use asperity_scene::{Document, Scene};
use std::path::{Path, PathBuf};

/// Beginning of a line with the SHA-256 and the name of a measured file.
const HASH: &str = "sha256: ";

/// Number of hexadecimal digits of a SHA-256 that an error message shows.
const SHOWN_DIGITS: usize = 12;

/// Beginning of the line with the command.
const COMMAND: &str = "command: ";

/// Beginning of a line with a premise of the model that the result does not meet.
const WARNING: &str = "warning: ";

/// Returns the first lines of a table, from which the table can be computed again: version,
/// command, measured files with their SHA-256, and scene. `folder` is the folder of the scene, and
/// `destination` is the folder of the table.
///
/// # Errors
/// Returns an error if a measured file cannot be read.
pub fn scene_provenance(
    command: &str,
    scene: &Scene,
    folder: &Path,
    destination: &Path,
) -> Result<String, String> {
    let mut text = head(command, &scene.measured_files(), folder, destination)?;
    let mut scene = scene.clone();
    scene.rename_measured_files(|file| named_from(file, folder, destination));
    if let Some(seed) = scene.seed() {
        text += &format!("seed: {seed}\n");
    }
    Ok(text + &format!("scene:\n{}", to_ron(&scene)))
}

/// Returns lines for the metadata of a figure, from which the figure can be computed again:
/// version, command, and all scenes that have a name.
pub fn scenes_provenance(command: &str, scenes: &[(String, Scene)]) -> String {
    let mut text = version_and_command(command, "");
    for (name, scene) in scenes {
        if !name.is_empty() {
            let name = printable(name);
            let scene = to_ron(scene);
            text += &format!("scene {name}:\n{scene}");
        }
    }
    text
}

/// Returns the lines `provenance` with a further line for each warning of a result. These lines
/// follow the line with the command.
pub fn with_warnings(provenance: &str, warnings: &[String]) -> String {
    let mut text = String::new();
    for line in provenance.lines() {
        text += &format!("{line}\n");
        if line.starts_with(COMMAND) {
            for warning in warnings {
                text += &format!("{WARNING}{}\n", printable(&warning.replace('\n', " ")));
            }
        }
    }
    text
}

/// Returns two entries of a JSON object, each as a key and a text: `program` with the version, and
/// `command` with the command. They are taken from the lines that [`scene_provenance`] returns.
pub fn entries(provenance: &str) -> Vec<(&str, &str)> {
    let program = provenance.lines().next();
    let command = provenance
        .lines()
        .find_map(|line| line.strip_prefix(COMMAND));
    let mut entries = Vec::new();
    if let Some(program) = program {
        entries.push(("program", program));
    }
    if let Some(command) = command {
        entries.push(("command", command));
    }
    entries
}

/// Returns the first lines of a table that was computed without a scene: version, command, and
/// measured files with their SHA-256. `destination` is the folder of the table.
///
/// # Errors
/// Returns an error if a file cannot be read.
pub fn files_provenance(
    command: &str,
    files: &[PathBuf],
    destination: &Path,
) -> Result<String, String> {
    let names: Vec<_> = files.iter().map(|file| file.to_string_lossy()).collect();
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    head(command, &names, Path::new(""), destination)
}

/// Returns lines with the version, the measured files with the SHA-256 of their contents, and the
/// command. The name of a file is written as a RON string, which never contains a line break.
fn head(
    command: &str,
    files: &[&str],
    folder: &Path,
    destination: &Path,
) -> Result<String, String> {
    let mut hashes = String::new();
    for file in files {
        let sha256 = hash_of(&folder.join(file))?;
        let name = named_from(file, folder, destination);
        hashes += &format!("{HASH}{sha256} {name:?}\n");
    }
    Ok(version_and_command(command, &hashes))
}

fn version_and_command(command: &str, hashes: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let command = command.replace(['\n', '\r'], " ");
    let command = printable(&command);
    format!("asperity {version}\n{hashes}{COMMAND}{command}\n")
}

/// Checks that the measured files of a scene have not changed since the table with this scene was
/// written.
///
/// # Errors
/// Returns an error if a file cannot be read, or if its SHA-256 differs from the one in the table.
pub fn check_measured_files(document: &Document) -> Result<(), String> {
    let files = document.scene().measured_files();
    for line in document.table_head().lines() {
        let Some(recorded) = RecordedFile::of_line(line) else {
            continue;
        };
        if !files.contains(&recorded.name.as_str()) {
            continue;
        }
        let path = document.resolve(&recorded.name);
        let found = hash_of(&path)?;
        if found != recorded.sha256 {
            let found: String = found.chars().take(SHOWN_DIGITS).collect();
            let expected: String = recorded.sha256.chars().take(SHOWN_DIGITS).collect();
            let file = path_name(&path);
            let table = printable(document.name());
            return Err(format!(
                "{file}: the measured file has changed: its SHA-256 is {found}…, {table} has {expected}…; allowed: the \
                 file as it was, or its scene in a file of its own"
            ));
        }
    }
    Ok(())
}

/// Measured file that is named in the first lines of a table.
struct RecordedFile<'a> {
    name: String,
    sha256: &'a str,
}

impl<'a> RecordedFile<'a> {
    /// Reads the line of a measured file; `None` for any other line.
    fn of_line(line: &'a str) -> Option<Self> {
        let (sha256, name) = line.strip_prefix(HASH)?.split_once(' ')?;
        let name = ron::from_str(name).ok()?;
        Some(RecordedFile { name, sha256 })
    }
}

fn hash_of(path: &Path) -> Result<String, String> {
    sha256_of(path).map_err(|reason| format!("{}: {reason}", path_name(path)))
}

/// Returns the path with which a table in the folder `destination` names a file. `file` is the path
/// of the file relative to `folder`. If the two folders differ, the returned path is absolute.
pub fn named_from(file: &str, folder: &Path, destination: &Path) -> String {
    if is_same_folder(folder, destination) {
        return file.to_owned();
    }
    match std::path::absolute(folder.join(file)) {
        Ok(absolute) => absolute.to_string_lossy().into_owned(),
        Err(_) => file.to_owned(),
    }
}

/// Returns true if two paths lead to the same folder, even if one of them contains links.
fn is_same_folder(first: &Path, second: &Path) -> bool {
    if first == second {
        return true;
    }
    let Ok(first) = Path::new(".").join(first).canonicalize() else {
        return false;
    };
    let second = Path::new(".").join(second).canonicalize();
    second.is_ok_and(|second| first == second)
}
