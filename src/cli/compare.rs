//! `asperity compare A B`: two scenes side by side, in the explorer or as text.

use super::error::CliError;
use super::explore::{self, LookArguments};
use super::output::{Origin, OutputArguments};
use super::scene::{Overrides, compute};
use crate::explorer::Opening;
use crate::export::{Comparison, Format};
use crate::scene::{Scene, open_argument};
use clap::Args;
use std::io::{IsTerminal, Write, stdin, stdout};

const EXAMPLES: &str = "\
Examples:
  asperity compare ideal-adhesion pressure-sensitive
  asperity compare before.ron after.ron --set roughness.seed=7 | less
  asperity compare measured.ron --as-line   Compare the equivalent line with the profile itself
  asperity compare before.ron after.ron -o loops.png
                                            Draw both force curves in one picture";

const FORMATS: &[Format] = &[Format::Text, Format::Svg, Format::Png, Format::Pdf];

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct CompareArguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE")]
    pub first: String,
    /// Scene file or built-in scene to compare it with
    #[arg(value_name = "OTHER", required_unless_present = "as_line")]
    pub second: Option<String>,
    /// Compare with the measured profile itself as the line
    #[arg(long, conflicts_with = "second")]
    pub as_line: bool,
    /// Changes of both scenes.
    #[command(flatten)]
    pub overrides: Overrides,
    #[command(flatten)]
    pub look: LookArguments,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// Opens the explorer on two scenes side by side; without a terminal, or with a format or a file, writes both in
/// words and figures.
pub(super) fn compare(arguments: &CompareArguments, out: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.output.format(FORMATS, Format::Text)?;
    let open = |name: &str| arguments.overrides.apply(open_argument(name)?);
    let first = open(&arguments.first)?;
    let second = match &arguments.second {
        Some(second) => open(second)?,
        None => first.set("roughness.as_line", "true")?,
    };
    let is_printed = arguments.output.format.is_some() || arguments.output.output.is_some();
    if !is_printed && stdin().is_terminal() && stdout().is_terminal() {
        let opening = Opening { beside: Some(second), ..Opening::from(first) };
        return explore::open(opening, arguments.look.options()?, out);
    }
    let outcomes = [compute(&first, first.scene())?, compute(&second, second.scene())?];
    let report = Comparison([(&first, &outcomes[0]), (&second, &outcomes[1])]);
    let names = [("A", &first), ("B", &second)];
    let scenes = names.map(|(name, document)| (name.to_owned(), Scene::clone(document.scene())));
    arguments.output.write(out, &report, format, Origin::Scenes(&scenes))
}
