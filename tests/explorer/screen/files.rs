//! Exports and the command that opens the scene.

use super::*;
use asperity::explorer::action::{Content, OutputFile};
use asperity::explorer::command_line::command_line;
use asperity::explorer::theme::Marker;
use asperity_plot::Colours;
use asperity_report::RunReport;
use asperity_report::scene_provenance;
use asperity_report::{Format, write};
use std::path::PathBuf;

/// Exports to a file and returns the effects.
fn export(driver: &mut Driver, path: &Path) -> Vec<Task> {
    driver.press(&format!("E Ctrl+u `{}` Enter", path.display()))
}

/// Exports to a file of this name in a folder of its own, and reads it.
fn exported(driver: &mut Driver, name: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    export(driver, &path);
    assert!(
        driver.status().starts_with("exported to "),
        "{}",
        driver.status()
    );
    fs::read_to_string(path).unwrap()
}

#[test]
fn the_ending_of_a_name_shows_what_is_exported() {
    for (name, format) in [
        ("a.csv", Format::Csv),
        ("folder/b.JSON", Format::Json),
        ("c.d.svg", Format::Svg),
    ] {
        let mut driver = pressed("");
        let (path, content) = (PathBuf::from(name), Content::Pane(format));
        let file = OutputFile {
            path,
            content,
            width: None,
            overwrite: false,
            then_quit: false,
        };
        assert_eq!(export(&mut driver, Path::new(name)), [Task::Write(file)]);
        driver.states(format!("exported to {name}"));
    }
    let mut driver = pressed("");
    assert!(export(&mut driver, Path::new("a.gif")).is_empty() && driver.files().is_empty());
    driver
        .states("unsupported file extension .gif; use .csv, .npy, .json, .svg, .png, .pdf or .txt");
    // The proposed name is that of the scene with the pane.
    let mut driver = pressed("");
    driver.press("E Enter");
    assert_eq!(driver.files(), ["rough-line-force.pdf"]);
    assert!(
        pressed("E Ctrl+u Enter").files().is_empty(),
        "no name is no file"
    );
}

#[test]
fn a_file_that_is_there_is_asked_about() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.csv");
    fs::write(&path, "theirs").unwrap();
    let mut driver = pressed("");
    export(&mut driver, &path);
    driver.states("Overwrite it?");
    driver.press("n");
    assert_eq!(fs::read_to_string(&path).unwrap(), "theirs");
    export(&mut driver, &path);
    driver.press("y");
    assert!(
        fs::read_to_string(&path)
            .unwrap()
            .contains("\nstage,indentation")
    );
    assert!(driver.app.prompt.is_none());
    // An error of the system is shown.
    export(&mut driver, &folder.path().join("no/such/folder/a.csv"));
    assert!(
        driver
            .refusal()
            .is_some_and(|why| why.contains("there is no folder")),
        "{}",
        driver.status()
    );
}

