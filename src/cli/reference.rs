//! `asperity reference`: a scene as a line and in three dimensions.

use super::error::CliError;
use super::output::{Origin, OutputArguments};
use super::progress::ProgressLine;
use super::scene::{ProfileArguments, SceneArguments};
use asperity_data::memory_size;
use asperity_report::{Format, ReferenceReport, duration};
use asperity_scene::Simulation;
use asperity_study::{Reference, ReferenceEvent, ReferenceOptions};
use clap::Args;
use std::io::Write;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

const EXAMPLES: &str = "\
Examples:
  asperity reference jkr-sphere --grid 128
  asperity reference rough-sphere --maps 12
  asperity reference my-scene.ron --format json | jq .reference.budget

Random squares with the spectrum of the scene are pressed on an elastic half-space and pulled off,
beside random lines. Their means are compared; the area of contact of a line means nothing.";

/// Random squares without and with adhesion.
const MAPS: [u64; 2] = [24, 12];
/// Lines for each square: a line takes a thousandth of the time.
const LINES_PER_MAP: u64 = 16;
/// Time, s, from which on it is stated before also where the standard error is no terminal.
const LONG: f64 = 10.0;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ReferenceArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Cells along the side of a square, a power of two from 32
    #[arg(long, value_name = "COUNT", default_value_t = 64)]
    pub grid: usize,
    /// Number of random squares; default: 24 without adhesion, 12 with
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub maps: Option<u64>,
    #[command(flatten)]
    pub profiles: ProfileArguments,
    #[command(flatten)]
    pub output: OutputArguments,
}

pub(super) fn reference(arguments: &ReferenceArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.output.format(&Format::ALL, Format::Text)?;
    let document = arguments.scene.open()?;
    let maps = arguments.maps.unwrap_or(MAPS[usize::from(document.scene().adhesion.is_some())]);
    let lines = arguments.profiles.lines.map_or(LINES_PER_MAP * maps, u64::from);
    let options = ReferenceOptions { cells: arguments.grid, maps, lines };
    let progress = Mutex::new(Squares { cells: arguments.grid, ..Squares::default() });
    let report = |event: ReferenceEvent<'_>| {
        progress.lock().unwrap_or_else(PoisonError::into_inner).show(event);
    };
    let simulation = (Simulation::new(document.resolve("")), arguments.profiles.threads());
    let found = Reference::of(document.scene(), options, simulation, &|| false, &report);
    progress.into_inner().unwrap_or_else(PoisonError::into_inner).line.clear();
    let found = found.map_err(|error| CliError::named(document.name(), error))?;
    let report = ReferenceReport { title: document.title(), scene: document.scene(), reference: &found };
    arguments.output.write(stdout, &report, format, Origin::Scene(&document, document.scene()))
}

/// Progress of the squares.
#[derive(Default)]
struct Squares {
    line: ProgressLine,
    cells: usize,
    maps: u64,
    done: u64,
    begun: Option<Instant>,
}

impl Squares {
    fn show(&mut self, event: ReferenceEvent<'_>) {
        let cells = self.cells;
        match event {
            ReferenceEvent::Begins { maps, threads, bytes, seconds } => {
                (self.maps, self.begun) = (maps, Some(Instant::now()));
                let time = duration(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
                let text = format!(
                    "squares of {cells} × {cells} cells: about {time} for {maps} of them, {} of memory, --jobs {threads}",
                    memory_size(bytes)
                );
                self.line.show(&text, (seconds >= LONG).then_some(&text));
                if seconds >= LONG {
                    self.line.keep();
                }
            }
            ReferenceEvent::Square { .. } => {
                self.done += 1;
                let left = self.begun.map_or(Duration::ZERO, |begun| begun.elapsed());
                let left = left.mul_f64((self.maps - self.done) as f64 / self.done as f64);
                let text = format!("{} of {} squares, {} left", self.done, self.maps, duration(left));
                self.line.show(&text, None);
            }
        }
    }
}
