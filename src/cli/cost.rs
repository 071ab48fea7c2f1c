//! `asperity cost`: what accuracy costs for a scene.

use super::{CliError, OutputArguments, SceneArguments};
use crate::accuracy::{Knob, Progress, measure};
use crate::draw::figure_svg;
use crate::export::{cost_text, work_precision, write_cost_csv, write_cost_json};
use crate::io::{check_writable, write_new};
use crate::scene::parse_quantity;
use clap::{Args, ValueEnum};
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  asperity cost jkr-sphere
  asperity cost my-scene.ron --budget 30s --svg my-scene.svg
  asperity cost rough-sphere --set adhesion.work=0.1 --format csv -o rough.csv

Errors are relative. They are counted from the closed form of the adhesion force where the scene has
one, else from the finest solution within the budget, whose own error is estimated and shown.";

/// Longest budget, s.
const LONGEST: f64 = 86_400.0;

/// Arguments of `cost`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct CostArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Time limit of the whole measurement: 500ms, 30s, 2min
    #[arg(long, value_name = "TIME", default_value = "10s", value_parser = budget)]
    pub budget: Duration,
    /// text, json, csv or svg; default: by the extension of FILE, else text
    #[arg(long, value_enum, hide_possible_values = true)]
    pub format: Option<CostFormat>,
    /// Draw errors over times to FILE, in SVG
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Write to FILE, whole or not at all; `-` is standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Overwrite files that exist
    #[arg(long)]
    pub force: bool,
}

/// Formats of costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CostFormat {
    /// The answer, then tables.
    Text,
    /// One object.
    Json,
    /// One row for each setting.
    Csv,
    /// A picture of errors over times.
    Svg,
}

/// Endings of files in each format.
const ENDINGS: [(&str, CostFormat); 3] =
    [("json", CostFormat::Json), ("csv", CostFormat::Csv), ("svg", CostFormat::Svg)];

/// A time as people write it.
fn budget(text: &str) -> Result<Duration, String> {
    let allowed = || "allowed: a time from 1ms to 24h, such as 500ms, 30s or 2min".to_owned();
    let minutes = [("min", 60.0), ("h", 3600.0)].into_iter().find_map(|(unit, seconds)| {
        Some(text.trim().strip_suffix(unit)?.trim().parse::<f64>().ok()? * seconds)
    });
    let seconds = minutes.or_else(|| parse_quantity(text, "s").ok()).ok_or_else(allowed)?;
    if (1e-3..=LONGEST).contains(&seconds) { Ok(Duration::from_secs_f64(seconds)) } else { Err(allowed()) }
}

/// Measures what accuracy costs and writes it.
pub(super) fn cost(arguments: &CostArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let output = OutputArguments { output: arguments.output.clone(), force: arguments.force };
    let format = output.format(arguments.format, &ENDINGS, CostFormat::Text)?;
    let svg_ending = OutputArguments { output: arguments.svg.clone(), force: arguments.force };
    svg_ending.format(Some(CostFormat::Svg), &ENDINGS, CostFormat::Svg)?;
    let document = arguments.scene.open()?;
    let scene = document.scene();
    output.check()?;
    if let Some(svg) = &arguments.svg {
        check_writable(svg, arguments.force)?;
    }
    let mut told = Told::default();
    let measured =
        measure(scene, &document.resolve(""), arguments.budget, &|| false, &mut |progress| match progress {
            Progress::Trying(knob, setting) => told.tell(knob, setting),
            Progress::Rows(_) => {}
        });
    told.end();
    let table = measured.map_err(|error| CliError::Cost { scene: document.name().into(), error })?;
    let title = if scene.title.is_empty() { document.name() } else { &scene.title };
    let picture = || figure_svg(&work_precision(title, &table));
    if let Some(svg) = &arguments.svg {
        write_new(svg, arguments.force, |out| out.write_all(picture().as_bytes()))?;
    }
    output.write(stdout, |out| match format {
        CostFormat::Text => out.write_all(cost_text(&table).as_bytes()),
        CostFormat::Json => write_cost_json(out, scene, &table),
        CostFormat::Csv => write_cost_csv(out, &table),
        CostFormat::Svg => out.write_all(picture().as_bytes()),
    })
}

/// Progress: on a terminal one line that changes, elsewhere one line for each knob.
#[derive(Default)]
struct Told {
    knob: Option<Knob>,
}

impl Told {
    fn tell(&mut self, knob: Knob, setting: &str) {
        let mut stderr = io::stderr();
        // Who cannot be told does without.
        let _ = if stderr.is_terminal() {
            write!(stderr, "\r\x1b[K{}: {setting}", knob.name()).and_then(|()| stderr.flush())
        } else if self.knob != Some(knob) {
            writeln!(stderr, "{}", knob.name())
        } else {
            Ok(())
        };
        self.knob = Some(knob);
    }

    fn end(&self) {
        let mut stderr = io::stderr();
        if self.knob.is_some() && stderr.is_terminal() {
            let _ = write!(stderr, "\r\x1b[K").and_then(|()| stderr.flush());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budgets_are_times() {
        let seconds = |text| budget(text).ok().map(|budget| budget.as_secs_f64());
        for (text, expected) in
            [("10s", 10.0), ("500ms", 0.5), ("2min", 120.0), ("1 h", 3600.0), ("3", 3.0), ("0.5 s", 0.5)]
        {
            assert_eq!(seconds(text), Some(expected), "{text}");
        }
        for wrong in ["", "s", "-1s", "0", "10m/s", "25h", "nan", "1us", "infs", "naNmin"] {
            assert_eq!(seconds(wrong), None, "{wrong}");
        }
    }
}
