//! Reliability of a pull-off force: the criteria of other theories, and the errors from each
//! source.

use crate::reference::{difference_words, model_words};
use crate::sheet::Sheet;
use asperity_contact::Relaxation;
use asperity_data::{Remedy, Warning, Wording, format_range, per_cent};
use asperity_scene::{Estimate, Outcome, Scene};
use asperity_study::half_space::Reference;
use asperity_study::trust::{Budget, Criterion, criteria};
use asperity_study::{Ensemble, Quantity};

/// Adds what criteria of other theories state about adhesion without a preload, and the error of
/// the pull-off force from each source.
pub(crate) fn add_trust(
    sheet: &mut Sheet,
    scene: &Scene,
    outcome: &Outcome,
    estimate: Option<&Estimate>,
    ensemble: Option<&Ensemble>,
    deviation: Option<f64>,
    wording: Wording,
) {
    let theories = theory_rows(scene, outcome, ensemble);
    let heading = "Adhesion without a preload, by several theories";
    add_rows(sheet, heading, theories);
    if let Some(budget) = Budget::of(outcome, estimate, ensemble, deviation) {
        let errors = error_rows(scene, outcome, estimate, &budget, ensemble, None, wording);
        add_rows(sheet, "Errors of F_a by their sources", errors);
    }
}

/// Adds a heading and rows. Adds nothing if there are no rows.
fn add_rows(sheet: &mut Sheet, heading: &str, rows: Vec<(&str, String)>) {
    if rows.is_empty() {
        return;
    }
    sheet.heading(heading);
    for (name, words) in rows {
        sheet.row(name, words);
    }
}

/// Returns what theories predict for the adhesion of a computed scene without a preload. Each row
/// has the name of a theory, and its verdict on whether the bodies adhere. The last rows have the
/// result of this program.
pub fn theory_rows(
    scene: &Scene,
    outcome: &Outcome,
    ensemble: Option<&Ensemble>,
) -> Vec<(&'static str, String)> {
    let criteria = criteria(scene, outcome, ensemble);
    let mut rows = Vec::new();
    if outcome.governing.amplitude.is_none() && !criteria.is_empty() {
        let words = "do not apply: the body is smooth".to_owned();
        rows.push(("criteria of roughness", words));
    }
    // A theory may have several rows. Only the first of them has the name of the theory.
    let mut last_name = "";
    for criterion in criteria {
        let name = if criterion.name == last_name {
            ""
        } else {
            criterion.name
        };
        last_name = criterion.name;
        rows.push((name, criterion.words()));
    }
    rows
}

/// Returns the verdicts of theories on the adhesion of a computed scene without a preload, in few
/// words: `yes Pastewka; no Persson, Fuller`. Theories without a verdict are left out; `None` if
/// none has one.
pub fn theories_briefly(scene: &Scene, outcome: &Outcome) -> Option<String> {
    let mut yes = Vec::new();
    let mut no = Vec::new();
    for criterion in criteria(scene, outcome, None) {
        if criterion.name == Criterion::THIS_PROGRAM {
            continue;
        }
        // Of several authors the first one, without the year.
        let words = criterion.name.split(' ');
        let words = words.take_while(|word| *word != "&" && word.parse::<u32>().is_err());
        let name = words.collect::<Vec<_>>().join(" ");
        match criterion.sticks {
            Some(true) => yes.push(name),
            Some(false) => no.push(name),
            None => {}
        }
    }
    let mut parts = Vec::new();
    for (verdict, names) in [("yes", yes), ("no", no)] {
        if !names.is_empty() {
            parts.push(format!("{verdict} {}", names.join(", ")));
        }
    }
    if parts.is_empty() {
        None
    } else {
        Some(parts.join("; "))
    }
}

