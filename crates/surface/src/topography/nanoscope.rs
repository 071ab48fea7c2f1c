//! The format of Nanoscope (Digital Instruments, Veeco, Bruker). A file has a header of text in
//! sections, followed by the heights of each channel as integers, the lowest row first.

use super::bytes::{Bytes, Number, Order, decoded};
use super::channel::{self, Label, Wanted};
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::transpose::reverse_rows;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{Note, shown};
use std::borrow::Cow;

pub(super) const SIGNATURE: &[u8] = b"\\*File list";

/// First bytes of a Nanoscope file that was measured in a liquid at a controlled electrode
/// potential.
pub(super) const SIGNATURE_OF_ELECTROCHEMISTRY: &[u8] = b"\\*EC File list";

/// Last words of the header.
const END: &[u8] = b"File list end";

/// Largest allowed length of a header in bytes.
const LONGEST_HEADER: usize = 1 << 18;

const MOST_CHANNELS: usize = 256;

/// Conversion for files without a unit of heights: the range of the heights in m is this constant
/// times the number in `Z magnify image`.
const PER_MAGNIFICATION: f64 = 1.0e-7;

/// Relative difference between the distance along the rows and the distance between rows. If the
/// difference is larger, a message states both distances.
const DIFFERENT: f64 = 0.01;

/// Reads one channel of a Nanoscope file. Channels are numbered from 0. If `wanted` is neither a
/// number nor a name, reads the only channel of heights.
pub(super) fn read(bytes: &[u8], wanted: Wanted<'_>) -> Result<Reading, SurfaceError> {
    let header = header(bytes)?;
    let sections: Vec<&str> = header.split("\n\\*").collect();
    let images: Vec<Image> = sections
        .iter()
        .filter(|section| is_image(section))
        .take(MOST_CHANNELS)
        .zip(0..)
        .map(|(section, number)| Image {
            number,
            section,
            sections: &sections,
        })
        .collect();
    let labels: Vec<Label> = images.iter().map(Image::label).collect();
    let index = channel::chosen(&labels, "channel", wanted)?;
    images[index].reading(bytes)
}

/// Returns the text of the header, without its last line.
fn header(bytes: &[u8]) -> Result<Cow<'_, str>, SurfaceError> {
    let head = &bytes[..bytes.len().min(LONGEST_HEADER)];
    let end = head
        .windows(END.len())
        .position(|found| found.eq_ignore_ascii_case(END));
    match end {
        Some(end) => Ok(decoded(&head[..end])),
        None => {
            let allowed = format!("\"\\*File list end\" in the first {LONGEST_HEADER} bytes");
            Err(refused(Place::File, "a header without an end", allowed))
        }
    }
}

/// Returns true if a section of the header describes a channel.
fn is_image(section: &str) -> bool {
    let name = section.lines().next().unwrap_or_default();
    let name = name.trim().to_ascii_lowercase();
    name.ends_with("image list")
        && !name.contains("force")
        && entry(section, "Data offset").is_some()
}

/// Returns the value of the first line `\key: value` of a section. The key may follow `@` and the
/// number of a group, as in `@2:Z scale`.
fn entry<'a>(section: &'a str, key: &str) -> Option<&'a str> {
    section.lines().find_map(|line| {
        let line = line.trim().strip_prefix('\\')?;
        let (name, value) = without_group(line).split_once(':')?;
        let is_key = name.trim().eq_ignore_ascii_case(key);
        is_key.then_some(value.trim())
    })
}

/// Returns a line without `@` and the number of a group before its key.
fn without_group(line: &str) -> &str {
    let Some(rest) = line.strip_prefix('@') else {
        return line;
    };
    match rest.split_once(':') {
        Some((group, entry)) if group.parse::<u8>().is_ok() => entry,
        _ => rest,
    }
}

/// Returns the name of the channel that a section describes. In `S [ZSensor] "Height Sensor"` it is
/// the text in quotation marks or, if there is none, the text in brackets.
fn title(image: &str) -> &str {
    let name = entry(image, "Image data").unwrap_or_default();
    let quoted = name.split('"').nth(1).filter(|name| !name.is_empty());
    let in_brackets = name.split(['[', ']']).nth(1);
    quoted.or(in_brackets).unwrap_or(name)
}

