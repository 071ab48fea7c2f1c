//! `asperity sweep plans`: lists and prints the built-in plans.

use crate::cli::error::CliError;
use crate::cli::output::AnswerFormat;
use asperity_data::counted;
use asperity_report::Sheet;
use asperity_study::{Changes, Plan};
use clap::Args;
use serde::Serialize;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity sweep plans
  asperity sweep plans figure-5b > my-plan.ron";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, mut_arg("format", |format| format.conflicts_with("name")))]
pub struct PlansArguments {
    /// Print this plan, as a template for your own
    pub name: Option<String>,
    /// Name, size and title in columns, or objects.
    #[command(flatten)]
    pub format: AnswerFormat,
}

pub(super) fn plans(arguments: &PlansArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    if let Some(name) = &arguments.name {
        return Ok(stdout.write_all(Plan::built_in(name)?.text.as_bytes())?);
    }
    let mut plans = Vec::new();
    for built_in in Plan::BUILT_IN {
        let plan = Plan::open(built_in.name, &Changes::default())?;
        plans.push(PlanEntry {
            name: built_in.name,
            title: plan.title.clone(),
            notice: plan.notice.clone(),
            cells: plan.cells(),
            lines: plan.lines,
        });
    }
    let list = PlanList { plans };
    let format = arguments.format;
    format.write(stdout, || table(&list.plans), &list)
}

fn table(plans: &[PlanEntry]) -> String {
    let mut rows = Vec::with_capacity(plans.len());
    for plan in plans {
        let profiles = counted(plan.lines, "profile");
        let size = format!("{} × {profiles}", counted(plan.cells, "cell"));
        rows.push([plan.name.to_owned(), size, plan.title.clone()]);
    }
    Sheet::of_table(&rows)
}

#[derive(Serialize)]
struct PlanList {
    plans: Vec<PlanEntry>,
}

#[derive(Serialize)]
struct PlanEntry {
    name: &'static str,
    title: String,
    notice: String,
    cells: u64,
    lines: u64,
}
