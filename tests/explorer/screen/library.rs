//! Choosing a scene from the library.

use super::*;
use asperity::explorer::action::Action;
use asperity::explorer::openable::Openable;
use asperity::explorer::opening::{Opened, Opening};
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

/// Names of the found entries, in order.
fn found(driver: &Driver) -> Vec<String> {
    let Prompt {
        purpose: Purpose::Open(entries),
        found,
        ..
    } = library(driver)
    else {
        panic!("no list")
    };
    found
        .iter()
        .map(|index| entries[*index].name().to_owned())
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
    driver.shows("nothing fits");
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
    assert_eq!(
        library(&driver).openable().unwrap().name(),
        presets()[1].name
    );
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
        let selected = library(&driver).openable().unwrap();
        let name: String = selected.name().chars().take(12).collect();
        assert!(driver.text().contains(&name), "{name}\n{}", driver.text());
    }
}

#[test]
fn a_broken_file_is_listed_with_its_error_and_not_opened() {
    let (_folder, mut driver) = opened();
    let before = driver.document().clone();
    driver.sees("`broken`", "! broken.ron");
    let Some(Openable::Scene(entry)) = library(&driver).openable() else {
        panic!("no scene is selected")
    };
    let error = entry.error().expect("it is no scene");
    driver.shows(error.chars().take(30).collect::<String>());
    driver.answers("Enter", "broken.ron");
    assert_eq!(
        (driver.document(), found(&driver)),
        (&before, vec!["broken.ron".to_owned()]),
        "the list stays"
    );
}

/// The points of a force curve of a sphere, in nm and µN, with a header or without.
fn curve(header: &str) -> String {
    let mut text = header.to_owned();
    let approach = -100_i32..=100;
    let retraction = (-100..100).rev();
    for (point, step) in approach.chain(retraction).enumerate() {
        let displacement = 10.0 * f64::from(step);
        let noise = if point % 2 == 0 { 1e-4 } else { -1e-4 };
        let force = 1e-4 * displacement.max(0.0).powf(1.5) + noise;
        text += &format!("{displacement},{force}\n");
    }
    text
}

/// An explorer in a folder with a study, a plan, force curves with and without units, and a
/// surface, with the list open.
fn opened_with_files() -> (TempDir, Driver) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let scene = smooth().text().to_owned();
    let axes = "[Linear(path: \"adhesion.work\", from: 0.01, to: 0.02, count: 2)]";
    let plan = format!(
        "(version: 1, scene: {scene}, axes: {axes}, profiles: 1, record: [pull_off_force])"
    );
    write("plan.ron", &plan);
    write("curve.txt", &curve("displacement (nm),force (uN)\n"));
    write("bare.txt", &curve(""));
    write("notes.md", "# Notes\n");
    write(".hidden.txt", &curve("displacement (nm),force (uN)\n"));
    write(
        "surface.csv",
        "x (um),z (nm)\n0,1\n1,3\n2,0\n3,2\n4,1\n5,2\n6,0\n7,1\n",
    );
    let mut driver = pressed("");
    driver.folder = folder.path().to_owned();
    driver.press("o");
    (folder, driver)
}

#[test]
fn files_of_the_folder_are_listed_by_what_they_are() {
    let (_folder, driver) = opened_with_files();
    let own: Vec<String> = found(&driver)[presets().len()..].to_vec();
    assert_eq!(own, ["plan.ron", "bare.txt", "curve.txt", "surface.csv"]);
    for row in [
        "plan.ron  plan",
        "curve.txt  force curve",
        "surface.csv  surface",
    ] {
        assert!(driver.text().contains(row), "{row}\n{}", driver.text());
    }
}

#[test]
fn a_listed_curve_and_a_listed_surface_are_opened() {
    let (_folder, mut driver) = opened_with_files();
    driver.press("`curve.txt` Enter");
    let measured = driver.app.edit.measured.as_ref();
    let measured = measured.unwrap_or_else(|| panic!("no curve\n{}", driver.text()));
    assert!(measured.name.ends_with("curve.txt"), "{}", measured.name);
    driver.press("o `surface.csv` Enter");
    assert!(driver.app.prompt.is_none(), "{}", driver.text());
    let is_rough = |driver: &Driver| driver.document().text().contains("surface.csv");
    assert!(is_rough(&driver), "{}", driver.document().text());
    driver.press("u");
    assert!(!is_rough(&driver));
}

#[test]
fn the_scene_of_a_listed_plan_is_opened() {
    let (_folder, mut driver) = opened_with_files();
    driver.press("`plan.ron` Enter");
    assert!(driver.app.prompt.is_none(), "{}", driver.text());
    let form = &driver.document().scene().form;
    assert_eq!(*form, smooth().scene().form);
}

/// The units of a curve without a header are asked for. A wrong answer keeps the question, and
/// Escape leaves everything as it was.
#[test]
fn a_curve_without_units_asks_for_them() {
    let (_folder, mut driver) = opened_with_files();
    let before = driver.document().clone();
    driver.sees("`bare.txt` Enter", "units:");
    driver.press("Esc");
    assert!(driver.app.prompt.is_none() && driver.app.edit.measured.is_none());
    assert_eq!(*driver.document(), before);
    driver.sees("o `bare.txt` Enter", "units:");
    driver.answers("Enter", "type units of displacement and force");
    driver.answers("`parsec,uN` Enter", "is not a unit of the displacement");
    driver.shows("units:");
    driver.press("`nm,uN` Enter");
    let measured = driver.app.edit.measured.as_ref();
    let measured = measured.unwrap_or_else(|| panic!("no curve\n{}", driver.text()));
    assert_eq!(measured.options.units, ["nm", "uN"]);
}

/// The stiffness that the file of an opened curve states replaces the stiffness of the scene, and a
/// message says so.
#[test]
fn the_stiffness_of_an_opened_curve_replaces_that_of_the_scene() {
    let (folder, mut driver) = opened_with_files();
    let text = curve("# spring constant: 20 N/m\ndisplacement (nm),force (uN)\n");
    fs::write(folder.path().join("stated.txt"), text).unwrap();
    driver.press("Esc");
    let stiff = driver.document().set("loading_stiffness", "500").unwrap();
    driver.act(Action::Opened(
        "stiff".to_owned(),
        Ok(Opened::Scene(Box::new(Opening::from(stiff)))),
    ));
    driver.press("o `stated.txt` Enter");
    assert_eq!(driver.document().scene().loading_stiffness, Some(20.0));
    driver.shows("in place of 500 N/m of the scene");
    driver.press("u");
    assert_eq!(driver.document().scene().loading_stiffness, Some(500.0));
}
