//! The source as a whole: directions of imports, circles of files, names that two crates publish,
//! words.

use super::generated::root;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Crates of the workspace. Cargo keeps their order, in which no circle is possible.
const CRATES: [&str; 10] = [
    "data",
    "fourier",
    "contact",
    "surface",
    "half-space",
    "plot",
    "scene",
    "experiment",
    "study",
    "report",
];

/// Rooms of crates from the ground up: each imports only earlier rooms.
const ROOMS: [(&str, &str); 4] = [
    ("surface", "error topography spectrum line"),
    (
        "scene",
        "scene analysis reference simulation error front profile_builder accuracy",
    ),
    ("experiment", "error read curve fit"),
    ("program", "explorer cli"),
];

/// Path of a module behind its crate, as `["contact", "adhesive"]`; the program is the crate
/// `program`.
type Module = Vec<String>;

/// Path and text of each file below a folder; the text of a file that holds none is empty.
fn texts_below(folder: &str) -> Vec<(PathBuf, String)> {
    let (mut texts, mut folders) = (Vec::new(), vec![root().join(folder)]);
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

/// Source files by their modules, without comments and tests.
fn modules() -> BTreeMap<Module, String> {
    let is_source = |path: &Path| path.extension().is_some_and(|extension| extension == "rs");
    let of = |name: &str, folder: &str, (path, text): (PathBuf, String)| {
        let inside = path
            .strip_prefix(root().join(folder))
            .unwrap()
            .with_extension("");
        let parts = inside.iter().map(|part| part.to_str().unwrap().to_owned());
        let parts = parts.filter(|part| part != "mod" && part != "lib");
        let is_body = |start: &usize| {
            text[*start..]
                .lines()
                .nth(2)
                .is_some_and(|line| line.contains("mod ") && line.ends_with('{'))
        };
        let mut tests = text
            .match_indices("\n#[cfg(test)]\n")
            .map(|(start, _)| start);
        let code = &text[..tests.find(is_body).unwrap_or(text.len())];
        let lines: Vec<&str> = code
            .lines()
            .map(|line| line.split("//").next().unwrap_or_default())
            .collect();
        (
            [name.to_owned()].into_iter().chain(parts).collect(),
            lines.join("\n"),
        )
    };
    let crates = CRATES.map(|name| (name, format!("crates/{name}/src")));
    let all = crates.into_iter().chain([("program", "src".to_owned())]);
    let files = all.flat_map(|(name, folder)| {
        let sources = texts_below(&folder)
            .into_iter()
            .filter(|(path, _)| is_source(path));
        sources
            .map(|file| of(name, &folder, file))
            .collect::<Vec<_>>()
    });
    files.collect()
}

fn is_part_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Adds the paths of a tree of imports to `found`, and returns the rest of the text.
fn multiply_out<'t>(prefix: &mut Module, text: &'t str, found: &mut Vec<Module>) -> &'t str {
    let text = text.trim_start();
    if let Some(mut inside) = text.strip_prefix('{') {
        loop {
            inside = multiply_out(&mut prefix.clone(), inside, found).trim_start();
            inside = inside.find([',', '}']).map_or("", |end| &inside[end..]);
            match inside.strip_prefix(',').map(str::trim_start) {
                Some(next) if !next.starts_with('}') => inside = next,
                Some(next) => return &next[1..],
                None => return inside.strip_prefix('}').unwrap_or(""),
            }
        }
    }
    let end = text.find(|c| !is_part_of_name(c)).unwrap_or(text.len());
    prefix.push(text[..end].to_owned());
    match text[end..].strip_prefix("::") {
        Some(more) => multiply_out(prefix, more, found),
        None => {
            found.push(prefix.clone());
            &text[end..]
        }
    }
}

/// Name of the last public module that begins in a code.
fn module_before(code: &str) -> Option<String> {
    let (_, rest) = code.rsplit_once("\npub mod ")?;
    rest.split_once(" {").map(|(name, _)| name.to_owned())
}

/// Modules and the items that a file takes from them: of `use` and of paths in code, from the
/// crate, from the modules above, from the modules below by their bare names, and through
/// re-exports.
struct Source {
    modules: BTreeMap<Module, String>,
    reexports: BTreeMap<Module, Module>,
}

