//! The panes keep their places when a number changes: whatever the title of the scene, its notice
//! and the window are.

use super::common::driver::Driver;
use super::common::scenes::{changed, rough};
use asperity::explorer::layout::Layout;
use asperity::scene::{Document, RunError, open, presets};
use std::fs;

/// Columns of the windows.
const WIDTHS: std::ops::RangeInclusive<u16> = 40..=200;

/// Rows of windows that have different panes.
const HEIGHTS: [u16; 9] = [8, 16, 24, 30, 32, 36, 40, 45, 60];

/// Rows whose values are choices.
const CHOICES: [&str; 4] = ["adhesion", "roughness", "form", "material.relaxation"];

/// An explorer that computes nothing: places need no results.
fn without_results(document: Document) -> Driver {
    Driver::open_with(
        document,
        |_, _, _, _| Err(RunError::OutOfMemory { bytes: 0 }),
        |_| false,
    )
}

/// The layouts of the windows of all widths, and of all heights at some of these widths.
fn layouts(driver: &Driver) -> Vec<Layout> {
    let mut layouts = Vec::new();
    for width in WIDTHS {
        for height in HEIGHTS {
            if height == 36 || width % 20 == 0 {
                layouts.push(Layout::within(&driver.app, (width, height)));
            }
        }
    }
    layouts
}

/// Changes the number of each row by one step, one after the other, and takes all changes back.
/// Asserts that no pane moves. Returns the number of changes.
fn assert_panes_stay(document: Document) -> usize {
    let name = document.name().to_owned();
    let mut driver = without_results(document);
    // The first key selects the list of parameters, which narrow windows then show.
    driver.press("g");
    let before = layouts(&driver);
    let paths: Vec<String> = driver
        .app
        .edit
        .parameters
        .iter()
        .filter(|parameter| {
            parameter
                .written
                .contains(|sign: char| sign.is_ascii_digit())
        })
        .map(|parameter| parameter.path.clone())
        .filter(|path| !CHOICES.contains(&path.as_str()))
        .collect();
    let mut changes = 0;
    for path in paths {
        let generation = driver.app.edit.generation;
        driver.select(&path);
        driver.press("l");
        if driver.app.edit.generation != generation {
            changes += 1;
            assert_same(&layouts(&driver), &before, &format!("{name}: {path}"));
        }
    }
    for number in 0..changes {
        driver.press("u");
        assert_same(
            &layouts(&driver),
            &before,
            &format!("{name}: undo {number}"),
        );
    }
    changes
}

#[track_caller]
fn assert_same(layouts: &[Layout], before: &[Layout], place: &str) {
    for (layout, before) in layouts.iter().zip(before) {
        assert_eq!(layout, before, "{place}");
    }
}

#[test]
fn panes_of_built_in_scenes_keep_their_places() {
    for preset in presets() {
        let changes = assert_panes_stay(open(preset.name).unwrap());
        assert!(changes > 3, "{}: {changes} changes", preset.name);
    }
}

#[test]
fn panes_of_scenes_in_files_keep_their_places() {
    let mut scenes = 0;
    for entry in fs::read_dir("docs/examples").unwrap() {
        let path = entry.unwrap().path();
        // Plans of studies are no scenes.
        if let Ok(document) = open(path.to_str().unwrap()) {
            let changes = assert_panes_stay(document);
            assert!(changes > 3, "{}: {changes} changes", path.display());
            scenes += 1;
        }
    }
    assert!(scenes >= 8, "{scenes} scenes");
}

#[test]
fn panes_keep_their_places_under_titles_of_all_lengths() {
    for (title, notice) in [(0, 100), (30, 0), (30, 60), (30, 100), (110, 0), (150, 150)] {
        let words = [("title", title), ("notice", notice)]
            .map(|(path, length)| (path, format!("{:?}", "a".repeat(length))));
        let fields = words.each_ref().map(|(path, text)| (*path, text.as_str()));
        let titled = changed(&rough(), &fields);
        for name in [
            "a.ron",
            "projects/of a long name/adhesion of rough pads/pad of rubber.ron",
        ] {
            assert_panes_stay(Document::parse(titled.text(), name).unwrap());
        }
    }
    // The title of a changed built-in scene is its name, which may be longer than its title.
    let built_in = open("pressure-sensitive").unwrap();
    for name in ["pad.ron", "pressure-sensitive", &"pad".repeat(20)] {
        assert_panes_stay(Document::parse(built_in.text(), name).unwrap());
    }
}