/// Returns the errors of the pull-off force from each source: number of springs, steps in time of a
/// half-space that relaxes, sample of profiles, measured surface, and model. Each row has a source
/// and its relative error in words.
/// `reference` is a comparison with an elastic half-space in three dimensions; if it is given, a
/// further row has the difference that this comparison has found. The last row names the largest
/// error.
pub fn error_rows(
    scene: &Scene,
    outcome: &Outcome,
    estimate: Option<&Estimate>,
    budget: &Budget,
    ensemble: Option<&Ensemble>,
    reference: Option<&Reference>,
    wording: Wording,
) -> Vec<(&'static str, String)> {
    let is_exceeded = outcome.warnings.iter().any(Warning::exceeds_errors);
    let mut rows = vec![("grid", grid_in_words(budget, estimate))];
    if let Some(error) = budget.steps {
        rows.push(("steps in time", steps_in_words(error)));
    }
    let sample = sample_in_words(scene, budget, ensemble);
    rows.push(("sample of profiles", sample));
    rows.push(("surface", surface_in_words(scene, budget)));
    if let Some(difference) = reference.and_then(difference_words) {
        rows.push(("three dimensions", difference));
    }
    rows.push(("model", model_in_words(scene, reference, is_exceeded)));
    let largest = largest_in_words(budget, is_exceeded, wording);
    rows.push(("largest known error", largest));
    rows
}

/// Returns a relative error as text: `± 2 %`.
fn error_in_words(error: f64) -> String {
    if error > 1.0 {
        "more than ± 100 %".to_owned()
    } else {
        format!("± {}", per_cent(error))
    }
}

/// Returns in words the error due to the finite number of springs.
fn grid_in_words(budget: &Budget, estimate: Option<&Estimate>) -> String {
    let Some(error) = budget.grid.map(error_in_words) else {
        return "not known".to_owned();
    };
    if estimate.is_some_and(|estimate| estimate.near_step) {
        format!("{error}, near a step of F_a(F_n)")
    } else {
        error
    }
}

/// Returns in words the error due to the steps in time of a half-space that relaxes.
fn steps_in_words(error: f64) -> String {
    let of_largest = per_cent(Relaxation::STEP_ERROR);
    let error = error_in_words(error);
    format!("{error}, by steps with up to {of_largest} of the largest force")
}

/// Returns in words the error due to the finite number of random profiles: half of the width of the
/// confidence interval of the median, and this interval, which may lie mostly on one side.
fn sample_in_words(scene: &Scene, budget: &Budget, ensemble: Option<&Ensemble>) -> String {
    let statistics = ensemble.and_then(|ensemble| ensemble.statistics(Quantity::PullOffForce));
    let interval = statistics.and_then(|statistics| statistics.median_interval);
    match (budget.sample.map(error_in_words), interval) {
        (Some(error), Some(interval)) => {
            let interval = format_range(interval, 3, "N");
            let profiles = ensemble.map_or(1, Ensemble::computed);
            format!("{error} of the median of {profiles} profiles: {interval}")
        }
        _ if scene.seed().is_some() => "not known: too few profiles".to_owned(),
        _ => "none: the profile is fixed".to_owned(),
    }
}

/// Error of a measured surface of whose spectrum the uncertainty is not computed, or not yet.
pub const SPECTRUM_NOT_COMPUTED: &str =
    "not known: the uncertainty of the spectrum is not computed";

/// Returns in words the error due to the measured surface.
fn surface_in_words(scene: &Scene, budget: &Budget) -> String {
    if let Some(error) = budget.surface.map(error_in_words) {
        return format!("{error}, by the uncertainty of the measured spectrum");
    }
    let words = if scene.measured().is_none() {
        "none: the scene states the surface"
    } else if scene.seed().is_some() {
        SPECTRUM_NOT_COMPUTED
    } else {
        "not known: the measured profile counts as exact"
    };
    words.to_owned()
}

/// Returns in words the error of the model. `is_exceeded` is true if a premise of the model is not
/// met, so that the error is unknown.
fn model_in_words(scene: &Scene, reference: Option<&Reference>, is_exceeded: bool) -> String {
    if let Some(reference) = reference {
        return model_words(reference);
    }
    let words = if scene.roughness.is_some() {
        "not known: the MDR is a model for rough bodies, whose adhesion is disputed"
    } else if is_exceeded {
        "not known: a premise does not hold (Warnings)"
    } else if scene.form.as_ref().is_some_and(|form| form.contacts() > 1) {
        "none for spheres so far apart that none deforms the body under another"
    } else {
        "none for bodies of revolution whose equivalent profile rises everywhere"
    };
    words.to_owned()
}

