//! The names of results: each quantity has one name in JSON and in tables, as in docs/terms.md.

use super::program::{json, text};
use serde_json::Value;
use std::collections::BTreeSet;

/// Words that name nothing in results, since another word of docs/terms.md has their meaning.
const AVOIDED: [&str; 8] = [
    "leg",
    "legs",
    "fragment",
    "fragments",
    "line",
    "lines",
    "maps",
    "contacts",
];

/// Names of quantities that another name of docs/terms.md has replaced.
const AVOIDED_NAMES: [&str; 4] = [
    "adhesion_force",
    "effective_modulus",
    "work_of_adhesion",
    "energy_loss",
];

/// Commands that write all kinds of results, with few springs and profiles.
const COMMANDS: [&str; 8] = [
    "run pressure-sensitive --profiles 2 --set numerics.points=1024",
    "run rough-sphere --events=all --set numerics.points=1024 --set roughness.modes=(4,256) \
     --set loading_stiffness=1e3",
    "find preload pressure-sensitive --where F_a=1uN --profiles 2 --set numerics.points=1024",
    "reversals pressure-sensitive --set numerics.points=1024",
    "sensitivity pressure-sensitive --set numerics.points=1024",
    "plan pressure-sensitive",
    "cost jkr-sphere --set numerics.points=1024 --budget 1s",
    "reference docs/examples/rough-square.ron --grid 32 --surfaces 2 --profiles 4",
];

/// Adds all keys of an object, and of the objects in it, but not those of the scene, whose names
/// are the fields of scene files.
fn add_keys(value: &Value, keys: &mut BTreeSet<String>) {
    match value {
        Value::Object(entries) => {
            for (key, entry) in entries {
                keys.insert(key.clone());
                if key != "scene" {
                    add_keys(entry, keys);
                }
            }
        }
        Value::Array(items) => {
            for item in items {
                add_keys(item, keys);
            }
        }
        _ => {}
    }
}

/// Keys of all JSON objects, and columns of the tables that some of the commands also write.
fn all_names() -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for command in COMMANDS {
        let words: Vec<&str> = command.split_whitespace().collect();
        let in_json = [&words[..], &["--format", "json"]].concat();
        add_keys(&json(&in_json), &mut names);
        if command.starts_with("run") || command.starts_with("reversals") {
            let table = text(&[&words[..], &["--format", "csv"]].concat());
            let header = table.lines().find(|line| !line.starts_with('#')).unwrap();
            names.extend(header.split(',').map(String::from));
        }
    }
    names
}

/// Names in the table of docs/terms.md.
fn stated_names() -> Vec<String> {
    let page = include_str!("../../docs/terms.md");
    let (_, section) = page.split_once("## Names").unwrap();
    let rows = section.lines().filter(|line| line.starts_with("| `"));
    let cells = rows.flat_map(|row| row.split('|').skip(1).step_by(2));
    let names = cells.flat_map(|cell| cell.split(','));
    names
        .map(|name| name.trim().trim_matches('`').to_owned())
        .filter(|name| !name.is_empty())
        .collect()
}

#[test]
fn results_have_the_names_of_the_page_of_terms() {
    let names = all_names();
    for name in &names {
        let avoided = name.split('_').find(|word| AVOIDED.contains(word));
        assert_eq!(avoided, None, "{name}");
        let replaced = AVOIDED_NAMES.iter().find(|old| name.contains(*old));
        assert_eq!(replaced, None, "{name}");
    }
    let stated = stated_names();
    assert!(stated.len() > 20, "{stated:?}");
    // Results by Python alone: the energy of each stage, and the field of a scene.
    let elsewhere = ["released_energy", "closing_work"];
    for name in stated {
        let is_known = names.contains(&name) || elsewhere.contains(&name.as_str());
        assert!(is_known, "{name}");
    }
}
