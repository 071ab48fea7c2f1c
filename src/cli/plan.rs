//! `asperity plan`: which stages a scene runs, and what they cost.

use super::plan_cost::{Cost, StageCost};
use super::{CliError, SceneArguments};
use crate::export::sheet::{Sheet, grouped};
use crate::export::write_json_value;
use crate::simulation::{Plan, PlannedStage};
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity plan pressure-sensitive
  asperity plan million-springs --set adhesion=None --format json

A stage that a scene does not call for does not run. Passes are given where the scene tells their
number beforehand; memory is what a stage adds while it runs.";

/// Arguments of `plan`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct PlanArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// How it is printed
    #[arg(long, value_enum, default_value_t = PlanFormat::Text)]
    pub format: PlanFormat,
}

/// How a plan is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PlanFormat {
    /// A table.
    Text,
    /// One object.
    Json,
}

/// The object; its keys stand in the order of these fields.
#[derive(Serialize)]
struct Report<'a> {
    springs: u64,
    peak_bytes: u64,
    stages: Vec<StageReport<'a>>,
}

#[derive(Serialize)]
struct StageReport<'a> {
    #[serde(flatten)]
    planned: &'a PlannedStage,
    #[serde(flatten)]
    cost: StageCost,
}

/// Writes the plan of a scene.
pub(super) fn plan(arguments: &PlanArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let document = arguments.scene.open()?;
    let plan = Plan::of(document.scene());
    let cost = Cost::of(document.scene());
    match arguments.format {
        PlanFormat::Text => stdout.write_all(text(&plan, &cost).as_bytes())?,
        PlanFormat::Json => {
            let stages = plan.stages.iter().map(|planned| StageReport { planned, cost: cost.stage(planned) });
            let stages = stages.collect();
            write_json_value(
                stdout,
                &Report { springs: cost.springs, peak_bytes: cost.peak_bytes(&plan), stages },
            )?;
        }
    }
    Ok(())
}

fn text(plan: &Plan, cost: &Cost) -> String {
    let mut rows = vec![["stage", "", "passes", "memory", "because"].map(String::from)];
    for planned in &plan.stages {
        let stage = cost.stage(planned);
        let runs = if planned.runs { "runs" } else { "skipped" };
        let passes = match stage.passes {
            None => "?".into(),
            Some(0) => String::new(),
            Some(passes) => grouped(passes),
        };
        let memory = if stage.bytes > 0 { memory(stage.bytes) } else { String::new() };
        rows.push([planned.stage.name().into(), runs.into(), passes, memory, planned.because.into()]);
    }
    let mut sheet = Sheet::default();
    sheet.table(&rows);
    let (springs, peak) = (grouped(cost.springs), memory(cost.peak_bytes(plan)));
    sheet.heading(&format!("{springs} springs under the body; arrays of about {peak} at any one time"));
    sheet.into_text()
}

fn memory(bytes: u64) -> String {
    let units = ["B", "KiB", "MiB", "GiB"];
    let mut size = bytes as f64;
    let mut unit = 0;
    while size >= 1024.0 && unit + 1 < units.len() {
        size /= 1024.0;
        unit += 1;
    }
    let decimals = usize::from(unit > 0 && size < 10.0);
    format!("{size:.decimals$} {}", units[unit])
}
