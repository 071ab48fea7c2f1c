//! Directions of imports: rooms from the ground up, and no two files that import each other.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Rooms of the source from the ground up: each imports only earlier rooms.
const ROOMS: [&str; 22] = [
    "text",
    "draw",
    "memory",
    "parallel",
    "io",
    "topography",
    "contact",
    "spectrum",
    "surface",
    "scene",
    "analysis",
    "reference",
    "simulation",
    "profile",
    "contact_cycle",
    "study",
    "accuracy",
    "check",
    "export",
    "explorer",
    "cli",
    "main",
];

/// Path of a module in the crate, as `["contact", "adhesive"]`.
pub type Module = Vec<String>;

/// Source files by their modules, without comments and tests.
pub fn modules() -> BTreeMap<Module, String> {
    let root = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/src"));
    let (mut found, mut folders) = (BTreeMap::new(), vec![root.clone()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.insert(module(path.strip_prefix(&root).unwrap()), code(&path));
            }
        }
    }
    found
}

fn module(file: &Path) -> Module {
    let mut parts: Module =
        file.with_extension("").iter().map(|part| part.to_str().unwrap().to_owned()).collect();
    if parts.last().is_some_and(|last| last == "mod" || last == "lib") {
        parts.pop();
    }
    parts
}

fn code(file: &Path) -> String {
    let text = fs::read_to_string(file).unwrap();
    let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    lines.collect::<Vec<_>>().join("\n")
}

/// Paths in a file that begin with `crate::` or `super::`, with braces multiplied out and relative to the crate.
fn paths(module: &[String], code: &str) -> Vec<Module> {
    let mut found = Vec::new();
    for start in ["crate::", "super::"] {
        for (index, _) in code.match_indices(start) {
            let before = code[..index].chars().next_back();
            if !before.is_some_and(|before| before.is_alphanumeric() || "_:$".contains(before)) {
                multiply_out(&mut Vec::new(), &code[index..], &mut found);
            }
        }
    }
    let absolute = |path: Module| {
        let up = path.iter().take_while(|part| *part == "super").count();
        let base = if path[0] == "crate" { &[] } else { &module[..module.len() - up.min(module.len())] };
        base.iter().cloned().chain(path.into_iter().skip(up.max(1))).collect()
    };
    found.into_iter().map(absolute).collect()
}

/// Adds the paths of a tree of imports to `found`, and returns the rest of the text.
pub fn multiply_out<'t>(prefix: &mut Module, text: &'t str, found: &mut Vec<Module>) -> &'t str {
    let text = text.trim_start();
    if let Some(mut inside) = text.strip_prefix('{') {
        loop {
            inside = multiply_out(&mut prefix.clone(), inside, found).trim_start();
            inside = inside.find([',', '}']).map_or("", |end| &inside[end..]);
            match inside.strip_prefix(',') {
                Some(next) if !next.trim_start().starts_with('}') => inside = next,
                Some(next) => return next.trim_start().strip_prefix('}').unwrap_or(""),
                None => return inside.strip_prefix('}').unwrap_or(""),
            }
        }
    }
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    prefix.push(text[..end].to_owned());
    match text[end..].strip_prefix("::") {
        Some(more) => multiply_out(prefix, more, found),
        None => {
            found.push(prefix.clone());
            &text[end..]
        }
    }
}

/// Files imported by each file; a path leads to the innermost module on it.
fn imports() -> BTreeMap<Module, BTreeSet<Module>> {
    let modules = modules();
    let innermost = |path: Module| {
        (1..=path.len()).rev().map(|end| path[..end].to_vec()).find(|part| modules.contains_key(part))
    };
    let of = |(module, code): (&Module, &String)| {
        let there = paths(module, code).into_iter().filter_map(innermost);
        (module.clone(), there.filter(|there| there != module).collect())
    };
    modules.iter().map(of).collect()
}

#[test]
fn rooms_import_in_one_direction() {
    let place = |module: &Module| {
        let room = module.first().map_or("main", String::as_str);
        ROOMS
            .iter()
            .position(|one| *one == room)
            .unwrap_or_else(|| panic!("{room} is not in the list of rooms"))
    };
    let (mut files, mut seen) = (0, 0);
    for (here, imported) in imports().iter().filter(|(here, _)| !here.is_empty()) {
        files += 1;
        for there in imported {
            seen += 1;
            assert!(place(there) <= place(here), "{} imports {}", here.join("::"), there.join("::"));
        }
    }
    assert!(files > 200 && seen > 1000, "{files} files, {seen} imports");
}

#[test]
fn no_two_files_import_each_other() {
    let imports = imports();
    let mutual = imports.iter().find_map(|(here, imported)| {
        let back = imported.iter().find(|there| imports[*there].contains(here))?;
        Some(format!("{} and {}", here.join("::"), back.join("::")))
    });
    assert_eq!(mutual, None, "files that import each other");
}

