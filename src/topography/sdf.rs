//! SDF of ISO 25178-71, as text and binary: header, heights as integers or real numbers, scales in m.

use super::Unit;
use super::bytes::{Bytes, Number, Order};
use super::entries::{Entries, missing};
use super::error::{Place, TopographyError, refused, shown};
use super::reading::{Format, RawGrid, Reading};

/// Types of heights by their number in the header, with the integer that marks a missing point.
const TYPES: [(Number, Option<f64>); 8] = [
    (Number::U8, None),
    (Number::U16, Some(65_535.0)),
    (Number::U32, Some(4_294_967_295.0)),
    (Number::F32, None),
    (Number::I8, None),
    (Number::I16, Some(-32_768.0)),
    (Number::I32, Some(-2_147_483_648.0)),
    (Number::F64, None),
];

/// Content of the header.
struct Header {
    columns: usize,
    rows: usize,
    /// Distances along and between rows and unit of the heights, m.
    scales: [f64; 3],
    missing: Option<f64>,
}

impl Header {
    fn into_reading(self, mut heights: Vec<f64>, first_missing: Option<Place>) -> Reading {
        let [along, between, unit] = self.scales;
        for height in &mut heights {
            *height = if Some(*height) == self.missing { f64::NAN } else { *height * unit };
        }
        let grid = RawGrid::of(self.columns, self.rows, Some([along, between]));
        Reading { first_missing, ..Reading::new(Format::Sdf, heights, grid, [Some(Unit::METRE); 2]) }
    }
}

fn data_type(number: usize, place: Place) -> Result<(Number, Option<f64>), TopographyError> {
    let found = TYPES.get(number).copied();
    found.ok_or_else(|| refused(place, format!("DataType = {number}"), "from 0 to 7"))
}

/// Reads the text form: `key = value` lines, `*`, heights between spaces, `*`.
pub(super) fn read_text(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let header = text_header(&mut lines)?;
    let points = header.columns.saturating_mul(header.rows);
    let mut heights = Vec::new();
    let mut first_missing = None;
    let mut last = 0;
    for (number, line) in lines.take_while(|(_, line)| *line != "*") {
        last = number;
        for word in line.split_ascii_whitespace() {
            let place = Place::Line(number);
            let height = match word.parse::<f64>() {
                Ok(height) => height,
                Err(_) if word.eq_ignore_ascii_case("BAD") => f64::NAN,
                Err(_) => return Err(refused(place, format!("{:?}", shown(word)), "a number or BAD")),
            };
            if heights.len() == points {
                let fault = format!("more than {points} heights");
                return Err(refused(place, fault, "NumPoints times NumProfiles"));
            }
            if !height.is_finite() || Some(height) == header.missing {
                first_missing.get_or_insert(place);
            }
            heights.push(height);
        }
    }
    if heights.len() < points {
        let fault = format!("{} of {points} heights up to the end", heights.len());
        return Err(refused(Place::Line(last), fault, "NumPoints times NumProfiles"));
    }
    Ok(header.into_reading(heights, first_missing))
}

fn text_header<'a>(lines: &mut impl Iterator<Item = (usize, &'a str)>) -> Result<Header, TopographyError> {
    const REQUIRED: &str = "NumPoints, NumProfiles, Xscale, Yscale, Zscale";
    let mut entries = Entries::default();
    let mut lines = lines.skip(1).filter(|(_, line)| !line.is_empty());
    loop {
        match lines.next() {
            Some((_, "*")) => break,
            Some((number, line)) => entries.take(number, line, "key = value, or * before the heights")?,
            None => {
                let allowed = "a line with * before the heights";
                return Err(refused(Place::File, "a header without an end", allowed));
            }
        }
    }
    let scale = |key: &str| entries.number(key)?.ok_or_else(|| missing(key, REQUIRED));
    let scales = [scale("Xscale")?, scale("Yscale")?, scale("Zscale")?];
    let (columns, rows) = (entries.count("NumPoints", REQUIRED)?, entries.count("NumProfiles", REQUIRED)?);
    let missing = match (entries.number("DataType"), entries.text("DataType")) {
        (Ok(Some(number)), Some((_, place))) => data_type(number.max(0.0) as usize, place)?.1,
        _ => None,
    };
    Ok(Header { columns, rows, scales, missing })
}

