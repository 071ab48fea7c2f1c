//! `asperity run`: computes scenes without the explorer.

use super::advice::option;
use super::error::CliError;
use super::output::{Origin, OutputArguments, PICTURES, TEXT_OR_PICTURE, WITHOUT_PICTURE};
use super::progress::{ProgressLine, Task, watched};
use super::scene::{
    ProfileArguments, SceneArguments, compute, compute_stages, holds_warnings, open_scene,
    simulation_of, staircase_of, threads, warn,
};
use asperity_contact::motion::JumpCollector;
use asperity_data::{counted, parse_quantity, wrap};
use asperity_plot::Figure;
use asperity_report::{
    ComparedScene, ContactSets, EventsReport, Format, PreloadReport, Report, RunReport,
    ScenesReport, check_measured_files, counted_texts, outcome_warnings,
};
use asperity_scene::discretisation::{Choice, choose, parse_tolerance};
use asperity_scene::{
    CheckedScene, Document, Estimate, Outcome, Scene, Simulation, Solver, estimate,
};
use asperity_study::trust::MeasuredAdhesion;
use asperity_study::{Axis, Ensemble, Results, Staircase};
use clap::{Args, ValueEnum};
use std::convert::Infallible;
use std::io;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity run pressure-sensitive
  asperity run my-scene.ron --set adhesion.work=0.1 --format json | jq .pull_off_force
  asperity run jkr-sphere --set numerics.points=65536 -o jkr.csv
  asperity run jkr.csv --set adhesion.work=0.1 -o other.npy
  asperity run jkr-sphere --tolerance 0.1%
  asperity run pressure-sensitive --profiles 32 --format csv     A row for each profile
  asperity run pressure-sensitive --preloads 0..20uN --profiles 16
  asperity run pressure-sensitive --events                       The jumps, with their energies
  asperity run pressure-sensitive -o loop.svg
  asperity run pressure-sensitive --draw profile -o profile.svg
  asperity run before.ron after.ron                  Differences, results, curves
  asperity run ideal-adhesion pressure-sensitive non-adhesive -o loops.svg
  asperity run ideal-adhesion pressure-sensitive non-adhesive --draw panels --width 170mm -o p.pdf

JSON is one object with scene, profile, figures, curve, contacts and work; CSV and .npy hold the
curve, in SI units. Compression is positive, indentation is zero at first touch. CSV and .npy
contain version, command and scene, and open as that scene.";

/// What a figure shows in place of the force curves in one chart.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// The profile and its contact at the largest force.
    Profile,
    /// The contact patches over the indentation.
    Patches,
    /// The force curve of each scene over axes of its own.
    Panels,
    /// The curves over the preload, which also become the table.
    Curves,
}

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct RunArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// More scenes beside it: a table of results and differences, force curves in one chart
    #[arg(value_name = "SCENE")]
    pub more: Vec<String>,
    /// Draw profile, patches or panels in place of the force curves
    ///
    /// profile: the profile and its contact at the largest force. patches: the contact patches
    /// over the indentation. panels: the force curve of each scene over axes of its own.
    /// curves: with --preloads; the table has the drawn curves instead of all profiles.
    #[arg(
        long,
        value_name = "WHAT",
        value_enum,
        hide_possible_values = true,
        verbatim_doc_comment
    )]
    pub draw: Option<Drawn>,
    /// Choose springs and edges for a pull-off force within T, as 1e-3 or 0.1%
    ///
    /// Doubles the springs until the error is small enough. The error is that from the closed
    /// form if there is one, else an estimate; without a pull-off it is that of the force curve.
    /// Replaces numerics.points and numerics.edges of the scene.
    #[arg(long, value_name = "T", value_parser = parse_tolerance, verbatim_doc_comment)]
    pub tolerance: Option<f64>,
    /// Compute the pull-off force for many preloads instead of the loading
    ///
    /// 64 preloads at equal distances, or the number after a colon: 0..20uN:128; with :log at
    /// equal ratios: 10nN..100uN:64:log. One loading, and one unloading from each preload.
    /// Several profiles give median, quartiles, range and mean. A preload below 0 N turns while
    /// the bodies are still drawn together, and is at least the force at first touch.
    #[arg(long, value_name = "A..B", allow_hyphen_values = true, value_parser = Axis::parse_preloads, verbatim_doc_comment)]
    pub preloads: Option<Axis>,
    /// List the jumps of the loading, those of at least 1 % of the largest energy
    ///
    /// Smaller ones too: --events=0.1%; all of them: --events=all. The list is the text and the
    /// table; JSON has all results and the key events.
    #[arg(
        long,
        value_name = "SHARE",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "1%",
        value_parser = parse_share,
        conflicts_with_all = ["preloads", "draw"],
        verbatim_doc_comment
    )]
    pub events: Option<f64>,
    #[command(flatten)]
    pub profiles: ProfileArguments,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// Parses the least share of the largest energy that a jump needs to be listed.
