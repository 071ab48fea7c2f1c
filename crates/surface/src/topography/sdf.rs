//! The format SDF of ISO 25178-71 and its predecessor BCR. A file is text or binary, with heights
//! as integers or real numbers, and with scales in m.

use super::bytes::{Bytes, Number, Order};
use super::key_values::{KeyValues, missing};
use super::reading::Reading;
use super::stated_units::StatedUnits;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::shown;
use std::ops::RangeInclusive;

/// A type of numbers that a file may use for heights.
#[derive(Clone, Copy)]
struct HeightType {
    name_in_bcr: &'static str,
    number: Number,
    /// Smallest value of the type. For real numbers, the smallest and the largest value are rounded
    /// to the few digits that texts contain.
    smallest: f64,
    largest: f64,
}

const fn height_type(
    name_in_bcr: &'static str,
    number: Number,
    smallest: f64,
    largest: f64,
) -> HeightType {
    HeightType {
        name_in_bcr,
        number,
        smallest,
        largest,
    }
}

/// Types of heights. The index in this list is the number of the type in the header.
const TYPES: [HeightType; 8] = [
    height_type("UCHAR", Number::U8, 0.0, 255.0),
    height_type("UINTEGER", Number::U16, 0.0, 65_535.0),
    height_type("ULONGINT", Number::U32, 0.0, 4_294_967_295.0),
    height_type("FLOAT", Number::F32, -3.4e38, 3.4e38),
    height_type("CHAR", Number::I8, -128.0, 127.0),
    height_type("INTEGER", Number::I16, -32_768.0, 32_767.0),
    height_type("LONGINT", Number::I32, -2_147_483_648.0, 2_147_483_647.0),
    height_type("DOUBLE", Number::F64, -1.7e308, 1.7e308),
];

/// Keys that a file in text form must contain, for error messages.
const REQUIRED: &str = "NumPoints, NumProfiles, Xscale, Yscale, Zscale";

/// Byte order mark that some programs write before a text.
const UTF_8_MARK: &[u8] = b"\xef\xbb\xbf";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Version {
    /// BCR, the predecessor of the standard, proposed in 1993.
    Bcr,
    /// ISO 25178-71 and its draft.
    Iso1,
    /// ISO 25178-71 from 2017 on, which has 32-bit numbers of points and so allows larger maps.
    Iso2,
}

/// Largest number of letters in the name of the institute with which the name of a version begins,
/// such as `NIST` in `aNIST-1.0`, where `a` means a text file.
const LONGEST_NAME: usize = 8;

/// Returns true if `bytes` begin like SDF: with `a` for text or `b` for binary, and the name of a
/// version.
pub(super) fn is_sdf(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(UTF_8_MARK).unwrap_or(bytes);
    let [form, version @ ..] = bytes else {
        return false;
    };
    let is_known = version.starts_with(b"ISO-") || version.starts_with(b"BCR-");
    b"aAbB".contains(form) && (is_known || is_of_institute(version))
}

/// Returns true for the name of an institute and a version, such as `NIST-1.0` or `NPL-V1.0`. Files
/// of these institutes have the version BCR, but begin with the name of the institute.
fn is_of_institute(version: &[u8]) -> bool {
    let head = &version[..version.len().min(LONGEST_NAME + 1)];
    let Some(letters) = head.iter().position(|byte| *byte == b'-') else {
        return false;
    };
    let number = &version[letters + 1..];
    let number = number.strip_prefix(b"V").unwrap_or(number);
    let is_number = match number {
        [before, b'.', after, end @ ..] => {
            let ends = end.first().is_none_or(|byte| !byte.is_ascii_alphanumeric());
            before.is_ascii_digit() && after.is_ascii_digit() && ends
        }
        _ => false,
    };
    letters >= 2 && head[..letters].iter().all(u8::is_ascii_uppercase) && is_number
}

/// Reads a file of any version, in text or binary form.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    let bytes = bytes.strip_prefix(UTF_8_MARK).unwrap_or(bytes);
    let version = version(bytes.get(1..).unwrap_or_default())?;
    if bytes[0].eq_ignore_ascii_case(&b'a') {
        read_text(bytes, version)
    } else {
        read_binary(bytes, version)
    }
}

