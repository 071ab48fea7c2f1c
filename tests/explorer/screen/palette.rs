//! The list of all commands, and completed paths.

use super::common::driver::Driver;
use super::common::scenes::rough;
use super::{mid_retraction, pressed};
use asperity::explorer::commands::table::bindings;
use asperity::explorer::keys::bindings::Context;
use asperity::explorer::pane::Pane;
use std::fs;

/// Opens the list and types a query.
fn query(driver: &mut Driver, text: &str) {
    driver.press(":");
    driver.type_text(text);
}

#[test]
fn every_command_is_in_the_list_with_its_keys() {
    let mut driver = pressed("");
    driver.resize((120, 200));
    driver.press(":");
    let rows = driver.rows();
    let exploring = [Context::Explore, Context::Map, Context::Parameters];
    let mut listed = 0;
    for binding in bindings().rows() {
        let row = binding.row;
        let is_elsewhere = !row.contexts.iter().any(|context| exploring.contains(context));
        if is_elsewhere || ["start-value", "start-sign", "open-palette"].contains(&row.name) {
            continue;
        }
        // The start of a long description.
        let help: String = row.help.chars().take(60).collect();
        let names = binding.names();
        let is_listed = |line: &String| line.contains(&help) && line.contains(&names);
        assert!(rows.iter().any(is_listed), "{names}: {help}\n{}", rows.join("\n"));
        listed += 1;
    }
    assert!(driver.text().contains(&format!("of {listed}")), "{listed}\n{}", driver.text());
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
            assert!(by_list.text().contains("nothing fits"), "{}", by_list.text());
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
        driver.press("Tab");
        assert!(driver.status().contains("no file or folder"), "{}", driver.status());
    }
}
