//! Around the panes: title, status, footer; and the help.

use super::common::driver::Driver;
use super::common::scenes::{changed, punch, rough, smooth};
use super::{SIZES, default_scene, mid_retraction, pressed};
use asperity::data::format_quantity;
use asperity::explorer::commands::table::bindings;

#[test]
fn an_unfinished_scene_says_that_it_computes() {
    let driver = Driver::open(rough());
    assert!(driver.text().contains("computing"), "{}", driver.text());
    // Later the old curve remains until the new one arrives.
    let mut driver = pressed("");
    let document = driver.app.edit.document.set("roughness.seed", "2").unwrap();
    let before = driver.text();
    driver.app.edit.document = document;
    driver.app.edit.generation += 1;
    driver.app.progress = Some(0);
    let text = driver.text();
    assert!(text.contains("computing") && !before.contains("computing"), "{text}");
    let curve = |text: &str| text.chars().filter(|c| ('\u{2801}'..='\u{28ff}').contains(c)).count();
    assert!(2 * curve(&text) > curve(&before), "{text}");
}

#[test]
fn the_headline_is_that_of_the_computed_curve() {
    for document in [default_scene(), rough(), smooth(), punch()] {
        let mut driver = mid_retraction(document);
        let outcome = driver.outcome().clone();
        let force = format_quantity(outcome.figures.adhesion_force.unwrap(), "N");
        for size in &SIZES[..4] {
            driver.resize(*size);
            assert!(driver.text().contains(&format!("F_a {force}")), "{size:?}: {}", driver.text());
        }
        let point = driver.point();
        let present =
            format!("d {} F {}", format_quantity(point.indentation, "m"), format_quantity(point.force, "N"));
        for size in [SIZES[0], (80, 24)] {
            driver.resize(size);
            assert!(driver.status().contains(&present), "{size:?} {present}: {}", driver.status());
        }
        driver.resize(SIZES[0]);
        assert!(driver.text().contains(outcome.regime.unwrap().name()), "{}", driver.text());
    }
}

/// A stage to zero force ends there but for rounding.
#[test]
fn a_rounding_error_is_a_force_of_zero() {
    let mut driver = Driver::start(changed(&rough(), &[("loading", "[ToForce(1e-5), ToForce(0), ToTouch]")]));
    driver.press("> >");
    let force = driver.point().force;
    assert!(force != 0.0 && driver.status().contains(" F 0 N"), "{force:e}: {}", driver.status());
}

#[test]
fn the_help_lists_every_binding() {
    let mut driver = pressed("?");
    driver.resize((120, 500));
    let lines = driver.rows();
    for binding in bindings().rows() {
        let (row, keys) = (binding.row, binding.names());
        let listed = lines.iter().any(|line| line.contains(row.help) && line.contains(&keys));
        assert!(listed, "{keys:?}: {}\n{}", row.help, lines.join("\n"));
        assert!(lines.iter().any(|line| line.contains(row.section)), "{}", row.section);
    }
}

#[test]
fn the_help_pages_to_its_ends_and_is_searched() {
    let mut driver = pressed("?");
    let top = driver.text();
    driver.press("k PageUp");
    assert_eq!(driver.text(), top);
    driver.press("PageDown PageDown");
    assert!(!driver.text().contains("What you see"), "{}", driver.text());
    driver.press("End");
    let end = driver.text();
    assert!(end.contains("quit without saving"), "{end}");
    driver.press("j PageDown");
    assert_eq!(driver.text(), end);
    driver.press("Home");
    assert_eq!(driver.text(), top);
    driver.press("/");
    driver.type_text("dissipated energy");
    let text = driver.text();
    assert!(text.contains("Find: dissipated energy") && text.contains("shade the area"), "{text}");
    assert!(!text.contains("quit without saving"), "{text}");
    driver.press("Enter");
    assert!(driver.text().contains("shade the area") && driver.app.prompt.is_some(), "{}", driver.text());
    driver.press("End Home PageDown Esc");
    assert!(driver.app.prompt.is_none());
}
