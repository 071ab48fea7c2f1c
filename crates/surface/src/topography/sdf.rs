//! Formats with a header of lines `key = value`. SDF of ISO 25178-71 and its predecessor BCR are
//! text or binary, with heights as integers or real numbers and scales in m. Gwyddion Simple Field
//! has 32-bit heights.

use super::Unit;
use super::bytes::{Bytes, Number, Order};
use super::reading::Reading;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::shown;
use std::ops::RangeInclusive;

/// Types of heights, indexed by their number in the header. Each has its name in BCR, the type, and
/// the smallest and largest value, for real numbers to the digits that texts have.
const TYPES: [(&str, Number, [f64; 2]); 8] = [
    ("UCHAR", Number::U8, [0.0, 255.0]),
    ("UINTEGER", Number::U16, [0.0, 65_535.0]),
    ("ULONGINT", Number::U32, [0.0, 4_294_967_295.0]),
    ("FLOAT", Number::F32, [-3.4e38, 3.4e38]),
    ("CHAR", Number::I8, [-128.0, 127.0]),
    ("INTEGER", Number::I16, [-32_768.0, 32_767.0]),
    ("LONGINT", Number::I32, [-2_147_483_648.0, 2_147_483_647.0]),
    ("DOUBLE", Number::F64, [-1.7e308, 1.7e308]),
];

/// Byte order mark that some programs write before a text.
const UTF_8_MARK: &[u8] = b"\xef\xbb\xbf";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Version {
    /// BCR, the proposal of 1993.
    Bcr,
    /// ISO 25178-71, also its draft.
    Iso1,
    /// ISO 25178-71 from 2017 on, with larger maps.
    Iso2,
}

/// Returns true for the first bytes of SDF: `a` for text or `b` for binary, and the name of a
/// version.
pub(super) fn is_sdf(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(UTF_8_MARK).unwrap_or(bytes);
    matches!(bytes, [b'a' | b'A' | b'b' | b'B', family @ ..] if family.starts_with(b"ISO-") || family.starts_with(b"BCR-"))
}

/// Reads the text or the binary form of any version.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    let bytes = bytes.strip_prefix(UTF_8_MARK).unwrap_or(bytes);
    let version = match bytes.get(1..8) {
        Some(b"BCR-1.0") => Version::Bcr,
        Some(b"ISO-1.0") => Version::Iso1,
        Some(b"ISO-2.0") => Version::Iso2,
        _ => {
            let found = String::from_utf8_lossy(&bytes[1..bytes.len().min(8)]);
            let fault = format!("version {:?} of SDF", shown(&found));
            return Err(refused(
                Place::Byte(1),
                fault,
                "BCR-1.0, ISO-1.0 and ISO-2.0",
            ));
        }
    };
    if bytes[0].eq_ignore_ascii_case(&b'a') {
        read_text(bytes, version)
    } else {
        read_binary(bytes, version)
    }
}

/// Creates heights in rows of `columns` points, with the distances along and between rows and the
/// unit of the heights in m.
fn reading(
    heights: Vec<f64>,
    columns: usize,
    [along, between, unit]: [f64; 3],
    missing: &RangeInclusive<f64>,
) -> Reading {
    let units = [Some(Unit::METRE); 3];
    let reading = Reading::even("SDF", heights, columns, Some([along, between]), units);
    reading.scaled(|height| missing.contains(&height), unit)
}

/// Returns the type with this number or name, and the range of heights that mark missing points.
/// The range is around the smallest value in ISO, around the largest one in BCR and in types
/// without negative values.
fn data_type(
    name: &str,
    version: Version,
    place: Place,
) -> Result<(Number, RangeInclusive<f64>), SurfaceError> {
    let mut types = TYPES.into_iter().enumerate();
    let is_it = |place: usize, of: &str| name == place.to_string() || name.eq_ignore_ascii_case(of);
    let Some((_, (_, number, [smallest, largest]))) =
        types.find(|(place, (of, ..))| is_it(*place, of))
    else {
        return Err(refused(
            place,
            format!("DataType = {}", shown(name)),
            "from 0 to 7",
        ));
    };
    // Texts round the largest and the smallest real number to few digits.
    let reach = if matches!(number, Number::F32 | Number::F64) {
        f64::INFINITY
    } else {
        0.0
    };
    let is_largest = version == Version::Bcr || smallest == 0.0;
    let missing = if is_largest {
        largest..=largest + reach
    } else {
        smallest - reach..=smallest
    };
    Ok((number, missing))
}

