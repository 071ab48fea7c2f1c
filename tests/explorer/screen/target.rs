//! The headline of random profiles, and the value of a row for a target.

use super::*;
use asperity::explorer::commands::target::{Sought, answer_lines};
use asperity::scene::open;
use asperity::study::{Ensemble, Quantity};
use std::f64::consts::PI;

/// The explorer on a scene, with the answers to targets and the random profiles.
fn asked(document: Document) -> Driver {
    let performs = |study: &Study| study.is::<Sought>() || study.is::<Ensemble>();
    let mut driver = Driver::open_with(document, Simulation::run, performs);
    driver.perform(vec![Task::Ask]);
    driver.press("Space");
    driver
}

/// Pull-off forces of the scene on the profiles of this number of seeds, ascending, N.
fn forces(driver: &Driver, profiles: u64) -> Vec<f64> {
    let scene = driver.document().scene();
    let force = |line: u64| {
        let scene = scene.with_seed(scene.seed().unwrap() + line);
        let outcome = Simulation::default()
            .run(&scene, &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        outcome.figures.pull_off_force.unwrap()
    };
    let mut forces: Vec<f64> = (0..profiles).map(force).collect();
    forces.sort_by(f64::total_cmp);
    forces
}

#[test]
fn the_headline_is_the_median_of_random_profiles() {
    let mut driver = asked(rough());
    let forces = forces(&driver, Ensemble::PROFILES);
    let median = f64::midpoint(forces[7], forces[8]);
    let rounded = asperity::data::format_rounded(median, 3, "N");
    let status = driver.status();
    assert!(
        status.starts_with(&format!("F_a median {rounded} (")),
        "{rounded}: {status}"
    );
    assert!(
        status.contains(", 16 profiles) · this profile 46.1 nN"),
        "{status}"
    );
    driver.shows("F_a/F_a,max ");
    // In units of F_a,max.
    driver.press("N");
    let ideal = driver.outcome().ideal_pull_off_force.unwrap();
    let share = asperity::data::format_rounded(median / ideal, 3, "1");
    driver.states(format!("F_a/F_a,max median {share}"));
    // A title changes no profile, another number does.
    let computed = |driver: &Driver| driver.app.studies.value::<Ensemble>().cloned();
    let before = computed(&driver);
    driver.set("title", "Another");
    assert_eq!(computed(&driver), before);
    driver.set("adhesion.kappa", "7");
    assert_ne!(computed(&driver), before);
    // A smooth body has one profile.
    let driver = asked(smooth());
    assert!(
        driver.status().contains(", fixed profile") && computed(&driver).is_none(),
        "{}",
        driver.status()
    );
}

#[test]
fn a_value_is_found_for_a_target_and_taken() {
    // F_a = (3/2)πγR.
    let document = changed(&open("jkr-sphere").unwrap(), &[("numerics.points", "2048")]);
    let mut driver = asked(document);
    driver.select("adhesion.work");
    driver.press("f Ctrl+u `F_a = 5 µN`");
    let exact = 5e-6 / (1.5 * PI * 1e-4);
    driver.states("γ for F_a = 5 µN");
    driver.shows("10.6");
    driver.shows("Enter takes it");
    driver.press("Enter");
    let work = driver.document().scene().adhesion.unwrap().work().unwrap();
    assert!((work / exact - 1.0).abs() < 1e-3, "{work} {exact}");
    assert!((driver.outcome().figures.pull_off_force.unwrap() / 5e-6 - 1.0).abs() < 1e-6);
    driver.press("u");
    assert_ne!(
        driver.document().scene().adhesion.unwrap().work(),
        Some(work)
    );
}

#[test]
fn a_preload_is_found_on_the_profiles_and_goes_to_the_stage_that_presses() {
    let mut driver = asked(rough());
    driver.select("loading");
    driver.press("f Ctrl+u `F_a/F_a,max = 0.2 %`");
    driver.states("F_n for F_a/F_a,max = 0.2 %");
    driver.shows("Enter takes the median");
    driver.press("Enter");
    assert!(driver.app.prompt.is_none(), "{}", driver.text());
    // The median of the answers is not the answer for the median profile.
    let shares = driver.app.studies.value::<Ensemble>().unwrap();
    let median = shares
        .statistics(Quantity::AdhesionShare)
        .unwrap()
        .quartiles[1];
    let median = asperity_report::percent(median, 3);
    driver.states(format!(
        "median preload; the median of F_a/F_a,max is then {median}"
    ));
    let ensemble = driver.app.studies.value::<Ensemble>().unwrap();
    let reached = ensemble
        .values(Quantity::AdhesionShare)
        .into_iter()
        .flatten();
    // The median preload suffices for half of the profiles.
    let reached = reached
        .filter(|share| *share >= 0.002 * (1.0 - 1e-6))
        .count();
    assert!((7..=9).contains(&reached), "{reached}");
    // What is out of reach is said, and the question stays.
    driver.press("f Ctrl+u `F_a/F_a,max = 99 %`");
    driver.shows("F_a/F_a,max = 99 % never");
    driver.press("Enter");
    assert!(
        driver
            .refusal()
            .is_some_and(|why| why.contains("never reached")),
        "{}",
        driver.text()
    );
}

#[test]
fn a_target_that_cannot_be_read_and_a_row_without_a_number_are_refused() {
    let mut driver = asked(rough());
    driver.select("roughness.hurst");
    for (typed, why) in [
        ("nothing", "allowed"),
        ("F_a/F_a,max = 120 %", "allowed: from 0"),
        ("κ = 2", "κ"),
    ] {
        driver.press(&format!("f Ctrl+u `{typed}`"));
        driver.shows(why);
        driver.press("Enter");
        assert!(driver.refusal().is_some(), "{typed}: {}", driver.text());
        driver.press("Esc");
    }
    driver.select("title");
    driver.answers("f", "title has no number to find");
}

#[test]
fn a_target_begins_with_what_the_scene_has_and_a_number_alone_is_in_per_cent() {
    let mut driver = asked(rough());
    driver.select("loading");
    driver.press("f");
    let ensemble = driver.app.studies.value::<Ensemble>().unwrap();
    let present = ensemble
        .statistics(Quantity::AdhesionShare)
        .unwrap()
        .quartiles[1];
    let proposed = format!("F_a/F_a,max = {}", asperity_report::percent(present, 2));
    let typed = |driver: &Driver| driver.app.prompt.as_ref().unwrap().line.text().to_owned();
    assert_eq!(typed(&driver), proposed);
    // The first character replaces the proposal.
    driver.press("`0.2`");
    driver.states("F_n for 0.2 → F_a/F_a,max = 0.2 %");
    let answer = |driver: &Driver| driver.app.studies.value::<Sought>().unwrap().value();
    let by_number = answer(&driver);
    for same in ["0.2 %", "F_a/F_a,max = 0.2 %", "F_a/F_a,max = 0.002"] {
        driver.press(&format!("Ctrl+u `{same}`"));
        assert_eq!(answer(&driver), by_number, "{same}");
    }
    // A share above 1 can only be meant in per cent.
    driver.press("Ctrl+u `F_a/F_a,max = 20`");
    driver.states("→ F_a/F_a,max = 20 %");
    // A target out of reach names what is reached.
    driver.press("Ctrl+u `99`");
    driver.shows_all(["F_a/F_a,max = 99 % never", "F_a/F_a,max 0"]);
    // Without adhesion, the share of F_a,max is no target.
    let mut driver = asked(without_adhesion());
    driver.select("loading");
    driver.press("f");
    assert_eq!(typed(&driver), "contact_fraction = 50 %");
}

#[test]
fn an_answer_has_one_line_in_a_small_window_and_a_strip_in_a_large_one() {
    let mut driver = asked(rough());
    driver.select("loading");
    driver.press("f `0.2`");
    for size in [(120, 40), (80, 24), (40, 12)] {
        driver.resize(size);
        let rows = driver.rows();
        let answer = rows[rows.len() - 1].trim();
        // The unit is written once: `12.44 µN (6.71 to 17.3)`.
        let (median, rest) = answer
            .split_once(" (")
            .unwrap_or_else(|| panic!("{answer}"));
        let unit = median.split(' ').nth(1).unwrap();
        let quartiles = rest.split(')').next().unwrap();
        assert!(!quartiles.contains(unit), "{answer}");
        assert!(quartiles.contains(" to "), "{answer}");
        if size.0 >= 80 {
            assert!(answer.ends_with("· Enter"), "{answer}");
        }
        // One dot for each profile with a value, in two rows at most, above the ends of the axis.
        let lines = answer_lines(&driver.app, 40, 20).unwrap();
        let texts: Vec<String> = lines.iter().map(ToString::to_string).collect();
        assert!(
            texts[1].contains('●') && texts[2].contains("──"),
            "{texts:#?}"
        );
    }
}

#[test]
fn a_row_with_two_numbers_has_no_number_to_find() {
    for document in [rough(), open("pressure-sensitive").unwrap()] {
        let mut driver = Driver::start(document);
        for path in ["roughness.modes", "roughness.wavelengths"] {
            if driver.document().value(path).is_none() {
                continue;
            }
            driver.select(path);
            driver.press("f");
            driver.states("has two numbers; select a row with a number");
            assert!(driver.app.prompt.is_none());
        }
    }
}

#[test]
fn enter_closes_the_question_if_every_preload_reaches_the_target() {
    let mut driver = asked(changed(
        &rough(),
        &[("adhesion", "(work: 1.0)"), ("numerics.points", "1024")],
    ));
    driver.select("loading");
    driver.press("f Ctrl+u `F_a/F_a,max = 1 %`");
    driver.shows("any");
    driver.press("Enter");
    assert!(driver.app.prompt.is_none(), "{}", driver.text());
    assert!(!driver.status().starts_with('!'), "{}", driver.status());
    assert_eq!(driver.app.edit.past.len(), 0);
}
