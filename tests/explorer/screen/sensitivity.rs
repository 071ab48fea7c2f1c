//! The pane of sensitivities.

use super::*;
use asperity::study::Sensitivity;

/// The explorer with the sensitivities computed, and shown.
pub fn computed_sensitivity(document: Document) -> Driver {
    let few = changed(
        &document,
        &[("numerics.points", "512"), ("roughness.modes", "(8, 128)")],
    );
    let mut driver = Driver::open_with(few, Simulation::run, Study::is::<Sensitivity>);
    driver.perform(vec![Task::Ask]);
    driver.press("Space Y");
    driver
}

#[test]
fn bars_show_the_changes_and_the_table_has_them_all() {
    let mut driver = computed_sensitivity(rough());
    assert!(driver.app.is_shown(Pane::Sensitivity));
    driver.press("z");
    let text = driver.text();
    for words in [
        "Sensitivity: each number ±10 %",
        "k_min",
        "F_a(d=0)",
        "ΔW",
        "profiles",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    driver.press("z R");
    assert!(
        driver.app.studies.value::<Sensitivity>().is_some(),
        "another profile has its own"
    );
    driver.press("Y");
    assert!(driver.app.is_shown(Pane::Profile));
}

/// Each number is on a page, with both of its changes, and the range over the profiles is on the
/// last page.
#[test]
fn a_small_window_has_the_further_numbers_on_further_pages() {
    let mut driver = computed_sensitivity(rough());
    driver.resize((80, 24));
    driver.shows("Sensitivity to ±10 % · 1/3 PageDown");
    let mut rows = Vec::new();
    loop {
        let before = driver.text();
        rows.extend(driver.rows());
        driver.press("PageDown");
        if driver.text() == before {
            break;
        }
    }
    let sensitivity = driver.app.studies.value::<Sensitivity>().unwrap();
    assert!(sensitivity.influences.len() > 4);
    for influence in &sensitivity.influences {
        let name = influence.axis.symbol_or_name().replace("force of ", "");
        let name = format!("{name} ");
        let count = rows.iter().filter(|row| row.starts_with(&name)).count();
        assert_eq!(count, 1, "{name}\n{}", rows.join("\n"));
    }
    let of_profiles = rows
        .iter()
        .filter(|row| row.starts_with("profiles "))
        .count();
    assert_eq!(of_profiles, sensitivity.range.iter().len());
}