/// Returns the source of the largest known error, and a way to reduce this error.
fn largest_in_words(budget: &Budget, is_exceeded: bool, wording: Wording) -> String {
    let words = match budget.largest {
        Some("grid") => {
            let option = wording(&Remedy::Tolerance);
            return format!("grid: more springs reduce it ({option})");
        }
        Some("sample") => {
            let option = wording(&Remedy::MoreProfiles);
            return format!("sample of profiles: more profiles reduce it ({option})");
        }
        Some("steps") => "steps in time: more springs do not help",
        Some("model") => "model: more springs do not help",
        Some(_) => "surface: more or larger scans reduce it",
        None if is_exceeded => "not known: a premise does not hold (Warnings)",
        None => "not known",
    };
    words.to_owned()
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
            ("material", "(modulus: 2.0e11)"),
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

    /// Only a half-space that relaxes has steps in time. Their error is a share of the largest
    /// force.
    #[test]
    fn the_error_of_the_steps_is_stated_with_relaxation_only() {
        let relaxation = "(modulus: 2.0e6, relaxation: (share: 0.4, time: 1.0))";
        let relaxing = [("material", relaxation), ("loading_speed", "1.0e-6")];
        for fields in [&relaxing[..], &[]] {
            let fields: Vec<_> = fields
                .iter()
                .map(|(path, value)| (path.to_string(), value.to_string()))
                .collect();
            let document = open("jkr-sphere").unwrap().set_all(&fields).unwrap();
            let outcome = run(&document).unwrap();
            let budget = Budget::of(&outcome, None, None, None).unwrap();
            let scene = document.scene();
            let rows = error_rows(scene, &outcome, None, &budget, None, None, |_| {
                String::new()
            });
            let row = rows.iter().find(|(name, _)| *name == "steps in time");
            let largest = outcome.history.stages.iter().fold(0.0, |largest, stage| {
                f64::max(largest, stage.largest.force.max(-stage.smallest.force))
            });
            let force = outcome.figures.pull_off_force.unwrap();
            let expected = 1e-3 * largest / force;
            match budget.steps {
                Some(error) => {
                    assert!((error / expected - 1.0).abs() < 1e-12, "{error} {expected}");
                    let (_, words) = row.unwrap();
                    assert!(words.contains("by steps with up to 0.1 %"), "{words}");
                }
                None => assert!(fields.is_empty() && row.is_none()),
            }
            assert_eq!(budget.steps.is_some(), scene.relaxes());
        }
    }

    /// If the contact reaches the ends of its profile, the report states no error and names no
    /// largest error.
    #[test]
    fn no_error_is_stated_where_the_contact_reaches_the_ends() {
        let fields = [("length", "2.0e-5"), ("material", "(modulus: 1.0e6)")];
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
        // The error remains unknown even if an estimate is given.
        let evidence = asperity_scene::discretisation::Evidence::ClosedForm;
        let target = asperity_scene::discretisation::Target::PullOffForce;
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
            |remedy| format!("{remedy:?}"),
        );
        assert!(
            rows[3].1.starts_with("not known: a premise")
                && rows[4].1.starts_with("not known: a premise")
        );
        let report = crate::RunReport {
            wording: |remedy| format!("{remedy:?}"),
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
        assert_eq!(json["pull_off_force_error"], serde_json::Value::Null);
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
            error_rows(scene, &outcome, None, &budget, ensemble, None, |remedy| {
                format!("{remedy:?}")
            })
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
            among[1].starts_with("± ") && among[1].contains(" of the median of 6 profiles: "),
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
        let brief = theories_briefly(scene, &outcome);
        assert_eq!(brief.as_deref(), Some("yes Pastewka; no Persson"));
    }
}