#[test]
fn the_curve_and_the_figures_are_those_of_the_command_line() {
    let mut driver = pressed("");
    let outcome = driver.outcome().clone();
    let scene = driver.document().scene().clone();
    let command = command_line("asperity run", driver.document().name(), &[]);
    let provenance = scene_provenance(&command, &scene, Path::new(""), Path::new("")).unwrap();
    let estimate = driver.app.studies.value();
    let report = RunReport {
        title: "",
        scene: &scene,
        outcome: &outcome,
        choice: None,
        estimate,
        ensemble: None,
        deviation: None,
        wording: asperity::explorer::advice::row,
    };
    let (mut curve, mut figures) = (Vec::new(), Vec::new());
    write(&mut curve, &report, Format::Csv, &provenance).unwrap();
    write(&mut figures, &report, Format::Json, &provenance).unwrap();
    assert_eq!(exported(&mut driver, "a.csv").into_bytes(), curve);
    assert_eq!(exported(&mut driver, "a.json").into_bytes(), figures);
    assert!(serde_json::from_slice::<serde_json::Value>(&figures).is_ok());
    // A failed scene has neither, but its screen can be exported.
    super::failures::detach(&mut driver);
    let folder = tempfile::tempdir().unwrap();
    for name in ["b.csv", "b.json"] {
        export(&mut driver, &folder.path().join(name));
        driver.states("nothing yet to export");
    }
    export(&mut driver, &folder.path().join("b.txt"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn profile_and_close_up_come_from_the_springs_at_any_size_of_the_window() {
    for pane in [Pane::Profile, Pane::CloseUp] {
        let of_size = |size| {
            let mut driver = pressed("");
            driver.app.view.pane = pane;
            driver.resize(size);
            ["a.csv", "a.svg"].map(|name| exported(&mut driver, name))
        };
        let [table, figure] = of_size((200, 60));
        for size in [(120, 36), (80, 24), (40, 12)] {
            assert!(
                of_size(size) == [table.clone(), figure.clone()],
                "{pane:?} {size:?}"
            );
        }
        let mut curves = std::collections::BTreeMap::<&str, Vec<(&str, &str)>>::new();
        for row in table.lines().filter(|line| !line.starts_with('#')).skip(1) {
            let [curve, x, z] = row.split(',').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            curves.entry(curve).or_default().push((x, z));
        }
        // A row for each spring, and in contact the surface is the profile.
        let springs = if pane == Pane::Profile {
            1024
        } else {
            curves["profile"].len()
        };
        assert_eq!(
            (curves["profile"].len(), curves["surface"].len()),
            (springs, springs)
        );
        let (profile, surface) = (&curves["profile"], &curves["surface"]);
        assert!(
            profile.windows(2).all(|pair| pair[0].0 != pair[1].0),
            "{pane:?}"
        );
        let contact: Vec<_> = curves["pressed"].iter().chain(&curves["pulled"]).collect();
        assert!(
            contact
                .iter()
                .all(|spring| profile.contains(spring) && surface.contains(spring))
        );
        assert!(!contact.is_empty() && springs > 60);
    }
}

#[test]
fn the_text_is_the_screen_without_the_prompt() {
    for marker in [Marker::Braille, Marker::Ascii] {
        let mut driver = pressed("c L d Shift+Left j");
        driver.app.view.appearance.marker = marker;
        driver.app.view.appearance.colours = Colours::Plain;
        driver.perform(vec![Task::Ask]);
        let seen = asperity_plot::screen_text(&driver.screen());
        let written = exported(&mut driver, "a.txt");
        assert_eq!(written, seen);
        assert!(written.contains("Force F (") && !written.contains("Export to"));
        assert_eq!(written.lines().count(), 40);
        assert_eq!(marker == Marker::Ascii, written.is_ascii());
    }
}

/// Each result is an object that begins with the version, the command and the scene.
fn is_exported_as_json(driver: &mut Driver) {
    let json: serde_json::Value = serde_json::from_str(&exported(driver, "a.json")).unwrap();
    for entry in ["program", "command", "scene"] {
        assert!(
            json.get(entry).is_some(),
            "{:?}: {entry}: {json}",
            driver.app.view.pane
        );
    }
    assert_eq!(json["scene"]["version"], 1, "{:?}", driver.app.view.pane);
}

#[test]
fn every_pane_is_exported_as_a_figure() {
    for (keys, pane, expected) in [
        (
            "",
            Pane::Parameters,
            ["loading", "unloading", "preload", "pull-off"].as_slice(),
        ),
        (
            "",
            Pane::Profile,
            &["surface", "profile", "pressed", "pulled", "(nm)"],
        ),
        ("", Pane::CloseUp, &["surface", "patch end"]),
        ("Q", Pane::Spectrum, &["wave number"]),
        ("c L", Pane::Force, &["H 0.7", "loading"]),
    ] {
        let mut driver = pressed(keys);
        driver.app.view.pane = pane;
        let figure = exported(&mut driver, "a.svg");
        let document = roxmltree::Document::parse(&figure).unwrap();
        assert!(
            document
                .root_element()
                .has_tag_name(("http://www.w3.org/2000/svg", "svg"))
        );
        let text: String = document
            .descendants()
            .filter_map(|node| node.text())
            .collect();
        for expected in expected.iter().chain(&["Rough line"]) {
            assert!(text.contains(*expected), "{pane:?}: {expected}: {text}");
        }
        assert_eq!(exported(&mut driver, "a.svg"), figure, "{pane:?}");
    }
    let mut driver = computed_preloads(rough());
    driver.app.view.pane = Pane::Preloads;
    assert!(exported(&mut driver, "a.svg").contains("present preload"));
    // A table is that of the pane.
    let tables = [
        (
            computed_preloads(rough()),
            Pane::Preloads,
            "asperity run --preloads=-",
            "preload,pull_off_force,",
        ),
        (
            trust::measured(rough()),
            Pane::Trust,
            "asperity cost",
            "error,",
        ),
        (
            computed_sensitivity(rough()),
            Pane::Sensitivity,
            "asperity sensitivity",
            "path,value,",
        ),
        (
            map::mapped(rough()),
            Pane::Map,
            "asperity",
            "roughness.hurst,adhesion.kappa,profiles,regime,",
        ),
    ];
    for (mut driver, pane, command, column) in tables {
        driver.app.view.pane = pane;
        let table = exported(&mut driver, "a.csv");
        assert!(
            table.contains(command) && table.contains(column),
            "{pane:?}: {table}"
        );
        is_exported_as_json(&mut driver);
    }
    for pane in [
        Pane::Force,
        Pane::Parameters,
        Pane::Profile,
        Pane::CloseUp,
        Pane::Spectrum,
    ] {
        let mut driver = pressed(if pane == Pane::Spectrum { "Q" } else { "" });
        driver.app.view.pane = pane;
        is_exported_as_json(&mut driver);
    }
    is_exported_as_json(&mut pressed("d Shift+Left"));
    let mut driver = pressed("");
    driver.app.view.pane = Pane::Spectrum;
    export(&mut driver, Path::new("a.svg"));
    driver.states("nothing yet to export");
    assert!(driver.files().is_empty());
    let folder = tempfile::tempdir().unwrap();
    driver.app.view.pane = Pane::Force;
    export(&mut driver, &folder.path().join("a.png"));
    assert!(
        fs::read(folder.path().join("a.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
}

#[test]
fn a_name_with_control_characters_is_not_copied() {
    let text = presets()[0].text;
    let document = Document::parse(text, "a\u{1b}]0;b\u{7}\nc.ron").unwrap();
    let mut driver = Driver::start(document);
    assert_eq!(driver.press("y"), []);
    assert!(
        driver
            .status()
            .starts_with("! not copied: control characters"),
        "{}",
        driver.status()
    );
}

#[test]
fn a_saved_scene_goes_on_under_its_new_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("it's mine.ron");
    let mut driver = pressed(&format!("l s Ctrl+u `{}` Enter", path.display()));
    assert_eq!(driver.document().name(), path.display().to_string());
    assert!(!driver.app.edit.is_unsaved());
    // The command opens the file, without options for the saved changes.
    driver.press("y");
    assert_eq!(
        driver.copied,
        [command_line("asperity", &path.display().to_string(), &[])]
    );
    driver.press("l y");
    assert!(
        driver.copied[1].ends_with(" --set roughness.hurst=0.72"),
        "{}",
        driver.copied[1]
    );
    // At the next save the name is proposed, with a question.
    driver.answers("s Enter", "Overwrite it?");
    driver.press("y");
    assert_eq!(fs::read_to_string(&path).unwrap(), driver.document().text());
    // Another explorer saves its own version in the meantime.
    fs::write(&path, "theirs").unwrap();
    driver.answers(
        "s Enter",
        "was changed by another program since it was opened. Overwrite it?",
    );
    driver.press("n");
    assert_eq!(fs::read_to_string(&path).unwrap(), "theirs");
    driver.press("q");
    assert!(driver.app.finished);
}

#[test]
fn a_figure_has_the_typed_width_and_the_last_kind_is_proposed() {
    let mut driver = pressed("");
    let typed = |driver: &Driver| driver.app.prompt.as_ref().unwrap().line.text().to_owned();
    // 85 mm are 321.26 px of 1/96 inch.
    for (name, file) in [
        ("loop.svg 85mm", "loop.svg"),
        ("other.svg 85 mm", "other.svg"),
        ("a loop.svg 8.5cm", "a loop.svg"),
    ] {
        driver.press(&format!("E Ctrl+u `{name}` Enter"));
        driver.states(format!("exported to {file}"));
        let svg = driver.file(file);
        assert!(svg.contains("width=\"321"), "{name}: {}", &svg[..300]);
    }
    driver.press("E");
    assert_eq!(typed(&driver), "rough-line-force.svg 85mm");
    driver.press("Ctrl+u `whole.svg` Enter");
    assert!(!driver.file("whole.svg").contains("width=\"321"));
    driver.press("E");
    assert_eq!(typed(&driver), "rough-line-force.svg");
    driver.press("Ctrl+u `t.csv` Enter E");
    assert_eq!(typed(&driver), "rough-line-force.csv");
    // A number without a unit belongs to the name.
    driver.press("Ctrl+u `figure 2` Enter");
    assert!(
        driver
            .refusal()
            .is_some_and(|why| why.contains("the extension chooses"))
    );
    for (name, why) in [
        ("t.csv 85mm", "a .csv file has no width"),
        ("t.svg 10mm", "allowed: from 50mm to 500mm"),
        ("t.svg 2m", "allowed: from 50mm to 500mm"),
    ] {
        driver.press(&format!("Ctrl+u `{name}` Enter"));
        assert!(
            driver.refusal().is_some_and(|said| said.contains(why)),
            "{name}"
        );
    }
    // After a question whether to overwrite the file, the width is the same.
    driver.press("Ctrl+u `whole.svg 85mm` Enter y");
    assert!(driver.file("whole.svg").contains("width=\"321"));
}

#[test]
fn curves_of_a_comparison_are_named_by_what_differs() {
    let mut driver = pressed("");
    driver.set("material.youngs_modulus", "1.2 MPa");
    driver.press("c");
    driver.set("roughness.rms_height", "180 nm");
    driver.press("c");
    driver.set("material.youngs_modulus", "2.4 MPa");
    driver.press("E Ctrl+u `c.svg` Enter");
    let svg = driver.file("c.svg");
    let text: String = svg
        .split('<')
        .filter_map(|part| part.split_once('>'))
        .map(|(_, text)| text)
        .collect();
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let places: Vec<_> = [
        "E 2.4 MPa, h 180 nm",
        "E 1.2 MPa, h 200 nm",
        "E 1.2 MPa, h 180 nm",
    ]
    .map(|name| text.find(name).unwrap_or_else(|| panic!("{name}: {text}")))
    .to_vec();
    // The present scene comes first, with the solid curve.
    assert!(places[0] < places[1], "{text}");
}
