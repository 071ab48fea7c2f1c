//! Loops kept as ghosts beside the present one.

use super::*;
use asperity::explorer::ghost::Ghost;

/// The scenes of the ghosts, the newest last.
fn kept(driver: &Driver) -> Vec<Document> {
    driver
        .app
        .ghosts
        .iter()
        .map(|ghost| ghost.document.clone())
        .collect()
}

fn message(driver: &Driver) -> String {
    match &driver.app.message {
        Some(Message::Done(text) | Message::Error(text) | Message::Refused(text)) => text.clone(),
        Some(Message::Taken { name, .. }) => name.clone(),
        None => String::new(),
    }
}

#[test]
fn ghosts_have_letters_and_say_where_they_differ() {
    let mut driver = pressed("c");
    assert!(message(&driver).contains("x swaps"), "{}", message(&driver));
    driver.shows("· the same scene");
    driver.press("L");
    driver.shows_all(["A: F_a ", "· H 0.7"]);
    driver.press("c");
    driver.set("adhesion.kappa", "4");
    driver.select("loading");
    driver.press("j");
    driver.enter("10 µN");
    let text = driver.text();
    for expected in ["· H 0.7, κ 8", "· κ 8, stage 1"] {
        assert!(text.contains(expected), "{expected}\n{text}");
    }
    driver.set("loading", "[ToForce(1.0e-5), ToIndentation(0.0)]");
    let text = driver.text();
    assert!(text.contains("· κ 8, loading "), "{text}");
    driver.press("u");
    // The letters are in the plot too.
    driver.press("z");
    let plot = driver.rows()[5..36].join("\n");
    for letter in ['A', 'B'] {
        assert_eq!(
            plot.matches(letter).count(),
            1,
            "{letter}\n{}",
            driver.text()
        );
    }
    driver.press("C");
    assert!(driver.app.ghosts.is_empty());
    driver.hides("κ 8");
}

#[test]
fn one_loop_is_kept_once_and_four_at_most() {
    let mut driver = pressed("c c");
    assert_eq!(driver.app.ghosts.len(), 1);
    assert!(
        message(&driver).contains("kept already"),
        "{}",
        message(&driver)
    );
    // Also after another scene in between.
    driver.press("l c h c");
    assert_eq!(driver.app.ghosts.len(), 2);
    driver.press("C");
    let mut scenes = Vec::new();
    for _ in 0..6 {
        driver.press("l c");
        scenes.push(driver.document().clone());
    }
    assert_eq!(kept(&driver), scenes[2..], "the oldest are dropped");
}

#[test]
fn two_exchanges_are_none() {
    let mut driver = pressed("c L");
    driver.select("adhesion.kappa");
    driver.press("c L L");
    let (document, ghosts, computed) = (
        driver.document().clone(),
        kept(&driver),
        driver.outcome().clone(),
    );
    driver.press("x");
    assert_eq!(*driver.document(), ghosts[1]);
    assert_eq!(kept(&driver), [ghosts[0].clone(), document.clone()]);
    assert!(is_up_to_date(&driver.app));
    assert_ne!(driver.outcome().history, computed.history);
    driver.press("x");
    assert_eq!(*driver.document(), document);
    assert_eq!(kept(&driver), ghosts);
    assert_eq!(driver.outcome().history, computed.history);
    // An exchange is undone like any other edit, and the ghosts remain.
    driver.press("x u");
    assert_eq!(*driver.document(), document);
    assert_eq!(driver.outcome().history, computed.history);
    assert_eq!(driver.app.ghosts.len(), 2);
    driver.press("U");
    assert_eq!(*driver.document(), ghosts[1]);
}

#[test]
fn a_scene_without_a_loop_is_not_kept() {
    let mut driver = Driver::open(rough());
    driver.answers("c", "no curve yet");
    assert!(driver.app.ghosts.is_empty());
    let mut driver = pressed("");
    driver.set("loading", "[ToForce(2.0e-5), ToForce(-1.0)]");
    driver.press("c");
    assert!(
        driver.app.ghosts.is_empty(),
        "a scene that failed has no loop"
    );
}

#[test]
fn a_scene_is_opened_with_the_loop_of_another_one() {
    let other = rough().set("adhesion.kappa", "4").unwrap();
    let outcome = Driver::start(other.clone()).outcome().clone().into();
    let ghost = Some(Ghost {
        document: other.clone(),
        outcome,
    });
    let mut driver = Driver::start(Opening {
        ghost,
        ..Opening::from(rough())
    });
    assert!(!driver.app.edit.is_unsaved() && driver.app.edit.past.is_empty());
    driver.shows_all(["A: F_a ", "· κ 4"]);
    driver.press("x");
    assert_eq!(
        (driver.document().text(), kept(&driver)),
        (other.text(), vec![rough()])
    );
}
