//! Around the panes: title, status, footer; and the help.

use super::*;
use asperity::data::format_rounded;

#[test]
fn the_headline_is_that_of_the_computed_curve() {
    for document in [default_scene(), rough(), smooth(), punch()] {
        let mut driver = mid_retraction(document);
        let outcome = driver.outcome().clone();
        let force = format_rounded(outcome.figures.adhesion_force.unwrap(), 3, "N");
        for size in &SIZES[..4] {
            driver.resize(*size);
            assert!(
                driver.text().contains(&format!("F_a {force}")),
                "{size:?}: {}",
                driver.text()
            );
        }
        let point = driver.point();
        let present = ["d", "F"]
            .into_iter()
            .zip([(point.indentation, "m"), (point.force, "N")]);
        for (symbol, (value, unit)) in present {
            let present = format!("{symbol} {}", format_rounded(value, 3, unit));
            driver.resize(SIZES[0]);
            driver.shows(present);
        }
        driver.resize(SIZES[0]);
        driver.shows(outcome.regime.unwrap().name());
    }
}

/// A stage to zero force ends there but for rounding.
#[test]
fn a_rounding_error_is_a_force_of_zero() {
    let mut driver = Driver::start(changed(
        &rough(),
        &[("loading", "[ToForce(1e-5), ToForce(0), ToTouch]")],
    ));
    driver.press("> >");
    let force = driver.point().force;
    driver.resize((240, 40));
    assert!(
        force != 0.0 && driver.text().contains(" F 0 N"),
        "{force:e}: {}",
        driver.text()
    );
    driver.shows("p_m 0 Pa");
}

/// A mistake in the configuration file is stated before what the session found, and neither hides
/// the other.
#[test]
fn notices_at_the_start_stand_beside_each_other() {
    let [warning, offer] =
        ["config.ron:3:1: speed", "unsaved changes are kept"].map(|text| Some(text.to_owned()));
    for (notice, warning, offer, shown) in [
        (None, &None, &None, ""),
        (None, &None, &offer, "unsaved changes are kept"),
        (
            Some("loaded"),
            &warning,
            &offer,
            "! config.ron:3:1: speed · loaded · unsaved changes are kept",
        ),
        (None, &warning, &None, "! config.ron:3:1: speed"),
    ] {
        let mut driver = mid_retraction(rough());
        driver.app.message = notice.map(|notice| Message::Done(notice.to_owned()));
        driver.app.state_beside(warning.clone(), offer.clone());
        assert_eq!(driver.app.message.is_some(), !shown.is_empty());
        driver.states(shown);
    }
}

#[test]
fn the_help_lists_every_binding() {
    let mut driver = pressed("?");
    driver.resize((120, 500));
    let lines = driver.rows();
    for binding in bindings().rows() {
        let (row, keys) = (binding.row, binding.names());
        // Many keys have a row of their own above their help.
        let listed = lines
            .windows(2)
            .any(|pair| pair[1].contains(row.help) && pair.concat().contains(&keys));
        assert!(listed, "{keys:?}: {}\n{}", row.help, lines.join("\n"));
        assert!(
            lines.iter().any(|line| line.contains(row.section)),
            "{}",
            row.section
        );
    }
}

#[test]
fn the_help_pages_to_its_ends_and_is_searched() {
    let mut driver = pressed("?");
    let top = driver.text();
    driver.press("k PageUp");
    assert_eq!(driver.text(), top);
    driver.press("PageDown PageDown");
    driver.hides("What you see");
    driver.press("End");
    let end = driver.text();
    assert!(end.contains("quit without saving"), "{end}");
    driver.press("j PageDown");
    assert_eq!(driver.text(), end);
    driver.press("Home");
    assert_eq!(driver.text(), top);
    driver.press("/ `dissipated energy`");
    let text = driver.text();
    assert!(
        text.contains("Find: dissipated energy") && text.contains("area of the loop"),
        "{text}"
    );
    assert!(!text.contains("quit without saving"), "{text}");
    // The search is over, its results stay, and a letter is a key again.
    driver.press("Enter j");
    let text = driver.text();
    assert!(
        text.contains("area of the loop") && !text.contains("dissipated energyj"),
        "{text}"
    );
    driver.press("End Home PageDown Esc");
    assert!(driver.app.prompt.is_none());
}
