//! `asperity compare A B`: two scenes side by side, in the explorer or as text.

use super::explore::{self, LookArguments};
use super::output::text_for_reader;
use super::scene::simulation_of;
use super::{CliError, Overrides};
use crate::explorer::Opening;
use crate::export::{comparison_figure, comparison_text};
use crate::scene::{Document, open_argument};
use crate::simulation::Outcome;
use clap::Args;
use std::io::{IsTerminal, Write, stdin, stdout};

const EXAMPLES: &str = "\
Examples:
  asperity compare ideal-adhesion pressure-sensitive
  asperity compare before.ron after.ron --set roughness.seed=7 | less
  asperity compare measured.ron --as-line   ... the equivalent line with the profile itself
  asperity run before.ron after.ron -o loops.svg
                                            ... draws both force curves into one picture";

/// Arguments of `compare`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct CompareArguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE")]
    pub first: String,
    /// The scene it is compared with
    #[arg(value_name = "OTHER", required_unless_present = "as_line")]
    pub second: Option<String>,
    /// Compare with the measured profile itself as the line
    #[arg(long, conflicts_with = "second")]
    pub as_line: bool,
    /// Changes of both scenes.
    #[command(flatten)]
    pub overrides: Overrides,
    /// Colours and markers of the explorer, and its mouse.
    #[command(flatten)]
    pub look: LookArguments,
}

/// Opens the explorer on two scenes side by side; without a terminal, prints both in words and figures.
pub(super) fn compare(arguments: &CompareArguments, out: &mut dyn Write) -> Result<(), CliError> {
    let open = |name: &str| arguments.overrides.apply(open_argument(name)?);
    let first = open(&arguments.first)?;
    let second = match &arguments.second {
        Some(second) => open(second)?,
        None => first.set("roughness.as_line", "true")?,
    };
    if stdin().is_terminal() && stdout().is_terminal() {
        let opening = Opening { beside: Some(second), ..Opening::from(first) };
        return explore::open(opening, arguments.look.options(), out);
    }
    let outcomes = [compute(&first)?, compute(&second)?];
    let pair = [(&first, &outcomes[0]), (&second, &outcomes[1])];
    let figure = text_for_reader(&comparison_figure(pair), false);
    Ok(out.write_all(format!("{}\n{figure}", comparison_text(pair)).as_bytes())?)
}

fn compute(document: &Document) -> Result<Outcome, CliError> {
    simulation_of(document)
        .run(document.scene(), &|| false, &mut |_, _, _| Ok(()))
        .map_err(|error| CliError::Run { scene: document.name().into(), error })
}
