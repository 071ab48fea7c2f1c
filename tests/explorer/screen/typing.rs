//! Values while typed, accepted and refused.

use super::*;
use asperity::explorer::update::update;

#[test]
fn the_editor_opens_with_the_value_selected_and_keeps_what_is_refused() {
    let mut driver = pressed("");
    driver.select("length");
    driver.press("Enter");
    let row = |driver: &Driver| {
        driver
            .rows()
            .into_iter()
            .find(|row| row.contains('›'))
            .unwrap_or_default()
    };
    assert!(
        row(&driver).contains("apparent diameter L (µm): 100 µm"),
        "{}",
        row(&driver)
    );
    assert_eq!(reversed(&driver.screen().content), "100 µm");
    let before = driver.document().clone();
    driver.press("`10 kg` Enter");
    assert_eq!(
        (driver.document(), driver.app.keys()),
        (&before, Context::Line)
    );
    let refused = "kg is not a unit of length: use m, mm, µm, nm";
    driver.states(refused);
    let line = driver
        .rows()
        .into_iter()
        .find(|row| row.contains("10 kg"))
        .unwrap_or_default();
    assert!(line.contains('!'), "{line}");
    driver.press("Backspace");
    driver.hides("not a unit of length");
    driver.press("Backspace `mm` Enter");
    assert!(driver.app.prompt.is_none());
    assert_eq!(driver.document().scene().length, 0.01);
    // Neither the unchanged value nor leaving the editor changes the text.
    let text = driver.document().text().to_owned();
    for path in [
        "length",
        "roughness.rms_height",
        "material.youngs_modulus",
        "adhesion.work",
        "loading.0.0",
    ] {
        driver.select(path);
        driver.press("Enter Enter");
        assert_eq!(
            (driver.document().text(), driver.app.keys()),
            (&*text, Context::Explore)
        );
    }
}

#[test]
fn what_is_chosen_and_typed_is_seen_in_the_smallest_window() {
    for size in SIZES {
        for pane in ["", "Tab", "Tab Tab", "Tab Tab Tab"] {
            for zoom in ["", "z"] {
                let mut driver = pressed(pane);
                driver.resize(size);
                driver.press(zoom);
                driver.press("j");
                assert!(
                    driver.text().contains('›'),
                    "{size:?} {pane} {zoom}\n{}",
                    driver.text()
                );
                driver.press("Tab Enter Ctrl+u `31415`");
                assert!(
                    driver.text().contains("31415"),
                    "{size:?} {pane} {zoom}\n{}",
                    driver.text()
                );
            }
        }
    }
}

#[test]
fn the_cursor_of_what_is_typed_is_on_the_screen() {
    let long = "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToZeroForce, ToForce(3.0e-5), ToSeparation]";
    for size in SIZES {
        let mut driver = pressed("Tab Tab Tab Tab");
        driver.resize(size);
        driver.select("loading");
        driver.press("Enter Ctrl+u");
        driver.type_text(long);
        for keys in ["", "Home", "End", "Left Left Left"] {
            driver.press(keys);
            let screen = driver.screen();
            assert_eq!(
                reversed(&screen.content).chars().count(),
                1,
                "{size:?} {keys}\n{}",
                driver.text()
            );
        }
        driver.press("Esc s");
        driver.type_text(
            "/a/folder/with/a/name/that/is/longer/than/many/windows/are/wide/and/then/some/more.ron",
        );
        let screen = driver.screen();
        let status = Layout::of(&driver.app).status;
        let from = usize::from(status.y) * usize::from(status.width);
        let status = &screen.content[from..from + usize::from(status.width)];
        assert_eq!(
            reversed(status).chars().count(),
            1,
            "{size:?}\n{}",
            driver.text()
        );
    }
}

