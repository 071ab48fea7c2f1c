//! Completion of a path that the user is typing, with existing files and folders.

use asperity_data::is_control;
use asperity_scene::library::typed_path;
use std::fs::read_dir;
use std::path::{MAIN_SEPARATOR, Path, is_separator};

const MOST_ENTRIES: usize = 10_000;

/// Returns the paths that begin with the typed path, in alphabetical order. A folder ends with a
/// separator. Hidden files are included only if the user has typed their dot.
pub fn complete(typed: &str) -> Vec<String> {
    let typed = typed.trim_start();
    let end_of_folder = match typed.rfind(is_separator) {
        Some(place) => place + 1,
        None => 0,
    };
    let (folder, name) = typed.split_at(end_of_folder);
    let directory = if folder.is_empty() {
        Path::new(".").to_path_buf()
    } else {
        typed_path(folder)
    };
    let entries = read_dir(directory).into_iter().flatten();
    let mut paths = Vec::new();
    // Entries that cannot be read count as well, so that the loop makes at most `MOST_ENTRIES`
    // attempts.
    for entry in entries.take(MOST_ENTRIES).flatten() {
        let Ok(found) = entry.file_name().into_string() else {
            continue;
        };
        let is_hidden = found.starts_with('.') && !name.starts_with('.');
        if is_hidden || !found.starts_with(name) || found.chars().any(is_control) {
            continue;
        }
        let mut path = format!("{folder}{found}");
        if entry.path().is_dir() {
            path.push(MAIN_SEPARATOR);
        }
        paths.push(path);
    }
    paths.sort_unstable();
    paths
}

/// Returns the longest text with which all the paths begin.
pub fn common_start(paths: &[String]) -> String {
    let Some((first, others)) = paths.split_first() else {
        return String::new();
    };
    let mut start = first.clone();
    for path in others {
        let same = start
            .chars()
            .zip(path.chars())
            .take_while(|(character, other)| character == other);
        start = same.map(|(character, _)| character).collect();
    }
    start
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn paths_begin_as_typed() {
        let folder = tempfile::tempdir().unwrap();
        for file in ["rough.ron", "rough-sphere.ron", "sphere.ron", ".hidden"] {
            fs::write(folder.path().join(file), "").unwrap();
        }
        fs::create_dir(folder.path().join("results")).unwrap();
        let base = format!("{}{MAIN_SEPARATOR}", folder.path().display());
        let found = |typed: &str| -> Vec<String> {
            let paths = complete(&format!("{base}{typed}"));
            paths
                .into_iter()
                .map(|path| path.strip_prefix(&base).unwrap().to_owned())
                .collect()
        };
        let results = format!("results{MAIN_SEPARATOR}");
        assert_eq!(
            found(""),
            [
                results.as_str(),
                "rough-sphere.ron",
                "rough.ron",
                "sphere.ron"
            ]
        );
        assert_eq!(common_start(&found("rou")), "rough");
        assert_eq!(found("re"), [results.as_str()]);
        assert_eq!(found("."), [".hidden"]);
        assert!(
            found("nothing").is_empty()
                && complete(&format!("{base}none{MAIN_SEPARATOR}")).is_empty()
        );
        assert_eq!(common_start(&[]), "");
    }
}
