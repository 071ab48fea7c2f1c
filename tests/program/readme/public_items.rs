//! The public items of the library, as a snapshot: changes of the interface are seen in review.
//!
//! The rooms of the program, `cli` and `explorer`, are left out. Signatures are read from the formatted source.

use super::imports::{Module, modules, multiply_out};
use std::collections::{BTreeMap, BTreeSet};

/// First words of the listed items.
const KINDS: [&str; 7] = ["const fn ", "const ", "enum ", "fn ", "struct ", "trait ", "type "];

/// Modules that are public up to the crate, without the rooms of the program.
fn public_modules(modules: &BTreeMap<Module, String>) -> Vec<Module> {
    let (mut found, mut next) = (Vec::new(), vec![Vec::new()]);
    while let Some(module) = next.pop() {
        for line in modules[&module].lines() {
            let child = line.strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(';'));
            let child = child.filter(|child| !["cli", "explorer"].contains(child));
            next.extend(child.map(|child| [module.clone(), vec![child.to_owned()]].concat()));
        }
        found.push(module);
    }
    found
}

/// Full paths re-exported by a module: its `pub use`, without those from outside the crate.
fn reexports(module: &Module, modules: &BTreeMap<Module, String>) -> Vec<Module> {
    let mut found = Vec::new();
    for (index, _) in modules[module].match_indices("\npub use ") {
        multiply_out(&mut Vec::new(), &modules[module][index + "\npub use ".len()..], &mut found);
    }
    let absolute = |path: Module| {
        let up = path.iter().take_while(|part| *part == "super").count();
        match path[0].as_str() {
            "crate" => path[1..].to_vec(),
            _ => [&module[..module.len() - up.min(module.len())], &path[up..]].concat(),
        }
    };
    found.into_iter().map(absolute).collect()
}

/// The signature that begins a text, on one line, up to its body.
fn signature(text: &str) -> String {
    let (mut depth, mut before) = (0, ' ');
    let end = text.char_indices().find(|&(_, c)| {
        depth += i32::from("([<".contains(c)) - i32::from(")]>".contains(c) && before != '-');
        before = c;
        depth == 0 && "{;=".contains(c)
    });
    let words =
        text[..end.map_or(text.len(), |(end, _)| end)].split_whitespace().collect::<Vec<_>>().join(" ");
    words.replace("( ", "(").replace(", )", ")")
}

/// Public items that a module defines: name, and the signature.
fn items(code: &str) -> Vec<(String, String)> {
    let starts = code.match_indices("\npub ").map(|(index, start)| &code[index + start.len()..]);
    let item = |text: &str| {
        let kind = KINDS.into_iter().find(|kind| text.starts_with(kind))?;
        let name = &text[kind.len()..];
        let end = name.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(name.len());
        Some((name[..end].to_owned(), signature(text)))
    };
    starts.filter_map(item).collect()
}

/// Fields, variants and methods of a type, or methods of a trait, from all files of its room.
fn members(name: &str, room: &[&String]) -> Vec<String> {
    let mut found = Vec::new();
    for code in room {
        for block in code.split("\n}\n") {
            let lines: Vec<&str> = block.lines().collect();
            let Some(head) = lines.iter().position(|line| {
                let words: Vec<&str> = line.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
                let begins =
                    ["impl", "pub struct", "pub enum", "pub trait"].iter().any(|one| line.starts_with(one));
                let is_own = !line.starts_with("impl") || !line.contains(" for ");
                begins && is_own && line.ends_with('{') && words.contains(&name)
            }) else {
                continue;
            };
            let whole = lines[head..].join("\n");
            // An implementation for another type that mentions the name lists nothing.
            let of = lines[head].trim_start_matches("impl").trim_start();
            let of = if of.starts_with('<') { of.split_once("> ").map_or("", |(_, rest)| rest) } else { of };
            if lines[head].starts_with("impl") && !of.starts_with(name) {
                continue;
            }
            let is_open = lines[head].starts_with("pub enum") || lines[head].starts_with("pub trait");
            let mut place = 0;
            for line in whole.split_inclusive('\n') {
                let text = &whole[place..];
                place += line.len();
                let own = line.strip_prefix("    ").filter(|own| own.starts_with(char::is_alphabetic));
                let Some(own) = own else { continue };
                let is_public = own.starts_with("pub ");
                if is_public && own.contains("fn ") || is_open && lines[head].contains("trait") {
                    found.push(signature(text.trim_start().trim_start_matches("pub ")));
                } else if is_public || is_open {
                    let field = own.trim_start_matches("pub ").trim_end().trim_end_matches([',', '{', '(']);
                    found.push(field.trim_end().to_owned());
                }
            }
        }
    }
    found
}

#[test]
fn public_items_are_those_of_the_snapshot() {
    let modules = modules();
    let mut lines = BTreeSet::new();
    for module in public_modules(&modules) {
        let mut shown: Vec<Module> = reexports(&module, &modules);
        shown.extend(
            items(&modules[&module]).into_iter().map(|(name, _)| [module.clone(), vec![name]].concat()),
        );
        for path in shown {
            let (name, place) = path.split_last().unwrap();
            // Re-exports may be of re-exports.
            let room: Vec<&String> = modules
                .iter()
                .filter(|(other, _)| other.first() == place.first())
                .map(|(_, code)| code)
                .collect();
            let at = modules.get(place).into_iter().chain(room.iter().copied());
            let Some(own) = at.flat_map(|code| items(code)).find(|(other, _)| other == name) else {
                continue;
            };
            let prefix = module.iter().map(|part| format!("{part}::")).collect::<String>();
            lines.insert(format!("{prefix}{name}: {}", own.1));
            if own.1.starts_with(char::is_lowercase) && !own.1.starts_with("fn ") {
                lines.extend(
                    members(name, &room).into_iter().map(|member| format!("{prefix}{name}. {member}")),
                );
            }
        }
    }
    assert!(lines.len() > 500, "{} items", lines.len());
    insta::assert_snapshot!(lines.into_iter().collect::<Vec<_>>().join("\n"));
}
