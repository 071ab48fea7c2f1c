//! `asperity cost`: measures the cost of accuracy, that is, error and computing time, for a scene.

use super::error::CliError;
use super::output::{Origin, OutputArguments};
use super::progress::{ProgressLine, Task, watched};
use super::reference::compared;
use super::scene::{SceneArguments, threads, warn};
use asperity_data::{Control, parse_quantity};
use asperity_report::{CostReport, Format};
use asperity_scene::discretisation::{Knob, Progress, measure};
use asperity_study::half_space::ReferenceOptions;
use clap::Args;
use std::io::Write;
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  asperity cost jkr-sphere
  asperity cost my-scene.ron --budget 30s -o my-scene.svg
  asperity cost rough-sphere --set adhesion.work=0.1 --format csv -o rough.csv

Errors are relative to the closed form of the pull-off force if the scene has one, else to the
finest solution within the budget, whose own error is estimated and stated.";

/// Largest time limit in s that the user may set for all measurements together.
const LONGEST: f64 = 86_400.0;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct CostArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Time limit of all measurements together: 500ms, 30s, 2min
    #[arg(long, value_name = "TIME", default_value = "10s", value_parser = budget)]
    pub budget: Duration,
    /// Compute the error of the model too; its time is not in the budget
    #[arg(long)]
    pub model: bool,
    #[command(flatten)]
    pub output: OutputArguments,
}

const ALLOWED_TIMES: &str = "allowed: a time from 1ms to 24h, such as 500ms, 30s or 2min";

fn budget(text: &str) -> Result<Duration, String> {
    let minutes = [("min", 60.0), ("h", 3600.0)]
        .into_iter()
        .find_map(|(unit, seconds)| {
            Some(text.trim().strip_suffix(unit)?.trim().parse::<f64>().ok()? * seconds)
        });
    let seconds = minutes
        .or_else(|| parse_quantity(text, "s").ok())
        .ok_or(ALLOWED_TIMES)?;
    if (1e-3..=LONGEST).contains(&seconds) {
        Ok(Duration::from_secs_f64(seconds))
    } else {
        Err(ALLOWED_TIMES.to_owned())
    }
}

/// Setting of the discretisation that is being measured now.
struct Trying {
    knob: Knob,
    setting: String,
}

pub(super) fn cost(arguments: &CostArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.output.format(&Format::ALL, Format::Text)?;
    let document = arguments.scene.open()?;
    warn(&document, &document.scene().warnings());
    let scene = document.scene();
    let task = Task {
        name: Some(document.name()),
        threads: threads(None),
        begins: "first solution".to_owned(),
    };
    let mut seen = Vec::new();
    let show = |trying: &Trying, line: &mut ProgressLine| {
        let name = trying.knob.name();
        let is_new = !seen.contains(&trying.knob);
        seen.push(trying.knob);
        line.show(
            &format!("{name}: {}", trying.setting),
            is_new.then_some(name),
        );
    };
    let table = watched(task, show, |mut control: Control<'_, Trying>| {
        let folder = document.resolve("");
        let stop = control.stop();
        let mut report = |progress: Progress<'_>| {
            if let Progress::Trying(knob, setting) = progress {
                let setting = setting.to_owned();
                control.report(Trying { knob, setting });
            }
        };
        measure(scene, &folder, arguments.budget, stop, &mut report).map_err(CliError::message)
    })?;
    let mut model = None;
    if arguments.model {
        let options = ReferenceOptions::of(scene, None);
        model = Some(compared(&document, options, threads(None))?);
    }
    let report = CostReport::new(document.title(), scene, &table, model.as_ref());
    arguments
        .output
        .write(stdout, &report, format, Origin::Scene(&document, scene))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budgets_are_times() {
        let seconds = |text| budget(text).ok().map(|budget| budget.as_secs_f64());
        for (text, expected) in [
            ("10s", 10.0),
            ("500ms", 0.5),
            ("2min", 120.0),
            ("1 h", 3600.0),
            ("3", 3.0),
            ("0.5 s", 0.5),
        ] {
            assert_eq!(seconds(text), Some(expected), "{text}");
        }
        for wrong in [
            "", "s", "-1s", "0", "10m/s", "25h", "nan", "1us", "infs", "naNmin",
        ] {
            assert_eq!(seconds(wrong), None, "{wrong}");
        }
    }
}
