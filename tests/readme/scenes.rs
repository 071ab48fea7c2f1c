//! The README's tables of fields and scenes.

use asperity::scene::{FIELDS, LEG_FORCE, LEG_INDENTATION, Range, presets};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// One test at a time writes the README.
static README: Mutex<()> = Mutex::new(());

/// The README is written anew.
pub fn updating() -> bool {
    std::env::var_os("UPDATE_README").is_some()
}

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")
}

/// The README has this table under this name.
pub fn check(name: &str, expected: &str) {
    let _alone = README.lock();
    let readme = std::fs::read_to_string(path()).unwrap();
    let (start, end) = (format!("<!-- {name} -->\n"), format!("<!-- end of {name} -->"));
    let (before, rest) = readme.split_once(&start).unwrap_or_else(|| panic!("README.md has no {start}"));
    let (found, after) = rest.split_once(&end).unwrap_or_else(|| panic!("README.md has no {end}"));
    if updating() {
        std::fs::write(path(), format!("{before}{start}{expected}{end}{after}")).unwrap();
    } else {
        assert_eq!(found, expected, "the table of {name} in README.md is not the program's");
    }
}

#[test]
fn fields_are_those_of_the_table() {
    let mut fields =
        String::from("| field | symbol | allowed | left out | means |\n| --- | --- | --- | --- | --- |\n");
    let legs = [&LEG_FORCE, &LEG_INDENTATION];
    for field in FIELDS.iter().chain(legs).filter(|field| field.range != Range::Group) {
        let of = field.variant.map_or(String::new(), |variant| format!(" ({variant})"));
        let or_none = |text: &str| if text.is_empty() { String::new() } else { format!("`{text}`") };
        let allowed = match field.range {
            Range::Choice(choices) => choices.iter().map(|c| format!("`{c}`")).collect::<Vec<_>>().join(", "),
            _ => field.allowed(),
        };
        fields += &format!(
            "| `{}`{of} | {} | {allowed} | {} | {} |\n",
            field.path,
            field.symbol,
            or_none(field.default),
            field.meaning,
        );
    }
    check("fields", &fields);
}

#[test]
fn scenes_are_the_presets() {
    let mut scenes = String::from("| scene | what it shows |\n| --- | --- |\n");
    for preset in presets() {
        let document = asperity::scene::open(preset.name).unwrap();
        scenes += &format!("| `{}` | {} |\n", preset.name, document.scene().notice);
    }
    check("scenes", &scenes);
}