impl Source {
    fn new() -> Self {
        let source = Source {
            modules: modules(),
            reexports: BTreeMap::new(),
        };
        let mut reexports = BTreeMap::new();
        for (module, code) in &source.modules {
            for (index, start) in code.match_indices("use ") {
                let before = code[..index].rsplit('\n').next().unwrap();
                if before.trim_start().starts_with("pub") {
                    let mut found = Vec::new();
                    multiply_out(&mut Vec::new(), &code[index + start.len()..], &mut found);
                    let paths = found
                        .iter()
                        .filter_map(|path| source.absolute(module, path));
                    // A line that is indented is inside a module of the root.
                    let inside = before
                        .starts_with(' ')
                        .then(|| module_before(&code[..index]))
                        .flatten();
                    let place: Module = module.iter().cloned().chain(inside).collect();
                    reexports.extend(
                        paths.map(|path| ([&place[..], &path[path.len() - 1..]].concat(), path)),
                    );
                }
            }
        }
        Source {
            reexports,
            ..source
        }
    }

    /// A path in a file as one from the crate; `None` for paths out of other packages.
    fn absolute(&self, module: &Module, path: &Module) -> Option<Module> {
        let up = path.iter().take_while(|part| *part == "super").count();
        let child = [&module[..], &path[..1]].concat();
        if let Some(name) = path[0].strip_prefix("asperity_") {
            return Some([&[name.to_owned()][..], &path[1..]].concat());
        }
        match path[0].as_str() {
            "crate" => Some([&module[..1], &path[1..]].concat()),
            "self" => Some([&module[..], &path[1..]].concat()),
            "super" => Some([&module[..module.len().checked_sub(up)?], &path[up..]].concat()),
            _ if self.modules.contains_key(&child) => Some([&module[..], path].concat()),
            _ => None,
        }
    }

    /// The file of the item at the end of a path: re-exports lead to the file that has it.
    fn file_of(&self, mut path: Module) -> Option<Module> {
        for _ in 0..8 {
            let longest = (1..=path.len())
                .rev()
                .find(|&end| self.reexports.contains_key(&path[..end]));
            let Some(end) = longest else { break };
            let next = [&self.reexports[&path[..end]][..], &path[end..]].concat();
            if next == path {
                break;
            }
            path = next;
        }
        (1..=path.len())
            .rev()
            .map(|end| path[..end].to_vec())
            .find(|part| self.modules.contains_key(part))
    }

    /// Files whose items a file uses; a `pub use` alone is the business of its users.
    fn imports(&self, module: &Module) -> BTreeSet<Module> {
        let code = &self.modules[module];
        let mut found = Vec::new();
        for (index, _) in code.match_indices("::") {
            let start = code[..index]
                .rfind(|c| !is_part_of_name(c))
                .map_or(0, |at| at + 1);
            let statement = code[..start].rsplit(['\n', ';']).next().unwrap();
            let is_first = !code[..start].ends_with("::") && start < index;
            if is_first
                && !(statement.trim_start().starts_with("pub") && statement.contains("use "))
            {
                multiply_out(&mut Vec::new(), &code[start..], &mut found);
            }
        }
        let absolute = found.iter().filter_map(|path| self.absolute(module, path));
        absolute
            .filter_map(|path| self.file_of(path))
            .filter(|there| there != module)
            .collect()
    }
}

#[test]
fn rooms_import_in_one_direction() {
    let source = Source::new();
    let mut seen = 0;
    for (name, rooms) in ROOMS {
        let place = |module: &Module| {
            let room = &module[1];
            let found = rooms.split(' ').position(|one| one == room);
            found.unwrap_or_else(|| panic!("{room} is not in the list of rooms of {name}"))
        };
        let is_inside =
            |module: &Module| module[0] == name && module.len() > 1 && module[1] != "main";
        for here in source.modules.keys().filter(|here| is_inside(here)) {
            for there in source.imports(here).iter().filter(|there| is_inside(there)) {
                seen += 1;
                assert!(
                    place(there) <= place(here),
                    "{} imports {}",
                    here.join("::"),
                    there.join("::")
                );
            }
        }
    }
    assert!(seen > 300, "{seen} imports");
}

#[test]
fn files_are_in_no_circle() {
    let source = Source::new();
    let imports: BTreeMap<&Module, BTreeSet<Module>> = source
        .modules
        .keys()
        .filter(|module| **module != ["program"])
        .map(|module| (module, source.imports(module)))
        .collect();
    // All files that a file leads to: a circle is a set of files that lead to each other.
    let reached = |from: &Module| {
        let (mut seen, mut next) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(file) = next.pop() {
            let new = imports
                .get(&file)
                .into_iter()
                .flatten()
                .filter(|there| seen.insert((*there).clone()));
            next.extend(new.cloned().collect::<Vec<_>>());
        }
        seen
    };
    let reached: BTreeMap<&Module, BTreeSet<Module>> =
        imports.keys().map(|file| (*file, reached(file))).collect();
    let circle = |file: &Module| -> Vec<String> {
        reached[file]
            .iter()
            .filter(|there| reached[*there].contains(file))
            .map(|there| there.join("::"))
            .collect()
    };
    let found: BTreeSet<Vec<String>> = reached
        .keys()
        .map(|file| circle(file))
        .filter(|circle| !circle.is_empty())
        .collect();
    assert!(found.is_empty(), "circles of files: {found:?}");
}

