//! Gwyddion Simple Field: a text header and 32-bit heights.

use super::Unit;
use super::bytes::{Bytes, Number, Order};
use super::entries::Entries;
use super::error::{Place, TopographyError, refused};
use super::reading::{Format, RawGrid, Reading};

pub(super) const SIGNATURE: &[u8] = b"Gwyddion Simple Field 1.0\n";

/// Reads `key = value` lines up to a zero byte, then XRes × YRes numbers from the next multiple of four bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let end = bytes.iter().position(|byte| *byte == 0).ok_or_else(|| {
        refused(Place::Byte(bytes.len()), "a header without an end", "a header that ends with a zero byte")
    })?;
    let mut header = Entries::default();
    for (index, line) in String::from_utf8_lossy(&bytes[..end]).lines().enumerate().skip(1) {
        header.take(index + 1, line, "key = value")?;
    }
    let count = |key: &str| header.count(key, "XRes and YRes");
    let (columns, rows) = (count("xres")?, count("yres")?);
    let mut data = Bytes::new(bytes, Order::Little);
    data.take((end / 4 + 1) * 4)?;
    let heights = data.numbers(columns.saturating_mul(rows), Number::F32)?;
    let sizes = header.number("xreal")?.zip(header.number("yreal")?);
    let spacing = sizes.map(|(width, height)| [width / columns as f64, height / rows as f64]);
    let unit = |key: &str| header.text(key).map_or(Ok(None), |(value, place)| Unit::stated(value, place));
    let units = [unit("xyunits")?, unit("zunits")?];
    Ok(Reading::new(Format::Gsf, heights, RawGrid::of(columns, rows, spacing), units))
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
