//! The tour of README.md, key by key: each key that it names is pressed, and each number that it
//! states is on the screen.

use super::*;
use asperity::data::format_rounded;
use asperity::explorer::commands::target::Sought;
use asperity::explorer::prompt::Purpose;
use asperity::study::Ensemble;

/// A key or a typed text of the tour, and the words after it up to the next one.
struct Token {
    text: String,
    after: String,
}

/// The text of a numbered step of the tour, on one line.
fn step(number: usize) -> String {
    let readme = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let (_, tour) = readme
        .split_once("## A tour of one minute")
        .expect("the tour");
    let (tour, _) = tour.split_once("\n![").expect("a figure after the tour");
    let (_, begin) = tour.split_once(&format!("\n{number}. ")).expect("the step");
    let (step, _) = begin
        .split_once(&format!("\n{}. ", number + 1))
        .unwrap_or((begin, ""));
    step.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The keys and texts between grave accents.
fn tokens(step: &str) -> Vec<Token> {
    let parts: Vec<&str> = step.split('`').collect();
    assert!(parts.len() % 2 == 1, "accents come in pairs: {step}");
    let pairs = parts[1..].chunks(2);
    pairs
        .map(|pair| Token {
            text: pair[0].to_owned(),
            after: pair[1].to_owned(),
        })
        .collect()
}

/// Presses the key of a token as often as the words after it say.
fn press(driver: &mut Driver, token: &Token) {
    let arrows = [("→", "Right"), ("←", "Left"), ("↓", "Down"), ("↑", "Up")];
    let arrow = arrows.iter().find(|(arrow, _)| *arrow == token.text);
    let key = arrow.map_or(token.text.as_str(), |(_, name)| name);
    let times = ["once", "twice", "three times", "four times"];
    let times = times
        .iter()
        .position(|times| token.after.trim_start().starts_with(times))
        .map_or(1, |at| at + 1);
    for _ in 0..times {
        driver.press(key);
    }
}

/// The words between two others.
#[track_caller]
fn between<'t>(text: &'t str, before: &str, after: &str) -> &'t str {
    let (_, rest) = text
        .split_once(before)
        .unwrap_or_else(|| panic!("no {before:?} in {text}"));
    let (found, _) = rest
        .split_once(after)
        .unwrap_or_else(|| panic!("no {after:?} in {rest}"));
    found
}

/// Pull-off force of the shown profile with this number of digits.
fn pull_off(driver: &Driver, digits: usize) -> String {
    format_rounded(
        driver.outcome().figures.pull_off_force.expect("a pull-off"),
        digits,
        "N",
    )
}

fn opened() -> Driver {
    let performs = |study: &Study| study.is::<Sought>() || study.is::<Ensemble>();
    let mut driver = Driver::open_with(default_scene(), Simulation::run, performs);
    driver.perform(vec![Task::Ask]);
    driver
}

/// Performs the first step: the question, its answer, and its acceptance.
fn asked() -> Driver {
    let mut driver = opened();
    let text = step(1);
    let keys = tokens(&text);
    let names: Vec<&str> = keys.iter().map(|token| token.text.as_str()).collect();
    assert_eq!(names, ["/", "loading", "Enter", "f", "20", "Enter"]);
    press(&mut driver, &keys[0]);
    driver.type_text(&keys[1].text);
    press(&mut driver, &keys[2]);
    press(&mut driver, &keys[3]);
    // "and type `20`", which replaces the text that the prompt proposes.
    assert!(keys[3].after.contains("type"), "{}", keys[3].after);
    driver.type_text(names[4]);
    let median = between(&text, "The answer is ", ", the median");
    let quartiles = between(&text, "with quartiles from ", ". `Enter`");
    let unit = median.split_once(' ').expect("a unit").1;
    let quartiles = quartiles.trim_end_matches(unit).trim_end();
    driver.shows(format!("{median} ({quartiles})"));
    let profiles = between(&text, "the median of ", " random profiles");
    assert_eq!(driver.app.edit.profiles.to_string(), profiles);
    press(&mut driver, &keys[5]);
    driver
}

