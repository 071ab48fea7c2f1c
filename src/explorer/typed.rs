//! Values being typed: a number without a unit gets the unit that its row shows.

use crate::explorer::app::App;
use crate::explorer::parameters::{Parameter, Setting};
use crate::explorer::prompt::Purpose;
use crate::explorer::reading::OPTIONS;
use asperity_data::{format_quantity, in_unit, parse_quantity, unit_of};
use asperity_scene::fields::target_field;
use asperity_scene::loading::{StageKind, loading_text, pressing_force, read_stage};

/// Force that determines the prefix of a typed force if the loading has no force, N.
const USUAL_FORCE: f64 = 1e-5;

/// A value in the format for readers; a value that follows from others is marked.
pub fn shown(app: &App, parameter: &Parameter) -> String {
    if !parameter.shown.is_empty() || parameter.setting == Setting::Heading {
        return parameter.shown.clone();
    }
    let written = app
        .written(parameter)
        .and_then(|written| written.parse::<f64>().ok());
    match written {
        Some(value) => format!("= {}", format_quantity(value, parameter.field.unit)),
        // A smooth body has no κ; before the computation κ is unknown.
        None if app.governing().is_some() => "none".to_owned(),
        None => "= …".to_owned(),
    }
}

/// Unit of a typed force, with the prefix of the largest force of the loading or, without one, of
/// the computed curve.
pub fn unit_of_force(app: &App) -> String {
    let computed = || {
        app.current()
            .and_then(|solved| solved.outcome.figures.preload)
    };
    let given = [
        pressing_force(&app.edit.document.scene().loading),
        computed().unwrap_or_default(),
        USUAL_FORCE,
    ];
    let force = given
        .into_iter()
        .find(|force| *force > 0.0)
        .unwrap_or(USUAL_FORCE);
    unit_of(&format_quantity(force, "N")).to_owned()
}

/// Adds the unit of the row to a typed value without one. A number for a stage without one is a
/// force.
pub fn with_unit(app: &App, parameter: &Parameter, typed: &str) -> String {
    if let (Setting::Reading(index), Some(measured)) = (parameter.setting, &app.edit.measured) {
        return OPTIONS[index].with_unit(measured, typed);
    }
    match parameter.leg {
        Some(_) if parameter.field.unit.is_empty() => in_unit(typed, &unit_of_force(app)),
        _ => parameter
            .field
            .in_shown_units(typed, &shown(app, parameter)),
    }
}

/// How a typed text without a unit will be read: `50 mJ/m²` for `50`.
pub fn reading(app: &App) -> Option<String> {
    let prompt = app.prompt.as_ref()?;
    let typed = prompt.line.text().trim();
    let (unit, read) = match prompt.purpose {
        Purpose::Force => {
            let force = parse_quantity(&in_unit(typed, &unit_of_force(app)), "N").ok()?;
            ("N", format_quantity(force, "N"))
        }
        Purpose::Value => {
            let parameter = app.edit.parameter()?;
            let typed = with_unit(app, parameter, typed);
            if let Some(leg) = parameter.leg {
                let kind = StageKind::of(app.edit.document.scene().loading.get(leg)?).0;
                let stage = read_stage(&typed, Some(kind)).ok()?;
                (
                    target_field(stage)?.0.unit,
                    loading_text(&[stage], format_quantity),
                )
            } else {
                let written = parameter.field.read_typed(&typed).ok()?;
                (
                    parameter.field.unit,
                    parameter.field.quantities(&written, format_quantity)?,
                )
            }
        }
        _ => return None,
    };
    let says_so = typed.ends_with(unit) && !prompt.line.text().is_empty();
    (!says_so && !matches!(unit, "" | "1")).then_some(read)
}
