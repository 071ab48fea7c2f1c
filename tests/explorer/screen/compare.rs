//! Loops kept as ghosts beside the present one.

use super::common::driver::Driver;
use super::common::scenes::rough;
use super::{is_up_to_date, pressed};
use asperity::explorer::Opening;
use asperity::explorer::app::{Message, Pane};
use asperity::scene::{Document, format_quantity};

/// The scenes of the ghosts, the newest last.
fn kept(driver: &Driver) -> Vec<Document> {
    driver.app.ghosts.iter().map(|ghost| ghost.document.clone()).collect()
}

fn message(driver: &Driver) -> String {
    match &driver.app.message {
        Some(Message::Done(text) | Message::Error(text) | Message::Refused(text)) => text.clone(),
        None => String::new(),
    }
}

#[test]
fn ghosts_have_letters_and_say_where_they_differ() {
    let mut driver = pressed("c");
    assert!(message(&driver).contains("x swaps"), "{}", message(&driver));
    assert!(driver.text().contains("· the same scene"), "{}", driver.text());
    driver.press("L");
    assert!(driver.text().contains("A: F_a ") && driver.text().contains("· H 0.7"), "{}", driver.text());
    driver.press("c");
    driver.select("adhesion.kappa");
    driver.enter("4");
    driver.select("loading");
    driver.press("j");
    driver.enter("10 µN");
    let text = driver.text();
    for expected in ["· H 0.7, κ 8", "· κ 8, stage 1"] {
        assert!(text.contains(expected), "{expected}\n{text}");
    }
    driver.select("loading");
    driver.enter("[ToForce(1.0e-5), ToIndentation(0.0)]");
    let text = driver.text();
    assert!(text.contains("· κ 8, loading "), "{text}");
    driver.press("u");
    // The letters are in the plot too.
    driver.press("z");
    let plot = driver.rows()[8..36].join("\n");
    for letter in ['A', 'B'] {
        assert_eq!(plot.matches(letter).count(), 1, "{letter}\n{}", driver.text());
    }
    driver.press("C");
    assert!(driver.app.ghosts.is_empty());
    assert!(!driver.text().contains("κ 8"), "{}", driver.text());
}

#[test]
fn one_loop_is_kept_once_and_four_at_most() {
    let mut driver = pressed("c c");
    assert_eq!(driver.app.ghosts.len(), 1);
    assert!(message(&driver).contains("kept already"), "{}", message(&driver));
    // Also after another scene in between.
    driver.press("l c h c");
    assert_eq!(driver.app.ghosts.len(), 2);
    driver.press("C");
    let mut scenes = Vec::new();
    for _ in 0..6 {
        driver.press("l c");
        scenes.push(driver.app.edit.document.clone());
    }
    assert_eq!(kept(&driver), scenes[2..], "the oldest are dropped");
    driver.screen();
}

#[test]
fn two_exchanges_are_none() {
    let mut driver = pressed("c L");
    driver.select("adhesion.kappa");
    driver.press("c L L");
    let (document, ghosts, computed) =
        (driver.app.edit.document.clone(), kept(&driver), driver.outcome().clone());
    driver.press("x");
    assert_eq!(driver.app.edit.document, ghosts[1]);
    assert_eq!(kept(&driver), [ghosts[0].clone(), document.clone()]);
    assert!(is_up_to_date(&driver.app));
    assert_ne!(driver.outcome().history, computed.history);
    driver.press("x");
    assert_eq!(driver.app.edit.document, document);
    assert_eq!(kept(&driver), ghosts);
    assert_eq!(driver.outcome().history, computed.history);
    // An exchange is undone like any other edit, and the ghosts remain.
    driver.press("x u");
    assert_eq!(driver.app.edit.document, document);
    assert_eq!(driver.outcome().history, computed.history);
    assert_eq!(driver.app.ghosts.len(), 2);
    driver.press("U");
    assert_eq!(driver.app.edit.document, ghosts[1]);
}