fn parse_share(text: &str) -> Result<f64, String> {
    if text == "all" {
        return Ok(0.0);
    }
    match parse_quantity(text, "1") {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err("allowed: all, or a share of the largest energy, such as 0.1%".to_owned()),
    }
}

/// Width of messages in columns.
const WIDTH: usize = 80;

/// A scene that is to be computed. If a tolerance is given, the springs and edges of `scene` are
/// those that were chosen for this tolerance.
struct Chosen<'a> {
    document: &'a Document,
    scene: CheckedScene,
    choice: Option<Choice>,
}

impl Chosen<'_> {
    /// Returns the scene with its title.
    fn titled(&self) -> (String, Scene) {
        (self.document.title().to_owned(), Scene::clone(&self.scene))
    }
}

impl RunArguments {
    /// Returns true if the user has requested figures of profiles or of contact patches.
    fn has_sections(&self) -> bool {
        matches!(self.draw, Some(Drawn::Profile | Drawn::Patches))
    }

    /// Returns true if the user has requested a table of the curves over the preload.
    fn lists_curves(&self) -> bool {
        self.draw == Some(Drawn::Curves)
    }

    /// Returns the format of the results. The number of scenes, `--draw` and `--preloads` determine
    /// which formats are possible.
    fn format(&self) -> Result<Format, CliError> {
        let several = !self.more.is_empty();
        if self.draw == Some(Drawn::Panels) && !several {
            return Err(CliError::named(
                "--draw panels",
                "one scene; allowed: several scenes, each over axes of its own",
            ));
        }
        match (self.draw, &self.preloads) {
            (Some(Drawn::Curves), None) => {
                return Err(CliError::named(
                    "--draw curves",
                    "the curves over the preload; allowed: with --preloads A..B",
                ));
            }
            (Some(Drawn::Profile | Drawn::Patches | Drawn::Panels), Some(_)) => {
                return Err(CliError::named(
                    "--draw",
                    "not with --preloads; allowed there: --draw curves",
                ));
            }
            _ => {}
        }
        if self.events.is_some() && several {
            return Err(CliError::named(
                "--events",
                "several scenes; allowed: one scene, and the share after an equals sign, as in --events=all",
            ));
        }
        if self.events.is_some() && self.profiles.lines.is_some() {
            return Err(CliError::named(
                "--events",
                "the list is that of one profile; allowed: without --profiles, with --set roughness.seed=2 for another profile",
            ));
        }
        let (formats, usual) = match self.preloads {
            _ if self.events.is_some() => (WITHOUT_PICTURE, Format::Text),
            _ if self.has_sections() => (PICTURES, Format::Svg),
            Some(_) if several => (PICTURES, Format::Svg),
            None if several => (TEXT_OR_PICTURE, Format::Text),
            _ => (&Format::ALL[..], Format::Text),
        };
        let format = self.output.format(formats, usual)?;
        if several
            && format.is_picture()
            && self.profiles.lines.is_some()
            && self.preloads.is_none()
        {
            let allowed = "allowed: one scene, text, or --preloads";
            return Err(CliError::named(
                "--profiles",
                format!("a figure of several scenes; {allowed}"),
            ));
        }
        Ok(format)
    }

    fn documents(&self) -> Result<Vec<Document>, CliError> {
        let more = self
            .more
            .iter()
            .map(|scene| self.scene.overrides.apply(open_scene(scene)?));
        let documents = std::iter::once(self.scene.open())
            .chain(more)
            .collect::<Result<Vec<_>, CliError>>()?;
        documents
            .iter()
            .try_for_each(check_measured_files)
            .map_err(CliError::message)?;
        Ok(documents)
    }

