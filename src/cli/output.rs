//! Destinations of results.

use super::CliError;
use crate::draw::{Colours, Figure, figure_text};
use crate::io::{check_writable, write_new};
use crate::scene::{Document, MeasuredHash, Provenance, Scene, TableContent};
use crate::text::path_name;
use clap::Args;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// Endings of pictures.
const PICTURES: [&str; 9] = ["svg", "svgz", "png", "pdf", "eps", "ps", "jpg", "jpeg", "gif"];

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

    /// Folder of the file; the working folder for standard output.
    pub(super) fn folder(&self) -> &Path {
        self.file().and_then(Path::parent).unwrap_or(Path::new(""))
    }

    /// Checks, before anything is computed, that the results can be written.
    pub(super) fn check(&self) -> Result<(), CliError> {
        Ok(self.file().map_or(Ok(()), |path| check_writable(path, self.force))?)
    }

    /// The chosen format, else that of the ending of FILE, else the usual one. `endings` are those of the formats;
    /// under the ending of a picture nothing but that picture is written, and a picture under no other ending.
    pub(super) fn format<F: Copy + PartialEq>(
        &self,
        chosen: Option<F>,
        endings: &[(&str, F)],
        usual: F,
    ) -> Result<F, CliError> {
        let path = self.file();
        let ending = path.and_then(Path::extension).map(|ending| ending.to_string_lossy().to_lowercase());
        let of = |ending: &str| endings.iter().find(|(one, _)| *one == ending).map(|(_, format)| *format);
        let by_ending = ending.as_deref().and_then(of);
        let format = chosen.or(by_ending).unwrap_or(usual);
        let is_picture = PICTURES.contains(&ending.as_deref().unwrap_or_default());
        let is_drawn = ending.is_some() && PICTURES.iter().any(|picture| of(picture) == Some(format));
        let (true, Some(path)) = (is_picture || is_drawn, path) else {
            return Ok(format);
        };
        if by_ending == Some(format) {
            return Ok(format);
        }
        let allowed = |(ending, one): &(&str, F)| {
            chosen.is_none_or(|chosen| chosen == *one).then_some(format!(".{ending}"))
        };
        let mut allowed: Vec<String> = endings.iter().filter_map(allowed).collect();
        if allowed.is_empty() {
            allowed.push(".txt".to_owned());
        }
        Err(CliError::Ending { path: path_name(path), allowed: allowed.join(", ") })
    }

    /// Refuses to write what is no text to a terminal.
    pub(super) fn check_binary(&self, is_binary: bool) -> Result<(), CliError> {
        match self.file() {
            None if is_binary && io::stdout().is_terminal() => Err(CliError::BinaryInTerminal),
            _ => Ok(()),
        }
    }

    /// Provenance of a table of a scene that goes where results go.
    pub(super) fn provenance(
        &self,
        document: &Document,
        scene: &Scene,
        content: TableContent,
    ) -> Result<Provenance, CliError> {
        let (folder, destination) = (document.resolve(""), self.folder());
        let hashes = MeasuredHash::of_files(scene.measured_files(), &folder, destination)?;
        Ok(Provenance::new(content, scene, &folder, destination).with_hashes(&hashes))
    }

    /// Writes results to where they go.
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

/// Columns of figures as text where there is no terminal.
const COLUMNS: usize = 80;

/// A figure as text, in the width and the colours of the terminal if it is for one.
pub(super) fn text_for_reader(figure: &Figure, to_stdout: bool) -> String {
    let terminal = to_stdout && io::stdout().is_terminal();
    let size = crossterm::terminal::size().ok().filter(|_| terminal);
    let columns = size.map_or(COLUMNS, |(columns, _)| usize::from(columns));
    figure_text(figure, columns, if terminal { colours() } else { Colours::None })
}

/// Colours of the terminal by the environment.
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

    const ENDINGS: [(&str, char); 2] = [("json", 'j'), ("svg", 's')];

    fn format(path: &str, chosen: Option<char>) -> Result<char, String> {
        let output = OutputArguments { output: Some(path.into()), force: false };
        output.format(chosen, &ENDINGS, 't').map_err(|error| error.to_string())
    }

    #[test]
    fn formats_follow_the_ending() {
        for (path, chosen, expected) in [
            ("a.json", None, 'j'),
            ("a.SVG", None, 's'),
            ("a.txt", None, 't'),
            ("svg", None, 't'),
            ("-", Some('s'), 's'),
            ("a", Some('s'), 's'),
            ("a.json", Some('t'), 't'),
        ] {
            assert_eq!(format(path, chosen), Ok(expected), "{path}");
        }
    }

    #[test]
    fn a_picture_is_written_under_its_ending_and_nothing_else() {
        for (path, chosen, allowed) in [
            ("a.svg", Some('j'), ".json"),
            ("a.svg", Some('t'), ".txt"),
            ("a.png", None, ".json, .svg"),
            ("a.PDF", Some('s'), ".svg"),
            ("a.json", Some('s'), ".svg"),
        ] {
            let error = format(path, chosen).unwrap_err();
            assert_eq!(error, format!("{path}: not an ending of what is written; allowed: {allowed}"));
        }
        let output = OutputArguments { output: Some("a.svg".into()), force: false };
        assert!(output.format(None, &[("csv", 'c')], 'c').is_err());
    }
}
