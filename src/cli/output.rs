//! Formats and destinations of the results of commands.

use super::error::CliError;
use super::typed::TYPED;
use crate::explorer::theme::Appearance;
use asperity_data::{check_writable, path_name, write_new};
use asperity_plot::{Figure, Palette, figure_text};
use asperity_report::{
    Format, LEAST_HEIGHT, LEAST_WIDTH, Report, alternatives, check_extension, entries,
    files_provenance, parameter_lines, parse_printed_length, printed_pixels, scene_provenance,
    scenes_provenance, with_warnings,
};
use asperity_scene::text::quoted;
use asperity_scene::{Document, Scene};
use clap::{Arg, ArgGroup, Args};
use serde::Serialize;
use std::io;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

pub(super) const PICTURES: &[Format] = &[Format::Svg, Format::Png, Format::Pdf];
pub(super) const TEXT_OR_PICTURE: &[Format] =
    &[Format::Text, Format::Svg, Format::Png, Format::Pdf];
pub(super) const TABLES: &[Format] = &[Format::Csv, Format::Npy];
pub(super) const WITHOUT_PICTURE: &[Format] =
    &[Format::Text, Format::Json, Format::Csv, Format::Npy];
/// Formats of a result that is neither a table nor a picture: text and JSON.
pub(super) const TEXT_OR_JSON: &[Format] = &[Format::Text, Format::Json];

/// Format of results, a file for them in place of standard output, and the look of figures.
#[derive(Args, Clone, Debug, Default)]
#[command(group(ArgGroup::new("written").multiple(true)))]
pub struct OutputArguments {
    /// Write to FILE, whole or not at all; `-` is standard output
    #[arg(short, long, value_name = "FILE", group = "written")]
    pub output: Option<PathBuf>,
    /// Overwrite files that exist
    #[arg(long, requires = "written")]
    pub force: bool,
    /// text, json, csv, npy, svg, png or pdf; default: by the extension
    #[arg(long, value_enum, hide_possible_values = true)]
    pub format: Option<Format>,
    /// Width of a printed figure: 85mm, 170mm; letters keep their size
    #[arg(long, value_name = "LENGTH", value_parser = |text: &str| parse_printed_length(text, LEAST_WIDTH))]
    pub width: Option<f64>,
    /// Height of a printed figure: 60mm; default: what its panels need
    #[arg(long, value_name = "LENGTH", value_parser = |text: &str| parse_printed_length(text, LEAST_HEIGHT))]
    pub height: Option<f64>,
    /// Draw only these panels of a figure: a, or a,c
    #[arg(long, value_name = "LETTERS")]
    pub only: Option<String>,
    /// Leave out the title of a figure
    #[arg(long)]
    pub no_title: bool,
    /// Add the numbers of the scene in a box to a figure
    #[arg(long)]
    pub parameters: bool,
}

/// Identifiers of the options that determine the look of figures.
const LOOK: [&str; 5] = ["width", "height", "only", "no_title", "parameters"];

/// Returns a function that adapts the help of options to a command whose results have only the
/// formats `formats`. The help of the format lists these formats. The options for the look of
/// figures are hidden if none of these formats is a picture.
pub(super) fn only_formats(formats: &'static [Format]) -> impl Fn(Arg) -> Arg {
    move |option| {
        let id = option.get_id().as_str();
        if id == "format" {
            let names = alternatives("", formats.iter().map(|format| format.name()));
            return option.help(format!("{names}; default: by the extension"));
        }
        let draws = formats.iter().any(|format| format.is_picture());
        let is_look = LOOK.contains(&id);
        option.hide(is_look && !draws)
    }
}