    /// Returns the scene of a document. If a tolerance is given, its springs and edges are chosen
    /// for this tolerance. The report of a single scene states this choice; in all other cases, it
    /// is written to standard error.
    fn chosen<'a>(&self, document: &'a Document, format: Format) -> Result<Chosen<'a>, CliError> {
        let Some(tolerance) = self.tolerance else {
            return Ok(Chosen {
                document,
                scene: document.scene().clone(),
                choice: None,
            });
        };
        let task = Task {
            name: Some(document.name()),
            threads: threads(None),
            begins: String::new(),
        };
        let choice = watched(
            task,
            |springs: &u64, line: &mut ProgressLine| {
                line.show(&format!("trying {}", counted(*springs, "spring")), None)
            },
            |mut control| {
                let folder = document.resolve("");
                let stop = control.stop();
                choose(document.scene(), &folder, tolerance, stop, &mut |springs| {
                    control.report(springs)
                })
            },
        )?;
        if format != Format::Text || !self.more.is_empty() {
            let _ = writeln!(
                io::stderr(),
                "{}",
                wrap(&choice.sentence(), WIDTH).join("\n")
            );
        }
        Ok(Chosen {
            document,
            scene: choice.apply(document.scene())?,
            choice: Some(choice),
        })
    }

    /// Returns the results of a scene on its random profiles; `None` if the user has requested only
    /// one profile. The results include the shares and heights of the profiles only if a table is
    /// written.
    fn ensemble(&self, chosen: &Chosen<'_>, format: Format) -> Result<Option<Ensemble>, CliError> {
        let Chosen {
            document, scene, ..
        } = chosen;
        let count = self.profiles.count(scene);
        let is_curve = format.is_table() && self.profiles.lines.is_none();
        if count < 2 || is_curve || format.is_picture() && !self.more.is_empty() {
            return Ok(None);
        }
        let further = if self.profiles.lines.is_some() {
            &Ensemble::FURTHER[..]
        } else {
            &[]
        };
        let mut simulation = Simulation::new(document.resolve(""));
        let ensemble = watched(
            self.profiles_task(document, count),
            |ensemble: &Ensemble, line: &mut ProgressLine| {
                line.show(&random_profiles(ensemble.computed(), count), None)
            },
            |control| Ensemble::of(scene, further, count, &mut simulation, control),
        )?;
        Ok(Some(ensemble))
    }

    /// Returns the task of computing `count` random profiles of a document, for the display of its
    /// progress.
    fn profiles_task<'a>(&self, document: &'a Document, count: u64) -> Task<'a> {
        Task {
            name: Some(document.name()),
            threads: self.profiles.threads(),
            begins: random_profiles(0, count),
        }
    }

    /// Returns the standard deviation in N of the pull-off force due to the uncertainty of a
    /// measured spectrum; `None` if its computation would take long.
    fn fit_deviation(
        &self,
        document: &Document,
        ensemble: &Ensemble,
    ) -> Result<Option<f64>, CliError> {
        let count = ensemble.profiles();
        watched(
            self.profiles_task(document, count),
            |computed: &u64, line: &mut ProgressLine| {
                line.show(&random_profiles(*computed, count), None)
            },
            |control| MeasuredAdhesion::quick_deviation(document, count, control),
        )
    }

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

fn random_profiles(computed: u64, count: u64) -> String {
    format!("{computed} of {count} random profiles")
}

pub(super) fn run(arguments: &RunArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.format()?;
    let documents = arguments.documents()?;
    let chosen = documents
        .iter()
        .map(|document| arguments.chosen(document, format));
    let chosen = chosen.collect::<Result<Vec<_>, CliError>>()?;
    let mut write = |report: &dyn Report| match &chosen[..] {
        [
            Chosen {
                document, scene, ..
            },
        ] => arguments
            .output
            .write(stdout, report, format, Origin::Scene(document, scene)),
        several => {
            let scenes: Vec<_> = several.iter().map(Chosen::titled).collect();
            arguments
                .output
                .write(stdout, report, format, Origin::Scenes(&scenes))
        }
    };
    if let (Some(least_share), [chosen]) = (arguments.events, &chosen[..]) {
        return run_events(chosen, least_share, format, &mut write);
    }
    match &arguments.preloads {
        _ if arguments.has_sections() => write(&sections(arguments, &chosen)?),
        Some(preloads) => run_preloads(arguments, preloads, &chosen, format, &mut write),
        None => run_loadings(arguments, &chosen, format, &mut write),
    }
}

/// Function that writes a report, together with its origin in all scenes.
type WriteReport<'a> = dyn FnMut(&dyn Report) -> Result<(), CliError> + 'a;

fn run_loadings(
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
fn run_events(
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

/// Writes the pull-off force as a function of the preload: for a single scene as a report, for
/// several scenes as a figure with a panel for each scene.
fn run_preloads(
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

/// Returns a figure that shows, for each scene, the profile in contact or the contact patches.
fn sections(arguments: &RunArguments, chosen: &[Chosen<'_>]) -> Result<Figure, CliError> {
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