/// Reads the text form: `key = value` lines, `*`, heights separated by white space, `*`, and
/// comments after semicolons.
fn read_text(bytes: &[u8], version: Version) -> Result<Reading, SurfaceError> {
    const REQUIRED: &str = "NumPoints, NumProfiles, Xscale, Yscale, Zscale";
    let text = String::from_utf8_lossy(bytes);
    let line_end = if text.contains('\n') { '\n' } else { '\r' };
    let mut lines = text
        .split(line_end)
        .map(|line| line.split(';').next().unwrap_or_default().trim())
        .enumerate()
        .map(|(index, line)| (index + 1, line));
    let entries = entries(&mut lines)?;
    let scale = |key: &str| entries.number(key)?.ok_or_else(|| missing(key, REQUIRED));
    let scales = [scale("Xscale")?, scale("Yscale")?, scale("Zscale")?];
    let (columns, rows) = (
        entries.count("NumPoints", REQUIRED)?,
        entries.count("NumProfiles", REQUIRED)?,
    );
    let missing = match entries.text("DataType") {
        Some((name, place)) => data_type(name, version, place)?.1,
        // Nothing but BAD, since no height is infinite.
        None => f64::INFINITY..=f64::INFINITY,
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
                Err(_) => {
                    return Err(refused(
                        place,
                        format!("{:?}", shown(word)),
                        "a number or BAD",
                    ));
                }
            };
            if heights.len() == points {
                let fault = format!("more than {points} heights");
                return Err(refused(place, fault, "NumPoints times NumProfiles"));
            }
            if !height.is_finite() || missing.contains(&height) {
                first_missing.get_or_insert(place);
            }
            heights.push(height);
        }
    }
    if heights.len() < points {
        let fault = format!("{} of {points} heights up to the end", heights.len());
        return Err(refused(
            Place::Line(last),
            fault,
            "NumPoints times NumProfiles",
        ));
    }
    Ok(Reading {
        first_missing,
        ..reading(heights, columns, scales, &missing)
    })
}

fn entries<'a>(
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
) -> Result<Entries, SurfaceError> {
    let mut entries = Entries::default();
    for (number, line) in lines.skip(1).filter(|(_, line)| !line.is_empty()) {
        if line == "*" {
            return Ok(entries);
        }
        entries.take(number, line, "key = value, or * before the heights")?;
    }
    Err(refused(
        Place::File,
        "a header without an end",
        "a line with * before the heights",
    ))
}

/// Reads the binary form, little-endian.
fn read_binary(bytes: &[u8], version: Version) -> Result<Reading, SurfaceError> {
    let mut data = Bytes::new(bytes, Order::Little);
    // Version, manufacturer, dates.
    data.take(8 + 10 + 12 + 12)?;
    let count = if version == Version::Iso2 {
        Number::U32
    } else {
        Number::U16
    };
    let (columns, rows) = (data.size(count)?, data.size(count)?);
    let [along, between, unit, _resolution] = data.array(Number::F64)?;
    let place = data.place();
    let [compression, kind, check] = data.array(Number::U8)?;
    if compression != 0.0 {
        return Err(refused(place, "compressed heights", "Compression = 0"));
    }
    if check != 0.0 {
        return Err(refused(
            place,
            "a check sum behind each row",
            "CheckType = 0",
        ));
    }
    let (number, missing) = data_type(&kind.to_string(), version, place)?;
    let heights = data.numbers(columns.saturating_mul(rows), number)?;
    Ok(reading(heights, columns, [along, between, unit], &missing))
}