#[test]
fn a_number_alone_has_the_unit_of_its_row_and_the_row_says_so() {
    for size in [(120, 36), (80, 24), (40, 12)] {
        for (path, typed, reading, written) in [
            ("adhesion.work", "50", "50 mJ/m²", "(work: 0.05)"),
            ("length", "5", "5 µm", "5.0e-6"),
            ("roughness.rms_height", "4e2", "400 nm", "4.0e-7"),
            ("adhesion.work", "50m", "50 mJ/m²", "(work: 0.05)"),
            (
                "loading.0.0",
                "60",
                "60 µN",
                "[ToForce(6.0e-5), ToSeparation]",
            ),
            (
                "loading.1",
                "-2",
                "-2 µN",
                "[ToForce(2.0e-5), ToForce(-2.0e-6)]",
            ),
            ("loading.0.0", "indentation 20", "20 m", ""),
        ] {
            // The narrowest list has no room for a long text and its reading.
            if size.0 < 80 && typed.starts_with("indentation") {
                continue;
            }
            let scene = rough()
                .set_all(&[("adhesion".into(), "(work: 0.0044)".into())])
                .unwrap();
            let mut driver = Driver::start(scene);
            driver.resize(size);
            driver.select(path);
            driver.press("Enter");
            driver.type_text(typed);
            let line = driver
                .rows()
                .into_iter()
                .find(|row| row.contains('→'))
                .unwrap_or_default();
            assert!(
                line.contains(&format!("→ {reading}")),
                "{size:?} {path} {typed}\n{}",
                driver.text()
            );
            driver.press("Enter");
            let place = path
                .split('.')
                .take(if path.starts_with("rough") { 2 } else { 1 });
            let place = place.collect::<Vec<_>>().join(".");
            if written.is_empty() {
                assert!(
                    driver.refusal().is_some(),
                    "{path} {typed}: {}",
                    driver.status()
                );
            } else {
                assert_eq!(
                    driver.document().value(&place),
                    Some(written),
                    "{path} {typed}"
                );
            }
        }
    }
    // With its unit a value needs no reading, and a whole loading is in SI units as in a file.
    let mut driver = pressed("");
    driver.select("length");
    driver.press("Enter `50 µm`");
    assert!(!driver.text().contains('→'), "{}", driver.text());
    driver.press("Esc");
    driver.select("loading");
    driver.sees("Enter", "separation; a number without");
    driver.press("`2e-5, separation` Enter");
    assert_eq!(driver.document().scene().loading, rough().scene().loading);
    // A force of manual loading has the prefix of the loading.
    driver.press("d 1 0");
    assert!(
        driver.status().starts_with("Press or pull to (µN, nm): 10")
            && driver.status().contains("→ 10 µN"),
        "{}",
        driver.status()
    );
    driver.press("Enter");
    assert!(
        (driver.point().force - 1e-5).abs() < 1e-12,
        "{}",
        driver.point().force
    );
}

#[test]
fn digits_begin_a_value_wherever_the_list_can_be_edited() {
    let mut driver = pressed("Tab Tab Tab Tab");
    assert_eq!(driver.app.view.pane, Pane::Parameters);
    driver.press(". 6 5 Enter");
    assert_eq!(
        driver.document().value("roughness.hurst"),
        Some(".65"),
        "{}",
        driver.text()
    );
    driver.press("0");
    assert_eq!(
        driver.app.prompt.as_ref().map(|prompt| prompt.line.text()),
        Some("0")
    );
    driver.press(". 7 Enter");
    assert_eq!(
        driver.document().scene().roughness,
        rough().scene().roughness
    );
    driver.select("loading");
    driver.sees("j - 2", "F (µN): -2");
    driver.press("Esc");
    // In the panes whose arrows change the value as well, though `-` and `.` have another meaning
    // there.
    let before = driver.document().clone();
    driver.select("roughness.hurst");
    driver.press("Tab Tab Tab . - 0");
    assert_eq!(
        driver.app.prompt.as_ref().map(|prompt| prompt.line.text()),
        Some("0")
    );
    driver.press(". 6 Enter");
    assert_eq!(driver.document().value("roughness.hurst"), Some("0.6"));
    // The arrows of map and crosshair are not those of the list, and digits do nothing.
    driver.press("u * 5 * m 5");
    assert_eq!(
        (driver.document(), driver.app.prompt.is_none()),
        (&before, true)
    );
}

