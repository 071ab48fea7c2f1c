//! `asperity run` of the loadings of scenes: results, events and drawings.

use super::arguments::{Chosen, Drawn, RunArguments, WriteReport};
use crate::cli::advice::option;
use crate::cli::error::CliError;
use crate::cli::progress::{ProgressLine, Task, watched};
use crate::cli::scene::{compute, compute_stages, holds_warnings, simulation_of, warn};
use asperity_contact::motion::JumpCollector;
use asperity_plot::Figure;
use asperity_report::{
    ComparedScene, ContactSets, EventsReport, Format, RunReport, ScenesReport, outcome_warnings,
};
use asperity_scene::{CheckedScene, Document, Estimate, Outcome, Solver, estimate};
use asperity_study::Ensemble;
use std::convert::Infallible;

pub(super) fn run_loadings(
    arguments: &RunArguments,
    chosen: &[Chosen<'_>],
    format: Format,
    write: &mut WriteReport<'_>,
) -> Result<(), CliError> {
    let mut scenes = Vec::new();
    for scene in chosen {
        scenes.push(loaded(arguments, scene, format)?);
    }
    let [chosen] = chosen else {
        return write(&ScenesReport {
            scenes: &scenes,
            panels: arguments.draw == Some(Drawn::Panels),
        });
    };
    let Some(ComparedScene {
        outcome, ensemble, ..
    }) = scenes.pop()
    else {
        return Ok(());
    };
    write_loading(arguments, chosen, outcome, ensemble, format, write)
}

/// Computes a scene on the profile with the seed of the scene, and also on random profiles if the
/// user has requested several.
fn loaded<'a>(
    arguments: &RunArguments,
    chosen: &Chosen<'a>,
    format: Format,
) -> Result<ComparedScene<'a>, CliError> {
    // The profile of the scene comes first, so that the message of an error names the scene and not
    // a random profile.
    let outcome = compute(chosen.document, &chosen.scene)?;
    let ensemble = arguments.ensemble(chosen, format)?;
    if !holds_warnings(format) {
        let warnings = outcome_warnings(&outcome, ensemble.as_ref());
        warn(chosen.document, &warnings);
    }
    Ok(ComparedScene {
        document: chosen.document,
        outcome,
        ensemble,
    })
}

/// Computes a scene and writes the events of its loading. Of the jumps, only those are written
/// whose energy is at least `least_share` of the largest one.
pub(super) fn run_events(
    chosen: &Chosen<'_>,
    least_share: f64,
    format: Format,
    write: &mut WriteReport<'_>,
) -> Result<(), CliError> {
    let Chosen {
        document,
        scene,
        choice,
    } = chosen;
    if matches!(scene.numerics.solver, Solver::Stepwise { .. }) {
        return Err(CliError::named(
            "--events",
            "the stepwise solver knows the contact only at its steps; allowed: --set numerics.solver=Exact",
        ));
    }
    let mut simulation = simulation_of(document);
    let mut jumps = JumpCollector::default();
    let outcome = compute_stages(document, scene, |stop, after| {
        simulation.run(scene, stop, &mut |stage, record, motion| {
            jumps.observe(record, motion)?;
            after(stage);
            Ok(())
        })
    })?;
    let events = jumps.events(&outcome.history.stages, least_share, usize::MAX)?;
    if !holds_warnings(format) {
        warn(document, &outcome_warnings(&outcome, None));
    }
    let estimate = match choice {
        Some(choice) => Some(choice.estimate()),
        None if format == Format::Json => estimated(document, scene, &outcome)?,
        None => None,
    };
    write(&EventsReport {
        run: RunReport {
            wording: option,
            title: document.title(),
            scene,
            outcome: &outcome,
            choice: choice.as_ref(),
            estimate: estimate.as_ref(),
            ensemble: None,
            deviation: None,
        },
        events: &events,
        least_share,
    })
}

/// Writes the result of a single scene: either a table of its random profiles, or its result with
/// the estimated errors.
fn write_loading(
    arguments: &RunArguments,
    chosen: &Chosen<'_>,
    outcome: Outcome,
    ensemble: Option<Ensemble>,
    format: Format,
    write: &mut WriteReport<'_>,
) -> Result<(), CliError> {
    let Chosen {
        document,
        scene,
        choice,
    } = chosen;
    let choice = choice.as_ref();
    if let Some(ensemble) = ensemble.as_ref().filter(|_| format.is_table()) {
        return write(ensemble);
    }
    let estimate = match choice {
        Some(choice) => Some(choice.estimate()),
        None if matches!(format, Format::Text | Format::Json) => {
            estimated(document, scene, &outcome)?
        }
        None => None,
    };
    let deviation = match &ensemble {
        Some(ensemble) => arguments.fit_deviation(document, ensemble)?,
        None => None,
    };
    write(&RunReport {
        wording: option,
        title: document.title(),
        scene,
        outcome: &outcome,
        choice,
        estimate: estimate.as_ref(),
        ensemble: ensemble.as_ref(),
        deviation,
    })
}

/// Estimates the error of an outcome due to the finite number of springs.
fn estimated(
    document: &Document,
    scene: &CheckedScene,
    outcome: &Outcome,
) -> Result<Option<Estimate>, CliError> {
    let task = Task {
        name: Some(document.name()),
        threads: 1,
        begins: "estimating the error".to_owned(),
    };
    watched(
        task,
        |(): &(), _: &mut ProgressLine| (),
        |control| {
            let folder = document.resolve("");
            Ok::<_, Infallible>(estimate(scene, &folder, outcome, control.stop()))
        },
    )
}

/// Returns a figure that shows, for each scene, the profile in contact or the contact patches.
pub(super) fn sections(
    arguments: &RunArguments,
    chosen: &[Chosen<'_>],
) -> Result<Figure, CliError> {
    let has_patches = arguments.draw == Some(Drawn::Patches);
    let mut figures = Vec::new();
    for Chosen {
        document, scene, ..
    } in chosen
    {
        let mut simulation = simulation_of(document);
        let mut sets = ContactSets::new(has_patches);
        let outcome = compute_stages(document, scene, |stop, after| {
            simulation.run(scene, stop, &mut |stage, record, motion| {
                sets.observe(record, motion);
                after(stage);
                Ok(())
            })
        })?;
        warn(document, &outcome.warnings);
        figures.push(match has_patches {
            true => sets.patches_figure(document.title(), &outcome),
            false => {
                let (line, ..) = simulation
                    .make_line(scene)
                    .map_err(|error| CliError::advised(document.name(), &error))?;
                sets.profile_figure(document.title(), &outcome, line)
            }
        });
    }
    Ok(if figures.len() == 1 {
        figures.remove(0)
    } else {
        Figure::of_panels(figures)
    })
}