/// Entries of a header with their line numbers. Keys are case-insensitive.
#[derive(Default)]
struct Entries {
    entries: Vec<(String, String, usize)>,
}

impl Entries {
    /// Reads one line of the header; `allowed` is for the message of an error.
    pub fn take(&mut self, number: usize, line: &str, allowed: &str) -> Result<(), SurfaceError> {
        let Some((key, value)) = line.split_once('=') else {
            return Err(refused(
                Place::Line(number),
                format!("{:?}", shown(line)),
                allowed,
            ));
        };
        self.entries.push((
            key.trim().to_ascii_lowercase(),
            value.trim().to_owned(),
            number,
        ));
        Ok(())
    }

    pub fn text(&self, key: &str) -> Option<(&str, Place)> {
        let found = self
            .entries
            .iter()
            .find(|(name, ..)| name.eq_ignore_ascii_case(key));
        found.map(|(_, value, line)| (value.as_str(), Place::Line(*line)))
    }

    pub fn number(&self, key: &str) -> Result<Option<f64>, SurfaceError> {
        let Some((value, place)) = self.text(key) else {
            return Ok(None);
        };
        match value.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(refused(
                place,
                format!("{key} = {}", shown(value)),
                "a number",
            )),
        }
    }

    /// Returns the positive integer of a key. The error for a missing key lists all `required`
    /// keys.
    pub fn count(&self, key: &str, required: &str) -> Result<usize, SurfaceError> {
        let Some((value, place)) = self.text(key) else {
            return Err(missing(key, required));
        };
        match value.parse::<f64>() {
            Ok(count) if count >= 1.0 && count < usize::MAX as f64 && count.fract() == 0.0 => {
                Ok(count as usize)
            }
            _ => Err(refused(
                place,
                format!("{key} = {}", shown(value)),
                "a whole number above 0",
            )),
        }
    }
}

fn missing(key: &str, required: &str) -> SurfaceError {
    refused(Place::File, format!("no {key} in the header"), required)
}

pub(super) const GSF: &[u8] = b"Gwyddion Simple Field 1.0\n";