/// Origin of results. The origin is written into the files of the results, so that they can be
/// computed again.
#[derive(Clone, Copy)]
pub(super) enum Origin<'a> {
    /// A scene, and the document from which it was read. Paths in the scene are relative to the
    /// folder of the document.
    Scene(&'a Document, &'a Scene),
    /// Several scenes with their names, which a figure shows together.
    Scenes(&'a [(String, Scene)]),
    /// Measured files that were analysed without a scene.
    Files(&'a [PathBuf]),
}

impl OutputArguments {
    /// Returns the path of the output file; `None` if the results go to standard output.
    pub(super) fn file(&self) -> Option<&Path> {
        self.output
            .as_deref()
            .filter(|path| *path != Path::new("-"))
    }

    /// Returns the folder of the output file, or the working folder for standard output.
    pub(super) fn folder(&self) -> &Path {
        self.file().and_then(Path::parent).unwrap_or(Path::new(""))
    }

    /// Returns the identifier of the first option for the look of figures that the user has given;
    /// `None` if there is none.
    fn look(&self) -> Option<&'static str> {
        let OutputArguments {
            width,
            height,
            only,
            no_title,
            parameters,
            ..
        } = self;
        let given = [
            width.is_some(),
            height.is_some(),
            only.is_some(),
            *no_title,
            *parameters,
        ];
        LOOK.into_iter()
            .zip(given)
            .find_map(|(option, is_given)| is_given.then_some(option))
    }

    /// Returns the figure with the width, height, panels and title that the user has requested.
    fn looked(&self, figure: Figure) -> Result<Figure, CliError> {
        let [width, height] = [self.width, self.height].map(|length| length.map(printed_pixels));
        let figure = Figure {
            width,
            height,
            untitled: self.no_title,
            ..figure
        };
        let Some(only) = &self.only else {
            return Ok(figure);
        };
        let letters: String = only
            .chars()
            .filter(|letter| ![',', ' '].contains(letter))
            .collect();
        figure.with_panels(&letters).map_err(|panels| {
            let allowed = format!("{only:?}; allowed: letters of its panels, {panels}");
            CliError::named("--only", allowed)
        })
    }

    /// Returns the format of the results. It is the format of the extension of FILE, otherwise the
    /// format that the user has chosen, otherwise `usual`. Also checks that FILE can be written, so
    /// that the user gets an error before the computation. Binary formats are refused on a
    /// terminal.
    pub(super) fn format(&self, formats: &[Format], usual: Format) -> Result<Format, CliError> {
        let format =
            Format::of_file(self.file(), self.format, formats, usual).map_err(CliError::message)?;
        if let Some(option) = self.look().filter(|_| !format.is_picture()) {
            let option = &format!("--{}", option.replace('_', "-"));
            let refused = match formats.iter().any(|format| format.is_picture()) {
                true => "only for figures; allowed: with -o FILE.svg, FILE.png or FILE.pdf",
                false => "this command draws no figure",
            };
            return Err(CliError::named(option, refused));
        }
        match self.file() {
            Some(path) => check_writable(path, self.force)?,
            None if matches!(format, Format::Npy | Format::Png | Format::Pdf)
                && io::stdout().is_terminal() =>
            {
                let format = format.name();
                let refused =
                    format!("--format {format}: not for a terminal; allowed: -o FILE.{format}");
                return Err(CliError::message(refused));
            }
            None => {}
        }
        Ok(format)
    }

    /// Writes a report with its origin to the file or to standard output. If the report is a
    /// figure, it has the width and the box of parameters that the user has requested.
    pub(super) fn write(
        &self,
        stdout: &mut dyn Write,
        report: &(impl Report + ?Sized),
        format: Format,
        origin: Origin<'_>,
    ) -> Result<(), CliError> {
        let provenance = match origin {
            _ if matches!(
                format,
                Format::Text | Format::Npy | Format::Png | Format::Pdf
            ) =>
            {
                Ok(String::new())
            }
            Origin::Scenes(scenes) => Ok(scenes_provenance(&command(), scenes)),
            Origin::Scene(document, scene) => {
                scene_provenance(&command(), scene, &document.resolve(""), self.folder())
            }
            Origin::Files(files) => files_provenance(&command(), files, self.folder()),
        };
        let provenance = provenance.map_err(CliError::message)?;
        let Some(figure) = report.figure().filter(|_| format.is_picture()) else {
            return self.fill(stdout, |out| {
                asperity_report::write(out, report, format, &provenance)
            });
        };
        let parameters = match origin {
            _ if !self.parameters => Vec::new(),
            Origin::Scene(_, scene) => parameter_lines(&[(String::new(), scene.clone())]),
            Origin::Scenes(scenes) => parameter_lines(scenes),
            Origin::Files(_) => {
                return Err(CliError::named("--parameters", "this figure has no scene"));
            }
        };
        let figure = self.looked(Figure {
            parameters,
            ..figure
        })?;
        let origin = with_warnings(&provenance, &report.warnings());
        self.fill(stdout, |out| {
            asperity_report::write(out, &figure, format, &origin)
        })
    }

    /// Writes a figure as a picture or as text, to the file or to standard output.
    pub(super) fn write_figure(
        &self,
        stdout: &mut dyn Write,
        figure: &Figure,
        format: Format,
        scenes: &[(String, Scene)],
    ) -> Result<(), CliError> {
        if format == Format::Text {
            let text = text_for_reader(figure, self.file().is_none());
            return self.fill(stdout, |out| out.write_all(text.as_bytes()));
        }
        self.write(stdout, figure, format, Origin::Scenes(scenes))
    }

    pub(super) fn fill(
        &self,
        stdout: &mut dyn Write,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), CliError> {
        match self.file() {
            Some(path) => Ok(write_new(path, self.force, |out| write(out))?),
            None => Ok(write(stdout)?),
        }
    }
}

