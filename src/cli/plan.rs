//! `asperity plan`: lists the parts of the computation of a scene and their cost.

use super::error::CliError;
use super::output::AnswerFormat;
use super::scene::{SceneArguments, warn};
use asperity_report::parts_text;
use asperity_scene::Scene;
use asperity_scene::workload::Workload;
use clap::Args;
use serde::Serialize;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity plan pressure-sensitive
  asperity plan million-springs --set adhesion=None --format json

A part that a scene does not need is skipped. \"per stage\" counts the passes of each loading stage;
springs are the most that all passes touch; memory is what a part adds while it runs.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct PlanArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// A table, or one object.
    #[command(flatten)]
    pub format: AnswerFormat,
}

pub(super) fn plan(arguments: &PlanArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let document = arguments.scene.open()?;
    warn(&document, &document.scene().warnings());
    let scene = document.scene();
    let plan = Workload::of(scene);
    arguments.format.write(
        stdout,
        || parts_text(&plan),
        &PlanJson { scene, plan: &plan },
    )
}

/// Computing stages of a scene, and the scene.
#[derive(Serialize)]
struct PlanJson<'a> {
    scene: &'a Scene,
    #[serde(flatten)]
    plan: &'a Workload,
}
