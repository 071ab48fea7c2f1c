//! The gallery: each picture is drawn by its command, and each number of an answer is in what the
//! commands of its entry print.

use super::generated::{compare, read, root};
use super::program::asperity_in;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// Largest picture, bytes.
const LARGEST_PICTURE: usize = 60_000;

/// Entries of the gallery, without its beginning.
fn entries() -> Vec<String> {
    let page = read("docs/gallery.md");
    page.split("\n## ").skip(1).map(String::from).collect()
}

/// Texts between backticks.
fn codes(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2)
}

/// Runs a command of the page in a folder: the program, or a script of the examples.
fn run(folder: &Path, command: &str) {
    if let Some(script) = command.strip_prefix("sh ") {
        let status = Command::new("sh").arg(script).current_dir(folder).status();
        assert!(status.unwrap().success(), "{command}");
        return;
    }
    let mut arguments = Vec::new();
    for (place, part) in command.split('"').enumerate() {
        if place % 2 == 1 {
            arguments.push(part);
        } else {
            arguments.extend(part.split_whitespace());
        }
    }
    asperity_in(folder, &arguments[1..]).succeeded();
}

#[test]
fn pictures_of_the_gallery_are_those_of_their_commands() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for inside in ["docs/gallery", "docs/examples"] {
        std::fs::create_dir_all(folder.join(inside)).unwrap();
    }
    for entry in std::fs::read_dir(root().join("docs/examples")).unwrap() {
        let path = entry.unwrap().path();
        let copy = folder.join("docs/examples").join(path.file_name().unwrap());
        std::fs::copy(&path, copy).unwrap();
    }
    for entry in entries() {
        let drawn = entry.lines().find(|line| line.starts_with("Drawn by "));
        let drawn = drawn.unwrap_or_else(|| panic!("no command draws: {entry}"));
        codes(drawn).for_each(|command| run(folder, command));
        let file = codes(drawn).last().unwrap().rsplit(' ').next().unwrap();
        let link = file.strip_prefix("docs/").unwrap();
        assert!(entry.contains(&format!("]({link})")), "{file} is not shown");
        let picture = std::fs::read_to_string(folder.join(file)).unwrap();
        let size = picture.len();
        assert!(size <= LARGEST_PICTURE, "{file} has {size} bytes");
        // Metadata name measured files by their whole path.
        let own = format!("{}/", folder.display());
        compare(file, &picture.replace(&own, ""));
    }
}

/// The numbers of a text.
fn numbers(text: &str) -> BTreeSet<&str> {
    let parts = text.split(|c: char| !c.is_ascii_digit() && c != '.');
    let parts = parts.map(|part| part.trim_matches('.'));
    parts.filter(|part| !part.is_empty()).collect()
}

/// True if a number is among others, or is one of them with fewer digits.
fn is_among(number: &str, others: &BTreeSet<&str>) -> bool {
    let digits = number.split_once('.').map_or(0, |(_, behind)| behind.len());
    let is_rounded = |other: &&str| {
        let value: Result<f64, _> = other.parse();
        value.is_ok_and(|value| format!("{value:.digits$}") == number)
    };
    others.contains(number) || others.iter().any(is_rounded)
}

#[test]
fn answers_of_the_gallery_have_the_numbers_of_their_commands() {
    let entries = entries();
    assert_eq!(entries.len(), 11);
    for entry in entries {
        let (asked, answer) = entry.split_once("**Answer.** ").unwrap();
        assert!(asked.contains("```console\n$ "), "{entry}");
        let (_, python) = asked.split_once("```python\n").unwrap();
        assert_eq!(python.lines().position(|line| line == "```"), Some(1));
        let printed = numbers(asked);
        for number in numbers(answer) {
            assert!(is_among(number, &printed), "{number}: {entry}");
        }
    }
}
