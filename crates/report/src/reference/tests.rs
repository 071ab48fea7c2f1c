//! Tests of the report on a comparison of profiles with three dimensions.

use super::*;
use asperity_data::Control;
use asperity_scene::{Simulation, open};
use asperity_study::half_space::ReferenceOptions;
use asperity_study::trust::Budget;

/// The figure shows a curve and a band for each model within its axes.
#[test]
fn the_figure_has_both_models() {
    let document = open("jkr-sphere").unwrap();
    let options = ReferenceOptions {
        cells: 32,
        surfaces: 1,
        profiles: 1,
    };
    let found = Reference::of(
        document.scene(),
        options,
        &mut Simulation::default(),
        Control::default().on_threads(1),
    )
    .unwrap();
    let report = ReferenceReport {
        wording: |remedy| format!("{remedy:?}"),
        title: "A sphere",
        scene: document.scene(),
        reference: &found,
    };
    let figure = report.figure().unwrap();
    assert_eq!(figure.size, Figure::WIDE);
    let legend: Vec<String> = figure
        .legend()
        .iter()
        .map(|entry| entry.name.to_string())
        .collect();
    assert_eq!(
        legend,
        [
            "profile, mean and quartiles",
            "three dimensions, mean and quartiles"
        ]
    );
    assert_eq!(figure.charts[0].layers.len(), 4);
}

/// All errors of the budget state which waves are compared. Forces at which few cells are in
/// contact are not compared.
#[test]
fn what_is_left_out_is_said() {
    let document = open("pressure-sensitive").unwrap();
    let options = ReferenceOptions {
        cells: 64,
        surfaces: 2,
        profiles: 32,
    };
    let found = Reference::of(
        document.scene(),
        options,
        &mut Simulation::default(),
        Control::default().on_threads(2),
    )
    .unwrap();
    let report = ReferenceReport {
        wording: |remedy| format!("{remedy:?}"),
        title: "Rough",
        scene: document.scene(),
        reference: &found,
    };
    let waves = ", of waves 4 to 8 of 4 to 512";
    let (rows, _) = report.errors();
    for (name, words) in &rows[1..4] {
        assert!(words.ends_with(waves), "{name}: {words}");
    }
    assert!(
        rows[3].1.starts_with("profile against three dimensions, "),
        "{rows:?}"
    );
    let text = report.text().unwrap();
    assert!(
        text.contains("rms height h") && text.contains("e_el/γ with adhesion"),
        "{text}"
    );
    assert_eq!(
        text.contains("Left out are forces"),
        !found.left_out.is_empty(),
        "{text}"
    );
    let scene = document.scene();
    let outcome = asperity_scene::run(&document).unwrap();
    let budget = Budget::default();
    let rows = crate::trust::error_rows(
        scene,
        &outcome,
        None,
        &budget,
        None,
        Some(&found),
        |remedy| format!("{remedy:?}"),
    );
    let row = rows
        .iter()
        .find(|(name, _)| *name == "three dimensions")
        .unwrap();
    assert!(row.1.ends_with(waves), "{row:?}");
    let model = rows.iter().find(|(name, _)| *name == "model").unwrap();
    assert_eq!(model.1, model_words(&found));
    let sentence = model_sentence(&found).unwrap();
    assert!(sentence.contains(waves), "{sentence}");
}

/// For a smooth body of revolution the difference is an error of the grid and not of the model.
#[test]
fn a_sphere_has_no_error_of_the_model() {
    let document = open("jkr-sphere").unwrap().set("length", "4.2e-5").unwrap();
    let options = ReferenceOptions {
        cells: 64,
        surfaces: 1,
        profiles: 1,
    };
    let found = Reference::of(
        document.scene(),
        options,
        &mut Simulation::default(),
        Control::default().on_threads(1),
    )
    .unwrap();
    let report = ReferenceReport {
        wording: |remedy| format!("{remedy:?}"),
        title: "A sphere",
        scene: document.scene(),
        reference: &found,
    };
    let (rows, largest) = report.errors();
    assert!(largest.starts_with("The largest is the grid"), "{largest}");
    assert!(rows.contains(&(
        "model",
        "none: the profile is exact for this body of revolution".to_owned()
    )));
    assert!(
        rows.contains(&("sample", "none: nothing is random".to_owned())),
        "{rows:?}"
    );
    assert!(!model_sentence(&found).unwrap().contains("at least"));
}
