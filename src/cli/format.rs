//! Formats of results: names, extensions of files, and the formats of a command.

use super::CliError;
use crate::draw::PictureFormat;
use crate::export::TableFormat;
use crate::io::write_json_value;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use serde::Serialize;
use std::io::Write;

/// Format of results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Text for a person.
    Text,
    /// One object.
    Json,
    /// Comma-separated values.
    Csv,
    /// Array of NumPy.
    Npy,
    /// Picture of lines.
    Svg,
    /// Picture of pixels.
    Png,
}

/// Formats with their names and the extensions of their files.
const FORMATS: [(Format, &str, &str); 6] = [
    (Format::Text, "text", "txt"),
    (Format::Json, "json", "json"),
    (Format::Csv, "csv", "csv"),
    (Format::Npy, "npy", "npy"),
    (Format::Svg, "svg", "svg"),
    (Format::Png, "png", "png"),
];

/// Former name of the text format.
const SUMMARY: &str = "summary";

impl Format {
    /// Parser of the names of these formats.
    pub(super) fn parser(formats: &'static [Format]) -> impl TypedValueParser<Value = Format> {
        let value = |format: &Format| match format {
            Format::Text => PossibleValue::new(format.name()).alias(SUMMARY),
            format => PossibleValue::new(format.name()),
        };
        let named =
            |name: String| FORMATS.into_iter().find(|row| row.1 == name).map_or(Format::Text, |row| row.0);
        PossibleValuesParser::new(formats.iter().map(value)).map(named)
    }

    /// Name on the command line.
    pub(super) fn name(self) -> &'static str {
        FORMATS[self as usize].1
    }

    /// Extension of files.
    pub(super) fn extension(self) -> &'static str {
        FORMATS[self as usize].2
    }

    /// Format of a table.
    pub(super) fn table(self) -> Option<TableFormat> {
        match self {
            Format::Csv => Some(TableFormat::Csv),
            Format::Npy => Some(TableFormat::Npy),
            _ => None,
        }
    }

    /// Format of a picture.
    pub(super) fn picture(self) -> Option<PictureFormat> {
        match self {
            Format::Svg => Some(PictureFormat::Svg),
            Format::Png => Some(PictureFormat::Png),
            _ => None,
        }
    }
}

/// Formats of short answers and of tables without a picture: text for a reader, or one object.
pub(super) const TEXT_OR_JSON: &[Format] = &[Format::Text, Format::Json];

/// Format of a short answer on standard output.
#[derive(Args, Clone, Copy, Debug)]
pub struct AnswerFormat {
    /// Output format
    #[arg(long, value_parser = Format::parser(TEXT_OR_JSON), default_value = "text")]
    format: Format,
}

impl AnswerFormat {
    /// Writes an answer as text or as JSON.
    pub(super) fn write(
        self,
        stdout: &mut dyn Write,
        text: impl FnOnce() -> String,
        answer: &impl Serialize,
    ) -> Result<(), CliError> {
        match self.format {
            Format::Json => write_json_value(stdout, answer)?,
            _ => stdout.write_all(text().as_bytes())?,
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_in_the_order_of_the_formats() {
        for (index, (format, name, _)) in FORMATS.into_iter().enumerate() {
            assert_eq!((format as usize, format.name()), (index, name));
        }
    }
}
