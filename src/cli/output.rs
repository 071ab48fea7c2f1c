//! Destinations of results.

use super::{CliError, Format};
use crate::draw::{Colours, Figure, figure_text};
use crate::export::Provenance;
use crate::io::{check_writable, write_new};
use crate::scene::{Document, Scene, quoted};
use crate::text::path_name;
use clap::Args;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// Formats of pictures.
pub(super) const PICTURES: &[Format] = &[Format::Svg, Format::Png];

/// Extensions of pictures, including those of unsupported formats.
const ENDINGS_OF_PICTURES: [&str; 9] = ["svg", "svgz", "png", "pdf", "eps", "ps", "jpg", "jpeg", "gif"];

/// A file for results in place of standard output.
#[derive(Args, Clone, Debug)]
pub struct OutputArguments {
    /// Write to FILE, whole or not at all; `-` is standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Overwrite FILE if it exists
    #[arg(long, requires = "output")]
    pub force: bool,
}

impl OutputArguments {
    /// The file, unless results go to standard output.
    pub(super) fn file(&self) -> Option<&Path> {
        self.output.as_deref().filter(|path| *path != Path::new("-"))
    }

    /// Another file, to be overwritten if this one is.
    pub(super) fn beside(&self, path: PathBuf) -> OutputArguments {
        OutputArguments { output: Some(path), force: self.force }
    }

    /// Folder of the file; the working folder for standard output.
    pub(super) fn folder(&self) -> &Path {
        self.file().and_then(Path::parent).unwrap_or(Path::new(""))
    }

    /// Checks, before any computation, that the results can be written.
    pub(super) fn check(&self) -> Result<(), CliError> {
        Ok(self.file().map_or(Ok(()), |path| check_writable(path, self.force))?)
    }

    /// The chosen format, else that of the extension of FILE, else the usual one. Only a picture is written under
    /// the extension of a picture, and a picture under no other extension. A terminal gets text only.
    pub(super) fn format(
        &self,
        chosen: Option<Format>,
        formats: &[Format],
        usual: Format,
    ) -> Result<Format, CliError> {
        let path = self.file();
        let ending = path.and_then(Path::extension).map(|ending| ending.to_string_lossy().to_lowercase());
        let has_ending = |format: &Format| ending.as_deref() == Some(format.extension());
        let by_ending = formats.iter().copied().find(has_ending);
        let format = chosen.or(by_ending).unwrap_or(usual);
        let is_binary = matches!(format, Format::Npy | Format::Png);
        let Some(path) = path else {
            return if is_binary && io::stdout().is_terminal() {
                Err(CliError::BinaryInTerminal { format: format.name() })
            } else {
                Ok(format)
            };
        };
        let is_picture = ENDINGS_OF_PICTURES.contains(&ending.as_deref().unwrap_or_default());
        let is_drawn = ending.is_some() && format.picture().is_some();
        if by_ending == Some(format) || !(is_picture || is_drawn) {
            return Ok(format);
        }
        let allowed = chosen.as_ref().map_or(formats, std::slice::from_ref);
        let allowed: Vec<String> = allowed.iter().map(|format| format!(".{}", format.extension())).collect();
        Err(CliError::Ending { path: path_name(path), allowed: allowed.join(", ") })
    }

    /// Writes a figure, as a picture or as text, to its destination.
    pub(super) fn write_figure(
        &self,
        stdout: &mut dyn Write,
        figure: &Figure,
        format: Format,
    ) -> Result<(), CliError> {
        let drawn = match format.picture() {
            Some(picture) => figure.picture(picture)?,
            None => text_for_reader(figure, self.file().is_none()).into_bytes(),
        };
        self.write(stdout, |out| out.write_all(&drawn))
    }

    /// Writes a table of a scene with its provenance to its destination.
    pub(super) fn write_table(
        &self,
        stdout: &mut dyn Write,
        (document, scene): (&Document, &Scene),
        write: impl FnOnce(&mut dyn Write, &Provenance) -> io::Result<()>,
    ) -> Result<(), CliError> {
        let provenance = Provenance::new(&command(), scene, &document.resolve(""), self.folder())?;
        self.write(stdout, |out| write(out, &provenance))
    }

    /// Writes results to their destination.
    pub(super) fn write(
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

/// The command of this process, for a POSIX shell, without format and destination of its results.
pub(super) fn command() -> String {
    let mut words = vec!["asperity".to_owned()];
    let mut typed = std::env::args().skip(1);
    while let Some(word) = typed.next() {
        if ["-o", "--output", "--format"].contains(&word.as_str()) {
            typed.next();
        } else if word != "--force"
            && !["-o", "--output=", "--format="].iter().any(|one| word.starts_with(one))
        {
            words.push(quoted(&word));
        }
    }
    words.join(" ")
}

/// Columns of figures as text without a terminal.
const COLUMNS: usize = 80;

/// A figure as text, in the width and the colours of the terminal if it is for one.
pub(super) fn text_for_reader(figure: &Figure, to_stdout: bool) -> String {
    let terminal = to_stdout && io::stdout().is_terminal();
    let size = crossterm::terminal::size().ok().filter(|_| terminal);
    let columns = size.map_or(COLUMNS, |(columns, _)| usize::from(columns));
    figure_text(figure, columns, if terminal { colours() } else { Colours::None })
}

/// Colours of the terminal according to the environment.
fn colours() -> Colours {
    let value = |name| std::env::var(name).unwrap_or_default();
    if !value("NO_COLOR").is_empty() || value("TERM") == "dumb" {
        Colours::None
    } else if ["truecolor", "24bit"].contains(&value("COLORTERM").as_str()) {
        Colours::All
    } else {
        Colours::Palette
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FORMATS: [Format; 3] = [Format::Text, Format::Json, Format::Svg];

    fn format(path: &str, chosen: Option<Format>) -> Result<Format, String> {
        let output = OutputArguments { output: Some(path.into()), force: false };
        output.format(chosen, &FORMATS, Format::Text).map_err(|error| error.to_string())
    }

    #[test]
    fn formats_follow_the_ending() {
        for (path, chosen, expected) in [
            ("a.json", None, Format::Json),
            ("a.SVG", None, Format::Svg),
            ("a.txt", None, Format::Text),
            ("a.dat", None, Format::Text),
            ("svg", None, Format::Text),
            ("-", Some(Format::Svg), Format::Svg),
            ("a", Some(Format::Svg), Format::Svg),
            ("a.json", Some(Format::Text), Format::Text),
        ] {
            assert_eq!(format(path, chosen), Ok(expected), "{path}");
        }
    }

    #[test]
    fn a_picture_is_written_under_its_ending_and_nothing_else() {
        for (path, chosen, allowed) in [
            ("a.svg", Some(Format::Json), ".json"),
            ("a.svg", Some(Format::Text), ".txt"),
            ("a.png", None, ".txt, .json, .svg"),
            ("a.PDF", Some(Format::Svg), ".svg"),
            ("a.json", Some(Format::Svg), ".svg"),
        ] {
            let error = format(path, chosen).unwrap_err();
            assert_eq!(error, format!("{path}: not an ending of what is written; allowed: {allowed}"));
        }
        let output = OutputArguments { output: Some("a.svg".into()), force: false };
        assert!(output.format(None, &[Format::Csv], Format::Csv).is_err());
    }
}
