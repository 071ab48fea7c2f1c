//! How far an adhesion force can be trusted: criteria of other theories, and errors by their
//! sources.

use crate::reference::{difference_words, model_words};
use crate::sheet::Sheet;
use asperity_data::{Warning, per_cent};
use asperity_scene::{Estimate, Outcome, Scene};
use asperity_study::Ensemble;
use asperity_study::half_space::Reference;
use asperity_study::trust::{Budget, Criterion, criteria};

/// Adds the criteria of adhesion without a preload, and the errors of the adhesion force by their
/// sources.
pub(crate) fn trust(
    sheet: &mut Sheet,
    (scene, outcome): (&Scene, &Outcome),
    estimate: Option<&Estimate>,
    ensemble: Option<&Ensemble>,
    deviation: Option<f64>,
) {
    let budget = Budget::of(outcome, estimate, ensemble, deviation);
    let errors = budget.map_or_else(Vec::new, |budget| {
        error_rows(scene, outcome, estimate, &budget, ensemble, None)
    });
    for (heading, rows) in [
        (
            "Adhesion without a preload, by several theories",
            theory_rows(scene, outcome, ensemble),
        ),
        ("Errors of F_a by their sources", errors),
    ] {
        if !rows.is_empty() {
            sheet.heading(heading);
        }
        rows.into_iter()
            .for_each(|(name, words)| sheet.row(name, words));
    }
}

/// Returns what theories predict for the adhesion of a computed scene without a preload. A row has
/// the name of a theory, and its verdict whether the bodies adhere. The last rows have the result
/// of this program.
pub fn theory_rows(
    scene: &Scene,
    outcome: &Outcome,
    ensemble: Option<&Ensemble>,
) -> Vec<(&'static str, String)> {
    let criteria = criteria(scene, outcome, ensemble);
    let smooth = outcome.governing.amplitude.is_none() && !criteria.is_empty();
    let smooth = smooth.then(|| {
        (
            "criteria of roughness",
            "do not apply: the body is smooth".to_owned(),
        )
    });
    let mut last = "";
    let row = |criterion: Criterion| {
        let name = if criterion.name == last {
            ""
        } else {
            criterion.name
        };
        last = criterion.name;
        (name, criterion.words())
    };
    smooth
        .into_iter()
        .chain(criteria.into_iter().map(row))
        .collect()
}

