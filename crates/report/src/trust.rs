//! How far an adhesion force can be trusted: criteria of other theories, and errors by their sources.

use crate::reference::{difference_words, model_words};
use crate::sheet::Sheet;
use asperity_data::per_cent;
use asperity_scene::{Estimate, Outcome, Scene};
use asperity_study::Ensemble;
use asperity_study::half_space::Reference;
use asperity_study::trust::{Budget, Criterion, criteria};

/// Returns a warning if the Tabor number of a computed scene is below 1, where JKR theory does not apply; otherwise `None`.
pub fn without_jkr(outcome: &Outcome) -> Option<String> {
    let number = outcome.tabor_number.filter(|number| *number < Criterion::LEAST_TABOR_NUMBER)?;
    let number = asperity_data::format_rounded(number, 2, "1");
    Some(format!(
        "JKR theory and the rule of Hess do not apply: the Tabor number {number} is below {}, so \
         that the attraction reaches beyond the contact. DMT theory applies, by which a loop dissipates next to nothing.",
        Criterion::LEAST_TABOR_NUMBER
    ))
}

/// Adds the criteria of adhesion without a preload, and the errors of the adhesion force by their sources.
pub(crate) fn trust(
    sheet: &mut Sheet,
    (scene, outcome): (&Scene, &Outcome),
    estimate: Option<&Estimate>,
    ensemble: Option<&Ensemble>,
    deviation: Option<f64>,
) {
    let budget = Budget::of(outcome, estimate, ensemble, deviation);
    let errors = budget.map_or_else(Vec::new, |budget| error_rows(scene, estimate, &budget, ensemble, None));
    for (heading, rows) in [
        ("Adhesion without a preload, by several theories", theory_rows(scene, outcome, ensemble)),
        ("Errors of F_a by their sources", errors),
    ] {
        if !rows.is_empty() {
            sheet.heading(heading);
        }
        rows.into_iter().for_each(|(name, words)| sheet.row(name, words));
    }
}

/// Returns what theories predict for the adhesion of a computed scene without a preload. A row has the name of a theory, and its
/// verdict whether the bodies adhere. The last rows have the result of this program.
pub fn theory_rows(
    scene: &Scene,
    outcome: &Outcome,
    ensemble: Option<&Ensemble>,
) -> Vec<(&'static str, String)> {
    let criteria = criteria(scene, outcome, ensemble);
    let smooth = outcome.governing.amplitude.is_none() && !criteria.is_empty();
    let smooth = smooth.then(|| ("criteria of roughness", "do not apply: the body is smooth".to_owned()));
    let mut last = "";
    let row = |criterion: Criterion| {
        let name = if criterion.name == last { "" } else { criterion.name };
        last = criterion.name;
        (name, criterion.words())
    };
    smooth.into_iter().chain(criteria.into_iter().map(row)).collect()
}

/// Returns the errors of the adhesion force by their sources: number of springs, sample of profiles, measured surface, and model.
/// A row has a source and its relative error in words. With the comparison `reference` with three dimensions there is also a
/// row for the difference from it. The last row names the largest source.
pub fn error_rows(
    scene: &Scene,
    estimate: Option<&Estimate>,
    budget: &Budget,
    ensemble: Option<&Ensemble>,
    reference: Option<&Reference>,
) -> Vec<(&'static str, String)> {
    let words = |share: f64| {
        if share > 1.0 { "more than ± 100 %".to_owned() } else { format!("± {}", per_cent(share)) }
    };
    let share = |share: Option<f64>| share.map(words);
    let grid = match share(budget.grid) {
        Some(grid) if estimate.is_some_and(|estimate| estimate.near_step) => {
            format!("{grid}, near a step of F_a(F_n)")
        }
        grid => grid.unwrap_or_else(|| "not known".to_owned()),
    };
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
        (None, None) => "none for bodies of revolution whose equivalent profile rises everywhere".into(),
    };
    let largest = match budget.largest {
        Some("grid") => "grid: more springs reduce it (--tolerance)",
        Some("sample") => "sample of profiles: more profiles reduce it (--profiles)",
        Some("model") => "model: more springs do not help",
        Some(_) => "surface: more or larger scans reduce it",
        None => "not known",
    };
    let mut rows = vec![("grid", grid), ("sample of profiles", sample), ("surface", surface)];
    let difference = reference.and_then(difference_words);
    rows.extend(difference.map(|difference| ("three dimensions", difference)));
    rows.push(("model", model));
    rows.push(("largest known error", largest.to_owned()));
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::{Simulation, open, run};

    fn scene(fields: &[(&str, &str)]) -> asperity_scene::Document {
        let fields = [&[("numerics.points", "2048"), ("roughness.modes", "(1, 256)")], fields].concat();
        let fields: Vec<_> =
            fields.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
        open("pressure-sensitive").unwrap().set_all(&fields).unwrap()
    }

    #[test]
    fn a_summary_begins_with_the_theory_that_does_not_apply() {
        let hard = scene(&[("material", "(effective_modulus: 2.0e11)"), ("adhesion", "(work: 0.05)")]);
        let outcome = run(&hard).unwrap();
        let text = crate::summary::brief_summary(hard.scene(), &outcome);
        assert!(
            text.starts_with("JKR theory and the rule of Hess do not apply: the Tabor number 0."),
            "{text}"
        );
        assert_eq!(without_jkr(&run(&scene(&[])).unwrap()), None);
    }

    #[test]
    fn each_source_has_a_row_and_the_largest_is_last() {
        let document = scene(&[]);
        let (scene, outcome) = (document.scene(), run(&document).unwrap());
        let simulation = (Simulation::default(), 1);
        let ensemble = Ensemble::of(scene, &[], 6, simulation, &|| false, &mut |_, _| ()).unwrap();
        let rows = |ensemble: Option<&Ensemble>| {
            let budget = Budget::of(&outcome, None, ensemble, None).unwrap();
            error_rows(scene, None, &budget, ensemble, None)
        };
        let words = |rows: Vec<(&str, String)>| rows.into_iter().map(|row| row.1).collect::<Vec<_>>();
        let alone = words(rows(None));
        assert_eq!((alone[0].as_str(), alone[1].as_str()), ("not known", "not known: too few profiles"));
        let among = words(rows(Some(&ensemble)));
        assert!(
            among[1].starts_with("± ") && among[1].ends_with(" of the median of 6 profiles"),
            "{among:?}"
        );
        assert!(among[4].starts_with("sample of profiles"), "{among:?}");
        let theories = theory_rows(scene, &outcome, Some(&ensemble));
        assert_eq!(theories.iter().filter(|row| row.0 == "this program").count(), 1, "{theories:?}");
        assert_eq!(theories.len(), 7);
    }
}
