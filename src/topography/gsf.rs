//! Gwyddion Simple Field: a text header and 32-bit heights.

use super::Unit;
use super::bytes::{Bytes, Number, Order};
use super::error::{Place, TopographyError, refused, shown};
use super::reading::{Format, RawGrid, Reading};

pub(super) const SIGNATURE: &[u8] = b"Gwyddion Simple Field 1.0\n";

/// Reads `key = value` lines up to a zero byte, then XRes × YRes numbers from the next multiple of four bytes on.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let end = bytes.iter().position(|byte| *byte == 0).ok_or_else(|| {
        refused(Place::Byte(bytes.len()), "a header without an end", "a header that ends with a zero byte")
    })?;
    let header = Header::parse(&bytes[..end])?;
    let (columns, rows) = (header.count("xres")?, header.count("yres")?);
    let mut data = Bytes::new(bytes);
    data.take((end / 4 + 1) * 4)?;
    let points = columns.saturating_mul(rows);
    let heights = data.numbers(points, Number::F32, Order::Little)?;
    let size =
        |key: &str, points: usize| header.number(key).map(|size| size.map(|size| size / points as f64));
    let spacing = match (size("xreal", columns)?, size("yreal", rows)?) {
        (Some(along), Some(between)) => Some([along, between]),
        _ => None,
    };
    Ok(Reading {
        format: Format::Gsf,
        heights,
        grid: RawGrid::of(columns, rows, spacing),
        lateral_unit: header.unit("xyunits")?,
        height_unit: header.unit("zunits")?,
        first_missing: None,
    })
}

/// Entries of the header, keys in lower case.
struct Header {
    entries: Vec<(String, String, usize)>,
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<Self, TopographyError> {
        let text = String::from_utf8_lossy(bytes);
        let mut entries = Vec::new();
        for (index, line) in text.lines().enumerate().skip(1) {
            let (key, value) = line.split_once('=').ok_or_else(|| {
                refused(Place::Line(index + 1), format!("{:?}", shown(line)), "key = value")
            })?;
            entries.push((key.trim().to_ascii_lowercase(), value.trim().to_owned(), index + 1));
        }
        Ok(Header { entries })
    }

    fn entry(&self, key: &str) -> Option<(&str, Place)> {
        let found = self.entries.iter().find(|(name, ..)| name == key);
        found.map(|(_, value, line)| (value.as_str(), Place::Line(*line)))
    }

    fn count(&self, key: &str) -> Result<usize, TopographyError> {
        let Some((value, place)) = self.entry(key) else {
            return Err(refused(Place::File, format!("no {key} in the header"), "XRes and YRes"));
        };
        match value.parse() {
            Ok(count) if count > 0 => Ok(count),
            _ => Err(refused(place, format!("{key} = {}", shown(value)), "a whole number above 0")),
        }
    }

    fn number(&self, key: &str) -> Result<Option<f64>, TopographyError> {
        let Some((value, place)) = self.entry(key) else { return Ok(None) };
        match value.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(refused(place, format!("{key} = {}", shown(value)), "a number")),
        }
    }

    fn unit(&self, key: &str) -> Result<Option<Unit>, TopographyError> {
        match self.entry(key) {
            None | Some(("", _)) => Ok(None),
            Some((value, place)) => Unit::stated(value, place).map(Some),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(header: &str, heights: &[f32]) -> Vec<u8> {
        let mut bytes = [SIGNATURE, header.as_bytes()].concat();
        bytes.resize((bytes.len() / 4 + 1) * 4, 0);
        bytes.extend(heights.iter().flat_map(|height| height.to_le_bytes()));
        bytes
    }

    #[test]
    fn a_field_has_sizes_and_units() {
        let heights = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        for padding in ["", "a", "ab", "abc"] {
            let header = format!(
                "XRes = 3\nYRes = 2\nXReal = 6e-6\nYReal = 8e-6\nXYUnits = m\nZUnits = m\nTitle = {padding}\n"
            );
            let reading = read(&field(&header, &heights)).unwrap();
            assert_eq!(reading.grid, RawGrid::Map { columns: 3, spacing: Some([2e-6, 4e-6]) });
            assert_eq!(reading.heights, heights.map(f64::from));
            assert_eq!((reading.lateral_unit, reading.height_unit), (Some(Unit::METRE), Some(Unit::METRE)));
        }
        let bare = read(&field("XRes = 3\nYRes = 2\n", &heights)).unwrap();
        assert_eq!((bare.grid, bare.height_unit), (RawGrid::Map { columns: 3, spacing: None }, None));
    }

    #[test]
    fn faults_have_a_place() {
        for (header, expected) in [
            ("XRes = 3\n", "no yres in the header; allowed: XRes and YRes"),
            ("XRes = -3\nYRes = 2\n", "line 2: xres = -3; allowed: a whole number above 0"),
            ("XRes = 3\nYRes = 2\nXReal = wide\n", "line 4: xreal = wide; allowed: a number"),
            ("XRes = 3\nYRes = 2\nZUnits = V\n", "line 4: \"V\" is no unit of length"),
            ("XRes = 3\nYRes = 4294967296\n", "byte "),
            ("XRes\n", "line 2: \"XRes\"; allowed: key = value"),
        ] {
            let error = read(&field(header, &[0.0; 6])).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{header}: {error}");
        }
        assert!(read(SIGNATURE).unwrap_err().to_string().contains("a header without an end"));
    }
}
