//! Formats with a header of lines `key = value`: SDF of ISO 25178-71, as text and binary, with heights as integers or real
//! numbers and scales in m; and Gwyddion Simple Field, with 32-bit heights.

use super::Unit;
use super::bytes::{Bytes, Number, Order};
use super::reading::Reading;
use super::{Place, TopographyError, refused, shown};

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

/// Heights in rows of `columns` points, with distances along and between rows and the unit of the heights, m.
fn reading(
    heights: Vec<f64>,
    columns: usize,
    [along, between, unit]: [f64; 3],
    missing: Option<f64>,
) -> Reading {
    let units = [Some(Unit::METRE); 2];
    Reading::even("SDF", heights, columns, Some([along, between]), units).scaled(missing, unit)
}

fn data_type(number: usize, place: Place) -> Result<(Number, Option<f64>), TopographyError> {
    let found = TYPES.get(number).copied();
    found.ok_or_else(|| refused(place, format!("DataType = {number}"), "from 0 to 7"))
}

/// Reads the text form: `key = value` lines, `*`, heights between spaces, `*`.
pub(super) fn read_text(bytes: &[u8]) -> Result<Reading, TopographyError> {
    const REQUIRED: &str = "NumPoints, NumProfiles, Xscale, Yscale, Zscale";
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let entries = entries(&mut lines)?;
    let scale = |key: &str| entries.number(key)?.ok_or_else(|| missing(key, REQUIRED));
    let scales = [scale("Xscale")?, scale("Yscale")?, scale("Zscale")?];
    let (columns, rows) = (entries.count("NumPoints", REQUIRED)?, entries.count("NumProfiles", REQUIRED)?);
    let missing = match (entries.number("DataType"), entries.text("DataType")) {
        (Ok(Some(number)), Some((_, place))) => data_type(number.max(0.0) as usize, place)?.1,
        _ => None,
    };
    let points = columns.saturating_mul(rows);
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
            if !height.is_finite() || Some(height) == missing {
                first_missing.get_or_insert(place);
            }
            heights.push(height);
        }
    }
    if heights.len() < points {
        let fault = format!("{} of {points} heights up to the end", heights.len());
        return Err(refused(Place::Line(last), fault, "NumPoints times NumProfiles"));
    }
    Ok(Reading { first_missing, ..reading(heights, columns, scales, missing) })
}

fn entries<'a>(lines: &mut impl Iterator<Item = (usize, &'a str)>) -> Result<Entries, TopographyError> {
    let mut entries = Entries::default();
    for (number, line) in lines.skip(1).filter(|(_, line)| !line.is_empty()) {
        if line == "*" {
            return Ok(entries);
        }
        entries.take(number, line, "key = value, or * before the heights")?;
    }
    Err(refused(Place::File, "a header without an end", "a line with * before the heights"))
}

/// Reads the binary form, little-endian.
pub(super) fn read_binary(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let mut data = Bytes::new(bytes, Order::Little);
    // Version, manufacturer, dates.
    data.take(8 + 10 + 12 + 12)?;
    let (columns, rows) = (data.size(Number::U16)?, data.size(Number::U16)?);
    let [along, between, unit, _resolution] = data.array(Number::F64)?;
    let place = data.place();
    let flags = data.take(3)?;
    if flags[0] != 0 {
        return Err(refused(place, "compressed heights", "Compression = 0"));
    }
    let (number, missing) = data_type(usize::from(flags[1]), place)?;
    Ok(reading(data.numbers(columns * rows, number)?, columns, [along, between, unit], missing))
}

/// Entries of a header with their line numbers. Keys are case-insensitive.
#[derive(Default)]
struct Entries {
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

    pub fn text(&self, key: &str) -> Option<(&str, Place)> {
        let found = self.entries.iter().find(|(name, ..)| name.eq_ignore_ascii_case(key));
        found.map(|(_, value, line)| (value.as_str(), Place::Line(*line)))
    }

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

fn missing(key: &str, required: &str) -> TopographyError {
    refused(Place::File, format!("no {key} in the header"), required)
}

pub(super) const GSF: &[u8] = b"Gwyddion Simple Field 1.0\n";

/// Reads `key = value` lines up to a zero byte, then XRes × YRes numbers from the next multiple of four bytes.
pub(super) fn read_gsf(bytes: &[u8]) -> Result<Reading, TopographyError> {
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
    Ok(Reading::even("GSF", heights, columns, spacing, units))
}
