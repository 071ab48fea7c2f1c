//! Headers that consist of lines `key = value`.

use crate::error::{Place, SurfaceError, refused};
use asperity_data::shown;

/// Entries of a header. Upper and lower case of the keys does not matter.
#[derive(Default)]
pub(super) struct KeyValues {
    entries: Vec<Entry>,
}

struct Entry {
    /// Key in lower case.
    key: String,
    value: String,
    line: usize,
}

/// The value of a key in a header, and its place in the file.
pub(super) struct Value<'a> {
    pub text: &'a str,
    pub place: Place,
}

impl KeyValues {
    /// Reads one line of the header. `allowed` says in error messages which lines are allowed.
    pub fn take(
        &mut self,
        line_number: usize,
        line: &str,
        allowed: &str,
    ) -> Result<(), SurfaceError> {
        let Some((key, value)) = line.split_once('=') else {
            let found = format!("{:?}", shown(line));
            return Err(refused(Place::Line(line_number), found, allowed));
        };
        self.entries.push(Entry {
            key: key.trim().to_ascii_lowercase(),
            value: value.trim().to_owned(),
            line: line_number,
        });
        Ok(())
    }

    pub fn value(&self, key: &str) -> Option<Value<'_>> {
        let mut entries = self.entries.iter();
        let entry = entries.find(|entry| entry.key.eq_ignore_ascii_case(key))?;
        Some(Value {
            text: &entry.value,
            place: Place::Line(entry.line),
        })
    }

    pub fn number(&self, key: &str) -> Result<Option<f64>, SurfaceError> {
        let Some(value) = self.value(key) else {
            return Ok(None);
        };
        match value.text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(wrong(key, value, "a number")),
        }
    }

    /// Returns the value of a key as a positive integer. If the key is missing, the error lists all
    /// `required` keys.
    pub fn count(&self, key: &str, required: &str) -> Result<usize, SurfaceError> {
        let Some(value) = self.value(key) else {
            return Err(missing(key, required));
        };
        match value.text.parse::<f64>() {
            Ok(count) if count >= 1.0 && count < usize::MAX as f64 && count.fract() == 0.0 => {
                Ok(count as usize)
            }
            _ => Err(wrong(key, value, "a whole number above 0")),
        }
    }
}

fn wrong(key: &str, value: Value<'_>, allowed: &str) -> SurfaceError {
    let found = format!("{key} = {}", shown(value.text));
    refused(value.place, found, allowed)
}

/// Returns the error for a missing key. It lists all `required` keys.
pub(super) fn missing(key: &str, required: &str) -> SurfaceError {
    refused(Place::File, format!("no {key} in the header"), required)
}
