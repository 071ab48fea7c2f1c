//! A measured force curve beside the scene: its first touch, the residual of the scene, and fits of parameters.

use super::edit;
use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::measured::{Fitting, fitted};
use crate::explorer::prompt::Purpose;
use crate::explorer::studies::Study;
use asperity_data::{format_quantity, one_unit};
use asperity_experiment::{Fit, FitOptions, FittedParameter, Free, Parameter, fit};
use std::sync::Arc;

/// Number of computed curves between two progress reports of a fit.
const REPORTED: usize = 64;

/// The study of the measured curve: the requested fit, or else the position of the curve and the residual.
pub fn study(app: &App) -> Option<Study> {
    let (curve, document) = (Arc::clone(&app.measured.as_ref()?.curve), app.edit.document.clone());
    let options = |free| FitOptions { free, lines: 1, jobs: 1 };
    Some(match app.studies.value::<Fitting>() {
        Some(Fitting { free, .. }) => {
            let (free, options) = (free.clone(), options(free.clone()));
            Study::new(app.edit.generation, true, move |_, stop, report| {
                let mut count = |evaluations: usize| {
                    if evaluations.is_multiple_of(REPORTED) {
                        report(Fitting { free: free.clone(), evaluations, found: None });
                    }
                };
                let found = fit(&curve, &document, &options, stop, &mut count);
                let found = found.map(Arc::new).map_err(|error| error.to_string());
                Ok(Fitting { free: free.clone(), evaluations: 0, found: Some(found) })
            })
        }
        None => {
            let options = options(vec![Free { parameter: Parameter::Offset, range: None }]);
            Study::new(app.edit.generation, true, move |_, stop, _| {
                let found = fit(&curve, &document, &options, stop, &mut |_| ());
                found.map(Arc::new).map_err(|error| error.to_string())
            })
        }
    })
}

pub fn ask_fit(app: &mut App) {
    match app.measured {
        Some(_) => app.ask(Purpose::Fit, "work,offset"),
        None => app.set_error("there is no measured curve; asperity SCENE --measured CURVE shows one"),
    }
}

pub fn accept_fit(app: &mut App, typed: &str) -> Result<(), String> {
    let free = typed.split(',').map(|one| one.trim().parse()).collect::<Result<Vec<Free>, String>>()?;
    if !app.is_current() {
        return Err("the scene is still being computed".to_owned());
    }
    app.studies.set(app.edit.generation, Fitting { free, evaluations: 0, found: None }, false);
    app.effects.push(Task::Study);
    Ok(())
}

/// Applies what a study has found: the position of the curve, and the scene of a fit.
pub fn found(app: &mut App) {
    if let Some(Fitting { found: Some(found), .. }) = app.studies.value::<Fitting>().cloned() {
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
    let offset = fitted(&app.studies).and_then(|fit| Some(fit.parameters.iter().find(is_offset)?.value));
    if let Some((measured, offset)) = app.measured.as_mut().zip(offset) {
        measured.offset = offset;
    }
}

/// The fitted parameters with their intervals, in words; first of all whether the scene does not describe the curve.
fn sentence(fit: &Fit) -> String {
    let found = |one: &FittedParameter| {
        let interval = one_unit([one.interval.0, one.interval.1].map(|end| one.text(end)));
        format!("{} {} ({interval})", one.parameter.row().symbol, one.text(one.value))
    };
    let found = fit.parameters.iter().map(found).collect::<Vec<_>>().join(", ");
    match fit.reason {
        None => format!("fit: {found}; u undoes"),
        Some(reason) => {
            let times = format_quantity(fit.residual_over_noise, "1");
            format!(
                "the scene does not describe the curve, residual {times} × noise; {found}; {reason} u undoes"
            )
        }
    }
}
