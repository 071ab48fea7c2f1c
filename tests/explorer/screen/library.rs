//! Choosing a scene from the library.

use super::*;
use asperity::explorer::prompt::{Prompt, Purpose};
use tempfile::TempDir;

const BROKEN: &str = "(version: 1, title: \"Broken\", length: -1.0)";

/// An explorer in a folder with a scene of one's own and a broken one, the library open.
fn opened() -> (TempDir, Driver) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.ron"), smooth().text()).unwrap();
    fs::write(folder.path().join("broken.ron"), BROKEN).unwrap();
    fs::write(folder.path().join("notes.txt"), "no scene").unwrap();
    let mut driver = pressed("");
    driver.folder = folder.path().to_owned();
    driver.press("o");
    (folder, driver)
}

fn library(driver: &Driver) -> &Prompt {
    driver.app.prompt.as_ref().expect("a prompt")
}

/// Names of the found scenes, in order.
fn found(driver: &Driver) -> Vec<String> {
    let Prompt {
        purpose: Purpose::Scene(entries),
        found,
        ..
    } = library(driver)
    else {
        panic!("no scenes")
    };
    found
        .iter()
        .map(|index| entries[*index].name.clone())
        .collect()
}

#[test]
fn all_scenes_are_listed_and_found_as_one_types() {
    let (_folder, mut driver) = opened();
    let names: Vec<String> = presets()
        .iter()
        .map(|preset| preset.name.to_owned())
        .collect();
    let own = ["broken.ron".to_owned(), "mine.ron".to_owned()];
    assert_eq!(found(&driver), [names, own.to_vec()].concat());
    for name in found(&driver) {
        assert!(driver.text().contains(&name), "{name}\n{}", driver.text());
    }
    driver.type_text("sph");
    let is_match = |name: &String| {
        let text = presets()
            .iter()
            .find(|preset| preset.name == *name)
            .map(|preset| preset.text);
        name == "mine.ron" || text.is_some_and(|text| text.to_lowercase().contains("sph"))
    };
    assert!(found(&driver).iter().all(is_match), "{:?}", found(&driver));
    assert!(
        found(&driver).contains(&"mine.ron".to_owned()),
        "its title has it"
    );
    driver.type_text("ere-no-such");
    assert!(found(&driver).is_empty());
    driver.shows("no scene fits");
    // On Enter the text is tried as a path.
    driver.answers("Enter", "! there is no such file");
    driver.press("Ctrl+u `mine`");
    assert_eq!(found(&driver), ["mine.ron"]);
    driver.press("Backspace Backspace Backspace Backspace");
    assert_eq!(found(&driver).len(), presets().len() + 2);
    // Letters are typed here, even those that are keys elsewhere.
    driver.press("q j ?");
    assert_eq!(library(&driver).line.text(), "qj?");
}

#[test]
fn enter_opens_and_escape_leaves() {
    let (folder, mut driver) = opened();
    let before = driver.document().clone();
    driver.press("Down Down Esc");
    assert!(driver.app.prompt.is_none() && *driver.document() == before);
    driver.press("o Down");
    assert_eq!(library(&driver).scene().unwrap().name, presets()[1].name);
    driver.press("Up Up");
    assert_eq!(library(&driver).selected, 0, "the list has an end");
    driver.press("`mine` Enter");
    assert!(driver.app.prompt.is_none());
    assert!(is_up_to_date(&driver.app));
    assert_eq!(driver.document().text(), smooth().text());
    assert_eq!(
        driver.document().name(),
        folder.path().join("mine.ron").display().to_string()
    );
    assert!(!driver.app.edit.is_unsaved() && driver.app.play.playing);
    driver.press("u");
    assert_eq!(*driver.document(), before);
    // The smallest window shows the whole list by scrolling.
    driver.resize((20, 5));
    driver.press("o");
    for _ in 0..presets().len() + 1 {
        driver.press("Down");
        let name: String = library(&driver)
            .scene()
            .unwrap()
            .name
            .chars()
            .take(12)
            .collect();
        assert!(driver.text().contains(&name), "{name}\n{}", driver.text());
    }
}

#[test]
fn a_broken_file_is_listed_with_its_error_and_not_opened() {
    let (_folder, mut driver) = opened();
    let before = driver.document().clone();
    driver.sees("`broken`", "! broken.ron");
    let error = library(&driver)
        .scene()
        .unwrap()
        .error()
        .expect("it is no scene");
    driver.shows(error.chars().take(30).collect::<String>());
    driver.answers("Enter", "broken.ron");
    assert_eq!(
        (driver.document(), found(&driver)),
        (&before, vec!["broken.ron".to_owned()]),
        "the list stays"
    );
}
