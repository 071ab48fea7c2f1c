//! Tests of the report on a comparison of profiles with three dimensions.

use super::*;
use asperity_data::Control;
use asperity_scene::{Document, Simulation, open};
use asperity_study::half_space::ReferenceOptions;
use asperity_study::trust::Budget;

/// Compares `surfaces` square surfaces of `cells` cells along a side with 16 profiles for each, or
/// with the only profile of a smooth body.
fn compared(document: &Document, cells: usize, surfaces: u64) -> Reference {
    let is_rough = document.scene().roughness.is_some();
    let options = ReferenceOptions {
        cells,
        surfaces,
        profiles: if is_rough { 16 * surfaces } else { 1 },
    };
    let control = Control::default().on_threads(2);
    Reference::of(
        document.scene(),
        options,
        &mut Simulation::default(),
        control,
    )
    .unwrap()
}

fn report_on<'a>(document: &'a Document, found: &'a Reference) -> ReferenceReport<'a> {
    ReferenceReport {
        wording: |remedy| format!("{remedy:?}"),
        title: "A body",
        scene: document.scene(),
        reference: found,
    }
}

/// The figure shows a curve and a band for each model within its axes.
#[test]
fn the_figure_has_both_models() {
    let document = open("jkr-sphere").unwrap();
    let found = compared(&document, 32, 1);
    let report = report_on(&document, &found);
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
    let found = compared(&document, 64, 2);
    let report = report_on(&document, &found);
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
    let found = compared(&document, 64, 1);
    let report = report_on(&document, &found);
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
