//! `asperity sweep`: parameter studies.

mod boundary;
mod merge;
mod plans;
mod plot;
mod run;
mod status;
mod submit;

use super::error::CliError;
use clap::{Args, Subcommand};
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity sweep plans                              List the built-in plans
  asperity sweep figure-5b -o study                 Compute it on all cores; run again to resume
  asperity sweep my-plan.ron -o study --shard 3/8   Shard 3 of 8, wherever the folder is mounted
  asperity sweep status study                       Show progress
  asperity sweep merge study                        results.csv, summary.csv and results.json
  asperity sweep boundary study                     κ at which F_a(d=0) vanishes, for each H
  asperity sweep plot study -o map.svg              A phase map, or curves
  asperity sweep submit my-plan.ron -o study --jobs 100
                                                    The same on a Slurm cluster

A run that computes everything merges by itself. Ctrl-C stops after the present cells; nothing is
lost, and the same command resumes. Killing the program loses the cells in progress; a power failure
may also lose the last 50 ms. Lost cells are computed again.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct SweepArguments {
    /// Action on a study; without one a plan is computed.
    #[command(subcommand)]
    pub command: Option<SweepCommand>,
    /// The plan that is computed.
    #[command(flatten)]
    pub run: run::SweepRunArguments,
}

/// Actions on a study.
#[derive(Debug, Subcommand)]
pub enum SweepCommand {
    /// Put the records of all processes into tables
    Merge(merge::MergeArguments),
    /// Show the progress of a study and its processes
    Status(status::StatusArguments),
    /// Find the κ at which adhesion without a preload vanishes
    Boundary(boundary::BoundaryArguments),
    /// Draw a merged study: a map over two axes, or curves over one
    Plot(plot::PlotArguments),
    /// Submit a plan to Slurm as a job array, whose last task merges
    Submit(submit::SubmitArguments),
    /// List the built-in plans, or print one of them
    Plans(plans::PlansArguments),
}

pub(super) fn sweep(arguments: &SweepArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    match &arguments.command {
        Some(SweepCommand::Merge(arguments)) => merge::merge(arguments, stdout),
        Some(SweepCommand::Status(arguments)) => status::status(arguments, stdout),
        Some(SweepCommand::Boundary(arguments)) => boundary::boundary(arguments, stdout),
        Some(SweepCommand::Plot(arguments)) => plot::plot(arguments, stdout),
        Some(SweepCommand::Submit(arguments)) => submit::submit(arguments, stdout),
        Some(SweepCommand::Plans(arguments)) => plans::plans(arguments, stdout),
        None => run::run(&arguments.run, stdout),
    }
}
