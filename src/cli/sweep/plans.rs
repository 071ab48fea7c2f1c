//! `asperity sweep plans`: what comes with the program.

use crate::cli::{CliError, Format};
use crate::export::sheet::Sheet;
use crate::io::write_json_value;
use crate::study::{Changes, Plan, PlanErrors, StudyError, find, plans as built_in};
use clap::Args;
use serde::Serialize;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity sweep plans
  asperity sweep plans figure-5b > my-plan.ron";

/// Arguments of `sweep plans`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct PlansArguments {
    /// Print the text of this plan, to start one's own from
    pub name: Option<String>,
    /// Format of the list
    #[arg(long, value_parser = Format::parser(FORMATS), default_value = "text", conflicts_with = "name")]
    pub format: Format,
}

/// Formats of the list: name, size and title in columns, or objects.
const FORMATS: &[Format] = &[Format::Text, Format::Json];

/// A plan in the list.
#[derive(Serialize)]
struct Listed {
    name: &'static str,
    title: String,
    notice: String,
    cells: u64,
    lines: u64,
}

/// Lists the built-in plans, or prints one.
pub(super) fn plans(arguments: &PlansArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    if let Some(name) = &arguments.name {
        let Some(plan) = find(name) else {
            let names = built_in().iter().map(|plan| plan.name).collect::<Vec<_>>().join(", ");
            let error = format!("{name}: there is no such built-in plan; allowed: {names}");
            return Err(StudyError::Plan(PlanErrors(vec![error])).into());
        };
        return Ok(stdout.write_all(plan.text.as_bytes())?);
    }
    let mut listed = Vec::new();
    for one in built_in() {
        let plan = Plan::open(one.name, &Changes::default()).map_err(StudyError::from)?;
        let (cells, lines) = (plan.cells(), plan.lines);
        listed.push(Listed { name: one.name, title: plan.title, notice: plan.notice, cells, lines });
    }
    match arguments.format {
        Format::Json => write_json_value(stdout, &listed)?,
        _ => {
            let row = |plan: Listed| {
                [plan.name.into(), format!("{} cells × {} lines", plan.cells, plan.lines), plan.title]
            };
            let mut sheet = Sheet::default();
            sheet.table(&listed.into_iter().map(row).collect::<Vec<_>>());
            stdout.write_all(sheet.into_text().as_bytes())?;
        }
    }
    Ok(())
}