#[test]
fn the_first_step_finds_the_preload() {
    let driver = asked();
    assert!(driver.app.prompt.is_none(), "{}", driver.text());
    let share = format!("which preload gives {} of F_a,max", "20 %");
    assert!(step(1).to_lowercase().contains(&share.to_lowercase()));
    let force = between(&step(1), "The answer is ", ", the median").to_owned();
    driver.shows(force);
    let stage = driver
        .app
        .edit
        .parameter()
        .and_then(|parameter| parameter.stage);
    assert_eq!(
        stage,
        Some(0),
        "the force of stage 1 is selected: {}",
        driver.text()
    );
}

#[test]
fn the_second_step_presses_until_patches_merge() {
    let mut driver = asked();
    let text = step(2);
    let keys = tokens(&text);
    let names: Vec<&str> = keys.iter().map(|token| token.text.as_str()).collect();
    assert_eq!(names, ["u", "c", "→", "Enter", "2.5 MPa", "10 µm"]);
    press(&mut driver, &keys[0]);
    assert!(!driver.app.edit.is_unsaved(), "u undoes the first step");
    press(&mut driver, &keys[1]);
    assert_eq!(driver.app.ghosts.len(), 1);
    let range = between(&text, "of this profile from ", ", because");
    let (before, after) = range.split_once(" to ").expect("two forces");
    let unit = after.split_whitespace().last().expect("a unit");
    let before = format!("{before} {unit}");
    assert_eq!(pull_off(&driver, 2), before);
    let mut seen = Vec::new();
    assert!(
        keys[2].after.starts_with(" three times"),
        "{}",
        keys[2].after
    );
    for _ in 0..3 {
        driver.press("Right");
        seen.push(pull_off(&driver, 2));
    }
    assert!(text.contains("The first two steps change nothing here. The third step raises"));
    assert_eq!(seen, [before.clone(), before, after.to_owned()]);
    let stages = &driver.document().scene().loading;
    assert_eq!(stages.len(), 2);
    assert_eq!(
        stages[1],
        asperity::contact::Move::ToSeparation,
        "the bodies are still separated at the end"
    );
    // `Enter` opens the editor of a value.
    press(&mut driver, &keys[3]);
    assert!(matches!(
        driver.app.prompt.as_ref().map(|prompt| &prompt.purpose),
        Some(Purpose::Value)
    ));
    driver.press("Esc");
    for (path, typed) in [("material.youngs_modulus", names[4]), ("length", names[5])] {
        driver.set(path, typed);
        assert_eq!(driver.refusal(), None, "{typed}");
    }
}

#[test]
fn the_third_step_names_keys_that_do_what_it_says() {
    let text = step(3);
    let keys = tokens(&text);
    let names: Vec<&str> = keys.iter().map(|token| token.text.as_str()).collect();
    assert_eq!(
        names,
        ["E", ".pdf", ".svg", ".png", "s", "y", ":", "?", "q"]
    );
    let mut driver = opened();
    for extension in &names[1..4] {
        press(&mut driver, &keys[0]);
        driver.press(&format!("Ctrl+u `loop{extension}` Enter"));
        driver.states("exported to");
    }
    press(&mut driver, &keys[4]);
    driver.press("Ctrl+u `tour` Enter");
    driver.states("saved to tour.ron");
    press(&mut driver, &keys[5]);
    assert_eq!(driver.copied, ["asperity tour.ron"]);
    for (key, shown) in [(&keys[6], "Commands, "), (&keys[7], "What you see")] {
        press(&mut driver, key);
        driver.shows(shown);
        driver.press("Esc");
    }
    press(&mut driver, &keys[8]);
    assert!(driver.app.finished);
}
