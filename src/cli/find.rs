//! `asperity find`: finds the value of a number of the scene, or the preload, at which a quantity
//! has a given value.

use super::error::CliError;
use super::output::{Origin, OutputArguments, WITHOUT_PICTURE, only_formats};
use super::progress::{ProgressLine, Task, watched};
use super::scene::{ProfileArguments, SceneArguments, warn_beside};
use asperity_data::counted;
use asperity_report::{FindReport, Format};
use asperity_scene::{Document, Simulation};
use asperity_study::{Axis, Found, Quantity, Question};
use clap::Args;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity find preload pressure-sensitive --where 'F_a/F_a,max = 20 %'
  asperity find adhesion.work rough-sphere --where 'F_a = 2 uN' --profiles 32
  asperity find roughness.rms_height my-scene.ron --where 'F_a/F_n = 0.1' --range 10nm..1um
  asperity find preload my-scene.ron --where 'dissipated energy = 2 pJ' --format json | jq .value

Each random profile is searched for itself; the answer is median, quartiles and range. A preload
replaces the loading of the scene. Over it F_a, F_a/F_n, the dissipated energy and the contact
length have exact answers. Any other quantity is computed at several values, and where it comes
close to the wanted value between two of them, the answer says that crossings may be missed.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, mut_args(only_formats(WITHOUT_PICTURE)))]
pub struct FindArguments {
    /// A number of the scene by its path, such as adhesion.work, or preload
    pub field: String,
    #[command(flatten)]
    pub scene: SceneArguments,
    /// A quantity by its symbol or name, and its value: 'F_a/F_a,max = 80 %'
    #[arg(long = "where", value_name = "CONDITION", value_parser = Question::parse_condition)]
    pub condition: (Quantity, f64),
    /// Searched range, as 10nm..1um; default: two decades down and up
    ///
    /// Preloads are searched from 0 N up to a hundred times the largest force of the loading.
    /// Numbers of a narrow allowed range, such as H, are searched in the whole of it.
    #[arg(
        long,
        value_name = "A..B",
        allow_hyphen_values = true,
        verbatim_doc_comment
    )]
    pub range: Option<String>,
    #[command(flatten)]
    pub profiles: ProfileArguments,
    #[command(flatten)]
    pub output: OutputArguments,
}

impl FindArguments {
    fn question(
        &self,
        document: &Document,
        profiles: u64,
        simulation: &mut Simulation,
    ) -> Result<Question, CliError> {
        let scene = document.scene();
        let question = Question::new(scene, &self.field, self.condition, profiles, simulation);
        let mut question = question.map_err(|error| CliError::advised(document.name(), &error))?;
        if let Some(range) = &self.range {
            let range = Axis::parse_range(range, question.axis.unit);
            question.searched = range.map_err(|error| CliError::advised("--range", &error))?;
        }
        Ok(question)
    }
}

pub(super) fn find(arguments: &FindArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.output.format(WITHOUT_PICTURE, Format::Text)?;
    let document = arguments.scene.open()?;
    let scene = document.scene();
    let profiles = arguments.profiles.count(scene);
    let mut simulation = Simulation::new(document.resolve(""));
    let question = arguments.question(&document, profiles, &mut simulation)?;
    let task = Task {
        name: Some(document.name()),
        threads: arguments.profiles.threads(),
        begins: format!("0 of {}", counted(profiles, "profile")),
    };
    let found = watched(
        task,
        |done: &u64, line: &mut ProgressLine| {
            line.show(&format!("{done} of {}", counted(profiles, "profile")), None)
        },
        |control| Found::of(question, &mut simulation, control),
    )?;
    let report = FindReport {
        title: document.title(),
        scene,
        found: &found,
    };
    warn_beside(&document, &report, format);
    arguments
        .output
        .write(stdout, &report, format, Origin::Scene(&document, scene))
}
