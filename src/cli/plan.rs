//! `asperity plan`: lists the computing stages of a scene and their cost.

use super::error::CliError;
use super::output::AnswerFormat;
use super::scene::SceneArguments;
use asperity_data::{grouped, memory_size};
use asperity_report::Sheet;
use asperity_scene::{PlannedStage, Scene, Workload};
use clap::Args;
use serde::Serialize;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity plan pressure-sensitive
  asperity plan million-springs --set adhesion=None --format json

A stage that a scene does not need is skipped. \"per stage\" counts the passes of each loading stage;
springs are the most that all passes touch; memory is what a stage adds while it runs.";

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
    let (scene, plan) = (document.scene(), Workload::of(document.scene()));
    arguments.format.write(stdout, || text(&plan), &PlanJson { scene, plan: &plan })
}

/// The stages of a scene, with the scene.
#[derive(Serialize)]
struct PlanJson<'a> {
    scene: &'a Scene,
    #[serde(flatten)]
    plan: &'a Workload,
}

fn text(plan: &Workload) -> String {
    let mut rows = vec![["stage", "passes", "springs", "memory", "because"].map(String::from)];
    let count = |count: u64| if count > 0 { grouped(count) } else { String::new() };
    for PlannedStage { stage, runs, because, passes, springs_touched, bytes } in &plan.stages {
        let memory = if *bytes > 0 { memory_size(*bytes) } else { String::new() };
        let passes = match *passes {
            _ if !runs => "skipped".to_owned(),
            None => "per stage".to_owned(),
            Some(0) => "runs".to_owned(),
            Some(passes) => grouped(passes),
        };
        let touched = springs_touched.map_or_else(String::new, count);
        rows.push([stage.name().into(), passes, touched, memory, (*because).into()]);
    }
    let mut sheet = Sheet::default();
    sheet.table(&rows);
    let (springs, peak) = (grouped(plan.springs), memory_size(plan.resident_bytes));
    let program = memory_size(Workload::PROGRAM);
    sheet.heading(&format!(
        "{springs} springs under the body; about {peak} of memory at any one time, {program} of them the program"
    ));
    sheet.into_text()
}
