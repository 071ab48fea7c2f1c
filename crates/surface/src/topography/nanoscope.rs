//! The format of Nanoscope (Digital Instruments, Veeco, Bruker): a header of text in sections, then
//! the integer heights of each channel, from the lowest row up.

use super::Unit;
use super::bytes::{Bytes, Number, Order, decoded};
use super::reading::Reading;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{gathered, shown};

pub(super) const SIGNATURE: &[u8] = b"\\*File list";

/// Line that follows the header.
const END: &[u8] = b"\\*File list end";

/// Limits of the length of a header, bytes, and of the number of channels.
const LONGEST_HEADER: usize = 1 << 18;
const MOST_CHANNELS: usize = 256;

/// Words in the names of channels of heights; other lengths are deflections and amplitudes.
const HEIGHTS: [&str; 3] = ["height", "zsens", "topography"];

/// Height of a step of the 2¹⁶ of files without a unit of heights, in m over the number in
/// `Z magnify image`.
const PER_MAGNIFICATION: f64 = 1.0e-7;

/// Relative difference between the distances along and between rows from which on a message states
/// both.
const DIFFERENT: f64 = 0.01;

/// Reads the channel with this number, from 0. Without a number, reads the only channel of heights.
pub(super) fn read(bytes: &[u8], channel: Option<u32>) -> Result<Reading, SurfaceError> {
    let head = &bytes[..bytes.len().min(LONGEST_HEADER)];
    let end = head
        .windows(END.len())
        .position(|found| found.eq_ignore_ascii_case(END))
        .ok_or_else(|| {
            let allowed = format!(
                "\"{}\" in the first {LONGEST_HEADER} bytes",
                END.escape_ascii()
            );
            refused(Place::File, "a header without an end", allowed)
        })?;
    let header = decoded(&head[..end]);
    let sections: Vec<&str> = header.split("\n\\*").collect();
    let is_image = |section: &&&str| {
        let name = section
            .lines()
            .next()
            .unwrap_or_default()
            .trim()
            .to_ascii_lowercase();
        name.ends_with("image list")
            && !name.contains("force")
            && entry(section, "Data offset").is_some()
    };
    let images: Vec<&str> = sections
        .iter()
        .filter(is_image)
        .copied()
        .take(MOST_CHANNELS)
        .collect();
    let is_chosen = |index: usize| match channel {
        Some(number) => index == number as usize,
        None => {
            let name = title(images[index]).to_lowercase();
            unit_and_scale(images[index], &sections).is_some()
                && HEIGHTS.iter().any(|of| name.contains(of))
        }
    };
    let chosen: Vec<usize> = (0..images.len())
        .filter(|index| is_chosen(*index))
        .collect();
    let (fault, allowed) = match (&chosen[..], channel) {
        ([one], _) => return reading(bytes, images[*one], &sections, *one),
        ([], Some(number)) => (
            format!("no channel {number}"),
            "the number of a channel, from 0",
        ),
        ([], None) => (
            "no channel of heights".to_owned(),
            "a channel of heights, or --channel with the number of one",
        ),
        (several, _) => (
            format!("{} channels of heights", several.len()),
            "--channel with the number of one, in a scene roughness.channel",
        ),
    };
    let describe = |(number, image): (usize, &&str)| {
        let direction =
            entry(image, "Line direction").map(|name| format!(" {}", shown(name).to_lowercase()));
        format!(
            "{number} {:?}{}",
            shown(title(image)),
            direction.unwrap_or_default()
        )
    };
    let names: Vec<String> = images.iter().enumerate().take(8).map(describe).collect();
    Err(refused(
        Place::File,
        format!("{fault}; channels: {}", names.join(", ")),
        allowed,
    ))
}

/// Returns the value of the first line `\key: value` of a section. Before the key may be `@` and
/// the number of a group, as in `@2:Z scale`.
fn entry<'a>(section: &'a str, key: &str) -> Option<&'a str> {
    section.lines().find_map(|line| {
        let line = line.trim().strip_prefix('\\')?;
        let line = line.strip_prefix('@').map_or(line, |rest| {
            rest.split_once(':')
                .filter(|(group, _)| group.parse::<u8>().is_ok())
                .map_or(rest, |(_, rest)| rest)
        });
        let (name, value) = line.split_once(':')?;
        name.trim()
            .eq_ignore_ascii_case(key)
            .then_some(value.trim())
    })
}

