//! Around the panes: title, status, footer; and the help.

use super::common::driver::Driver;
use super::common::scenes::{changed, punch, rough, smooth};
use super::{SIZES, default_scene, everywhere, mid_retraction, pressed};

use asperity::explorer::keys::{Context, bindings};
use asperity::scene::format_quantity;

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

/// The keys of the footer, each with its word.
fn footer(driver: &Driver) -> Vec<String> {
    driver.footer().split("  ").map(|one| one.trim().to_owned()).filter(|one| !one.is_empty()).collect()
}

#[test]
fn the_footer_shows_keys_of_the_table_that_are_valid_now() {
    for mut driver in everywhere() {
        let mode = driver.app.keys();
        let bindings = bindings();
        let labels: Vec<&str> =
            bindings.valid_in(mode).map(|one| one.row.label).filter(|label| !label.is_empty()).collect();
        let is_valid = |one: &String| {
            let ends = labels.iter().filter(|label| one.ends_with(&format!(" {label}")));
            let label = ends.max_by_key(|label| label.len());
            let Some(label) = label else { return false };
            let rows = bindings.valid_in(mode).filter(|one| one.row.label == *label);
            let names: Vec<String> =
                rows.flat_map(|row| row.keys.iter().map(|key| key.name.clone())).collect();
            one[..one.len() - label.len()].split_whitespace().all(|key| names.iter().any(|name| name == key))
        };
        for size in [(300, 40), (120, 40), (80, 24), (40, 12), (20, 6)] {
            driver.resize(size);
            // A long text takes the place of the keys.
            if driver.refusal().is_some() || driver.app.message.is_some() {
                continue;
            }
            let shown = footer(&driver);
            assert!(!shown.is_empty(), "{mode:?} {size:?}");
            assert!(shown.iter().all(is_valid), "{shown:?} {labels:?}");
            if matches!(mode, Context::Explore | Context::Map | Context::Parameters) {
                assert!(shown.iter().any(|one| one.contains("help")), "{size:?}: {shown:?}");
                assert!(shown.iter().any(|one| one.contains("quit")), "{size:?}: {shown:?}");
            }
        }
    }
}

#[test]
fn the_status_line_has_the_mechanics_of_the_contact() {
    let mut driver = mid_retraction(smooth());
    driver.resize((160, 40));
    let computed = driver.app.solved.clone().unwrap();
    let snapshot = driver.snapshot().clone();
    // A circle of the contact's radius: that of one patch, and of no more than half the diameter.
    let radius = 0.5 * snapshot.point.contact_length;
    assert!((snapshot.contact_radius / radius - 1.0).abs() < 1e-12, "{} {radius}", snapshot.contact_radius);
    let pressure = snapshot.point.force / (std::f64::consts::PI * radius * radius);
    let rounded = |value: f64| -> f64 { format!("{value:.1e}").parse().unwrap() };
    let energy = computed.outcome.figures.dissipated_energy.unwrap();
    let edges_in_place = computed.outcome.governing.effective_modulus * snapshot.point.contact_length;
    for text in [
        format!("p_m {}", format_quantity(rounded(pressure), "Pa")),
        format!("ΔW {}", format_quantity(rounded(energy), "J")),
        format!("E*l {}", format_quantity(rounded(edges_in_place), "N/m")),
    ] {
        assert!(driver.status().contains(&text), "{text}: {}", driver.status());
    }
    driver.press("d {");
    assert!(driver.status().contains("springs changed"), "{}", driver.status());
    assert!(driver.status().contains("released "), "{}", driver.status());
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
fn the_help_scrolls_to_its_end_and_no_further() {
    let mut driver = pressed("");
    driver.resize((120, 100));
    driver.press("?");
    let top = driver.text();
    driver.press("k");
    assert_eq!(driver.text(), top);
    (0..120).for_each(|_| drop(driver.press("j")));
    let end = driver.text();
    assert!(end != top && end.contains("stay"), "{end}");
    driver.press("k");
    assert_ne!(driver.text(), end, "one step up is one step up");
    (0..120).for_each(|_| drop(driver.press("k")));
    assert_eq!(driver.text(), top);
    driver.press("Esc");
    assert!(driver.app.prompt.is_none());
}