/// A number with a unit in the header, as in `V [Sens. Zsens] (0.005 V/LSB) 2.9 V`.
#[derive(Default)]
struct Value<'a> {
    /// Name of the sensitivity that converts the number to a length, here `Sens. Zsens`.
    scale: Option<&'a str>,
    number: f64,
    unit: &'a str,
}

impl<'a> Value<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        let mut rest = text.strip_prefix("V ").unwrap_or(text).trim();
        let mut scale = None;
        if let Some((name, after)) = enclosed(rest, '[', ']') {
            scale = Some(name.trim());
            rest = after.trim();
        }
        if let Some((_, after)) = enclosed(rest, '(', ')') {
            rest = after.trim();
        }
        let mut words = rest.split_ascii_whitespace();
        let number: f64 = words.next()?.parse().ok()?;
        if !number.is_finite() {
            return None;
        }
        Some(Value {
            scale,
            number,
            unit: words.next().unwrap_or_default(),
        })
    }
}

/// Returns the text between two brackets at the beginning of `text`, and the text after the
/// brackets.
fn enclosed(text: &str, open: char, close: char) -> Option<(&str, &str)> {
    text.strip_prefix(open)?.split_once(close)
}

/// Returns the unit of length with this name, in which µ may be written as `~`.
fn length_unit(text: &str) -> Option<Unit> {
    text.replace('~', "µ").parse().ok()
}

/// Returns the value of an electric unit in V; `None` for another unit.
fn in_volts(unit: &str) -> Option<f64> {
    match unit {
        "V" => Some(1.0),
        "mV" => Some(1e-3),
        _ => None,
    }
}

/// Range of the heights of a channel: the difference between the heights of the largest and the
/// smallest integer.
struct HeightRange {
    unit: Unit,
    range: f64,
}

struct ScanSize {
    unit: Unit,
    width: f64,
    height: f64,
}

/// A channel of the file.
struct Image<'a> {
    number: u32,
    section: &'a str,
    /// All sections of the header, because scales of channels are in other sections.
    sections: &'a [&'a str],
}

