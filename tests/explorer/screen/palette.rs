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
        ("shade area", "a"),
        ("dissipated", "a"),
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
fn a_path_is_completed() {
    let folder = tempfile::tempdir().unwrap();
    for file in ["alpha-one.ron", "alpha-two.ron", "beta.ron"] {
        fs::write(folder.path().join(file), "").unwrap();
    }
    fs::create_dir(folder.path().join("results")).unwrap();
    let base = format!("{}/", folder.path().display());
    for open in ["s", "E", "o"] {
        let mut driver = pressed(open);
        let mut line = |text: &str, keys: &str| {
            if !text.is_empty() {
                driver.press("Ctrl+u");
                driver.type_text(text);
            }
            driver.press(keys);
            let typed = driver.app.prompt.as_ref().unwrap().line.text();
            (typed.trim_start_matches(&base).to_owned(), driver.footer())
        };
        let start = format!("{base}al");
        let (typed, shown) = line(&start, "Tab");
        assert_eq!(typed, "alpha-", "{open}");
        assert!(shown.contains("alpha-one.ron  alpha-two.ron"), "{open}: {shown}");
        assert_eq!(line("o", "Tab").0, "o", "a name alone is beside the working folder");
        let (typed, shown) = line(&format!("{base}alpha-o"), "Tab");
        assert_eq!(typed, "alpha-one.ron");
        assert!(shown.contains("cancel"), "a single candidate needs no list: {shown}");
        assert_eq!(line(&format!("{base}re"), "Tab").0, "results/");
        line(&format!("{base}zzz"), "Tab");
        let escaped = line("", "x").1;
        assert!(escaped.contains("cancel"), "{escaped}");
        driver.press("Ctrl+u");
        driver.type_text(&format!("{base}zzz"));
        driver.answers("Tab", "no file or folder");
    }
}
