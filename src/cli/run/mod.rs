//! `asperity run`: computes scenes without the explorer.

pub(super) mod arguments;
mod loading;
mod preloads;

use super::error::CliError;
use super::output::Origin;
use arguments::{Chosen, RunArguments};
use asperity_report::Report;
use loading::{run_events, run_loadings, sections};
use preloads::run_preloads;
use std::io::Write;

pub(super) fn run(arguments: &RunArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.format()?;
    let documents = arguments.documents()?;
    let chosen = documents
        .iter()
        .map(|document| arguments.chosen(document, format));
    let chosen = chosen.collect::<Result<Vec<_>, CliError>>()?;
    let mut write = |report: &dyn Report| match &chosen[..] {
        [
            Chosen {
                document, scene, ..
            },
        ] => arguments
            .output
            .write(stdout, report, format, Origin::Scene(document, scene)),
        several => {
            let scenes: Vec<_> = several.iter().map(Chosen::titled).collect();
            arguments
                .output
                .write(stdout, report, format, Origin::Scenes(&scenes))
        }
    };
    if let (Some(least_share), [chosen]) = (arguments.events, &chosen[..]) {
        return run_events(chosen, least_share, format, &mut write);
    }
    match &arguments.preloads {
        _ if arguments.has_sections() => write(&sections(arguments, &chosen)?),
        Some(preloads) => run_preloads(arguments, preloads, &chosen, format, &mut write),
        None => run_loadings(arguments, &chosen, format, &mut write),
    }
}
