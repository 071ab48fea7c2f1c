//! The list of all commands, and completed paths.

use super::*;

/// Opens the list and types a query.
fn query(driver: &mut Driver, text: &str) {
    driver.press(":");
    driver.type_text(text);
}

#[test]
fn a_command_is_found_by_words_and_runs_as_its_key_does() {
    for (typed, keys) in [
        ("normalised units", "N"),
        ("next patch", "n"),
        ("undo", "u"),
        ("swap", "x"),
        ("separation", "S"),
        ("no such thing", ""),
    ] {
        let (mut by_list, mut by_key) = (pressed("l"), pressed("l"));
        query(&mut by_list, typed);
        if keys.is_empty() {
            // No command has all these words.
            by_list.shows("nothing fits");
            continue;
        }
        by_list.press("Enter");
        by_key.press(keys);
        assert_eq!(by_list.text(), by_key.text(), "{typed}");
    }
    // Commands of another pane select this pane first.
    let mut driver = pressed("");
    query(&mut driver, "another quantity");
    driver.press("Enter");
    assert!(driver.app.is_shown(Pane::Map));
    assert_eq!(driver.app.view.pane, Pane::Map);
    let mut driver = mid_retraction(rough());
    query(&mut driver, "switch effect");
    driver.press("Enter");
    assert!(driver.app.edit.is_unsaved(), "{}", driver.text());
}

#[test]
fn everyday_words_find_commands_parameters_and_scenes() {
    for (typed, found) in [
        ("theme", "change the colours"),
        ("spectrum", "show spectra"),
        ("spread", "show adhesion against preload"),
        ("minor loop", "begin manual loading"),
        ("hysteresis", "plot force"),
        ("roughness", "rms height"),
        ("work of adhesion", "work of adhesion"),
        ("title", "title"),
        ("normalised", "forces in units of F_a,max"),
        ("normalize", "forces in units of F_a,max"),
        ("accuracy", "how far F_a can be trusted"),
        ("young", "Young's modulus"),
        ("kappa", "roughness-adhesion parameter"),
        ("jkr-sphere", "Johnson, Kendall and Roberts"),
        ("which preload", "for a target"),
    ] {
        let mut driver = pressed("");
        query(&mut driver, typed);
        driver.shows(found);
    }
    // An entry for a parameter goes to the parameter, one for a scene opens the scene.
    let mut driver = pressed("");
    query(&mut driver, "hurst");
    driver.press("Enter");
    assert_eq!(driver.app.edit.parameter().unwrap().path, "roughness.hurst");
    assert_eq!(driver.app.view.pane, Pane::Parameters);
    query(&mut driver, "jkr-sphere");
    driver.press("Enter");
    assert_eq!(driver.document().name(), "jkr-sphere");
    // A misspelt word is answered with the nearest one.
    query(&mut driver, "hysterisis");
    driver.shows_all(["for hysteresis", "plot force"]);
    driver.press("Ctrl+u `qqqqqq`");
    driver.shows("nothing fits");
}

#[test]
fn a_path_is_completed() {
    let folder = tempfile::tempdir().unwrap();
    for file in ["alpha-one.ron", "alpha-two.ron", "beta.ron"] {
        fs::write(folder.path().join(file), "").unwrap();
    }
    fs::create_dir(folder.path().join("results")).unwrap();
    for open in ["s", "E", "o"] {
        for (start, completed, footer) in [
            ("al", "alpha-", "alpha-one.ron  alpha-two.ron"),
            // A single candidate needs no list.
            ("alpha-o", "alpha-one.ron", "cancel"),
            ("re", "results/", "cancel"),
            // The prompt is there, since the refusal takes its row.
            ("zzz", "zzz", "zzz"),
        ] {
            let base = format!("{}/", folder.path().display());
            let driver = pressed(&format!("{open} Ctrl+u `{base}{start}` Tab"));
            let typed = driver.app.prompt.as_ref().unwrap().line.text().to_owned();
            assert_eq!(typed, format!("{base}{completed}"), "{open}");
            if start == "zzz" {
                driver.states("no file or folder");
            }
            assert!(
                driver.footer().contains(footer),
                "{open}: {}",
                driver.footer()
            );
        }
    }
}
