//! Completion of the path of a file that is typed between quotes, as in `Measured(file: "sty`.

use crate::text::is_control;
use std::fs;
use std::path::{Path, is_separator};

/// Most entries of a folder that are looked at.
const MOST_ENTRIES: usize = 10_000;

/// Most names that are kept.
const MOST_NAMES: usize = 200;

/// Names that continue a path.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Completion {
    /// The path as typed.
    pub typed: String,
    /// Entries of its folder that begin as its last part, in order; folders end with a separator.
    pub names: Vec<String>,
}

/// Path between quotes that ends at the cursor, from the text before the cursor.
#[must_use]
pub fn unfinished_path(before: &str) -> Option<&str> {
    let is_open = before.matches('"').count() % 2 == 1;
    before.rsplit('"').next().filter(|_| is_open)
}

/// Folder part of a path, separator included, and the rest.
fn split(typed: &str) -> (&str, &str) {
    typed.split_at(typed.rfind(is_separator).map_or(0, |index| index + 1))
}

impl Completion {
    /// Looks for the entries of the folder of a path, which is relative to `folder`. A folder that cannot be read has none.
    #[must_use]
    pub fn new(typed: String, folder: &Path) -> Self {
        let (parent, begin) = split(&typed);
        let entries = fs::read_dir(match folder.join(parent) {
            here if here.as_os_str().is_empty() => Path::new(".").to_path_buf(),
            there => there,
        });
        let names = entries.into_iter().flatten().take(MOST_ENTRIES).flatten().filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let is_hidden = name.starts_with('.') && !begin.starts_with('.');
            // What a text of RON would need escapes for is left to be typed.
            let is_plain = !name.contains(|c: char| is_control(c) || c == '"' || c == '\\');
            if !name.starts_with(begin) || is_hidden || !is_plain {
                return None;
            }
            Some(if entry.path().is_dir() { name + "/" } else { name })
        });
        let mut names: Vec<String> = names.collect();
        names.sort_unstable();
        names.truncate(MOST_NAMES);
        Completion { typed, names }
    }

    /// Characters that all names have behind the typed ones.
    #[must_use]
    pub fn addition(&self) -> &str {
        let (_, begin) = split(&self.typed);
        let Some((first, others)) = self.names.split_first() else { return "" };
        let rest = &first[begin.len()..];
        let common = |other: &String| {
            let same = rest.chars().zip(other[begin.len()..].chars()).take_while(|(a, b)| a == b);
            same.map(|(c, _)| c.len_utf8()).sum::<usize>()
        };
        &rest[..others.iter().map(common).min().unwrap_or(rest.len())]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_between_quotes_are_completed() {
        assert_eq!(unfinished_path("Measured(file: \"a/b"), Some("a/b"));
        assert_eq!(unfinished_path("\""), Some(""));
        for closed in ["", "Measured(", "Measured(file: \"a\""] {
            assert_eq!(unfinished_path(closed), None, "{closed}");
        }
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("scans")).unwrap();
        for name in ["stylus-é1.txt", "stylus-é2.txt", "scans/map.gwy", ".hidden", "sty\"le"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let complete = |typed: &str| {
            let found = Completion::new(typed.to_owned(), folder.path());
            (found.addition().to_owned(), found.names.join(" "))
        };
        let both = "stylus-é1.txt stylus-é2.txt";
        assert_eq!(complete("sty"), ("lus-é".to_owned(), both.to_owned()));
        assert_eq!(complete("stylus-é"), (String::new(), both.to_owned()));
        assert_eq!(complete("stylus-é2"), (".txt".to_owned(), "stylus-é2.txt".to_owned()));
        assert_eq!(complete("sc"), ("ans/".to_owned(), "scans/".to_owned()));
        assert_eq!(complete("scans/"), ("map.gwy".to_owned(), "map.gwy".to_owned()));
        assert_eq!(complete(".h"), ("idden".to_owned(), ".hidden".to_owned()));
        assert_eq!(complete("none/"), (String::new(), String::new()));
        assert_eq!(complete(""), ("s".to_owned(), format!("scans/ {both}")));
    }
}
