//! Headers of lines `key = value`.

use super::error::{Place, TopographyError, refused, shown};

/// Entries of a header with their line numbers. Keys are case-insensitive.
#[derive(Default)]
pub(super) struct Entries {
    entries: Vec<(String, String, usize)>,
}

impl Entries {
    /// Reads a line with its number; `allowed` is for the message.
    pub fn take(&mut self, number: usize, line: &str, allowed: &str) -> Result<(), TopographyError> {
        let Some((key, value)) = line.split_once('=') else {
            return Err(refused(Place::Line(number), format!("{:?}", shown(line)), allowed));
        };
        self.entries.push((key.trim().to_ascii_lowercase(), value.trim().to_owned(), number));
        Ok(())
    }

    /// Value of a key, and its place.
    pub fn text(&self, key: &str) -> Option<(&str, Place)> {
        let found = self.entries.iter().find(|(name, ..)| name.eq_ignore_ascii_case(key));
        found.map(|(_, value, line)| (value.as_str(), Place::Line(*line)))
    }

    /// Finite number of a key.
    pub fn number(&self, key: &str) -> Result<Option<f64>, TopographyError> {
        let Some((value, place)) = self.text(key) else { return Ok(None) };
        match value.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(refused(place, format!("{key} = {}", shown(value)), "a number")),
        }
    }

    /// Integer above 0 of a key. The error of a missing key lists all `required` keys.
    pub fn count(&self, key: &str, required: &str) -> Result<usize, TopographyError> {
        let Some((value, place)) = self.text(key) else { return Err(missing(key, required)) };
        match value.parse::<f64>() {
            Ok(count) if count >= 1.0 && count < usize::MAX as f64 && count.fract() == 0.0 => {
                Ok(count as usize)
            }
            _ => Err(refused(place, format!("{key} = {}", shown(value)), "a whole number above 0")),
        }
    }
}

pub(super) fn missing(key: &str, required: &str) -> TopographyError {
    refused(Place::File, format!("no {key} in the header"), required)
}
