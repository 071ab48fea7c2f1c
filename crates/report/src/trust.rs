//! How far an adhesion force can be trusted: criteria of other theories, and errors by their sources.

use crate::sheet::Sheet;
use asperity_data::per_cent;
use asperity_scene::{Estimate, Outcome, Scene};
use asperity_study::{Budget, Criterion, LEAST_TABOR_NUMBER_OF_JKR, criteria};

/// The sentence with which a summary begins where JKR theory does not apply.
pub(crate) fn without_jkr(outcome: &Outcome) -> Option<String> {
    let number = outcome.tabor_number.filter(|number| *number < LEAST_TABOR_NUMBER_OF_JKR)?;
    let number = asperity_data::format_rounded(number, 2, "1");
    Some(format!(
        "JKR theory and the rule of Hess do not apply: the Tabor number {number} is below {LEAST_TABOR_NUMBER_OF_JKR}, so \
         that the attraction reaches beyond the contact. DMT theory applies; the adhesion below is too large."
    ))
}

/// Adds the criteria of adhesion, and the errors of the adhesion force if there is one.
pub(crate) fn trust(sheet: &mut Sheet, scene: &Scene, outcome: &Outcome, estimate: Option<&Estimate>) {
    theories(sheet, outcome, &criteria(scene, outcome, None));
    if let Some(budget) = Budget::of(outcome, estimate, &[], None) {
        errors(sheet, scene, estimate, &budget, 1);
    }
}

/// Adds the criteria of adhesion without a preload, a row for each.
fn theories(sheet: &mut Sheet, outcome: &Outcome, criteria: &[Criterion]) {
    if criteria.is_empty() {
        return;
    }
    sheet.heading("Adhesion without a preload, by several theories");
    if outcome.governing.amplitude.is_none() {
        sheet.row("criteria of roughness", "do not apply: the body is smooth");
    }
    let mut last = "";
    for criterion in criteria {
        sheet.row(if criterion.name == last { "" } else { criterion.name }, criterion.words());
        last = criterion.name;
    }
}

/// Adds the errors of the adhesion force by their sources, with the largest of them in words; `profiles` is the number of
/// random profiles of the median.
fn errors(sheet: &mut Sheet, scene: &Scene, estimate: Option<&Estimate>, budget: &Budget, profiles: usize) {
    let share = |share: Option<f64>| share.map(|share| format!("± {}", per_cent(share)));
    sheet.heading("Errors of F_a by their sources");
    let grid = match share(budget.grid) {
        Some(grid) if estimate.is_some_and(|estimate| estimate.near_step) => {
            format!("{grid}, near a step of F_a(F_n)")
        }
        grid => grid.unwrap_or_else(|| "not known".to_owned()),
    };
    sheet.row("grid", grid);
    let is_random = scene.seed().is_some();
    let sample = match share(budget.sample) {
        Some(sample) => format!("{sample} of the median of {profiles} profiles"),
        None if is_random => "not known: one profile alone".to_owned(),
        None => "none: the profile is fixed".to_owned(),
    };
    sheet.row("sample of profiles", sample);
    let surface = match (share(budget.surface), scene.measured()) {
        (Some(surface), _) => format!("{surface}, by the uncertainty of the measured spectrum"),
        (None, Some(_)) if is_random => {
            "not known: asperity surface FILE --modulus E --work γ estimates it".to_owned()
        }
        (None, Some(_)) => "not known: the measured profile counts as exact".to_owned(),
        (None, None) => "none: the scene states the surface".to_owned(),
    };
    sheet.row("surface", surface);
    let model = match scene.roughness {
        Some(_) => "not known: the MDR is a model for rough bodies, whose adhesion is disputed",
        None => "none for bodies of revolution whose equivalent profile rises everywhere",
    };
    sheet.row("model", model);
    let largest = match budget.largest {
        Some("grid") => "grid: more springs reduce it (--tolerance)",
        Some("sample") => "sample of profiles: more profiles reduce it (--lines)",
        Some(_) => "surface: more or larger scans reduce it",
        None => "not known",
    };
    sheet.row("largest known error", largest);
}