/// Names that a crate publishes, with their public module, if they are in one: re-exports, modules
/// and own items.
fn published(code: &str) -> BTreeSet<(Option<String>, String)> {
    let own = [
        "mod ", "fn ", "struct ", "enum ", "trait ", "type ", "const ", "static ",
    ];
    let own = own.iter().flat_map(|keyword| {
        let lines = code
            .lines()
            .filter_map(move |line| line.strip_prefix("pub ")?.strip_prefix(keyword));
        lines.map(|rest| {
            rest.split(|c| !is_part_of_name(c))
                .next()
                .unwrap_or_default()
                .to_owned()
        })
    });
    let uses = code.match_indices("pub use ").flat_map(|(start, keyword)| {
        let mut found = Vec::new();
        multiply_out(&mut Vec::new(), &code[start + keyword.len()..], &mut found);
        let is_inside = code[..start].ends_with(' ');
        let module = is_inside.then(|| module_before(&code[..start])).flatten();
        found
            .into_iter()
            .filter_map(move |path| Some((module.clone(), path.last()?.clone())))
    });
    own.map(|name| (None, name)).chain(uses).collect()
}

/// Names of items of the crate of values that the crates above publish again, for users who need
/// few other names of it.
const PUBLISHED_AGAIN: [&str; 2] = ["CountedWarning", "Warning"];

/// Names that two crates publish would mean two things; the program's crate publishes again what
/// its users need.
#[test]
fn each_published_name_is_of_one_crate() {
    let modules = modules();
    let mut crates_of: BTreeMap<String, BTreeSet<&str>> = BTreeMap::new();
    for name in CRATES {
        for (_, published) in published(&modules[&vec![name.to_owned()]]) {
            crates_of.entry(published).or_default().insert(name);
        }
    }
    assert!(crates_of.len() > 300, "{} names", crates_of.len());
    crates_of.retain(|name, crates| crates.len() > 1 && !PUBLISHED_AGAIN.contains(&name.as_str()));
    let twice: Vec<_> = crates_of.iter().collect();
    assert!(twice.is_empty(), "{twice:?}");
}

/// Words that docs/design.md replaces.
const REPLACED: [&str; 8] = [
    "tell", "tells", "told", "owe", "owes", "owed", "stands", "stood",
];

#[test]
fn replaced_words_are_not_used() {
    let folders = [
        "src",
        "crates",
        "presets",
        "tests",
        "benches",
        "examples",
        "docs",
        "fuzz/src",
        "fuzz/fuzz_targets",
        ".ci",
    ];
    let pages = [
        "README.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "fuzz/README.md",
    ];
    let pages = pages.map(|page| {
        (
            root().join(page),
            fs::read_to_string(root().join(page)).unwrap(),
        )
    });
    let mut words = 0;
    for (path, text) in folders.into_iter().flat_map(texts_below).chain(pages) {
        if path.ends_with("program/source.rs") {
            continue;
        }
        // docs/design.md ends with the words to avoid.
        let text = text.split("## Words to avoid").next().unwrap();
        for word in text.split(|c: char| !c.is_alphabetic()) {
            words += 1;
            assert!(!REPLACED.contains(&word), "{}: {word}", path.display());
        }
    }
    assert!(words > 100_000, "{words} words");
}

/// rustfmt leaves comments as they are. A link may be longer.
#[test]
fn comments_are_within_100_columns() {
    let mut comments = 0;
    for folder in ["src", "crates", "python/src", "tests", "benches"] {
        for (path, text) in texts_below(folder) {
            if path.extension().is_none_or(|extension| extension != "rs") {
                continue;
            }
            for line in text
                .lines()
                .filter(|line| line.trim_start().starts_with("//"))
            {
                comments += 1;
                let is_link = line.contains("](") || line.contains("http");
                let columns = line.chars().count();
                assert!(is_link || columns <= 100, "{}: {line}", path.display());
            }
        }
    }
    assert!(comments > 20_000, "{comments} comments");
}

/// Python and the explorer show the texts of the libraries too, and have no options. The words of
/// an option are in `src/cli/advice.rs`.
#[test]
fn libraries_name_no_option_of_the_command_line() {
    for (module, code) in modules() {
        if module[0] == "program" {
            continue;
        }
        for line in code.lines() {
            let mut starts = line.match_indices("--");
            let named = starts.find(|(start, _)| {
                let next = line[start + 2..].chars().next();
                next.is_some_and(|letter| letter.is_ascii_lowercase())
            });
            assert!(named.is_none(), "{module:?}: {line}");
        }
    }
}