#[test]
fn a_value_that_is_typed_shows_its_curve_before_it_is_taken() {
    for size in [(120, 40), (80, 24)] {
        let mut driver = pressed("");
        driver.resize(size);
        driver.select("roughness.rms_height");
        let (document, computed) = (
            driver.document().clone(),
            driver.app.solved.clone().unwrap(),
        );
        let before = driver.text();
        driver.press("Enter");
        assert!(
            driver.app.tried_outcome().is_none(),
            "the value as it is needs no preview"
        );
        driver.type_text("300 nm");
        let tried = driver.app.tried_outcome().expect("a preview").figures;
        assert_ne!(
            tried.pull_off_force,
            computed.outcome.figures.pull_off_force
        );
        let alone = document.set("roughness.rms_height", "3.0e-7").unwrap();
        let alone = Driver::start(alone).app.solved.clone().unwrap();
        assert_eq!(tried, alone.outcome.figures);
        let force = format_quantity(tried.pull_off_force.unwrap(), "N");
        assert!(
            driver
                .status()
                .starts_with(&format!("preview: F_a {force}")),
            "{}",
            driver.status()
        );
        // The scene itself is unchanged, also after Esc.
        assert_eq!(
            (driver.document(), is_up_to_date(&driver.app)),
            (&document, true)
        );
        // A text that is no value has no preview.
        driver.type_text("kg");
        assert!(driver.app.tried_outcome().is_none() && driver.app.tried.is_none());
        driver.press("Backspace Backspace");
        assert!(driver.app.tried_outcome().is_some());
        let effects = driver.press("Esc");
        assert_eq!(
            (effects, driver.app.tried.is_none()),
            (vec![Task::Study], true)
        );
        assert_eq!(driver.text(), before);
        driver.press("Enter Ctrl+u `300 nm` Enter");
        assert_eq!(driver.outcome().figures, tried);
    }
}

#[test]
fn no_older_curve_is_shown_between_a_preview_and_the_next_one() {
    let mut driver = pressed("");
    driver.select("roughness.rms_height");
    driver.press("Enter Ctrl+u `300 nm`");
    let force = |driver: &Driver| {
        driver
            .app
            .tried_outcome()
            .and_then(|one| one.figures.pull_off_force)
    };
    let first = force(&driver).expect("a preview");
    // The next value is typed, and its curve is not there yet: the previous one remains.
    driver.press("Home Delete");
    let waiting = update(&mut driver.app, Action::Paste('4'.to_string()));
    assert_eq!(waiting, [Task::Study]);
    // "00 nm" is no allowed height, and has no curve.
    assert!(driver.status().starts_with("preview: computing…") || force(&driver).is_none());
    driver.perform(waiting);
    let second = force(&driver).expect("a preview");
    assert_ne!(first, second);
    assert!(
        !driver.status().contains("computing"),
        "{}",
        driver.status()
    );
    // After acceptance the curve remains until the scene itself is computed.
    let accepted = driver.update("accept");
    assert_eq!(accepted, [Task::Ask]);
    assert_eq!(
        (driver.app.is_computing(), force(&driver)),
        (true, Some(second))
    );
    driver.shows("preview");
    driver.perform(accepted);
    assert_eq!(driver.app.tried_outcome(), None);
    assert_eq!(driver.outcome().figures.pull_off_force, Some(second));
}

#[test]
fn a_width_is_appended_to_the_offered_name_of_a_figure() {
    let mut driver = Driver::start(rough());
    driver.press("E ` 85mm`");
    assert!(
        driver.text().contains("force.pdf 85mm"),
        "{}",
        driver.text()
    );
    driver.press("Esc E `mine.svg`");
    assert!(driver.text().contains(": mine.svg"), "{}", driver.text());
}

#[test]
fn an_undone_edit_leaves_the_row_of_the_keys() {
    let mut driver = Driver::start(rough());
    driver.resize((80, 24));
    driver.set("roughness.rms_height", "3e-7");
    driver.press("u");
    let rows = driver.rows();
    assert!(rows[22].contains("undo: "), "{}", rows[22]);
    assert!(rows[23].contains("? help"), "{}", rows[23]);
}