/// Returns the name of the channel of a section: the text in quotation marks, or in brackets, of
/// `S [ZSensor] "Height Sensor"`.
fn title(image: &str) -> &str {
    let name = entry(image, "Image data").unwrap_or_default();
    let quoted = || name.split('"').nth(1).filter(|name| !name.is_empty());
    quoted().or(name.split(['[', ']']).nth(1)).unwrap_or(name)
}

/// Returns the name of the scale that converts a value, the value and its unit, as in
/// `V [Sens. Zsens] (0.005 V/LSB) 2.9 V`.
fn value(text: &str) -> Option<(Option<&str>, f64, &str)> {
    let mut rest = text.strip_prefix("V ").unwrap_or(text).trim();
    let mut scale = None;
    if let Some((name, after)) = rest.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
        (scale, rest) = (Some(name.trim()), after.trim());
    }
    if let Some((_, after)) = rest.strip_prefix('(').and_then(|rest| rest.split_once(')')) {
        rest = after.trim();
    }
    let mut words = rest.split_ascii_whitespace();
    let number = words
        .next()?
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite())?;
    Some((scale, number, words.next().unwrap_or_default()))
}

/// Returns the unit of length of the heights of a channel, and their range in this unit; `None` if
/// they are no lengths.
fn unit_and_scale(image: &str, sections: &[&str]) -> Option<(Unit, f64)> {
    let (scale, range, unit) = entry(image, "Z scale").and_then(value).unwrap_or_default();
    if let Some(unit) = length_unit(unit) {
        return Some((unit, range));
    }
    let Some(name) = scale else {
        let (_, magnification, _) = value(entry(image, "Z magnify image")?)?;
        return Some((Unit::METRE, PER_MAGNIFICATION * magnification));
    };
    let (_, sensitivity, unit_of) = sections
        .iter()
        .find_map(|section| value(entry(section, name)?))?;
    let (of_height, of_signal) = unit_of.split_once('/')?;
    let in_volts = |unit: &str| match unit {
        "V" => Some(1.0),
        "mV" => Some(1e-3),
        _ => None,
    };
    Some((
        length_unit(of_height)?,
        range * sensitivity * in_volts(unit)? / in_volts(of_signal)?,
    ))
}

/// Unit of length; µ is written as `~`.
fn length_unit(text: &str) -> Option<Unit> {
    text.replace('~', "µ").parse().ok()
}

