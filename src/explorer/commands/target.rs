//! The inverse question: for which value of the selected parameter does a quantity reach a target
//! that the user types?

use super::edit;
use crate::explorer::action::Task;
use crate::explorer::advice;
use crate::explorer::app::{App, Message};
use crate::explorer::parameters::{Parameter, Setting};
use crate::explorer::prompt::Purpose;
use crate::explorer::studies::Study;
use crate::explorer::text::wrapped;
use asperity_contact::Move;
use asperity_data::{Remedied, format_rounded};
use asperity_report::{found_briefly, found_in_words, percent};
use asperity_scene::fields::Range;
use asperity_scene::text::ron_float;
use asperity_study::{Ensemble, Found, Quantity, Question};
use ratatui::text::Line;
use std::convert::Infallible;
use std::sync::Arc;

/// Quantity of the target that the prompt proposes.
const SHARE: Quantity = Quantity::AdhesionShare;
/// Share of F_a,max that the prompt proposes before the share of the scene is known.
const USUAL: f64 = 0.5;
/// Number of rows of dots in the strip of answers. Further dots at the same place are left out.
const ROWS_OF_STRIP: usize = 2;

/// Answer to an inverse question: at which value of a number of the scene does a result have the
/// wanted value? `key` is a text that identifies the question.
#[derive(Clone, Debug)]
pub struct Sought {
    key: String,
    found: Result<Found, String>,
}

impl Sought {
    /// Returns the median answer; `None` if there is none.
    pub fn value(&self) -> Option<f64> {
        self.found.as_ref().ok()?.quantile(0.5)
    }
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
        Setting::Heading | Setting::CurveOption(_) | Setting::Profiles
    );
    if is_value && parameter.takes_number() && !is_pair(parameter) {
        Some(&parameter.path)
    } else {
        None
    }
}

/// Returns true if the value of a parameter consists of two numbers.
fn is_pair(parameter: &Parameter) -> bool {
    matches!(
        parameter.field.range,
        Range::Band(..) | Range::Wavelengths(..)
    )
}

/// Returns the name of the number that an inverse question seeks. This is the preload if a row of
/// the loading is selected, otherwise the parameter of the selected row.
pub fn name(app: &App) -> String {
    match app.edit.parameter() {
        Some(parameter) if sought(parameter) == Some("preload") => {
            Quantity::PreloadForce.symbol().to_owned()
        }
        Some(parameter) if !parameter.field.symbol.is_empty() => parameter.field.symbol.to_owned(),
        Some(parameter) => parameter.name(),
        None => String::new(),
    }
}

/// Returns the target that the prompt proposes: the share of F_a,max that the scene reaches, as the
/// median over the profiles. Other values are then near a value that is reached. For a scene
/// without adhesion, the target is half of the contact.
fn proposed(app: &App) -> String {
    let of_profiles = app
        .studies
        .value::<Ensemble>()
        .and_then(|ensemble| ensemble.statistics(Quantity::AdhesionShare))
        .map(|shares| shares.quartiles[1]);
    let of_this_profile = || {
        let force = app.outcome()?.figures.pull_off_force?;
        Some(force / app.ideal_pull_off_force()?)
    };
    if app.edit.document.scene().adhesion.is_none() {
        let name = Quantity::ContactFraction.symbol_or_name();
        return format!("{name} = 50 %");
    }
    let share = of_profiles.or_else(of_this_profile).unwrap_or(USUAL);
    format!("{} = {}", SHARE.symbol_or_name(), percent(share, 2))
}

/// Returns the condition that the user has typed. A number alone is a share of F_a,max in per cent,
/// and so is a number above 1 without a unit.
fn condition_text(typed: &str) -> String {
    let typed = typed.trim();
    let name = SHARE.symbol_or_name();
    let (value, is_alone) = match typed.rsplit_once('=') {
        Some((left, value)) if left.trim() == name => (value.trim(), false),
        Some(_) => return typed.to_owned(),
        None => (typed, true),
    };
    match value.parse::<f64>() {
        Ok(number) if is_alone || number > 1.0 => format!("{name} = {value} %"),
        Err(_) if is_alone && value.starts_with(|first: char| first.is_ascii_digit()) => {
            format!("{name} = {value}")
        }
        _ => typed.to_owned(),
    }
}

