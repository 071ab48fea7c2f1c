//! Values that the user is typing. If a number has no unit, it gets the unit that the list of
//! parameters shows for the value.

use crate::explorer::app::App;
use crate::explorer::curve_options::OPTIONS;
use crate::explorer::parameters::{Parameter, Setting};
use crate::explorer::prompt::Purpose;
use asperity_contact::Move;
use asperity_data::{format_quantity, in_unit, parse_quantity, unit_of};
use asperity_scene::fields::target_field;
use asperity_scene::loading::{StageKind, loading_text, pressing_force, read_stage};

/// Force in N that determines the prefix of the unit of a typed force, if neither the loading nor
/// the computed curve contains a force.
const USUAL_FORCE: f64 = 1e-5;

/// Returns the value of a parameter as the list of parameters shows it. If the value follows from
/// other values, the text begins with `=`.
pub fn shown(app: &App, parameter: &Parameter) -> String {
    if !parameter.shown.is_empty() || parameter.setting == Setting::Heading {
        return parameter.shown.clone();
    }
    let written = app
        .written(parameter)
        .and_then(|written| written.parse::<f64>().ok());
    match written {
        Some(value) => format!("= {}", format_quantity(value, parameter.field.unit)),
        // The governing parameters are known, so there is no κ because the profile has no
        // roughness.
        None if app.governing().is_some() => "none".to_owned(),
        None => "= …".to_owned(),
    }
}

/// Returns the unit that a typed force gets if it has no unit. The prefix of the unit suits the
/// largest force of the loading or, if the loading has no force, the largest force of the computed
/// curve.
pub fn unit_of_force(app: &App) -> String {
    let of_loading = pressing_force(&app.edit.document.scene().loading);
    let of_curve = app
        .current()
        .and_then(|solved| solved.outcome.figures.preload)
        .unwrap_or_default();
    let force = if of_loading > 0.0 {
        of_loading
    } else if of_curve > 0.0 {
        of_curve
    } else {
        USUAL_FORCE
    };
    unit_of(&format_quantity(force, "N")).to_owned()
}

/// Adds a unit to a typed value that has no unit: the unit that the list of parameters shows. If
/// the parameter is a stage of the loading that has no number, a typed number becomes a force.
pub fn with_unit(app: &App, parameter: &Parameter, typed: &str) -> String {
    if let Setting::CurveOption(index) = parameter.setting
        && let Some(measured) = &app.edit.measured
    {
        return OPTIONS[index].with_unit(measured, typed);
    }
    match parameter.stage {
        Some(_) if parameter.field.unit.is_empty() => in_unit(typed, &unit_of_force(app)),
        _ => parameter
            .field
            .in_shown_units(typed, &shown(app, parameter)),
    }
}

/// Returns the number that the user has typed without a unit, together with the unit that it gets,
/// such as `50 mJ/m²` for `50`. `None` if the typed text contains a unit, or if the quantity has no
/// unit.
pub fn understood(app: &App) -> Option<String> {
    let prompt = app.prompt.as_ref()?;
    let typed = prompt.line.text().trim();
    let quantity = match prompt.purpose {
        Purpose::Move => typed_move(app, typed)?,
        Purpose::Value => typed_value(app, typed)?,
        _ => return None,
    };
    let has_unit = typed.ends_with(quantity.unit) && !prompt.line.text().is_empty();
    if has_unit || matches!(quantity.unit, "" | "1") {
        return None;
    }
    Some(quantity.in_words)
}

/// A typed quantity, as the explorer has understood it.
struct Quantity {
    unit: &'static str,
    in_words: String,
}

/// Reads the typed target of a move of the body. A number without a unit is a force, in units of
/// F_a,max if the force curve shows these. `None` if the text is no target.
pub fn target(app: &App, typed: &str) -> Option<Move> {
    let typed = typed.trim();
    if app.is_normalised()
        && let Some(ideal) = app.ideal_pull_off_force()
        && let Ok(share) = parse_quantity(typed, "1")
    {
        return Some(Move::ToForce(share * ideal));
    }
    read_stage(&in_unit(typed, &unit_of_force(app)), None).ok()
}

fn typed_move(app: &App, typed: &str) -> Option<Quantity> {
    let target = target(app, typed)?;
    let (field, _) = target_field(target)?;
    Some(Quantity {
        unit: field.unit,
        in_words: loading_text(&[target], format_quantity),
    })
}

/// Reads a typed value of the selected parameter. For a loading stage, the user may type a stage of
/// any kind.
fn typed_value(app: &App, typed: &str) -> Option<Quantity> {
    let parameter = app.edit.parameter()?;
    let typed = with_unit(app, parameter, typed);
    let Some(index) = parameter.stage else {
        let written = parameter.field.read_typed(&typed).ok()?;
        return Some(Quantity {
            unit: parameter.field.unit,
            in_words: parameter.field.quantities(&written, format_quantity)?,
        });
    };
    let (kind, _) = StageKind::of(app.edit.document.scene().loading.get(index)?);
    let stage = read_stage(&typed, Some(kind)).ok()?;
    let (field, _) = target_field(stage)?;
    Some(Quantity {
        unit: field.unit,
        in_words: loading_text(&[stage], format_quantity),
    })
}
