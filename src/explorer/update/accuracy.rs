//! Cost of accuracy, and springs for a tolerance.

use super::{Effect, edit};
use crate::accuracy::{Choice, ChoiceError, Target, parse_tolerance};
use crate::explorer::model::{Estimated, Model};
use crate::explorer::prompt::Purpose;
use crate::explorer::study::{Finding, Found, Task};
use crate::explorer::text_line::TextLine;
use crate::scene::format_quantity;
use crate::text::grouped;

/// Remaining studies of the present scene, in this order.
#[must_use]
pub fn study_tasks(model: &Model) -> Vec<Task> {
    let Some(computed) = model.current() else { return Vec::new() };
    let appraisal = &model.appraisal;
    if let Some((tolerance, _)) = appraisal.choosing {
        return vec![Task::Choose(computed.scene.clone(), tolerance)];
    }
    let estimate =
        (appraisal.estimated == Estimated::Waiting).then(|| Task::Estimate(std::sync::Arc::clone(computed)));
    let shown = model.large.filter(|pane| !model.failures.contains_key(pane));
    let shown = shown.and_then(|pane| (pane.row().task)(model, computed));
    estimate.into_iter().chain(shown).collect()
}

const NOT_COMPUTED: &str = "not before the scene is computed";

/// Asks for a tolerance.
pub fn type_tolerance(model: &mut Model) {
    if model.is_current() {
        model.ask(Purpose::Tolerance, TextLine::default());
    } else {
        model.set_error(NOT_COMPUTED);
    }
}

/// Searches springs for a typed tolerance.
pub fn accept_tolerance(model: &mut Model, typed: &str) -> Result<Vec<Effect>, String> {
    let tolerance = parse_tolerance(typed)?;
    if !model.is_current() {
        return Err(NOT_COMPUTED.to_owned());
    }
    model.appraisal.choosing = Some((tolerance, None));
    model.appraisal.answer = None;
    // The search ends a measurement.
    model.appraisal.costs.trying = None;
    Ok(vec![Effect::Study])
}

/// Stores a finding.
pub fn found(model: &mut Model, found: Found) -> Vec<Effect> {
    if found.generation != model.generation {
        // The scene has been changed since.
        return Vec::new();
    }
    match found.finding {
        Finding::Chosen(tolerance, result) => {
            // Without a search under way the choice is no longer wanted.
            if model.appraisal.choosing.take().is_none() {
                return Vec::new();
            }
            match result {
                Ok(choice) => return take_over(model, &choice),
                Err(error) => {
                    refuse(model, tolerance, &error);
                    return vec![Effect::Study];
                }
            }
        }
        Finding::Extended(data) => (data.pane().row().take_in)(model, data),
        Finding::NotExtended(pane, why) => drop(model.failures.insert(pane, why)),
        Finding::Estimated(estimate) => {
            model.appraisal.estimated = estimate.map_or(Estimated::Unknown, Estimated::Known);
        }
        Finding::Choosing(points) => {
            if let Some((_, trying)) = &mut model.appraisal.choosing {
                *trying = Some(points);
            }
        }
    }
    Vec::new()
}

/// Makes a choice an edit.
fn take_over(model: &mut Model, choice: &Choice) -> Vec<Effect> {
    let sentence = choice.sentence();
    let numerics = model.document.scene().numerics;
    let short = format!(
        "{} springs, edges {}: {} within {}",
        grouped(choice.points),
        choice.edges.name(),
        if choice.target == Target::Curve { "curve" } else { "F_a" },
        per_cent(choice.tolerance),
    );
    let mut effects = vec![Effect::Study];
    let is_so = (numerics.points, numerics.edges) == (choice.points, choice.edges);
    if !is_so {
        let points = choice.points.to_string();
        let fields = [("numerics.points", points.as_str()), ("numerics.edges", choice.edges.name())];
        let fields = fields.map(|(path, value)| (path.to_owned(), value.to_owned()));
        effects = edit::take_over(model, model.document.set_all(&fields));
        if let Some((_, why)) = &model.refused {
            model.appraisal.answer = Some(why.clone());
            return effects;
        }
    }
    // From finer solutions than those of an estimate.
    model.appraisal.estimated = Estimated::Known(choice.estimate());
    let already = if is_so { "as it is: " } else { "" };
    let text = fitting(model, format!("{already}{sentence}"), format!("{already}{short}"));
    model.set_done(text);
    model.appraisal.answer = Some(sentence);
    effects
}

/// States the accuracy within reach instead.
fn refuse(model: &mut Model, tolerance: f64, error: &ChoiceError) {
    let sentence = error.to_string();
    let short = match error {
        ChoiceError::Unreached { best: Some(best), .. } => format!(
            "{tolerance:e} is out of reach: {:.1e} with {} springs, edges {}",
            best.error,
            grouped(best.points),
            best.edges.name()
        ),
        ChoiceError::Unreached { best: None, .. } => {
            format!("{tolerance:e} cannot be checked: too few springs")
        }
        ChoiceError::Stepwise => "a tolerance needs numerics.solver: Exact".to_owned(),
        ChoiceError::Run(_) | ChoiceError::Stopped => sentence.clone(),
    };
    let why = fitting(model, sentence.clone(), short);
    model.set_error(why);
    model.appraisal.answer = Some(sentence);
}

/// The long text where the status line has room, else the short one.
fn fitting(model: &Model, long: String, short: String) -> String {
    if long.chars().count() + 2 <= usize::from(model.size.0) { long } else { short }
}

/// A share in per cent.
fn per_cent(share: f64) -> String {
    format!("{} %", format_quantity(100.0 * share, "1"))
}