/// Returns the errors of the adhesion force by their sources: number of springs, sample of
/// profiles, measured surface, and model. A row has a source and its relative error in words. With
/// the comparison `reference` with three dimensions there is also a row for the difference from it.
/// The last row names the largest source.
pub fn error_rows(
    scene: &Scene,
    outcome: &Outcome,
    estimate: Option<&Estimate>,
    budget: &Budget,
    ensemble: Option<&Ensemble>,
    reference: Option<&Reference>,
) -> Vec<(&'static str, String)> {
    let words = |share: f64| {
        if share > 1.0 {
            "more than ± 100 %".to_owned()
        } else {
            format!("± {}", per_cent(share))
        }
    };
    let share = |share: Option<f64>| share.map(words);
    let grid = match share(budget.grid) {
        Some(grid) if estimate.is_some_and(|estimate| estimate.near_step) => {
            format!("{grid}, near a step of F_a(F_n)")
        }
        grid => grid.unwrap_or_else(|| "not known".to_owned()),
    };
    let is_exceeded = outcome.warnings.iter().any(Warning::exceeds_errors);
    let is_random = scene.seed().is_some();
    let profiles = ensemble.map_or(1, Ensemble::computed);
    let sample = match share(budget.sample) {
        Some(sample) => format!("{sample} of the median of {profiles} profiles"),
        None if is_random => "not known: too few profiles".to_owned(),
        None => "none: the profile is fixed".to_owned(),
    };
    let surface = match (share(budget.surface), scene.measured()) {
        (Some(surface), _) => format!("{surface}, by the uncertainty of the measured spectrum"),
        (None, Some(_)) if is_random => {
            "not known: the uncertainty of the spectrum is not computed".to_owned()
        }
        (None, Some(_)) => "not known: the measured profile counts as exact".to_owned(),
        (None, None) => "none: the scene states the surface".to_owned(),
    };
    let model = match (reference, &scene.roughness) {
        (Some(reference), _) => model_words(reference),
        (None, Some(_)) => {
            "not known: the MDR is a model for rough bodies, whose adhesion is disputed".into()
        }
        (None, None) if is_exceeded => "not known: a premise does not hold (Warnings)".into(),
        (None, None) => {
            "none for bodies of revolution whose equivalent profile rises everywhere".into()
        }
    };
    let largest = match budget.largest {
        None if is_exceeded => "not known: a premise does not hold (Warnings)",
        Some("grid") => "grid: more springs reduce it (--tolerance)",
        Some("sample") => "sample of profiles: more profiles reduce it (--profiles)",
        Some("model") => "model: more springs do not help",
        Some(_) => "surface: more or larger scans reduce it",
        None => "not known",
    };
    let mut rows = vec![
        ("grid", grid),
        ("sample of profiles", sample),
        ("surface", surface),
    ];
    let difference = reference.and_then(difference_words);
    rows.extend(difference.map(|difference| ("three dimensions", difference)));
    rows.push(("model", model));
    rows.push(("largest known error", largest.to_owned()));
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_data::Control;
    use asperity_scene::{Simulation, open, run};

    fn scene(fields: &[(&str, &str)]) -> asperity_scene::Document {
        let fields = [
            &[("numerics.points", "2048"), ("roughness.modes", "(1, 256)")],
            fields,
        ]
        .concat();
        let fields: Vec<_> = fields
            .iter()
            .map(|(path, value)| (path.to_string(), value.to_string()))
            .collect();
        open("pressure-sensitive")
            .unwrap()
            .set_all(&fields)
            .unwrap()
    }

    #[test]
    fn a_summary_names_the_theory_that_does_not_apply() {
        let hard = scene(&[
            ("material", "(effective_modulus: 2.0e11)"),
            ("adhesion", "(work: 0.05)"),
        ]);
        let outcome = run(&hard).unwrap();
        let text = crate::summary::brief_summary(hard.scene(), &outcome);
        assert!(
            text.contains("* JKR theory and the rule of Hess do not apply: the Tabor number 0."),
            "{text}"
        );
        assert_eq!(
            run(&scene(&[("roughness.modes", "(4, 256)")]))
                .unwrap()
                .warnings,
            []
        );
    }

    /// No error is stated for a contact that reaches the ends of its profile, and none is named as
    /// the largest one.
    #[test]
    fn no_error_is_stated_where_the_contact_reaches_the_ends() {
        let fields = [
            ("length", "2.0e-5"),
            ("material", "(effective_modulus: 1.0e6)"),
        ];
        let fields = fields.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let document = open("jkr-sphere").unwrap().set_all(&fields).unwrap();
        let outcome = run(&document).unwrap();
        let own = asperity_scene::estimate(
            document.scene(),
            std::path::Path::new(""),
            &outcome,
            &|| false,
        );
        assert_eq!(own, None);
        // Also if somebody states one.
        let evidence = asperity_scene::discretisation::Evidence::ClosedForm;
        let target = asperity_scene::discretisation::Target::AdhesionForce;
        let stated = Estimate {
            target,
            error: 7e-4,
            near_step: false,
            evidence,
        };
        let budget = Budget::of(&outcome, Some(&stated), None, None).unwrap();
        assert_eq!(budget.largest, None);
        let rows = error_rows(
            document.scene(),
            &outcome,
            own.as_ref(),
            &budget,
            None,
            None,
        );
        assert!(
            rows[3].1.starts_with("not known: a premise")
                && rows[4].1.starts_with("not known: a premise")
        );
        let report = crate::RunReport {
            title: "",
            scene: document.scene(),
            outcome: &outcome,
            choice: None,
            estimate: Some(&stated),
            ensemble: None,
            deviation: None,
        };
        use crate::report::Report;
        let text = report.text().unwrap();
        assert!(
            text.contains("error unknown") && !text.contains("grid ±"),
            "{text}"
        );
        let mut json = Vec::new();
        report.json().unwrap().write_json(&mut json, &[]).unwrap();
        let json: serde_json::Value = serde_json::from_slice(&json).unwrap();
        assert_eq!(json["adhesion_force_error"], serde_json::Value::Null);
        assert!(
            json["warnings"][0]
                .as_str()
                .unwrap()
                .starts_with("The contact reaches an end of the profile")
        );
    }

    #[test]
    fn each_source_has_a_row_and_the_largest_is_last() {
        let document = scene(&[]);
        let (scene, outcome) = (document.scene(), run(&document).unwrap());
        let control = Control::default().on_threads(1);
        let ensemble = Ensemble::of(scene, &[], 6, &mut Simulation::default(), control).unwrap();
        let rows = |ensemble: Option<&Ensemble>| {
            let budget = Budget::of(&outcome, None, ensemble, None).unwrap();
            error_rows(scene, &outcome, None, &budget, ensemble, None)
        };
        let words =
            |rows: Vec<(&str, String)>| rows.into_iter().map(|row| row.1).collect::<Vec<_>>();
        let alone = words(rows(None));
        assert_eq!(
            (alone[0].as_str(), alone[1].as_str()),
            ("not known", "not known: too few profiles")
        );
        let among = words(rows(Some(&ensemble)));
        assert!(
            among[1].starts_with("± ") && among[1].ends_with(" of the median of 6 profiles"),
            "{among:?}"
        );
        assert!(among[4].starts_with("sample of profiles"), "{among:?}");
        let theories = theory_rows(scene, &outcome, Some(&ensemble));
        assert_eq!(
            theories
                .iter()
                .filter(|row| row.0 == "this program")
                .count(),
            1,
            "{theories:?}"
        );
        assert_eq!(theories.len(), 7);
    }
}
