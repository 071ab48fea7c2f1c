//! Commands for the measured force curve that the explorer compares with the scene: its point of
//! first touch, its deviation from the scene, and fits of parameters.

use super::edit;
use crate::explorer::action::{CurveRequest, Task};
use crate::explorer::advice;
use crate::explorer::app::App;
use crate::explorer::curve_options::{CurveOptionRow, OPTIONS};
use crate::explorer::editor::Edited;
use crate::explorer::measured::{Fitting, Measured, fitted};
use crate::explorer::parameters::Setting;
use crate::explorer::prompt::Purpose;
use crate::explorer::studies::Study;
use asperity_data::Remedied;
use asperity_data::{Control, format_rounded, one_unit};
use asperity_experiment::{Fit, FitResult, FittedParameter, Free, Grade, Parameter};
use std::convert::Infallible;
use std::sync::Arc;

/// Number of curves that a fit computes between two reports of its progress.
const REPORTED: u64 = 64;

/// Returns the study (background computation) of the measured curve, which is the fit that the user
/// has requested. If the user has requested no fit, the study fits only the displacement at first
/// touch, and computes the deviation of the curve from the scene. `None` if there is nothing to
/// compute.
pub fn study(app: &App) -> Option<Study> {
    let (curve, document) = (
        Arc::clone(&app.edit.measured.as_ref()?.curve),
        app.edit.document.clone(),
    );
    Some(match app.studies.value::<Fitting>() {
        Some(Fitting { free, .. }) => {
            let free = free.clone();
            Study::new(app.edit.generation, true, move |_, mut control| {
                let control_of_fit = control.of_part();
                let mut count = |evaluations: &u64| {
                    if evaluations.is_multiple_of(REPORTED) {
                        control.report(Fitting {
                            free: free.clone(),
                            evaluations: *evaluations,
                            found: None,
                        });
                    }
                };
                let fit = free.iter().copied().fold(Fit::of(&document), Fit::free);
                let found = fit.run(&curve, control_of_fit.reporting_to(&mut count));
                let found = found
                    .map(Arc::new)
                    .map_err(|error| error.in_words(advice::row));
                Ok::<_, Infallible>(Fitting {
                    free: free.clone(),
                    evaluations: 0,
                    found: Some(found),
                })
            })
        }
        None => Study::new(
            app.edit.generation,
            true,
            move |_, control: Control<'_, Arc<FitResult>>| {
                let fit = Fit::of(&document).free(Parameter::Offset);
                fit.run(&curve, control.of_part()).map(Arc::new)
            },
        ),
    })
}

pub fn ask_fit(app: &mut App) {
    match app.edit.measured {
        Some(_) => app.ask(Purpose::Fit, "work,offset"),
        None => app.set_error("there is no measured curve; o opens one by its path"),
    }
}

pub fn accept_fit(app: &mut App, typed: &str) -> Result<(), String> {
    let names = typed.split(',');
    let free = names
        .map(|name| name.trim().parse())
        .collect::<Result<Vec<Free>, String>>()?;
    if !app.is_current() {
        return Err(edit::STILL_COMPUTED.to_owned());
    }
    let fitting = Fitting {
        free,
        evaluations: 0,
        found: None,
    };
    app.studies.set(app.edit.generation, fitting, false);
    app.effects.push(Task::Study);
    Ok(())
}

/// Applies the results of a fit. The measured curve gets the displacement at first touch, and the
/// scene gets the fitted parameters.
pub fn found(app: &mut App) {
    if let Some(Fitting {
        found: Some(found), ..
    }) = app.studies.value::<Fitting>().cloned()
    {
        app.studies.forget::<Fitting>();
        match found {
            Ok(fit) => {
                edit::apply(app, Ok(fit.document.clone()));
                app.set_done(sentence(&fit));
                app.studies.set(app.edit.generation, fit, true);
            }
            Err(why) => app.set_error(why),
        }
    }
    if let Some(offset) = fitted_offset(app)
        && let Some(measured) = &mut app.edit.measured
    {
        measured.offset = offset;
    }
}

/// Returns the measured displacement at first touch in m; `None` if no fit has found it yet.
fn fitted_offset(app: &App) -> Option<f64> {
    let fit = fitted(&app.studies)?;
    let mut parameters = fit.parameters.iter();
    let offset = parameters.find(|fitted| fitted.parameter == Parameter::Offset)?;
    Some(offset.value)
}