impl Image<'_> {
    /// Returns the label of the channel. It counts as a channel of heights if its numbers are
    /// lengths and its name says that it contains heights.
    fn label(&self) -> Label {
        let name = title(self.section);
        Label {
            number: self.number,
            name: name.to_owned(),
            direction: entry(self.section, "Line direction").map(str::to_lowercase),
            has_heights: self.height_range().is_some() && channel::names_heights(name),
            ..Label::default()
        }
    }

    /// Returns the range of the heights; `None` if the numbers of the channel are not lengths.
    fn height_range(&self) -> Option<HeightRange> {
        let scale = entry(self.section, "Z scale").and_then(Value::parse);
        let scale = scale.unwrap_or_default();
        if let Some(unit) = length_unit(scale.unit) {
            return Some(HeightRange {
                unit,
                range: scale.number,
            });
        }
        let Some(name) = scale.scale else {
            let magnification = Value::parse(entry(self.section, "Z magnify image")?)?;
            return Some(HeightRange {
                unit: Unit::METRE,
                range: PER_MAGNIFICATION * magnification.number,
            });
        };
        let mut sections = self.sections.iter();
        let sensitivity = sections.find_map(|section| Value::parse(entry(section, name)?))?;
        // The unit of the sensitivity is a ratio, such as nm/V.
        let (unit_of_height, unit_of_signal) = sensitivity.unit.split_once('/')?;
        let range = scale.number * sensitivity.number;
        Some(HeightRange {
            unit: length_unit(unit_of_height)?,
            range: range * in_volts(scale.unit)? / in_volts(unit_of_signal)?,
        })
    }

    /// Reads the heights of the channel. The order of the rows is reversed, because the file begins
    /// with the lowest row.
    fn reading(&self, bytes: &[u8]) -> Result<Reading, SurfaceError> {
        let columns = self.count("Samps/line")?;
        let rows = self.count("Number of lines")?;
        let offset = self.count("Data offset")?;
        let length = self.count("Data length")?;
        let points = columns.saturating_mul(rows);
        let number = self.number_type(points, length)?;
        let Some(heights) = self.height_range() else {
            return Err(self.wrong("Z scale", "a scale of heights in a unit of length"));
        };
        let mut data = Bytes::new(bytes, Order::Little);
        data.take(offset)?;
        let mut numbers = data.numbers(points, number)?;
        reverse_rows(&mut numbers, columns);

        let size = self.scan_size()?;
        let along = size.width / columns as f64;
        let between = size.height / rows as f64;
        // The stated size is 0 for a scan of a single place, and for a scan whose settings are
        // lost.
        let has_size = along > 0.0 && between > 0.0;
        let steps = 2.0_f64.powi(8 * number.size() as i32);
        let units = StatedUnits::new(Some(size.unit), Some(heights.unit));
        let spacing = has_size.then_some([along, between]);
        let mut reading = Reading::even("Nanoscope", numbers, columns, spacing, units)
            .scaled(|_| false, heights.range / steps);
        if has_size && rows > 1 && (along / between - 1.0).abs() > DIFFERENT {
            let ScanSize {
                unit,
                width,
                height,
            } = size;
            let text = format!(
                "points are {along:.4} {unit} apart along rows and {between:.4} {unit} between \
                 rows, by the size of the scan, {width} × {height} {unit}: a scan that was \
                 stopped early is smaller"
            );
            reading.warnings.push(Note::new(text));
        }
        Ok(reading)
    }

    /// Returns the type of the integers if `points` points take `length` bytes.
    fn number_type(&self, points: usize, length: usize) -> Result<Number, SurfaceError> {
        // Some versions state that an integer has 2 bytes but store it in 4 bytes.
        let size_by_length = [2, 4]
            .into_iter()
            .find(|size| points.saturating_mul(*size) == length);
        let size = match size_by_length {
            Some(size) => size,
            None => self.count("Bytes/pixel")?,
        };
        match size {
            2 => Ok(Number::I16),
            4 => Ok(Number::I32),
            _ => Err(self.wrong("Bytes/pixel", "2 or 4")),
        }
    }

    fn scan_size(&self) -> Result<ScanSize, SurfaceError> {
        let stated = entry(self.section, "Scan size").or_else(|| {
            let mut sections = self.sections.iter();
            sections.find_map(|section| entry(section, "Scan size"))
        });
        let Some(mut size) = stated.and_then(ScanSize::parse) else {
            let allowed = "width and height with a unit of length";
            return Err(self.wrong("Scan size", allowed));
        };
        // If the file states only the width, or the width twice, the height follows from the aspect
        // ratio.
        if size.height == size.width || size.height == 0.0 {
            size.height = size.width / self.aspect_ratio().unwrap_or(1.0);
        }
        Ok(size)
    }

    fn aspect_ratio(&self) -> Option<f64> {
        let (along, between) = entry(self.section, "Aspect ratio")?.split_once(':')?;
        let ratio = finite(along.trim())? / finite(between.trim())?;
        (ratio > 0.0).then_some(ratio)
    }

    /// Returns the number in the line with this key. Returns an error unless it is a positive
    /// integer.
    fn count(&self, key: &str) -> Result<usize, SurfaceError> {
        let word = entry(self.section, key).and_then(|text| text.split_ascii_whitespace().next());
        match word.and_then(|word| word.parse().ok()) {
            Some(count) if count > 0 => Ok(count),
            _ => Err(self.wrong(key, "a whole number above 0")),
        }
    }

    fn wrong(&self, key: &str, allowed: &str) -> SurfaceError {
        let place = Place::Part(format!("channel {}", self.number));
        let value = entry(self.section, key).unwrap_or_default();
        let found = format!("{key} = {:?}", shown(value));
        refused(place, found, allowed)
    }
}

