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
            by_list.shows("no command or row is called");
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
        ("minor loop", "press and pull by hand"),
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
        ("stiffness", "loading stiffness"),
        ("cantilever", "stiffness of the instrument"),
        ("spring constant", "stiffness of the instrument"),
        ("noise", "fit parameters of the scene"),
        ("save as pdf", "export the selected pane"),
        ("report", "export the selected pane"),
        ("dwell", "stages in their order"),
        ("surface energy", "energy per area that opens"),
        ("slope", "root mean square slope"),
        ("Sq", "root mean square height"),
        ("sensitivity", "±10 % of each number"),
        ("zoom", "show only the selected pane"),
        ("recent", "open a scene, a study"),
        ("measured surface", "open a scene, a study"),
        ("height histogram", "rigid"),
        ("tabor", "range of the attraction"),
        ("equilibrium", "exact solver, or equilibrium"),
        ("cite", "CITATION.cff"),
        ("version", "version 0"),
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
    driver.shows("no command or row is called qqqqqq; Esc and ? lists all keys");
    // A wrong guess would hide that nothing was found: none of these words is misspelt.
    for typed in ["speed", "faster", "latex", "quantum"] {
        driver.press(&format!("Ctrl+u `{typed}`"));
        assert!(
            !driver.text().contains(", for "),
            "{typed}\n{}",
            driver.text()
        );
    }
    // An unknown word is named, and the other words are searched.
    driver.press("Ctrl+u `colours of the qqqqqq`");
    driver.shows_all(["no command or row is called qqqqqq", "change the colours"]);
    driver.press("Enter");
    assert!(driver.app.prompt.is_none(), "the first row is a result");
}

#[test]
fn a_parameter_without_a_row_is_found_and_gets_one() {
    for open in ["/", ":"] {
        let mut driver = pressed("");
        let has_row = |driver: &Driver| driver.text().contains("loading stiffness k");
        assert!(!has_row(&driver));
        driver.press(open);
        driver.type_text("cantilever");
        driver.press("Enter");
        let selected = driver.app.edit.parameter().unwrap();
        assert_eq!(
            (selected.path.as_str(), selected.shown.as_str()),
            ("loading_stiffness", "none")
        );
        driver.enter("2 N/m");
        assert_eq!(driver.document().scene().loading_stiffness, Some(2.0));
        // The row stays after the edit and after its undo.
        driver.press("u");
        assert_eq!(
            driver.app.edit.parameter().unwrap().path,
            "loading_stiffness"
        );
    }
    // What is left out on leaving the search is not listed.
    let rows = pressed("").app.edit.parameters.len();
    let left = pressed("/ `cantilever` Esc");
    assert_eq!(left.app.edit.parameters.len(), rows);
}

#[test]
fn a_search_of_the_rows_names_what_it_does_not_find() {
    for (typed, said) in [
        ("qqqqqq", "no row and no command is called qqqqqq"),
        ("apex", "another scene may have form."),
        ("clipboard", "no row is called clipboard; key y"),
    ] {
        let mut driver = pressed("/");
        driver.type_text(typed);
        let text = driver
            .text()
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        assert!(
            said.split(' ').all(|word| text.contains(word)),
            "{typed}\n{}",
            driver.text()
        );
    }
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