/// Returns the version whose name follows the first letter of a file.
fn version(name: &[u8]) -> Result<Version, SurfaceError> {
    let is_known = name.starts_with(b"ISO-") || name.starts_with(b"BCR-");
    match name.get(..7) {
        Some(b"BCR-1.0") => Ok(Version::Bcr),
        Some(b"ISO-1.0") => Ok(Version::Iso1),
        Some(b"ISO-2.0") => Ok(Version::Iso2),
        _ if !is_known && is_of_institute(name) => Ok(Version::Bcr),
        _ => {
            let name = String::from_utf8_lossy(&name[..name.len().min(7)]);
            let found = format!("version {:?} of SDF", shown(&name));
            let allowed = "BCR-1.0, ISO-1.0 and ISO-2.0, and versions of institutes, as NIST-1.0";
            Err(refused(Place::Byte(1), found, allowed))
        }
    }
}

/// Size of a map, distances between its points, and scale of its heights.
struct Layout {
    columns: usize,
    rows: usize,
    /// Distances in m between points along and between rows.
    spacing: [f64; 2],
    /// Height in m to which a number 1 in the file corresponds.
    unit: f64,
}

impl Layout {
    fn reading(&self, heights: Vec<f64>, missing: &RangeInclusive<f64>) -> Reading {
        let spacing = Some(self.spacing);
        let units = StatedUnits::METRES;
        let reading = Reading::even("SDF", heights, self.columns, spacing, units);
        reading.scaled(|height| missing.contains(&height), self.unit)
    }

    fn points(&self) -> usize {
        self.columns.saturating_mul(self.rows)
    }
}

/// Returns the type of heights that has this number (in SDF) or this name (in BCR).
fn height_type_named(name: &str, place: Place) -> Result<HeightType, SurfaceError> {
    for (number, kind) in TYPES.into_iter().enumerate() {
        if name == number.to_string() || name.eq_ignore_ascii_case(kind.name_in_bcr) {
            return Ok(kind);
        }
    }
    let found = format!("DataType = {}", shown(name));
    Err(refused(place, found, "from 0 to 7"))
}

impl HeightType {
    /// Returns the range of heights that mark missing points. In ISO the mark is the smallest value
    /// of the type. In BCR, and for types without negative values, it is the largest value.
    fn missing(&self, version: Version) -> RangeInclusive<f64> {
        // A text may round the largest or the smallest real number beyond its exact value. Any
        // number beyond the limit is therefore a mark too.
        let is_real = matches!(self.number, Number::F32 | Number::F64);
        let reach = if is_real { f64::INFINITY } else { 0.0 };
        if version == Version::Bcr || self.smallest == 0.0 {
            self.largest..=self.largest + reach
        } else {
            self.smallest - reach..=self.smallest
        }
    }
}

/// A line of a text, without the comment at its end.
struct Line<'a> {
    number: usize,
    text: &'a str,
}

/// Reads the text form. It has a header of lines `key = value`, then `*`, heights separated by
/// white space, and `*`. Comments follow after semicolons.
fn read_text(bytes: &[u8], version: Version) -> Result<Reading, SurfaceError> {
    let text = String::from_utf8_lossy(bytes);
    let line_end = if text.contains('\n') { '\n' } else { '\r' };
    let mut lines = text.split(line_end).enumerate().map(|(index, line)| Line {
        number: index + 1,
        text: line.split(';').next().unwrap_or_default().trim(),
    });
    let entries = entries(&mut lines)?;
    let spacing = [scale(&entries, "Xscale")?, scale(&entries, "Yscale")?];
    let unit = scale(&entries, "Zscale")?;
    let layout = Layout {
        columns: entries.count("NumPoints", REQUIRED)?,
        rows: entries.count("NumProfiles", REQUIRED)?,
        spacing,
        unit,
    };
    let missing = match entries.value("DataType") {
        Some(value) => height_type_named(value.text, value.place)?.missing(version),
        // If the header states no type of heights, only the word BAD marks a missing point. This
        // range contains no height, because no height is infinite.
        None => f64::INFINITY..=f64::INFINITY,
    };
    let heights = heights(lines, layout.points(), &missing)?;
    let mut reading = layout.reading(heights.values, &missing);
    reading.first_missing = heights.first_missing;
    Ok(reading)
}

fn scale(entries: &KeyValues, key: &str) -> Result<f64, SurfaceError> {
    let scale = entries.number(key)?;
    scale.ok_or_else(|| missing(key, REQUIRED))
}

