//! `asperity run --preloads`: the pull-off force as a function of the preload.

use super::arguments::{Chosen, RunArguments, WriteReport, random_profiles};
use crate::cli::error::CliError;
use crate::cli::progress::{ProgressLine, watched};
use crate::cli::scene::{holds_warnings, simulation_of, staircase_of, warn};
use asperity_plot::Figure;
use asperity_report::{Format, PreloadReport, counted_texts};
use asperity_scene::Simulation;
use asperity_study::{Axis, Results, Staircase};

impl RunArguments {
    /// Computes the pull-off force of a scene as a function of the preload. The staircase is
    /// computed only if the figure shows it, or if there are preloads below zero.
    fn adhesion(
        &self,
        chosen: &Chosen<'_>,
        preloads: &Axis,
        is_drawn: bool,
    ) -> Result<(Results, Option<Staircase>), CliError> {
        let Chosen {
            document, scene, ..
        } = chosen;
        let mut staircase = None;
        if is_drawn || self.lists_curves() || preloads.values[0] < 0.0 {
            let mut simulation = simulation_of(document);
            staircase = Some(staircase_of(document, scene, preloads, &mut simulation)?);
        }
        let results = self.adhesion_on_profiles(chosen, preloads)?;
        Ok((results, staircase))
    }

    /// Computes the pull-off force as a function of the preload on one or several random profiles.
    /// On a terminal, the number of computed profiles is shown meanwhile.
    fn adhesion_on_profiles(
        &self,
        chosen: &Chosen<'_>,
        preloads: &Axis,
    ) -> Result<Results, CliError> {
        let Chosen {
            document, scene, ..
        } = chosen;
        let count = self.profiles.lines.map_or(1, u64::from);
        let mut simulation = Simulation::new(document.resolve(""));
        if count == 1 {
            simulation = simulation_of(document);
        }
        watched(
            self.profiles_task(document, count),
            |results: &Results, line: &mut ProgressLine| {
                line.show(&random_profiles(results.profiles_done(), count), None)
            },
            |control| {
                let record = &Results::OF_PRELOADS;
                Results::of_scene(
                    scene,
                    record,
                    count,
                    Some(preloads),
                    &mut simulation,
                    control,
                )
            },
        )
    }
}

/// Writes the pull-off force as a function of the preload: for a single scene as a report, for
/// several scenes as a figure with a panel for each scene.
pub(super) fn run_preloads(
    arguments: &RunArguments,
    preloads: &Axis,
    chosen: &[Chosen<'_>],
    format: Format,
    write: &mut WriteReport<'_>,
) -> Result<(), CliError> {
    if let [one] = chosen {
        let (results, staircase) = arguments.adhesion(one, preloads, format.is_picture())?;
        if !holds_warnings(format) {
            let warnings = counted_texts(&results.all_warnings(), results.plan().lines);
            warn(one.document, &warnings);
        }
        return write(&PreloadReport {
            title: one.document.title(),
            choice: one.choice.as_ref(),
            results: &results,
            staircase: staircase.as_ref(),
            curves: arguments.lists_curves(),
        });
    }
    let mut figures = Vec::new();
    for one in chosen {
        let (results, staircase) = arguments.adhesion(one, preloads, true)?;
        figures.extend(
            PreloadReport {
                title: one.document.title(),
                choice: None,
                results: &results,
                staircase: staircase.as_ref(),
                curves: false,
            }
            .drawn(false),
        );
    }
    write(&Figure::of_panels(figures))
}
