//! The README's tables are those of the program.
//!
//! After a change of the tables, `UPDATE_README=1 cargo test --test readme` writes them anew.

use asperity::check::checks;
use asperity::explorer::demo::{Demo, ONE_SCENE};
use asperity::explorer::theme::{Appearance, Marker, Theme};
use asperity::explorer::{keys, svg_of};
use asperity::export::check_markdown;
use asperity::scene::{FIELDS, LEG_FORCE, LEG_INDENTATION, Range, presets};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

/// One test at a time writes the README.
static README: Mutex<()> = Mutex::new(());

fn updating() -> bool {
    std::env::var_os("UPDATE_README").is_some()
}

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")
}

fn check(name: &str, expected: &str) {
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
fn tables_are_those_of_the_program() {
    check("keys", &keys::markdown());
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
    let mut scenes = String::from("| scene | what it shows |\n| --- | --- |\n");
    for preset in presets() {
        let document = asperity::scene::open(preset.name).unwrap();
        scenes += &format!("| `{}` | {} |\n", preset.name, document.scene().notice);
    }
    check("scenes", &scenes);
    check("hard cases", &check_markdown(&checks(|_| true)));
}

#[test]
fn the_picture_is_that_of_the_program() {
    let document = asperity::scene::open("pressure-sensitive").unwrap();
    let appearance = Appearance { theme: Theme::Dark, marker: Marker::Braille };
    let mut demo = Demo::new(document, ONE_SCENE, (120, 36), appearance, 12.0);
    while demo.advance().is_some_and(|seconds| seconds + 1e-9 < 9.0) {}
    let picture = svg_of(demo.model());
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/explorer.svg");
    if updating() {
        std::fs::write(&path, picture).unwrap();
    } else {
        let found = std::fs::read_to_string(&path).unwrap();
        assert!(found == picture, "docs/explorer.svg is not the program's: the README says how to make it");
    }
}

fn asperity(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_asperity")).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn boundaries_are_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("edge");
    let study = study.to_str().unwrap();
    asperity(&["sweep", "equation-15", "-o", study]);
    let levels = ["--level", "0.5", "--level", "0.1", "--format", "markdown"];
    check("boundaries", &asperity(&[&["sweep", "boundary", study], &levels[..]].concat()));
}
