//! The README's tables are those of the program.
//!
//! After a change of the tables, `UPDATE_README=1 cargo test --test readme` writes them anew.

#[path = "readme/scenes.rs"]
mod scenes;

use asperity::check::checks;
use asperity::explorer::demo::{Demo, ONE_SCENE};
use asperity::explorer::theme::{Appearance, Marker, Theme};
use asperity::explorer::{keys, svg_of};
use asperity::export::check_markdown;
use scenes::{check, updating};
use std::path::Path;
use std::process::Command;

#[test]
fn tables_are_those_of_the_program() {
    check("keys", &keys::markdown());
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
