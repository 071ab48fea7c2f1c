//! Around the panes: title, status, footer; and the help.

use super::*;
use asperity::data::format_rounded;

#[test]
fn the_headline_is_that_of_the_computed_curve() {
    for document in [default_scene(), rough(), smooth(), punch()] {
        let mut driver = mid_retraction(document);
        let outcome = driver.outcome().clone();
        let force = format_rounded(outcome.figures.pull_off_force.unwrap(), 3, "N");
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

/// The status line, the title of the force curve and the results round a quantity in one way.
#[test]
fn a_quantity_has_the_same_digits_everywhere() {
    let mut driver = Driver::start(rough());
    driver.press("!");
    driver.resize((240, 45));
    let figures = driver.outcome().figures;
    let energy = format_rounded(figures.dissipated_energy.unwrap(), 3, "J");
    let text = driver.text();
    assert_eq!(text.matches(&format!("ΔW {energy}")).count(), 2, "{text}");
    assert!(text.contains(&format!("dissipated  {energy}")), "{text}");
    let share = driver.app.adhesion_share_in_words().unwrap();
    assert_eq!(text.matches(&share).count(), 3, "{text}");
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

/// An offer alone has the place of the footer until the next key, and the results stay visible.
#[test]
fn an_offer_hides_no_result() {
    let mut driver = mid_retraction(rough());
    let results = driver.app.message.clone();
    let offer = "asperity --restore opens the unsaved changes of a scene";
    driver.app.state_beside(None, Some(offer.to_owned()));
    assert_eq!(driver.app.message, results);
    assert_eq!(driver.rows().last().unwrap().trim_end(), offer);
    driver.press("Tab");
    driver.hides(offer);
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

#[test]
fn the_title_has_a_second_line_only_for_a_long_notice() {
    let top = |driver: &Driver| driver.area(Pane::Force).y;
    let long = "A notice. ".repeat(20);
    let mut driver = Driver::start(changed(&rough(), &[("notice", &format!("{long:?}"))]));
    driver.press("Space");
    let (first, rows) = (top(&driver), driver.rows());
    assert!(!rows[1].trim().is_empty(), "{rows:#?}");
    // After a change, the notice may be wrong and is hidden, but the panes keep their places.
    driver.set("roughness.hurst", "0.6");
    assert_eq!(top(&driver), first);
    assert!(driver.rows()[1].trim().is_empty(), "{}", driver.text());
    driver.set("notice", "A short notice.");
    assert_eq!(top(&driver), first - 1);
    assert!(driver.rows()[1].contains("Force"), "{}", driver.text());
}

#[test]
fn a_message_that_leaves_no_room_for_the_results_takes_the_row_of_the_keys() {
    let mut driver = pressed("");
    driver.resize((60, 20));
    let offer = "asperity --restore opens the unsaved changes of a scene";
    driver.app.message = Some(Message::Done(offer.to_owned()));
    let rows = driver.rows();
    let [message, results] = [&rows[rows.len() - 2], &rows[rows.len() - 1]];
    assert!(message.starts_with(offer), "{message}");
    assert!(results.starts_with("F_a 46.1 nN"), "{results}");
}
