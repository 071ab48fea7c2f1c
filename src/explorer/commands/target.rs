//! The inverse question: the value of the selected row at which a quantity has a typed value.

use super::edit;
use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::parameters::{Parameter, Setting};
use crate::explorer::prompt::Purpose;
use crate::explorer::studies::Study;
use asperity_contact::Move;
use asperity_report::found_in_words;
use asperity_scene::text::ron_float;
use asperity_study::{Ensemble, Found, Question};
use std::convert::Infallible;
use std::sync::Arc;

/// The target that the prompt proposes.
const USUAL: &str = "F_a/F_a,max = 80 %";

/// The answer to a question, which is identified by its key.
#[derive(Clone, Debug)]
pub struct Sought {
    key: String,
    found: Result<Found, String>,
}

/// Path of the number that is sought on the row of a parameter: its own, or of the loading the
/// preload.
fn sought(parameter: &Parameter) -> Option<&str> {
    match parameter.setting {
        _ if parameter.group == "loading" => Some("preload"),
        Setting::Heading | Setting::Reading(_) => None,
        _ => Some(parameter.path.as_str()).filter(|_| parameter.takes_number()),
    }
}

/// Name of the number that is sought on the selected row.
pub fn name(app: &App) -> String {
    let parameter = app
        .edit
        .parameter()
        .filter(|parameter| sought(parameter) != Some("preload"));
    parameter.map_or_else(|| "the preload".to_owned(), Parameter::name)
}

/// Asks for a target of the selected row.
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

/// The condition being typed; `None` without such a prompt.
fn typed(app: &App) -> Option<&str> {
    let prompt = app
        .prompt
        .as_ref()
        .filter(|prompt| matches!(prompt.purpose, Purpose::Target))?;
    Some(prompt.line.text())
}

/// Key of the question for the selected row with this condition.
fn key(app: &App, typed: &str) -> Option<String> {
    let path = sought(app.edit.parameter()?)?;
    Some(format!("{} {path} {}", app.edit.generation, typed.trim()))
}

/// Finds the value for the typed target; `None` without a target that can be read.
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
                found: found.map_err(|error| error.to_string()),
            })
        },
    ))
}

/// The answer to the question with this condition; `None` while it is not known.
fn found<'a>(app: &'a App, typed: &str) -> Option<&'a Result<Found, String>> {
    let key = key(app, typed)?;
    app.studies
        .value::<Sought>()
        .filter(|sought| sought.key == key)
        .map(|sought| &sought.found)
}

/// The answer in words, or what is missing; `None` without a question.
pub fn answer(app: &App) -> Option<String> {
    let typed = typed(app)?;
    Some(
        match (Question::parse_condition(typed), found(app, typed)) {
            (Err(why), _) => why.to_string(),
            (Ok(_), None) => "finding the value on all profiles…".to_owned(),
            (Ok(_), Some(Ok(found))) => {
                let any = found.question.seeks_least_preload()
                    && found.quantile(0.5) == Some(found.question.searched.0);
                match value(found) {
                    Some(_) => found_in_words(found) + " Enter takes the median.",
                    None if any => {
                        format!("At any preload on most profiles. {}", found_in_words(found))
                    }
                    None => found_in_words(found),
                }
            }
            (Ok(_), Some(Err(why))) => why.clone(),
        },
    )
}

/// The value to take: the median over the profiles, if the target needs one.
fn value(found: &Found) -> Option<f64> {
    let is_needed =
        |value: &f64| !found.question.seeks_least_preload() || *value > found.question.searched.0;
    found.quantile(0.5).filter(is_needed)
}

/// Gives the selected row the found value; a preload goes to the stage that presses most.
pub fn accept(app: &mut App, typed: &str) -> Result<(), String> {
    Question::parse_condition(typed).map_err(|error| error.to_string())?;
    let found = found(app, typed)
        .ok_or("the value is still being found")?
        .as_ref()
        .map_err(Clone::clone)?;
    let (value, is_preload) = (
        value(found).ok_or_else(|| found_in_words(found))?,
        found.question.is_of_preload(),
    );
    app.prompt = None;
    if is_preload {
        let loading = &app.edit.document.scene().loading;
        let force = |stage: &Move| {
            if let Move::ToForce(force) = stage {
                *force
            } else {
                f64::NEG_INFINITY
            }
        };
        let most = (0..loading.len())
            .max_by(|one, other| force(&loading[*one]).total_cmp(&force(&loading[*other])));
        let stage = most.filter(|stage| force(&loading[*stage]) > 0.0);
        let stage =
            stage.ok_or("no loading stage presses to a force; V changes the kind of a stage")?;
        let row = app
            .edit
            .parameters
            .iter()
            .position(|one| one.leg == Some(stage));
        app.edit.select(row.unwrap_or(app.edit.selected));
    }
    edit::set_selected(app, &ron_float(value));
    Ok(())
}