/// Reads the binary form, little-endian.
pub(super) fn read_binary(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let mut data = Bytes::new(bytes, Order::Little);
    // Version, manufacturer, dates.
    data.take(8 + 10 + 12 + 12)?;
    let (columns, rows) = (data.size(Number::U16)?, data.size(Number::U16)?);
    let scales = data.array(Number::F64)?;
    let _resolution = data.number(Number::F64)?;
    let place = data.place();
    let flags = data.take(3)?;
    if flags[0] != 0 {
        return Err(refused(place, "compressed heights", "Compression = 0"));
    }
    let (number, missing) = data_type(usize::from(flags[1]), place)?;
    let heights = data.numbers(columns * rows, number)?;
    Ok(Header { columns, rows, scales, missing }.into_reading(heights, None))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "aISO-1.0\nManufacID = none\nNumPoints = 3\nNumProfiles = 2\nXscale = 1e-6\nYscale = 2e-6\n\
                          Zscale = 1e-9\nZresolution = -1\nCompression = 0\nDataType = 5\nCheckType = 0\n*\n";

    #[test]
    fn text_has_scales_and_bad_points() {
        let reading = read_text(format!("{HEADER}1 2 3\n4 BAD -32768\n*\ntrailer").as_bytes()).unwrap();
        assert_eq!(reading.grid, RawGrid::Map { columns: 3, spacing: Some([1e-6, 2e-6]) });
        assert_eq!(reading.heights[..4], [1e-9, 2e-9, 3.0 * 1e-9, 4.0 * 1e-9]);
        assert!(reading.heights[4].is_nan() && reading.heights[5].is_nan());
        assert_eq!(reading.first_missing, Some(Place::Line(14)));
        assert_eq!(reading.height_unit, Some(Unit::METRE));
    }

    #[test]
    fn binary_is_the_same_surface() {
        let mut bytes = b"bISO-1.0".to_vec();
        bytes.resize(42, b' ');
        bytes.extend([3, 0, 2, 0]);
        [1e-6, 2e-6, 1e-9, -1.0].iter().for_each(|scale: &f64| bytes.extend(scale.to_le_bytes()));
        bytes.extend([0, 5, 0]);
        [1_i16, 2, 3, 4, -32_768, 6].iter().for_each(|height| bytes.extend(height.to_le_bytes()));
        let text = read_text(format!("{HEADER}1 2 3 4 BAD 6\n*").as_bytes()).unwrap();
        let binary = read_binary(&bytes).unwrap();
        assert_eq!(format!("{:?}", binary.heights), format!("{:?}", text.heights));
        assert_eq!(binary.grid, text.grid);
        assert!(read_binary(&bytes[..90]).unwrap_err().to_string().starts_with("byte 81: "));
    }

    #[test]
    fn faults_have_a_place() {
        for (text, expected) in [
            (format!("{HEADER}1 2 3 4 5"), "line 13: 5 of 6 heights up to the end"),
            (format!("{HEADER}1 2 3 4 5 6\n7"), "line 14: more than 6 heights"),
            (format!("{HEADER}1 2 x"), "line 13: \"x\"; allowed: a number or BAD"),
            (
                HEADER.replace("NumPoints = 3", "NumPoints = 2.5"),
                "line 3: NumPoints = 2.5; allowed: a whole number",
            ),
            (HEADER.replace("Zscale = 1e-9\n", ""), "no Zscale in the header"),
            (HEADER.replace("DataType = 5", "DataType = 9"), "line 10: DataType = 9; allowed: from 0 to 7"),
            (HEADER.replace("*\n", ""), "a header without an end"),
        ] {
            let error = read_text(text.as_bytes()).map(|_| ()).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{text}: {error}");
        }
    }
}
