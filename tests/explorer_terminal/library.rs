//! Scenes are chosen from the library: built-in ones, those of the user, those in the working folder.

use crate::common::deadline::within;
use crate::driving::{CLEAR_LINE, ENTER, ESCAPE, SCENE, answer, explorer, paused, quit};
use std::fs;
use std::path::Path;

/// Puts a scene of this title into the folder of the user's scenes.
fn own_scene(config: &Path, name: &str, title: &str) {
    let folder = config.join("asperity").join("presets");
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join(name), SCENE.replace("Rough line", title)).unwrap();
}

#[test]
fn a_scene_is_searched_looked_at_and_opened() {
    within(60, || {
        let (program, folder) = explorer();
        let config = folder.path().join("config");
        own_scene(&config, "tape.ron", "Sticky tape");
        fs::write(folder.path().join("broken.ron"), "(version: 1, lenght: 1)").unwrap();
        let mut terminal = paused(program.env("XDG_CONFIG_HOME", config.to_str().unwrap()));
        terminal.send("o");
        for listed in ["pressure-sensitive  built-in", "tape  own", "scene.ron  here", "! broken.ron  here"] {
            terminal.wait_for(listed);
        }
        // Letters are typed here, even those that are keys elsewhere.
        terminal.send("qdzz");
        terminal.wait_for("no scene fits");
        terminal.send(CLEAR_LINE);
        terminal.wait_for("jkr-sphere  built-in");
        terminal.send("tape");
        terminal.wait_for("› tape  own");
        terminal.wait_for("Sticky tape");
        terminal.send(ENTER);
        terminal.wait("scene", |rows| rows[0].starts_with("Sticky tape") && !rows[0].contains("[changed]"));

        terminal.send("o");
        terminal.wait_for("Search:");
        terminal.send("broken");
        terminal.wait_for("lenght");
        terminal.send(ENTER);
        terminal.wait("what is wrong with it", |rows| {
            rows[0].starts_with("Sticky tape") && rows.iter().any(|row| row.contains("! broken.ron"))
        });
        terminal.send("o");
        terminal.wait_for("Search:");
        terminal.send(ESCAPE);
        terminal.wait_without("Search:");
        // The keys have their usual meaning again.
        quit(&mut terminal);
    });
}

#[test]
fn what_was_saved_is_found_again() {
    within(60, || {
        let (program, folder) = explorer();
        let mut terminal = paused(program);
        terminal.send("s");
        answer(&mut terminal, "Save as: ", "kept.ron");
        terminal.wait_for("saved to kept.ron");
        terminal.send("3");
        terminal.wait("built-in scene", |rows| !rows[0].starts_with("Rough line"));
        terminal.send("o");
        terminal.wait_for("kept.ron  here");
        terminal.send("kept");
        terminal.wait_for("› kept.ron  here");
        terminal.send(ENTER);
        terminal.wait("saved scene", |rows| rows[0].starts_with("Rough line"));
        quit(&mut terminal);
        drop(folder);
    });
}

#[test]
fn an_own_scene_opens_by_its_name() {
    within(40, || {
        let folder = tempfile::tempdir().unwrap();
        own_scene(folder.path(), "tape.ron", "Sticky tape");
        let program = crate::common::terminal::Program::new(crate::driving::ASPERITY).argument("tape");
        let mut terminal = paused(program.env("XDG_CONFIG_HOME", folder.path().to_str().unwrap()));
        assert!(terminal.rows()[0].starts_with("Sticky tape"), "{}", terminal.text());
        quit(&mut terminal);
    });
}