/// Returns how the typed target was understood; `None` if it is a condition as it is typed.
pub fn understood(app: &App) -> Option<String> {
    let typed = typed(app)?.trim();
    let condition = condition_text(typed);
    let is_read = Question::parse_condition(&condition).is_ok();
    if is_read && condition != typed {
        Some(condition)
    } else {
        None
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
        let found = if is_pair(parameter) {
            "two numbers"
        } else {
            "no number to find"
        };
        let why = format!(
            "{} has {found}; select a row with a number, or a loading stage",
            parameter.name()
        );
        return app.set_error(why);
    }
    app.ask(Purpose::Target, &proposed(app));
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
    let typed = condition_text(typed(app)?);
    let (key, condition) = (key(app, &typed)?, Question::parse_condition(&typed).ok()?);
    let (scene, path) = (
        Arc::clone(&app.edit.scene),
        sought(app.edit.parameter()?)?.to_owned(),
    );
    let profiles = app.edit.count_profiles();
    Some(Study::new(
        key.clone(),
        false,
        move |simulation, control| {
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

/// Returns the answer to the inverse question in few words, the most important first, or a text
/// about what is missing; `None` if the user is typing no target.
pub fn answer(app: &App) -> Option<Vec<String>> {
    let condition = condition_text(typed(app)?);
    if let Err(why) = Question::parse_condition(&condition) {
        return Some(vec![why.to_string()]);
    }
    Some(match found(app, &condition) {
        None => vec!["finding the value on all profiles…".to_owned()],
        Some(Err(why)) => vec![why.clone()],
        Some(Ok(known)) => {
            let mut parts: Vec<String> = Vec::new();
            for part in found_briefly(known) {
                parts.push(part.text);
            }
            if value(known).is_some() {
                parts.push("Enter".to_owned());
            }
            parts
        }
    })
}

/// Returns the answer to the inverse question in as many lines of this width as it needs. If there
/// are at most `rows` lines, a strip of the values on all profiles comes first. `None` if the user
/// is typing no target, or if there is no answer yet.
pub fn answer_lines(app: &App, width: u16, rows: usize) -> Option<Vec<Line<'static>>> {
    let condition = condition_text(typed(app)?);
    let Some(Ok(known)) = found(app, &condition) else {
        return None;
    };
    let mut lines = Vec::new();
    for part in found_briefly(known) {
        let text = if part.detail.is_empty() {
            part.text
        } else {
            format!("{}, {}", part.text, part.detail)
        };
        lines.extend(wrapped(&Line::raw(text), width));
    }
    if value(known).is_some() {
        let taken = if known.answers.len() > 1 {
            "Enter takes the median"
        } else {
            "Enter takes it"
        };
        lines.push(Line::raw(taken));
    }
    let mut strip = strip(known, width.into());
    if strip.len() + lines.len() <= rows {
        strip.append(&mut lines);
        return Some(strip);
    }
    Some(lines)
}

/// Returns the values on all profiles as dots along an axis from the smallest to the largest value,
/// with a line at the median. Returns nothing if fewer than two values differ.
fn strip(known: &Found, width: usize) -> Vec<Line<'static>> {
    let Some((least, most)) = known.range() else {
        return Vec::new();
    };
    if least == most || width < 2 {
        return Vec::new();
    }
    let column = |value: f64| {
        let share = (value - least) / (most - least);
        (share * (width - 1) as f64).round() as usize
    };
    let mut counts = vec![0; width];
    for value in known.values().into_iter().flatten() {
        counts[column(value)] += 1;
    }
    let median = known.quantile(0.5).map(column);
    let mut rows = Vec::new();
    for row in (0..ROWS_OF_STRIP).rev() {
        let mut text = String::new();
        for (place, count) in counts.iter().enumerate() {
            text.push(if *count > row {
                '●'
            } else if median == Some(place) {
                '│'
            } else {
                ' '
            });
        }
        rows.push(Line::raw(text));
    }
    let unit = known.question.axis.unit;
    let [low, high] = [least, most].map(|end| format_rounded(end, 3, unit));
    let taken = low.chars().count() + high.chars().count();
    let between = "─".repeat(width.saturating_sub(taken));
    rows.push(Line::raw(format!("{low}{between}{high}")));
    rows
}

/// Returns the message after the answer of a question has been taken: the median, over the
/// profiles, that the quantity then has. It differs from the target, because the median of the
/// answers is not the answer for the median profile.
pub fn taken_in_words(app: &App, name: &str, quantity: Quantity) -> String {
    let ensemble = app.studies.value::<Ensemble>();
    let is_computed = app.is_current() && app.studies.is_done::<Ensemble>();
    let symbol = quantity.symbol_or_name();
    let text = format!("median {name}; the median of {symbol} is then");
    match ensemble.and_then(|ensemble| ensemble.statistics(quantity)) {
        Some(statistics) if is_computed => {
            let median = statistics.quartiles[1];
            let value = if quantity == SHARE {
                percent(median, 3)
            } else {
                format_rounded(median, 3, quantity.unit())
            };
            format!("{text} {value}")
        }
        _ => format!("{text} …"),
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
    let typed = condition_text(typed);
    Question::parse_condition(&typed).map_err(|error| error.to_string())?;
    let known = match found(app, &typed) {
        Some(Ok(known)) => known,
        Some(Err(why)) => return Err(why.clone()),
        None => return Err("the value is still being found".to_owned()),
    };
    let Some(median) = value(known) else {
        let answer = found_in_words(known);
        if known.quantile(0.5).is_none() {
            return Err(answer);
        }
        // Every preload reaches the target, so there is nothing to set.
        app.prompt = None;
        app.set_done(answer);
        return Ok(());
    };
    let is_preload = known.question.is_of_preload();
    let has_profiles = known.answers.len() > 1;
    let quantity = known.question.quantity;
    let name = if is_preload {
        "preload".to_owned()
    } else {
        name(app)
    };
    app.prompt = None;
    if is_preload {
        let stage = pressing_stage(&app.edit.document.scene().loading)
            .ok_or("no loading stage presses to a force; V changes the kind of a stage")?;
        app.edit.select_stage(stage);
    }
    edit::set_selected(app, &ron_float(median));
    if app.is_refused() {
        return Ok(());
    }
    // The explorer computes this median for a few quantities only.
    if has_profiles && Ensemble::NUMBERS.contains(&quantity) {
        app.message = Some(Message::Taken { name, quantity });
    } else {
        app.set_done(format!("{name} for {typed}; u undoes"));
    }
    Ok(())
}

/// Returns the index of the stage to the largest force. If several stages have this force, returns
/// the last of them.
pub fn pressing_stage(loading: &[Move]) -> Option<usize> {
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
