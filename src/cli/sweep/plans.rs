//! `asperity sweep plans`: lists and prints the built-in plans.

use crate::cli::error::CliError;
use crate::cli::output::AnswerFormat;
use asperity_data::object;
use asperity_report::Sheet;
use asperity_study::{Changes, Plan};
use clap::Args;
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
    let open = |name| -> Result<_, CliError> { Ok((name, Plan::open(name, &Changes::default())?)) };
    let plans = Plan::BUILT_IN
        .iter()
        .map(|plan| open(plan.name))
        .collect::<Result<Vec<_>, _>>()?;
    let row = |(name, plan): &(&str, Plan)| {
        let size = format!("{} cells × {} profiles", plan.cells(), plan.lines);
        [(*name).to_owned(), size, plan.title.clone()]
    };
    let text = || Sheet::of_table(&plans.iter().map(row).collect::<Vec<_>>());
    let objects = plans.iter().map(|(name, plan)| {
        object! {
            "name": name,
            "title": &plan.title,
            "notice": &plan.notice,
            "cells": plan.cells(),
            "lines": plan.lines,
        }
    });
    arguments.format.write(
        stdout,
        text,
        &object! { "plans": objects.collect::<Vec<_>>() },
    )
}