/// Returns the option for reading the curve that the selected row shows, and the measured curve;
/// `None` if the selected row shows no such option.
fn selected(app: &App) -> Option<(&'static CurveOptionRow, &Measured)> {
    let Setting::CurveOption(index) = app.edit.parameter()?.setting else {
        return None;
    };
    Some((OPTIONS.get(index)?, app.edit.measured.as_ref()?))
}

/// Returns true if the selected row is an option for reading the measured curve.
pub fn is_option(app: &App) -> bool {
    selected(app).is_some()
}

/// Sets the option in the selected row to the typed value. The measured curve is then read again.
pub fn accept_option(app: &mut App, typed: &str) -> Result<(), String> {
    let Some((option, measured)) = selected(app) else {
        return Ok(());
    };
    let options = option.with(&measured.options, &option.with_unit(measured, typed))?;
    if options != measured.options {
        app.effects.push(Task::ReadCurve(CurveRequest {
            options,
            typed: Some(typed.to_owned()),
        }));
    }
    Ok(())
}

/// Changes the value of the option in the selected row. A force changes by `steps` steps, which are
/// as large as the steps of the explorer for a force in a scene, and larger if `coarse` is true. An
/// option with a list of values gets the next value, or the previous one if `steps` is negative. A
/// message appears if the option can only be typed.
pub fn step_option(app: &mut App, steps: i32, coarse: bool) {
    edit::show_parameters(app);
    let Some((option, measured)) = selected(app) else {
        return;
    };
    let Some(next) = next_value(option, measured, steps, coarse) else {
        let name = option.field.name;
        let shown = option.shown(measured);
        return edit::refuse(app, format!("{name}: {shown}; Enter types a value"));
    };
    match option.with(&measured.options, &next) {
        Ok(options) => app.effects.push(Task::ReadCurve(CurveRequest {
            options,
            typed: None,
        })),
        Err(why) => edit::refuse(app, why),
    }
}

/// Returns the value of an option after a number of steps; `None` if the value can only be typed.
fn next_value(
    option: &CurveOptionRow,
    measured: &Measured,
    steps: i32,
    coarse: bool,
) -> Option<String> {
    if let Some(choice) = option.next_choice(&measured.options, steps > 0) {
        return Some(choice.to_owned());
    }
    let present = option.value(&measured.options)?;
    option.field.stepped(&present, steps, coarse)
}

/// Shows the measured curve that was read with other options, and sets the loading that follows
/// from this curve. Both changes are one edit. If the curve could not be read, a message states the
/// reason.
pub fn show_read(app: &mut App, wanted: &CurveRequest, read: Result<Box<Measured>, String>) {
    match read.and_then(|measured| with_loading(app, *measured)) {
        Ok(edited) => {
            edit::adopt_all(app, edited);
            if let Some(measured) = &app.edit.measured {
                app.set_done(measured.statements());
            }
        }
        Err(why) => match &wanted.typed {
            Some(typed) => app.ask_again(Purpose::Value, typed, &why),
            None => edit::refuse(app, why),
        },
    }
}

/// Returns the present scene with the loading of a measured curve, and the curve.
fn with_loading(app: &App, measured: Measured) -> Result<Edited, String> {
    let document = measured.curve.load(&app.edit.document, measured.offset);
    Ok(Edited {
        document: document.map_err(|errors| errors.to_string())?,
        measured: Some(measured),
    })
}

/// Returns the fitted parameters with their intervals as text. If the scene does not describe the
/// curve, this statement comes first.
fn sentence(fit: &FitResult) -> String {
    let values: Vec<String> = fit.parameters.iter().map(value_in_words).collect();
    let values = values.join(", ");
    let Some(reason) = &fit.reason else {
        return format!("fit: {values}; u undoes");
    };
    let misfit = format_rounded(fit.misfit, 3, "1");
    let described = match fit.grade {
        Grade::No => "the scene does not describe the curve".to_owned(),
        _ => format!("the scene describes the curve {}", fit.agreement),
    };
    format!("{described}, misfit {misfit}; {values}; {reason} u undoes")
}

/// Returns a fitted parameter with its interval as text.
fn value_in_words(fitted: &FittedParameter) -> String {
    let symbol = fitted.parameter.row().symbol;
    if let Some(bound) = fitted.bound() {
        return format!("{symbol} {bound}");
    }
    let (low, high) = fitted.interval;
    let interval = one_unit([fitted.text(low), fitted.text(high)]);
    format!("{symbol} {} ({interval})", fitted.text(fitted.value))
}
