//! The pages as a whole: their groups in the site, their length, the messages that they quote, and
//! the notebooks.

use super::documentation::PAGES;
use super::generated::{pages_in, read, root};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// Words of all pages of docs/ without the tables that the program generates, and without the
/// reference of Python. Marks of tables and lists are no words.
const MOST_WORDS: usize = 15_000;

#[test]
fn the_site_has_the_pages_in_the_groups_of_the_readme() {
    let mut navigation = "nav:\n".to_owned();
    let mut former = "";
    for (group, page, _) in PAGES {
        if group != former {
            writeln!(navigation, "  - {group}:").unwrap();
            former = group;
        }
        if page == "learn.md" {
            navigation += "      - index.md\n";
        }
        writeln!(navigation, "      - {page}").unwrap();
    }
    navigation += "      - contributing.md\n      - changelog.md\n";
    let configuration = read("mkdocs.yml");
    assert!(configuration.contains(&navigation), "{navigation}");
}

/// The page without its generated parts, each of which ends with `<!-- end of NAME -->`.
fn written(page: &str) -> String {
    let mut text = read(page);
    while let Some((before, rest)) = text.split_once("<!-- end of ") {
        let (name, after) = rest.split_once(" -->").unwrap();
        let start = before.find(&format!("<!-- {name} -->")).unwrap();
        text = format!("{}{after}", &before[..start]);
    }
    text
}

#[test]
fn the_pages_are_short() {
    let mut words = 0;
    for page in pages_in("docs") {
        if page != "docs/python.md" {
            let text = written(&page);
            let of_page = text.split_whitespace();
            words += of_page
                .filter(|word| word.contains(char::is_alphabetic))
                .count();
        }
    }
    assert!(words <= MOST_WORDS, "{words} words; allowed: {MOST_WORDS}");
}

/// The text of all sources below a folder, in one line and without breaks inside of texts.
fn source_below(folder: &Path, text: &mut String) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            source_below(&path, text);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let source = std::fs::read_to_string(&path).unwrap();
            let joined: Vec<&str> = source
                .split_whitespace()
                .filter(|word| *word != "\\")
                .collect();
            *text += &joined.join(" ");
        }
    }
}

/// A message is quoted as the program has it: each part between the marks … is in the source.
#[test]
fn the_quoted_messages_exist_in_the_program() {
    let mut source = String::new();
    source_below(&root().join("src"), &mut source);
    source_below(&root().join("crates"), &mut source);
    let page = read("docs/messages.md");
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let mut seen = 0;
    for row in rows {
        let cell = row.split(" | ").next().unwrap();
        for quoted in cell.split('`').skip(1).step_by(2) {
            for part in quoted.split('…').map(str::trim) {
                assert!(source.contains(part), "no message has: {part}");
            }
            seen += 1;
        }
    }
    assert!(seen > 40, "{seen} messages");
}

#[test]
fn notebooks_are_their_scripts() {
    for name in ["force_curves", "measured_map"] {
        let script = read(&format!("python/examples/{name}.py"));
        let notebook = read(&format!("docs/notebooks/{name}.ipynb"));
        let notebook: Value = serde_json::from_str(&notebook).unwrap();
        let mut code = Vec::new();
        let mut words = String::new();
        for cell in notebook["cells"].as_array().unwrap() {
            let lines = cell["source"].as_array().unwrap();
            let text: String = lines.iter().map(|line| line.as_str().unwrap()).collect();
            if cell["cell_type"] == "code" {
                assert!(cell["outputs"].as_array().unwrap().is_empty(), "{name}");
                code.push(text);
            } else {
                words += &text;
            }
        }
        let (_, rest) = script.split_once("\"\"\"").unwrap();
        let (about, rest) = rest.split_once("\"\"\"").unwrap();
        assert!(words.contains(about), "{name}: {words}");
        let own = "docs/notebooks/make.py makes the notebook anew";
        assert_eq!(code.join("\n\n"), rest.trim(), "{own}");
    }
}
