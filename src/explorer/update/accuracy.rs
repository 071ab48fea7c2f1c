//! Cost of accuracy, and springs for a tolerance.

use super::{Effect, edit};
use crate::accuracy::{Choice, ChoiceError, Target, parse_tolerance};
use crate::explorer::app::{App, Estimated, Message};
use crate::explorer::prompt::Purpose;
use crate::explorer::study::{Finding, Found, Task};
use crate::explorer::text_line::TextLine;
use crate::scene::format_quantity;
use crate::text::grouped;

/// Remaining studies of the present scene, in this order.
#[must_use]
pub fn study_tasks(app: &App) -> Vec<Task> {
    let Some(computed) = app.current() else { return Vec::new() };
    let appraisal = &app.studies.appraisal;
    if let Some((tolerance, _)) = appraisal.choosing {
        return vec![Task::Choose(computed.scene.clone(), tolerance)];
    }
    let estimate =
        (appraisal.estimated == Estimated::Waiting).then(|| Task::Estimate(std::sync::Arc::clone(computed)));
    let shown = app.view.large.filter(|pane| !app.studies.failures.contains_key(pane));
    let shown = shown.and_then(|pane| (pane.row().task)(app, computed));
    estimate.into_iter().chain(shown).collect()
}

const NOT_COMPUTED: &str = "not before the scene is computed";

/// Asks for a tolerance.
pub fn type_tolerance(app: &mut App) {
    if app.is_current() {
        app.ask(Purpose::Tolerance, TextLine::default());
    } else {
        app.set_error(NOT_COMPUTED);
    }
}

/// Searches springs for a typed tolerance.
pub fn accept_tolerance(app: &mut App, typed: &str) -> Result<Vec<Effect>, String> {
    let tolerance = parse_tolerance(typed)?;
    if !app.is_current() {
        return Err(NOT_COMPUTED.to_owned());
    }
    app.studies.appraisal.choosing = Some((tolerance, None));
    app.studies.appraisal.answer = None;
    // The search ends a measurement.
    app.studies.appraisal.costs.trying = None;
    Ok(vec![Effect::Study])
}

/// Stores a finding.
pub fn found(app: &mut App, found: Found) -> Vec<Effect> {
    if found.generation != app.edit.generation {
        // The scene has been changed since.
        return Vec::new();
    }
    match found.finding {
        Finding::Chosen(tolerance, result) => {
            // Without a search under way the choice is no longer wanted.
            if app.studies.appraisal.choosing.take().is_none() {
                return Vec::new();
            }
            match result {
                Ok(choice) => return take_over(app, &choice),
                Err(error) => {
                    refuse(app, tolerance, &error);
                    return vec![Effect::Study];
                }
            }
        }
        Finding::Extended(data) => (data.pane().row().take_in)(app, data),
        Finding::NotExtended(pane, why) => drop(app.studies.failures.insert(pane, why)),
        Finding::Estimated(estimate) => {
            app.studies.appraisal.estimated = estimate.map_or(Estimated::Unknown, Estimated::Known);
        }
        Finding::Choosing(points) => {
            if let Some((_, trying)) = &mut app.studies.appraisal.choosing {
                *trying = Some(points);
            }
        }
    }
    Vec::new()
}

/// Makes a choice an edit.
fn take_over(app: &mut App, choice: &Choice) -> Vec<Effect> {
    let sentence = choice.sentence();
    let numerics = app.edit.document.scene().numerics;
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
        effects = edit::take_over(app, app.edit.document.set_all(&fields));
        if let Some(Message::Refused(why)) = &app.message {
            app.studies.appraisal.answer = Some(why.clone());
            return effects;
        }
    }
    // From finer solutions than those of an estimate.
    app.studies.appraisal.estimated = Estimated::Known(choice.estimate());
    let already = if is_so { "as it is: " } else { "" };
    let text = fitting(app, format!("{already}{sentence}"), format!("{already}{short}"));
    app.set_done(text);
    app.studies.appraisal.answer = Some(sentence);
    effects
}

/// States the accuracy within reach instead.
fn refuse(app: &mut App, tolerance: f64, error: &ChoiceError) {
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
    let why = fitting(app, sentence.clone(), short);
    app.set_error(why);
    app.studies.appraisal.answer = Some(sentence);
}

/// The long text where the status line has room, else the short one.
fn fitting(app: &App, long: String, short: String) -> String {
    if long.chars().count() + 2 <= usize::from(app.view.size.0) { long } else { short }
}

/// A share in per cent.
fn per_cent(share: f64) -> String {
    format!("{} %", format_quantity(100.0 * share, "1"))
}