#[test]
fn files_of_the_contact_are_in_no_circle() {
    let mut left: BTreeMap<Module, BTreeSet<Module>> = imports()
        .into_iter()
        .filter(|(module, _)| module.first().is_some_and(|room| room == "contact"))
        .collect();
    let count = left.len();
    // Files without imports from the rest of the room are removed until none is left, or all are in cycles.
    loop {
        let names: BTreeSet<Module> = left.keys().cloned().collect();
        let before = left.len();
        // The file of a folder names its files and gives them its items: this is no import by them.
        left.retain(|here, imported| {
            imported.iter().any(|there| names.contains(there) && !here.starts_with(there))
        });
        if left.len() == before {
            break;
        }
    }
    assert!(count > 20 && left.is_empty(), "in circles: {:?}", left.keys());
}

/// Files with this name as a whole, in order.
fn files_that_name(name: &str) -> Vec<String> {
    let is_whole = |code: &str, at: usize| !code[at + name.len()..].starts_with(char::is_alphanumeric);
    let names = |code: &str| code.match_indices(name).any(|(at, _)| is_whole(code, at));
    modules().iter().filter(|(_, code)| names(code)).map(|(module, _)| module.join("::")).collect()
}

#[test]
fn few_files_name_a_pane() {
    // The file of the pane, the table of panes, that of keys, and the data or the demo.
    const MOST: usize = 4;
    for pane in ["Accuracy", "Spectrum", "Preloads", "Lengths"] {
        let files = files_that_name(&format!("Pane::{pane}"));
        for table in ["explorer::panes", "explorer::keys"] {
            assert!(files.iter().any(|file| file == table), "{table} does not name {pane}: {files:?}");
        }
        assert!(files.len() <= MOST, "{pane}: {files:?}");
    }
}

#[test]
fn two_files_name_a_form() {
    // The profile of a sphere only constructs a form.
    let is_example = |file: &String| file == "profile";
    for form in ["Form::Paraboloid", "Form::Cone", "Form::Power", "Form::Punch"] {
        let files: Vec<String> = files_that_name(form).into_iter().filter(|file| !is_example(file)).collect();
        assert_eq!(files, ["surface::form"], "{form}");
    }
}

#[test]
fn eight_files_name_an_effect() {
    // A second work of adhesion: fields, check, rule and force, summary, builder of the library, and the maps, which refuse.
    let files = [
        "analysis::governing",
        "contact::foundation",
        "contact_cycle",
        "export::summary",
        "scene::adhesion",
        "scene::check",
        "scene::fields",
        "study::map::template",
    ];
    assert_eq!(files_that_name("closing_work"), files);
}

/// Path and text of each file below these folders of the repository; the text of a file that holds none is empty.
fn texts_below(folders: &[&str]) -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders: Vec<PathBuf> = folders.iter().map(|folder| root.join(folder)).collect();
    let mut texts = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let text = fs::read_to_string(&path).unwrap_or_default();
                texts.push((path, text));
            }
        }
    }
    texts
}

/// Words that the glossary replaces.
const REPLACED: [&str; 8] = ["tell", "tells", "told", "owe", "owes", "owed", "stands", "stood"];

#[test]
fn replaced_words_are_not_used() {
    let mut words = 0;
    for (path, text) in texts_below(&["src", "presets", "tests", "benches", "examples"]) {
        if path.ends_with("readme/imports.rs") {
            continue;
        }
        for word in text.split(|c: char| !c.is_alphabetic()) {
            words += 1;
            assert!(!REPLACED.contains(&word), "{}: {word}", path.display());
        }
    }
    assert!(words > 100_000, "{words} words");
}

/// First words that make a sentence of a comment an indirect question.
const QUESTIONS: [&str; 6] = ["What ", "Whether ", "How ", "Why ", "Who ", "See the module"];

#[test]
fn comments_begin_with_a_noun_or_a_verb() {
    let of_line = |line: &str| -> Option<String> {
        let line = line.trim_start();
        ["/// ", "//! "].iter().find_map(|mark| line.strip_prefix(mark)).map(str::to_owned)
    };
    let mut seen = 0;
    for (path, text) in texts_below(&["src"]) {
        let mut before = None;
        for line in text.lines() {
            let comment = of_line(line);
            if let (None, Some(first)) = (&before, &comment) {
                seen += 1;
                let question = QUESTIONS.iter().any(|question| first.starts_with(question));
                assert!(!question, "{}: {first}", path.display());
            }
            before = comment;
        }
    }
    assert!(seen > 5000, "{seen} comments");
}
