//! Completion of a typed path with existing files and folders.

use asperity_data::is_control;
use asperity_scene::library::typed_path;
use std::fs::read_dir;
use std::path::{MAIN_SEPARATOR, Path, is_separator};

const MOST_ENTRIES: usize = 10_000;

/// Returns the paths that begin as the typed one, sorted. Folders end in a separator; hidden files
/// need a typed dot.
pub fn complete(typed: &str) -> Vec<String> {
    let typed = typed.trim_start();
    let (folder, name) = typed.split_at(typed.rfind(is_separator).map_or(0, |at| at + 1));
    let directory = if folder.is_empty() {
        Path::new(".").to_path_buf()
    } else {
        typed_path(folder)
    };
    let path = |entry: std::io::Result<std::fs::DirEntry>| {
        let entry = entry.ok()?;
        let found = entry
            .file_name()
            .into_string()
            .ok()
            .filter(|found| !found.chars().any(is_control))?;
        let fits = found.starts_with(name) && (name.starts_with('.') || !found.starts_with('.'));
        let end = if entry.path().is_dir() {
            String::from(MAIN_SEPARATOR)
        } else {
            String::new()
        };
        fits.then(|| format!("{folder}{found}{end}"))
    };
    let entries = read_dir(directory).into_iter().flatten().take(MOST_ENTRIES);
    let mut paths: Vec<String> = entries.filter_map(path).collect();
    paths.sort_unstable();
    paths
}

/// Returns the longest text with which all paths begin.
pub fn common_start(paths: &[String]) -> String {
    let shared = |start: String, path: &String| {
        let same = start
            .chars()
            .zip(path.chars())
            .take_while(|(one, other)| one == other);
        same.map(|(one, _)| one).collect()
    };
    paths
        .iter()
        .skip(1)
        .fold(paths.first().cloned().unwrap_or_default(), shared)
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