/// Returns an error if a file has another extension than `extension`, or if the file cannot be
/// written. A name without an extension is allowed.
pub(super) fn check_file(path: &Path, extension: &str, overwrite: bool) -> Result<(), CliError> {
    check_extension(path, &[extension]).map_err(|error| CliError::named(path_name(path), error))?;
    Ok(check_writable(path, overwrite)?)
}

/// Format of a short answer on standard output.
#[derive(Args, Clone, Copy, Debug)]
pub struct AnswerFormat {
    /// text or json
    #[arg(long, value_enum, hide_possible_values = true, default_value = "text")]
    format: Format,
}

impl AnswerFormat {
    /// Writes an answer as text, or as a JSON object that begins with the version and the command.
    pub(super) fn write(
        self,
        stdout: &mut dyn Write,
        text: impl FnOnce() -> String,
        answer: &impl Serialize,
    ) -> Result<(), CliError> {
        let format = Format::of_file(None, Some(self.format), TEXT_OR_JSON, Format::Text);
        match format.map_err(CliError::message)? {
            Format::Json => {
                let provenance =
                    files_provenance(&command(), &[], Path::new("")).map_err(CliError::message)?;
                asperity_data::write_json(stdout, answer, &entries(&provenance))?
            }
            _ => stdout.write_all(text().as_bytes())?,
        }
        Ok(())
    }
}

/// Returns the command line of this process for a POSIX shell. The options for format and
/// destination are left out.
pub(super) fn command() -> String {
    command_without(&[])
}

/// Returns the command line of this process for a POSIX shell. It lacks the options for format and
/// destination, and also the options `options` with their values.
pub(super) fn command_without(options: &[&str]) -> String {
    let mut words = vec!["asperity".to_owned()];
    let typed = TYPED.get().into_iter().flatten();
    let mut typed = typed.skip(1).map(|word| word.to_string_lossy());
    while let Some(word) = typed.next() {
        if ["-o", "--output", "--format"].contains(&&*word) {
            typed.next();
        } else if let Some(option) = options.iter().find(|option| is_option(&word, option)) {
            if word == *option {
                typed.next();
            }
        } else if word != "--force"
            && !["-o", "--output=", "--format="]
                .iter()
                .any(|one| word.starts_with(one))
        {
            words.push(quoted(&*word));
        }
    }
    words.join(" ")
}

/// Returns true if a word is the option alone, or the option with its value after `=`.
fn is_option(word: &str, option: &str) -> bool {
    match word.strip_prefix(option) {
        Some(value) => value.is_empty() || value.starts_with('='),
        None => false,
    }
}

/// Width in columns of a figure that is written as text, but not to a terminal.
const COLUMNS: usize = 80;

/// Returns a figure as text. For a terminal, the text has the width and the colours of the
/// terminal.
fn text_for_reader(figure: &Figure, to_stdout: bool) -> String {
    let terminal = to_stdout && io::stdout().is_terminal();
    let size = crossterm::terminal::size().ok().filter(|_| terminal);
    let columns = size.map_or(COLUMNS, |(columns, _)| usize::from(columns));
    let palette = if terminal {
        Appearance::of_environment().palette()
    } else {
        Palette::PLAIN
    };
    figure_text(figure, columns, palette)
}