/// Reads `key = value` lines up to a zero byte, then XRes × YRes numbers from the next multiple of
/// four bytes.
pub(super) fn read_gsf(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    let end = bytes.iter().position(|byte| *byte == 0).ok_or_else(|| {
        refused(
            Place::Byte(bytes.len()),
            "a header without an end",
            "a header that ends with a zero byte",
        )
    })?;
    let mut header = Entries::default();
    for (index, line) in String::from_utf8_lossy(&bytes[..end])
        .lines()
        .enumerate()
        .skip(1)
    {
        header.take(index + 1, line, "key = value")?;
    }
    let count = |key: &str| header.count(key, "XRes and YRes");
    let (columns, rows) = (count("xres")?, count("yres")?);
    let mut data = Bytes::new(bytes, Order::Little);
    data.take((end / 4 + 1) * 4)?;
    let heights = data.numbers(columns.saturating_mul(rows), Number::F32)?;
    let sizes = header.number("xreal")?.zip(header.number("yreal")?);
    let spacing = sizes.map(|(width, height)| [width / columns as f64, height / rows as f64]);
    let unit = |key: &str| {
        header
            .text(key)
            .map_or(Ok(None), |(value, place)| Unit::stated(value, place))
    };
    let units = [unit("xyunits")?, unit("xyunits")?, unit("zunits")?];
    Ok(Reading::even("GSF", heights, columns, spacing, units))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(bytes: &[u8]) -> Result<Vec<f64>, String> {
        let reading = read(bytes).map_err(|error| error.to_string())?;
        assert_eq!((reading.columns, reading.spacing), (3, Some([1.0, 2.0])));
        Ok(reading.heights)
    }

    fn text(version: &str, kind: &str, heights: &str) -> String {
        format!(
            "a{version}\nManufacID = x\nNumPoints = 3\nNumProfiles = 2\nXscale = 1\nYscale = 2\nZscale = 0.5\n\
             Compression = 0\nDataType = {kind}\n*\n{heights}\n*\n"
        )
    }

    fn binary(version: &str, kind: u8, heights: &[u8]) -> Vec<u8> {
        let count = |count: u8| {
            if version == "ISO-2.0" {
                vec![count, 0, 0, 0]
            } else {
                vec![count, 0]
            }
        };
        let scales = [1.0_f64, 2.0, 0.5, -1.0].map(f64::to_le_bytes).concat();
        let header = format!("b{version}{}", " ".repeat(34));
        [
            header.as_bytes(),
            &count(3),
            &count(2),
            &scales,
            &[0, kind, 0],
            heights,
        ]
        .concat()
    }

    #[test]
    fn versions_mark_missing_points_by_the_largest_or_by_the_smallest_height() {
        macro_rules! check {
            ($($kind:literal: $type:ty),*) => {$({
                let heights = [7 as $type, <$type>::MIN, <$type>::MAX, 8 as $type, 9 as $type, 10 as $type];
                let bytes: Vec<u8> = heights.iter().flat_map(|z| z.to_le_bytes()).collect();
                let words: Vec<String> = heights.iter().map(|z| z.to_string()).collect();
                for version in ["BCR-1.0", "ISO-1.0", "ISO-2.0"] {
                    let is_largest = version == "BCR-1.0" || <$type>::MIN as f64 == 0.0;
                    for content in [
                        text(version, stringify!($kind), &words.join(" ")).into_bytes(),
                        binary(version, $kind, &bytes),
                    ] {
                        let found = found(&content).unwrap();
                        let marked = (found[1].is_nan(), found[2].is_nan());
                        assert_eq!(marked, (!is_largest, is_largest), "{version} {}", $kind);
                        assert_eq!((found[0], found[5]), (3.5, 5.0));
                    }
                }
            })*};
        }
        check!(0: u8, 1: u16, 2: u32, 3: f32, 4: i8, 5: i16, 6: i32, 7: f64);
    }

    #[test]
    fn texts_of_programs_have_names_comments_marks_and_line_ends_of_their_own() {
        let plain = text("BCR-1.0", "5", "1 2 3\n4 5 32767");
        let expected = found(plain.as_bytes()).unwrap();
        assert!(expected[5].is_nan() && expected[..5] == [0.5, 1.0, 1.5, 2.0, 2.5]);
        for other in [
            plain.replacen('a', "A", 1),
            format!("\u{feff}{plain}"),
            plain.replace('\n', "\r"),
            plain.replace('\n', "\r\n"),
            plain.replace("= 5", "= Integer"),
            plain
                .replace("2 3", "2 3 ; first row")
                .replace("*\n1", "* ; heights\n1"),
        ] {
            let same = found(other.as_bytes()).unwrap();
            assert!(same[5].is_nan() && same[..5] == expected[..5], "{other:?}");
        }
    }

    #[test]
    fn what_is_not_read_has_a_place() {
        let checked = binary("ISO-1.0", 7, &[0; 48]);
        for (content, expected) in [
            (
                text("ISO-3.0", "5", ""),
                "byte 1: version \"ISO-3.0\" of SDF; allowed: BCR-1.0, ISO-1.0 and ISO-2.0",
            ),
            (
                text("BCR-1.0", "FLOATING", ""),
                "line 9: DataType = FLOATING; allowed: from 0 to 7",
            ),
        ] {
            assert_eq!(found(content.as_bytes()).unwrap_err(), expected);
        }
        let flags = checked.len() - 48 - 3;
        let with_check = [&checked[..flags + 2], &[1], &checked[flags + 3..]].concat();
        let error = found(&with_check).unwrap_err();
        assert_eq!(
            error,
            format!("byte {flags}: a check sum behind each row; allowed: CheckType = 0")
        );
        let huge = [&checked[..42], &[255; 4], &checked[46..]].concat();
        assert!(
            found(&huge).unwrap_err().contains("at least"),
            "{:?}",
            found(&huge)
        );
    }
}