impl ScanSize {
    /// Parses one or two lengths with a unit, such as `500 250 nm`.
    fn parse(text: &str) -> Option<Self> {
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        let (width, height, unit) = match words[..] {
            [width, unit] => (width, width, unit),
            [width, height, unit] => (width, height, unit),
            _ => return None,
        };
        Some(ScanSize {
            unit: length_unit(unit)?,
            width: finite(width)?,
            height: finite(height)?,
        })
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::super::options::ReadOptions;
    use super::*;

    /// Returns a file whose header has the lines `scan` and, for each image, its lines. Each image
    /// has the integers of two rows of three points.
    fn file(scan: &str, images: &[&str], numbers: &[u8]) -> Vec<u8> {
        let mut header = format!("\\*File list\r\n\\Version: 0x07200000\r\n{scan}");
        for (index, image) in images.iter().enumerate() {
            let offset = 2048 + index * numbers.len();
            header += &format!(
                "\\*Ciao image list\r\n\\Data offset: {offset}\r\n\\Data length: {}\r\n",
                numbers.len()
            );
            header += &format!("\\Samps/line: 3\r\n\\Number of lines: 2\r\n{image}");
        }
        let mut bytes = (header + "\\*File list end\r\n\x1a").into_bytes();
        bytes.resize(2048, 0);
        images.iter().for_each(|_| bytes.extend(numbers));
        bytes
    }

    const SCAN: &str = "\\*Scanner list\r\n\\@Sens. Zsens: V 12.5 nm/V\r\n\\*Ciao scan list\r\n\\@Sens. Amp: V 60.0 nm/V\r\n";
    const HEIGHT: &str = "\\Scan Size: 3 2 ~m\r\n\\Bytes/pixel: 2\r\n\\Line Direction: Trace\r\n\
                          \\@2:Image Data: S [ZSensor] \"Height Sensor\"\r\n\\@2:Z scale: V [Sens. Zsens] (0.005 V/LSB) 6.5536 V\r\n";
    const NUMBERS: [i16; 6] = [1, 2, 3, -4, 5, 6];

    fn short() -> Vec<u8> {
        NUMBERS
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect()
    }

    /// Heights in nm, distances and warnings.
    type Found = (Vec<f64>, Option<[f64; 2]>, Vec<Note>);

    fn heights(bytes: &[u8]) -> Result<Found, String> {
        let found = read(bytes, Wanted::Heights).map_err(|error| error.to_string())?;
        let unit = found.units.heights.unwrap_or(Unit::METRE);
        let rounded = |height: &f64| (unit.to_metres(*height) * 1e15).round() / 1e6;
        Ok((
            found.heights.iter().map(rounded).collect(),
            found.spacing,
            found.warnings,
        ))
    }

    #[test]
    fn heights_and_sizes_follow_from_the_scales_of_any_version() {
        // Heights in nm: a number times 12.5 nm/V × 6.5536 V / 2¹⁶. The last row in the file is the
        // upper row of the map.
        let steps = |step: f64| {
            [-4.0, 5.0, 6.0, 1.0, 2.0, 3.0]
                .map(|number: f64| (number * step * 1e6).round() / 1e6)
                .to_vec()
        };
        let with = |from: &str, to: &str| file(SCAN, &[&HEIGHT.replace(from, to)], &short());
        let square = Some([1.0, 1.0]);
        for (bytes, step, spacing) in [
            (with("", ""), 1.25e-3, square),
            (
                with("3 2 ~m", "3 3 µm\r\n\\Aspect Ratio: 3:2"),
                1.25e-3,
                square,
            ),
            (with("6.5536 V", "6553.6 mV"), 1.25e-3, square),
            (
                with(
                    "V [Sens. Zsens] (0.005 V/LSB) 6.5536 V",
                    "V (1 nm/LSB) 65.536 nm",
                ),
                1e-3,
                square,
            ),
            (
                with(
                    "@2:Z scale: V [Sens. Zsens] (0.005 V/LSB) 6.5536 V",
                    "Z scale: 65.536 nm (65536)",
                ),
                1e-3,
                square,
            ),
            (
                with(
                    "@2:Z scale: V [Sens. Zsens] (0.005 V/LSB) 6.5536 V",
                    "Z magnify image: 65.536",
                ),
                0.1,
                square,
            ),
        ] {
            let (found, distances, warnings) = heights(&bytes).unwrap();
            assert_eq!((found, distances, warnings), (steps(step), spacing, vec![]));
        }
        let (_, distances, warnings) = heights(&with("3 2 ~m", "3 ~m")).unwrap();
        assert_eq!(distances, Some([1.0, 1.5]));
        assert!(
            warnings[0]
                .to_string()
                .starts_with("points are 1.0000 µm apart along rows and 1.5000 µm between"),
            "{warnings:?}"
        );
        // Each height has four bytes, although the header states two.
        let long: Vec<u8> = NUMBERS
            .iter()
            .flat_map(|number| (i32::from(*number) << 16).to_le_bytes())
            .collect();
        assert_eq!(
            heights(&file(SCAN, &[HEIGHT], &long)).unwrap().0,
            steps(1.25e-3)
        );
    }

    #[test]
    fn scans_in_liquid_and_without_a_size_are_read() {
        let plain = file(SCAN, &[HEIGHT], &short());
        let head = plain.strip_prefix(SIGNATURE).unwrap();
        let mut in_liquid = [SIGNATURE_OF_ELECTROCHEMISTRY, head].concat();
        // Three bytes are removed elsewhere in the header, so that the heights keep their offset.
        in_liquid.drain(1_000..1_003);
        assert_eq!(heights(&in_liquid), heights(&plain));

        let no_size = file(SCAN, &[&HEIGHT.replace("3 2 ~m", "0 0 ~m")], &short());
        let found = heights(&no_size).unwrap();
        assert_eq!((&found.0, found.1), (&heights(&plain).unwrap().0, None));
        let read = |spacing: Option<f64>| {
            let options = ReadOptions {
                spacing,
                ..ReadOptions::default()
            };
            let surface = read(&no_size, Wanted::Heights).unwrap().resolve(&options);
            let spacing = surface.map(|surface| surface.spacing().unwrap());
            spacing.map_err(|error| error.to_string())
        };
        assert_eq!(read(Some(5e-8)), Ok([5e-8; 2]));
        let error = read(None).unwrap_err();
        assert!(
            error
                .contains("without a distance between points; allowed: a distance beside the file"),
            "{error}"
        );
    }

    #[test]
    fn channels_are_chosen_by_number_or_as_the_only_heights() {
        let retrace = HEIGHT.replace("Trace", "Retrace");
        let amplitude = HEIGHT
            .replace("Zsens]", "Amp]")
            .replace("[ZSensor] \"Height Sensor\"", "[Amplitude] \"\"");
        assert!(heights(&file(SCAN, &[&amplitude, HEIGHT], &short())).is_ok());
        let both = file(SCAN, &[HEIGHT, &retrace, &amplitude], &short());
        assert_eq!(
            heights(&both).unwrap_err(),
            "2 channels of heights; channels: 0 \"Height Sensor\" trace, 1 \"Height Sensor\" retrace, 2 \"Amplitude\" trace; \
             allowed: the number or the name of one"
        );
        assert!(read(&both, Wanted::Number(2)).is_ok());
        for (name, index) in [("retrace", 1), ("height sensor TRACE", 0), ("Amplitude", 2)] {
            let found = read(&both, Wanted::Name(name)).unwrap();
            assert_eq!(found, read(&both, Wanted::Number(index)).unwrap(), "{name}");
        }
        for (bytes, channel, expected) in [
            (
                &both[..],
                Wanted::Number(3),
                "no channel 3; channels: 0 \"Height",
            ),
            (
                &file(SCAN, &[&amplitude], &short()),
                Wanted::Heights,
                "no channel of heights; channels: 0 \"Amplitude\" trace",
            ),
            (
                &file("", &[HEIGHT], &short()),
                Wanted::Number(0),
                "channel 0: Z scale = \"V [Sens. Zsens]",
            ),
            (
                &file(SCAN, &[&HEIGHT.replace("~m", "V")], &short()),
                Wanted::Heights,
                "channel 0: Scan size = \"3 2 V\"",
            ),
            (&both[..2080], Wanted::Number(2), "byte "),
            (&both[..400], Wanted::Heights, "a header without an end"),
        ] {
            let error = read(bytes, channel).unwrap_err().to_string();
            assert!(
                error.starts_with(expected) && error.contains("; allowed: "),
                "{error}"
            );
        }
    }
}
