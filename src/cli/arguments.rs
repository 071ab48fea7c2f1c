//! Arguments of the program.

use super::{
    check, completions, cost, demo, explore, find, fit, plan, presets, profile, reference,
    reversals, run, sensitivity, surface, sweep,
};
use clap::{Parser, Subcommand};

const EXAMPLES: &str = "\
Examples:
  asperity                                  Open the explorer
  asperity rough-sphere --set adhesion.work=0.1
                                            ... on a built-in scene, with one field changed
  asperity my-study                         ... on the map of a study, by its folder
  asperity run my-scene.ron                 Compute a scene and print a summary
  asperity run jkr-sphere -o jkr.csv        Write its force curve to a file
  asperity cost my-scene.ron                Springs and time for an error of 1 %

Exit codes: 0 success, 1 failure of the input or the run, 2 wrong usage.";

/// Adhesion of rough elastic contacts: pull-off force and hysteresis for any loading history.
///
/// Computes the adhesive contact of a rough body on an elastic half-space by the method of
/// dimensionality reduction with the rule of Hess: the whole loop of force against
/// indentation, exactly, for any loading history. Without a command the explorer opens.
#[derive(Debug, Parser)]
#[command(
    name = "asperity",
    version,
    verbatim_doc_comment,
    after_help = EXAMPLES,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true
)]
pub struct Arguments {
    /// The command; without one the explorer opens.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// The scene the explorer opens on.
    #[command(flatten)]
    pub explore: explore::ExploreArguments,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute a scene: a summary, JSON, or the curve as CSV
    Run(run::arguments::RunArguments),
    /// Find the preload, or another number of a scene, at which a quantity has a value
    Find(find::FindArguments),
    /// Unload a scene from many turning points: reversal curves, adhesion against preload
    Reversals(reversals::ReversalsArguments),
    /// Change each number of a scene by 10 %: median pull-off force, dissipated energy
    Sensitivity(sensitivity::SensitivityArguments),
    /// Fit a scene to measured force curves: work of adhesion, other parameters, errors
    Fit(fit::FitArguments),
    /// Play the explorer without a keyboard: on screen, as text, or as a picture
    Demo(demo::DemoArguments),
    /// List the parts of the computation of a scene with their cost, and the skipped parts
    Plan(plan::PlanArguments),
    /// Measure errors against computing time for each setting that affects accuracy
    Cost(cost::CostArguments),
    /// Compare random profiles with random square surfaces in three dimensions
    Reference(reference::ReferenceArguments),
    /// Compute a parameter study: many cells on many random profiles
    Sweep(sweep::SweepArguments),
    /// Check this build against closed forms, laws and numerically hard cases
    Check(check::CheckArguments),
    /// Write the rigid profile of a scene as a table: x and z in m
    Profile(profile::ProfileTableArguments),
    /// Analyse measured surfaces: statistics, spectrum, equivalent line
    Surface(surface::SurfaceArguments),
    /// List, show and check scenes
    #[command(subcommand)]
    Presets(presets::PresetsCommand),
    /// Print a completion script for a shell
    Completions(completions::CompletionsArguments),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_agree_with_each_other() {
        Arguments::command().debug_assert();
    }
}