#[test]
fn what_cannot_be_kept_or_exchanged_says_why() {
    let mut driver = Driver::open(rough());
    driver.press("c");
    assert!(driver.app.ghosts.is_empty() && message(&driver).contains("no curve yet"));
    let mut driver = pressed("");
    let before = driver.app.edit.document.clone();
    driver.press("x");
    assert!(message(&driver).contains("no ghost to swap with"), "{}", message(&driver));
    assert_eq!(driver.app.edit.document, before);
    driver.select("loading");
    driver.enter("[ToForce(2.0e-5), ToForce(-1.0)]");
    driver.press("c");
    assert!(driver.app.ghosts.is_empty(), "a scene that failed has no loop");
}

/// The rows of the pane that holds the close-up or the scene beside.
fn lower_pane(driver: &Driver) -> Vec<String> {
    driver.pane(driver.app.view.lower)
}

/// Numbers on the scale beside a plot.
fn scale(rows: &[String]) -> Vec<String> {
    let number = |row: &String| Some(row.split_once(" ┤")?.0.trim_start_matches('│').trim().to_owned());
    rows.iter().filter_map(number).collect()
}

#[test]
fn two_scenes_are_shown_side_by_side() {
    for size in [(120, 40), (80, 24)] {
        let mut driver = pressed("&");
        driver.resize(size);
        assert_eq!(driver.app.ghosts.len(), 1, "the present scene is the one to compare with");
        let text = lower_pane(&driver).join("\n");
        assert!(text.contains("A → this scene: the same scene") && text.contains("ratio 1 "), "{text}");
        driver.press("L");
        let now = driver.snapshot().clone();
        let before = driver.app.ghosts[0].snapshot.clone().unwrap();
        let ghost = driver.app.ghosts[0].computed.outcome.clone();
        assert_eq!(before.line, ghost.line);
        assert_ne!(before.profile.columns, now.profile.columns);
        let pane = lower_pane(&driver);
        let [before, now] = [&ghost, driver.outcome()].map(|outcome| outcome.figures.adhesion_force.unwrap());
        let ratio: f64 = format!("{:.3e}", now / before).parse().unwrap();
        let written = |force: f64| format_quantity(force, "N");
        let forces = format!("F_a {} → {}, ratio {ratio}", written(before), written(now));
        assert!(pane.iter().any(|row| row.contains(&forces)), "{forces}\n{}", pane.join("\n"));
        assert!(pane.iter().any(|row| row.contains("A → this scene: H 0.7 → 0.8")), "{}", pane.join("\n"));
        assert!(pane[0].contains("Profile z(x) of A: Rough line"), "{}", pane[0]);
        // Both profiles have one scale, if the panes have one height.
        let [upper, lower] = [scale(&driver.pane(Pane::Profile)), scale(&pane)];
        assert!(!lower.is_empty(), "{}", driver.text());
        if size.0 == 120 {
            assert_eq!(upper.first(), lower.first(), "{}", driver.text());
        }
        driver.press("&");
        assert!(driver.pane(Pane::CloseUp)[0].contains("Contact patches"));
    }
}

#[test]
fn two_scenes_that_are_opened_are_shown_side_by_side() {
    let second = rough().set("adhesion.kappa", "4").unwrap().set("title", "\"Stickier\"").unwrap();
    let opening = Opening { beside: Some(second.clone()), ..Opening::from(rough()) };
    let mut driver = Driver::start(opening);
    let scenes: Vec<_> = kept(&driver).iter().map(|document| document.scene().clone()).collect();
    assert_eq!(scenes, [rough().scene().clone()]);
    assert_eq!(driver.app.edit.document.scene(), second.scene());
    assert!(!driver.app.edit.is_unsaved() && driver.app.edit.past.is_empty());
    let text = driver.text();
    assert!(text.contains("Stickier") && text.contains("A → this scene: κ 8 → 4"), "{text}");
    // After the exchange, the other scene is beside.
    driver.press("x");
    assert!(is_up_to_date(&driver.app));
    assert!(driver.text().contains("A → this scene: κ 4 → 8"), "{}", driver.text());
    // Another pane in its place hides the ghost.
    for keys in ["A", "m", "m", "D"] {
        driver.press(keys);
        driver.screen();
    }
    assert!(!driver.app.is_shown(Pane::Beside));
    driver.press("&");
    assert!(driver.app.is_shown(Pane::Beside));
    driver.press("C");
    assert!(!driver.app.is_shown(Pane::Beside));
}
