//! Completion of a typed path by existing files and folders.

use super::fuzzy::{Candidate, find, letters_found};
use crate::scene::typed_path;
use crate::text::is_control;
use std::fs::read_dir;
use std::path::{MAIN_SEPARATOR, Path, is_separator};

/// Most entries read from a folder.
const MOST_ENTRIES: usize = 10_000;

/// Paths in the folder of a typed path, in order: names that begin as typed or, without such, names with the typed
/// letters, the best first. Folders end in a separator; hidden files need a typed dot.
#[must_use]
pub fn complete(typed: &str) -> Vec<String> {
    let (folder, name) = split(typed.trim_start());
    let directory = if folder.is_empty() { Path::new(".").to_path_buf() } else { typed_path(folder) };
    let Ok(entries) = read_dir(directory) else { return Vec::new() };
    let mut names: Vec<String> = entries
        .take(MOST_ENTRIES)
        .filter_map(|entry| {
            let entry = entry.ok()?;
            let name = entry.file_name().into_string().ok().filter(|name| !name.chars().any(is_control))?;
            Some(if entry.path().is_dir() { format!("{name}{MAIN_SEPARATOR}") } else { name })
        })
        .filter(|one| name.starts_with('.') || !one.starts_with('.'))
        .collect();
    names.sort_unstable();
    let begin: Vec<&String> = names.iter().filter(|one| one.starts_with(name)).collect();
    let found = if begin.is_empty() {
        find(names.iter().map(|one| candidate(one)), name).into_iter().map(|index| &names[index]).collect()
    } else {
        begin
    };
    found.into_iter().map(|one| format!("{folder}{one}")).collect()
}

fn candidate(name: &str) -> Candidate {
    Candidate { names: vec![name.to_owned()], prose: Vec::new() }
}

/// Folder of a path as typed, with its separator, and the rest.
fn split(path: &str) -> (&str, &str) {
    let end = path.trim_end_matches(is_separator).len();
    let from = if end < path.len() { path.len() } else { path.rfind(is_separator).map_or(0, |at| at + 1) };
    path.split_at(from)
}

/// Paths that complete a typed one, and the taken one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completion {
    /// Name as typed, without its folder.
    typed: String,
    paths: Vec<String>,
    taken: Option<usize>,
}

impl Completion {
    /// Candidates for a typed path, none of them taken.
    #[must_use]
    pub fn new(typed: &str, paths: Vec<String>) -> Self {
        Completion { typed: split(typed.trim_start()).1.to_owned(), paths, taken: None }
    }

    /// Characters of a candidate's name found by the typed name.
    #[must_use]
    pub fn letters_found(&self, name: &str) -> Vec<usize> {
        if name.starts_with(&self.typed) {
            return (0..self.typed.chars().count()).collect();
        }
        letters_found(&candidate(name), name, &self.typed)
    }

    /// Longest text with which all paths begin.
    #[must_use]
    pub fn common_start(&self) -> String {
        let mut paths = self.paths.iter();
        let Some(first) = paths.next() else { return String::new() };
        paths.fold(first.clone(), |start, path| {
            start
                .chars()
                .zip(path.chars())
                .take_while(|(one, other)| one == other)
                .map(|(one, _)| one)
                .collect()
        })
    }

    /// The path, if only one.
    #[must_use]
    pub fn only(&self) -> Option<&str> {
        if let [path] = &self.paths[..] { Some(path) } else { None }
    }

    /// Takes the next path; the first follows the last.
    pub fn take_next(&mut self) -> Option<&str> {
        let next = self.taken.map_or(0, |taken| taken + 1);
        self.taken = Some(if next < self.paths.len() { next } else { 0 });
        self.paths.get(self.taken.unwrap_or(0)).map(String::as_str)
    }

    /// Names of the paths without their folders, each with true if taken; the taken path comes first.
    #[must_use]
    pub fn names(&self) -> Vec<(String, bool)> {
        let first = self.taken.unwrap_or(0);
        let places = (first..self.paths.len()).chain(0..first.min(self.paths.len()));
        let name = |place: usize| {
            let path = self.paths[place].trim_end_matches(is_separator);
            let from = path.rfind(is_separator).map_or(0, |at| at + 1);
            (self.paths[place][from..].to_owned(), self.taken == Some(place))
        };
        places.map(name).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn names_that_begin_so_come_before_letters_of_others() {
        let folder = tempfile::tempdir().unwrap();
        for file in ["rough.ron", "rough-sphere.ron", "sphere.ron", ".hidden"] {
            fs::write(folder.path().join(file), "").unwrap();
        }
        fs::create_dir(folder.path().join("results")).unwrap();
        let base = format!("{}{MAIN_SEPARATOR}", folder.path().display());
        let found = |typed: &str| -> Vec<String> {
            let paths = complete(&format!("{base}{typed}"));
            paths.into_iter().map(|path| path.strip_prefix(&base).unwrap().to_owned()).collect()
        };
        let results = format!("results{MAIN_SEPARATOR}");
        assert_eq!(found(""), [results.as_str(), "rough-sphere.ron", "rough.ron", "sphere.ron"]);
        assert_eq!(found("rou"), ["rough-sphere.ron", "rough.ron"]);
        assert_eq!(found("re"), [results.as_str()]);
        assert_eq!(found("sph"), ["sphere.ron"]);
        assert_eq!(found("rghs"), ["rough-sphere.ron"]);
        assert_eq!(found("."), [".hidden"]);
        assert_eq!(found("nothing"), [""; 0]);
        assert_eq!(complete(&format!("{base}no such folder{MAIN_SEPARATOR}")), [""; 0]);
    }

    #[test]
    fn candidates_are_taken_in_turn() {
        let paths = ["a/rough.ron", "a/rough-sphere.ron"].map(str::to_owned).to_vec();
        let mut completion = Completion::new("a/ro", paths);
        assert_eq!((completion.common_start().as_str(), completion.only()), ("a/rough", None));
        assert!(completion.names().iter().all(|(_, taken)| !taken));
        let taken: Vec<_> = (0..3).map(|_| completion.take_next().map(str::to_owned)).collect();
        let (first, second) = (Some("a/rough.ron".to_owned()), Some("a/rough-sphere.ron".to_owned()));
        assert_eq!(taken, [first.clone(), second, first]);
        let names = [("rough.ron".to_owned(), true), ("rough-sphere.ron".to_owned(), false)];
        assert_eq!(completion.names(), names);
        assert_eq!(completion.letters_found("rough.ron"), [0, 1]);
        let scattered = Completion::new("a/rghs", Vec::new());
        assert_eq!(scattered.letters_found("rough-sphere.ron"), [0, 3, 4, 6]);
        assert_eq!(Completion::new("", Vec::new()).take_next(), None);
        assert_eq!(Completion::new("a/", vec!["a/b/".to_owned()]).names(), [("b/".to_owned(), false)]);
    }
}
