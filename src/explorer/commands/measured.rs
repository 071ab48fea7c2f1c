//! A measured force curve beside the scene: its first touch, the residual of the scene, and fits of
//! parameters.

use super::edit;
use crate::explorer::action::{Reading, Task};
use crate::explorer::app::App;
use crate::explorer::editor::Edited;
use crate::explorer::measured::{Fitting, Measured, fitted};
use crate::explorer::parameters::Setting;
use crate::explorer::prompt::Purpose;
use crate::explorer::reading::{OPTIONS, ReadingOption};
use crate::explorer::studies::Study;
use asperity_data::{Control, format_rounded, one_unit};
use asperity_experiment::{Fit, FitResult, FittedParameter, Free, Parameter};
use std::convert::Infallible;
use std::sync::Arc;

/// Number of computed curves between two progress reports of a fit.
const REPORTED: u64 = 64;

/// The study of the measured curve: the requested fit, or else the position of the curve and the
/// residual.
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
                let found = found.map(Arc::new).map_err(|error| error.to_string());
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
    let free = typed
        .split(',')
        .map(|one| one.trim().parse())
        .collect::<Result<Vec<Free>, String>>()?;
    if !app.is_current() {
        return Err("the scene is still being computed".to_owned());
    }
    app.studies.set(
        app.edit.generation,
        Fitting {
            free,
            evaluations: 0,
            found: None,
        },
        false,
    );
    app.effects.push(Task::Study);
    Ok(())
}

/// Applies what a study has found: the position of the curve, and the scene of a fit.
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
    let is_offset = |one: &&FittedParameter| one.parameter == Parameter::Offset;
    let offset =
        fitted(&app.studies).and_then(|fit| Some(fit.parameters.iter().find(is_offset)?.value));
    if let Some((measured, offset)) = app.edit.measured.as_mut().zip(offset) {
        measured.offset = offset;
    }
}

/// The option of reading in the selected row, with the curve that it belongs to.
fn selected(app: &App) -> Option<(&'static ReadingOption, &Measured)> {
    match (app.edit.parameter()?.setting, &app.edit.measured) {
        (Setting::Reading(index), Some(measured)) => Some((OPTIONS.get(index)?, measured)),
        _ => None,
    }
}

/// Returns true if the selected row is an option of reading.
pub fn is_option(app: &App) -> bool {
    selected(app).is_some()
}

/// Takes a typed value of the selected option; the curve is then read anew.
pub fn accept_option(app: &mut App, typed: &str) -> Result<(), String> {
    let Some((option, measured)) = selected(app) else {
        return Ok(());
    };
    let options = option.with(&measured.options, &option.with_unit(measured, typed))?;
    if options != measured.options {
        app.effects.push(Task::Read(Reading {
            options,
            typed: Some(typed.to_owned()),
        }));
    }
    Ok(())
}

/// Changes the selected option to the next choice; given forces change as the forces of a scene do.
pub fn step_option(app: &mut App, steps: i32, coarse: bool) {
    edit::show_parameters(app);
    let Some((option, measured)) = selected(app) else {
        return;
    };
    let next = option
        .next_choice(&measured.options, steps > 0)
        .map(str::to_owned);
    let written = || {
        option
            .field
            .stepped(&option.value(&measured.options)?, steps, coarse)
    };
    let Some(next) = next.or_else(written) else {
        let name = option.field.name;
        return edit::refuse(
            app,
            format!("{name}: {}; Enter types a value", option.shown(measured)),
        );
    };
    match option.with(&measured.options, &next) {
        Ok(options) => app.effects.push(Task::Read(Reading {
            options,
            typed: None,
        })),
        Err(why) => edit::refuse(app, why),
    }
}

/// Shows the curve as read with other options, in one edit with its loading; or states why it was
/// not read.
pub fn read(app: &mut App, reading: &Reading, read: Result<Box<Measured>, String>) {
    let loaded = |measured: Box<Measured>| {
        let document = measured.curve.load(&app.edit.document, measured.offset);
        let document = document.map_err(|errors| errors.to_string())?;
        Ok(Edited {
            document,
            measured: Some(*measured),
        })
    };
    match (read.and_then(loaded), &reading.typed) {
        (Ok(edited), _) => {
            edit::adopt_all(app, edited);
            let statements = app
                .edit
                .measured
                .as_ref()
                .map(|measured| measured.curve.statements.join(" "));
            statements
                .into_iter()
                .for_each(|statements| app.set_done(statements));
        }
        (Err(why), Some(typed)) => app.ask_again(Purpose::Value, typed, &why),
        (Err(why), None) => edit::refuse(app, why),
    }
}

/// The fitted parameters with their intervals, in words; first of all whether the scene does not
/// describe the curve.
fn sentence(fit: &FitResult) -> String {
    let found = |one: &FittedParameter| {
        let interval = one_unit([one.interval.0, one.interval.1].map(|end| one.text(end)));
        format!(
            "{} {} ({interval})",
            one.parameter.row().symbol,
            one.text(one.value)
        )
    };
    let found = fit
        .parameters
        .iter()
        .map(found)
        .collect::<Vec<_>>()
        .join(", ");
    match fit.reason {
        None => format!("fit: {found}; u undoes"),
        Some(reason) => {
            let misfit = format_rounded(fit.misfit, 3, "1");
            format!(
                "the scene does not describe the curve, misfit {misfit}; {found}; {reason} u undoes"
            )
        }
    }
}