fn reading(
    bytes: &[u8],
    image: &str,
    sections: &[&str],
    number: usize,
) -> Result<Reading, SurfaceError> {
    let wrong = |key: &str, allowed: &str| {
        let found = entry(image, key).unwrap_or_default();
        refused(
            Place::Part(format!("channel {number}")),
            format!("{key} = {:?}", shown(found)),
            allowed,
        )
    };
    let count = |key: &str| {
        let count =
            entry(image, key).and_then(|text| text.split_ascii_whitespace().next()?.parse().ok());
        count
            .filter(|count: &usize| *count > 0)
            .ok_or_else(|| wrong(key, "a whole number above 0"))
    };
    let (columns, rows) = (count("Samps/line")?, count("Number of lines")?);
    let (offset, length) = (count("Data offset")?, count("Data length")?);
    let points = columns.saturating_mul(rows);
    // Some versions state 2 bytes and store 4.
    let of_each = [2, 4]
        .into_iter()
        .find(|size| points.saturating_mul(*size) == length);
    let number = match of_each.map_or_else(|| count("Bytes/pixel"), Ok)? {
        2 => Number::I16,
        4 => Number::I32,
        _ => return Err(wrong("Bytes/pixel", "2 or 4")),
    };
    let (unit, range) = unit_and_scale(image, sections)
        .ok_or_else(|| wrong("Z scale", "a scale of heights in a unit of length"))?;
    let mut data = Bytes::new(bytes, Order::Little);
    data.take(offset)?;
    let heights = data.numbers(points, number)?;
    let heights = gathered(
        points,
        heights.chunks_exact(columns).rev().flatten().copied(),
    )?;
    let scan = entry(image, "Scan size")
        .or_else(|| sections.iter().find_map(|part| entry(part, "Scan size")));
    let words: Vec<&str> = scan.unwrap_or_default().split_ascii_whitespace().collect();
    let size = |text: &str| text.parse().ok().filter(|size: &f64| size.is_finite());
    let sizes = match words[..] {
        [width, unit] => size(width).map(|width| [width; 2]).zip(length_unit(unit)),
        [width, height, unit] => size(width)
            .zip(size(height))
            .map(|(x, y)| [x, y])
            .zip(length_unit(unit)),
        _ => None,
    };
    let ([width, mut height], lateral) =
        sizes.ok_or_else(|| wrong("Scan size", "width and height with a unit of length"))?;
    // A second size is that of a square, unless it differs.
    let aspect = || {
        let (along, between) = entry(image, "Aspect ratio")?.split_once(':')?;
        Some(size(along.trim())? / size(between.trim())?).filter(|ratio| *ratio > 0.0)
    };
    if height == width {
        height = width / aspect().unwrap_or(1.0);
    }
    let [along, between] = [width / columns as f64, height / rows as f64];
    let steps = 2.0_f64.powi(8 * number.size() as i32);
    let units = [Some(lateral), Some(lateral), Some(unit)];
    let mut reading = Reading::even("Nanoscope", heights, columns, Some([along, between]), units)
        .scaled(|_| false, range / steps);
    if rows > 1 && (along / between - 1.0).abs() > DIFFERENT {
        reading.warnings.push(format!(
            "points are {along:.4} {lateral} apart along rows and {between:.4} {lateral} between rows, by the size of the scan, \
             {width} × {height} {lateral}: a scan that was stopped early is smaller"
        ));
    }
    Ok(reading)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with the entries of a scan and of its images; each image has the integers of two rows
    /// of three points.
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
    type Found = (Vec<f64>, Option<[f64; 2]>, Vec<String>);

    fn heights(bytes: &[u8]) -> Result<Found, String> {
        let found = read(bytes, None).map_err(|error| error.to_string())?;
        let unit = found.units[2].unwrap_or(Unit::METRE);
        let rounded = |height: &f64| (unit.to_metres(*height) * 1e15).round() / 1e6;
        Ok((
            found.heights.iter().map(rounded).collect(),
            found.spacing,
            found.warnings,
        ))
    }

    #[test]
    fn heights_and_sizes_follow_from_the_scales_of_any_version() {
        // Heights in nm: 12.5 nm/V × 6.5536 V / 2¹⁶; the last row is the lowest.
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
            warnings[0].starts_with("points are 1.0000 µm apart along rows and 1.5000 µm between"),
            "{warnings:?}"
        );
        // Four bytes, though the header states two.
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
             allowed: --channel with the number of one, in a scene roughness.channel"
        );
        assert!(read(&both, Some(2)).is_ok());
        for (bytes, channel, expected) in [
            (&both[..], Some(3), "no channel 3; channels: 0 \"Height"),
            (
                &file(SCAN, &[&amplitude], &short()),
                None,
                "no channel of heights; channels: 0 \"Amplitude\" trace",
            ),
            (
                &file("", &[HEIGHT], &short()),
                Some(0),
                "channel 0: Z scale = \"V [Sens. Zsens]",
            ),
            (
                &file(SCAN, &[&HEIGHT.replace("~m", "V")], &short()),
                None,
                "channel 0: Scan size = \"3 2 V\"",
            ),
            (&both[..2080], Some(2), "byte "),
            (&both[..400], None, "a header without an end"),
        ] {
            let error = read(bytes, channel).unwrap_err().to_string();
            assert!(
                error.starts_with(expected) && error.contains("; allowed: "),
                "{error}"
            );
        }
    }
}