/// Reads the header, which goes from the second line to the line `*`.
fn entries<'a>(lines: &mut impl Iterator<Item = Line<'a>>) -> Result<KeyValues, SurfaceError> {
    let mut entries = KeyValues::default();
    for line in lines.skip(1) {
        match line.text {
            "*" => return Ok(entries),
            "" => {}
            text => entries.take(line.number, text, "key = value, or * before the heights")?,
        }
    }
    let allowed = "a line with * before the heights";
    Err(refused(Place::File, "a header without an end", allowed))
}

/// Heights of the text form, not yet multiplied by the scale in the header.
struct TextHeights {
    values: Vec<f64>,
    first_missing: Option<Place>,
}

/// Reads the heights up to the line `*`. Returns an error unless there are exactly `points`
/// heights.
fn heights<'a>(
    lines: impl Iterator<Item = Line<'a>>,
    points: usize,
    missing: &RangeInclusive<f64>,
) -> Result<TextHeights, SurfaceError> {
    const ALLOWED: &str = "NumPoints times NumProfiles";
    let mut values = Vec::new();
    let mut first_missing = None;
    let mut last = 0;
    for line in lines.take_while(|line| line.text != "*") {
        last = line.number;
        for word in line.text.split_ascii_whitespace() {
            let place = Place::Line(line.number);
            let height = match word.parse::<f64>() {
                Ok(height) => height,
                Err(_) if word.eq_ignore_ascii_case("BAD") => f64::NAN,
                Err(_) => {
                    let found = format!("{:?}", shown(word));
                    return Err(refused(place, found, "a number or BAD"));
                }
            };
            if values.len() == points {
                let found = format!("more than {points} heights");
                return Err(refused(place, found, ALLOWED));
            }
            if !height.is_finite() || missing.contains(&height) {
                first_missing.get_or_insert(place);
            }
            values.push(height);
        }
    }
    if values.len() < points {
        let found = format!("{} of {points} heights up to the end", values.len());
        return Err(refused(Place::Line(last), found, ALLOWED));
    }
    Ok(TextHeights {
        values,
        first_missing,
    })
}

/// Reads the binary form, in which the lowest byte of each number comes first.
fn read_binary(bytes: &[u8], version: Version) -> Result<Reading, SurfaceError> {
    let mut data = Bytes::new(bytes, Order::Little);
    // These are the fields of the version, the manufacturer and two dates, which are not needed.
    data.take(8 + 10 + 12 + 12)?;
    let count = if version == Version::Iso2 {
        Number::U32
    } else {
        Number::U16
    };
    let columns = data.size(count)?;
    let rows = data.size(count)?;
    let [along, between, unit, _resolution] = data.array(Number::F64)?;
    let place = data.place();
    let [compression, kind, check] = data.array(Number::U8)?;
    if compression != 0.0 {
        return Err(refused(place, "compressed heights", "Compression = 0"));
    }
    if check != 0.0 {
        let found = "a check sum behind each row";
        return Err(refused(place, found, "CheckType = 0"));
    }
    let kind = height_type_named(&kind.to_string(), place)?;
    let layout = Layout {
        columns,
        rows,
        spacing: [along, between],
        unit,
    };
    let heights = data.numbers(layout.points(), kind.number)?;
    Ok(layout.reading(heights, &kind.missing(version)))
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
    fn institutes_write_the_version_of_bcr_under_their_names() {
        let expected = found(text("BCR-1.0", "5", "1 2 3\n4 5 6").as_bytes()).unwrap();
        for name in ["NIST-1.0", "NPL-V1.0", "BC-1.0"] {
            let content = text(name, "5", "1 2 3\n4 5 6");
            assert!(is_sdf(content.as_bytes()), "{name}");
            assert_eq!(found(content.as_bytes()), Ok(expected.clone()), "{name}");
        }
        let heights = [1_i16, 2, 3, 4, 5, 6].map(i16::to_le_bytes).concat();
        // The field of the version has 8 bytes. A shorter name is padded to this size.
        for name in ["NPL-1.0", "BC-1.0 "] {
            let content = binary(name, 5, &heights);
            assert!(is_sdf(&content), "{name}");
            assert_eq!(found(&content), Ok(expected.clone()), "{name}");
        }
        for other in [
            "a",
            "aB",
            "aSCAN-12",
            "absolute-1.0",
            "aNIST-1.00",
            "a-1.0",
            "aLONGNAMES-1.0",
        ] {
            assert!(!is_sdf(other.as_bytes()), "{other}");
        }
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
                "byte 1: version \"ISO-3.0\" of SDF; allowed: BCR-1.0, ISO-1.0 and ISO-2.0, and versions of institutes, as NIST-1.0",
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
