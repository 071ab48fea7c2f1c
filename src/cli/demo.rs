//! `asperity demo`: plays the explorer automatically.

use super::error::CliError;
use super::explore::failed;
use super::output::check_file;
use super::scene::Overrides;
use crate::explorer::demo::Demo;
use crate::explorer::demo::script::{ONE_SCENE, TOUR};
use crate::explorer::demo::watch::play;
use crate::explorer::theme::{Appearance, Marker, Theme};
use crate::explorer::writing::{screenshot, text_of};
use asperity_data::write_new;
use asperity_plot::Colours;
use asperity_scene::library::open_argument;
use asperity_scene::presets;
use clap::Args;
use std::io;
use std::io::{IsTerminal, Write, stdout};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  asperity demo                             Watch a tour of the built-in scenes; any key ends it
  asperity demo rough-sphere                Watch one scene being pressed and pulled off
  asperity demo --marker ascii | less       Read the tour frame by frame
  asperity demo my-scene.ron --at 8 -o screen.svg
                                            Take a picture of the screen after 8 seconds

The same command gives the same frames, whenever and wherever it runs.";

/// Number of frames per second of a demo that is played on a terminal.
const WATCHED: f64 = 12.0;
/// Number of frames per second of a demo that is printed as text.
const READ: f64 = 1.0;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct DemoArguments {
    /// Scene file or built-in scene; default: a tour of the built-in scenes
    pub scene: Option<String>,
    #[command(flatten)]
    pub overrides: Overrides,
    /// Size of the screen; default: the size of the terminal, else 120x40
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = size)]
    pub size: Option<(u16, u16)>,
    /// Marker of plots
    ///
    /// Default: braille.
    #[arg(long, value_enum)]
    pub marker: Option<Marker>,
    /// Background of the terminal
    ///
    /// Default: dark for a picture, else chosen from COLORFGBG.
    #[arg(long, value_enum)]
    pub theme: Option<Theme>,
    /// Print only the frame at this time
    #[arg(long, value_name = "SECONDS", value_parser = |text: &str| number(text, 0.0, 3600.0))]
    pub at: Option<f64>,
    /// Write a picture of the screen to FILE, an SVG document
    #[arg(short, long, value_name = "FILE", requires = "at")]
    pub output: Option<PathBuf>,
    /// Overwrite FILE if it exists
    #[arg(long)]
    pub force: bool,
}

fn number(text: &str, low: f64, high: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        _ => Err(format!("allowed: a number from {low} to {high}")),
    }
}

fn size(text: &str) -> Result<(u16, u16), String> {
    let allowed = "allowed: columns x rows, each from 1 to 1000, such as 120x40";
    let (columns, rows) = text.split_once(['x', '×']).ok_or(allowed)?;
    let columns = side(columns).ok_or(allowed)?;
    let rows = side(rows).ok_or(allowed)?;
    Ok((columns, rows))
}

/// Reads a number of columns or rows; `None` if the number is not allowed.
fn side(text: &str) -> Option<u16> {
    let side = text.parse().ok()?;
    (1..=1000).contains(&side).then_some(side)
}

/// Plays a script in the explorer. On a terminal, it is shown as an animation; otherwise its frames
/// are written as text. With `--at`, only one frame is written, as text or as a picture.
pub(super) fn demo(arguments: &DemoArguments, stdout_: &mut dyn Write) -> Result<(), CliError> {
    let first = presets().first().map_or("", |preset| preset.name);
    let document = arguments
        .overrides
        .apply(open_argument(arguments.scene.as_deref().unwrap_or(first))?)?;
    if let Some(file) = &arguments.output {
        check_file(file, "svg", arguments.force)?;
    }
    let script = if arguments.scene.is_some() {
        ONE_SCENE
    } else {
        TOUR
    };
    let watched = arguments.at.is_none() && stdout().is_terminal() && io::stdin().is_terminal();
    let environment = Appearance::of_environment();
    let appearance = Appearance {
        // The theme of a picture in a file must be the same in every environment.
        theme: arguments.theme.unwrap_or(if arguments.output.is_some() {
            Theme::Dark
        } else {
            environment.theme
        }),
        colours: if arguments.output.is_some() {
            Colours::TrueColour
        } else {
            environment.colours
        },
        marker: arguments.marker.unwrap_or(environment.marker),
    };
    let of_terminal = if watched {
        crossterm::terminal::size().ok()
    } else {
        None
    };
    let size = arguments.size.or(of_terminal).unwrap_or((120, 40));
    let is_read = !watched && arguments.at.is_none();
    let fps = if is_read { READ } else { WATCHED };
    let mut demo = Demo::new(document, script, size, appearance, fps);
    if let Some(at) = arguments.at {
        while demo.advance().is_some_and(|seconds| seconds + 1e-9 < at) {}
        let app = demo.app();
        return match &arguments.output {
            Some(file) => Ok(write_new(file, arguments.force, |out| {
                out.write_all(screenshot(app).as_bytes())
            })?),
            None => Ok(stdout_.write_all(text_of(app).as_bytes())?),
        };
    }
    if watched {
        return play(&mut demo, fps).map_err(failed);
    }
    while let Some(seconds) = demo.advance() {
        writeln!(stdout_, "== {seconds:.2} s ==")?;
        stdout_.write_all(text_of(demo.app()).as_bytes())?;
    }
    Ok(())
}
