//! The inverse question: for which value of the selected parameter does a quantity reach a target
//! that the user types?

use super::edit;
use crate::explorer::action::Task;
use crate::explorer::advice;
use crate::explorer::app::App;
use crate::explorer::parameters::{Parameter, Setting};
use crate::explorer::prompt::Purpose;
use crate::explorer::studies::Study;
use asperity_contact::Move;
use asperity_data::Remedied;
use asperity_report::found_in_words;
use asperity_scene::text::ron_float;
use asperity_study::{Ensemble, Found, Question};
use std::convert::Infallible;
use std::sync::Arc;

/// Target that the prompt proposes.
const USUAL: &str = "F_a/F_a,max = 80 %";

/// Answer to an inverse question: at which value of a number of the scene does a result have the
/// wanted value? `key` is a text that identifies the question.
#[derive(Clone, Debug)]
pub struct Sought {
    key: String,
    found: Result<Found, String>,
}

/// Returns the path of the number that the inverse question seeks if this row is selected: the
/// preload for a row of the loading, otherwise the parameter of the row. `None` if the question is
/// not possible for this row.
fn sought(parameter: &Parameter) -> Option<&str> {
    if parameter.group == "loading" {
        return Some("preload");
    }
    let is_value = !matches!(
        parameter.setting,
        Setting::Heading | Setting::CurveOption(_)
    );
    if is_value && parameter.takes_number() {
        Some(&parameter.path)
    } else {
        None
    }
}

/// Returns the name of the number that an inverse question seeks. This is the preload if a row of
/// the loading is selected, otherwise the parameter of the selected row.
pub fn name(app: &App) -> String {
    match app.edit.parameter() {
        Some(parameter) if sought(parameter) != Some("preload") => parameter.name(),
        _ => "the preload".to_owned(),
    }
}

/// Asks the user which value a result should have, such as `F_a/F_a,max = 80 %`. The explorer then
/// seeks the value of the selected parameter, or the preload, with which the result has this value.
pub fn ask(app: &mut App) {
    edit::show_parameters(app);
    let Some(parameter) = app.edit.parameter() else {
        return;
    };
    if sought(parameter).is_none() {
        let why = format!(
            "{} has no number to find; select a row with a number, or a loading stage",
            parameter.name()
        );
        return app.set_error(why);
    }
    app.ask(Purpose::Target, USUAL);
    app.effects.push(Task::Study);
}

/// Returns the target that the user is typing; `None` if the prompt for a target is not open.
fn typed(app: &App) -> Option<&str> {
    let prompt = app.prompt.as_ref()?;
    match prompt.purpose {
        Purpose::Target => Some(prompt.line.text()),
        _ => None,
    }
}

/// Returns the key of the inverse question: it contains the scene, the path of the sought number
/// and the target.
fn key(app: &App, typed: &str) -> Option<String> {
    let path = sought(app.edit.parameter()?)?;
    Some(format!("{} {path} {}", app.edit.generation, typed.trim()))
}

/// Returns the study (background computation) that seeks the value for the typed target; `None` if
/// the target is not valid yet.
pub fn study(app: &App) -> Option<Study> {
    let (key, condition) = (
        key(app, typed(app)?)?,
        Question::parse_condition(typed(app)?).ok()?,
    );
    let (scene, path) = (
        Arc::clone(&app.edit.scene),
        sought(app.edit.parameter()?)?.to_owned(),
    );
    Some(Study::new(
        key.clone(),
        false,
        move |simulation, control| {
            let profiles = Ensemble::profiles_of(&scene);
            let found = Question::new(&scene, &path, condition, profiles, simulation)
                .and_then(|question| Found::of(question, simulation, control.of_part()));
            Ok::<_, Infallible>(Sought {
                key,
                found: found.map_err(|error| error.in_words(advice::row)),
            })
        },
    ))
}

/// Returns the answer to the inverse question with this target; `None` if the answer is not known
/// yet.
fn found<'a>(app: &'a App, typed: &str) -> Option<&'a Result<Found, String>> {
    let key = key(app, typed)?;
    let sought = app.studies.value::<Sought>()?;
    if sought.key == key {
        Some(&sought.found)
    } else {
        None
    }
}

/// Returns the answer to the inverse question as text, or a text that states what is missing for an
/// answer. `None` if the user is not typing a target.
pub fn answer(app: &App) -> Option<String> {
    let typed = typed(app)?;
    if let Err(why) = Question::parse_condition(typed) {
        return Some(why.to_string());
    }
    Some(match found(app, typed) {
        None => "finding the value on all profiles…".to_owned(),
        Some(Ok(known)) => answer_in_words(known),
        Some(Err(why)) => why.clone(),
    })
}

fn answer_in_words(found: &Found) -> String {
    let words = found_in_words(found);
    if value(found).is_some() {
        return words + " Enter takes the median.";
    }
    let (least, _) = found.question.searched;
    let is_met_at_any = found.question.seeks_least_preload() && found.quantile(0.5) == Some(least);
    if is_met_at_any {
        format!("At any preload on most profiles. {words}")
    } else {
        words
    }
}

/// Returns the value to be set: the median over the random profiles. Returns `None` if even the
/// smallest preload reaches the target, because then any preload will do.
fn value(found: &Found) -> Option<f64> {
    let median = found.quantile(0.5)?;
    let (least, _) = found.question.searched;
    let is_needed = !found.question.seeks_least_preload() || median > least;
    if is_needed { Some(median) } else { None }
}

/// Sets the selected parameter to the value that the inverse question has found. If this value is a
/// preload, it becomes the force of the loading stage with the largest force.
pub fn accept(app: &mut App, typed: &str) -> Result<(), String> {
    Question::parse_condition(typed).map_err(|error| error.to_string())?;
    let known = match found(app, typed) {
        Some(Ok(known)) => known,
        Some(Err(why)) => return Err(why.clone()),
        None => return Err("the value is still being found".to_owned()),
    };
    let median = value(known).ok_or_else(|| found_in_words(known))?;
    let is_preload = known.question.is_of_preload();
    app.prompt = None;
    if is_preload {
        let stage = pressing_stage(&app.edit.document.scene().loading)
            .ok_or("no loading stage presses to a force; V changes the kind of a stage")?;
        app.edit.select_stage(stage);
    }
    edit::set_selected(app, &ron_float(median));
    Ok(())
}

/// Returns the index of the stage to the largest force. If several stages have this force, returns
/// the last of them.
fn pressing_stage(loading: &[Move]) -> Option<usize> {
    let mut pressing: Option<(usize, f64)> = None;
    for (index, stage) in loading.iter().enumerate() {
        if let Move::ToForce(force) = stage
            && *force > 0.0
            && pressing.is_none_or(|(_, largest)| *force >= largest)
        {
            pressing = Some((index, *force));
        }
    }
    pressing.map(|(index, _)| index)
}
