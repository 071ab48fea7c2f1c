//! Arguments of `asperity run`, and the scenes that they choose.

use crate::cli::error::CliError;
use crate::cli::output::{OutputArguments, PICTURES, TEXT_OR_PICTURE, WITHOUT_PICTURE};
use crate::cli::progress::{ProgressLine, Task, watched};
use crate::cli::scene::{ProfileArguments, SceneArguments, open_scene, threads};
use asperity_data::{counted, parse_quantity, wrap};
use asperity_report::{Format, Report, check_measured_files};
use asperity_scene::discretisation::{Choice, choose, parse_tolerance};
use asperity_scene::{CheckedScene, Document, Scene, Simulation};
use asperity_study::trust::MeasuredAdhesion;
use asperity_study::{Axis, Ensemble};
use clap::{Args, ValueEnum};
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
pub(super) struct Chosen<'a> {
    pub document: &'a Document,
    pub scene: CheckedScene,
    pub choice: Option<Choice>,
}

impl Chosen<'_> {
    /// Returns the scene with its title.
    pub(super) fn titled(&self) -> (String, Scene) {
        (self.document.title().to_owned(), Scene::clone(&self.scene))
    }
}

impl RunArguments {
    /// Returns true if the user has requested figures of profiles or of contact patches.
    pub(super) fn has_sections(&self) -> bool {
        matches!(self.draw, Some(Drawn::Profile | Drawn::Patches))
    }

    /// Returns true if the user has requested a table of the curves over the preload.
    pub(super) fn lists_curves(&self) -> bool {
        self.draw == Some(Drawn::Curves)
    }

    /// Returns the format of the results. The number of scenes, `--draw` and `--preloads` determine
    /// which formats are possible.
    pub(super) fn format(&self) -> Result<Format, CliError> {
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

    pub(super) fn documents(&self) -> Result<Vec<Document>, CliError> {
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
    pub(super) fn chosen<'a>(
        &self,
        document: &'a Document,
        format: Format,
    ) -> Result<Chosen<'a>, CliError> {
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
    pub(super) fn ensemble(
        &self,
        chosen: &Chosen<'_>,
        format: Format,
    ) -> Result<Option<Ensemble>, CliError> {
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
    pub(super) fn profiles_task<'a>(&self, document: &'a Document, count: u64) -> Task<'a> {
        Task {
            name: Some(document.name()),
            threads: self.profiles.threads(),
            begins: random_profiles(0, count),
        }
    }

    /// Returns the standard deviation in N of the pull-off force due to the uncertainty of a
    /// measured spectrum; `None` if its computation would take long.
    pub(super) fn fit_deviation(
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
}

pub(super) fn random_profiles(computed: u64, count: u64) -> String {
    format!("{computed} of {count} random profiles")
}

/// Function that writes a report, together with its origin in all scenes.
pub(super) type WriteReport<'a> = dyn FnMut(&dyn Report) -> Result<(), CliError> + 'a;
