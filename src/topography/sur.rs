//! Digital Surf SUR: a header of 512 bytes, comments, and integers, plain or compressed.

use super::Unit;
use super::bytes::{Bytes, Number, Order, most_expanded};
use super::error::{Place, TopographyError, refused};
use super::reading::{Format, RawGrid, Reading};
use crate::io::read_limited;
use encoding_rs::WINDOWS_1252;
use flate2::read::ZlibDecoder;

/// Distance of the mark of missing points below the smallest height.
const MISSING_BELOW: f64 = 2.0;

/// Most compressed parts: each takes some microseconds, also for a single byte.
const MOST_PARTS: usize = 1 << 16;

pub(super) fn read(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let mut data = Bytes::new(bytes, Order::Little);
    let is_compressed = data.take(12)? == b"DSCOMPRESSED";
    let [order, _objects, _version, study] = data.array(Number::U16)?;
    if order != 0.0 {
        return Err(refused(Place::Byte(12), "numbers in the order of Motorola", "the order of a PC"));
    }
    if ![1.0, 2.0].contains(&study) {
        let fault = format!("a study of type {study}");
        return Err(refused(Place::Byte(18), fault, "1, a profile, or 2, a map"));
    }
    // Names, material, acquisition, range.
    data.take(30 + 30 + 6)?;
    let has_missing = data.size(Number::U16)? == 1;
    // Absolute heights, gauge resolution, reserved.
    data.take(2 + 4 + 4)?;
    let number = match data.size(Number::U16)? {
        16 => Number::I16,
        32 => Number::I32,
        bits => return Err(refused(Place::Byte(98), format!("heights of {bits} bits"), "16 or 32")),
    };
    let [lowest, _highest] = data.array(Number::I32)?;
    let (columns, rows) = (count(&mut data)?, count(&mut data)?);
    let points = columns.saturating_mul(rows);
    data.take(4)?;
    let [along, between, scale] = data.array(Number::F32)?;
    // Names of the axes.
    data.take(3 * 16)?;
    let mut unit = || {
        let place = data.place();
        unit_of(data.take(16)?, place)
    };
    let (unit_along, unit_between, height_unit) = (unit()?, unit()?, unit()?);
    // Units of axes and ratios of units, imprint; further on times.
    data.take(3 * 16 + 3 * 4 + 2)?;
    let is_inverted = data.size(Number::U16)? != 0;
    data.take(334 - 292)?;
    let (comment, private) = (data.size(Number::U16)?, data.size(Number::U16)?);
    data.take(512 - 338 + comment + private)?;
    let mut heights = if is_compressed {
        Bytes::new(&expand(&mut data, points, number)?, Order::Little).numbers(points, number)?
    } else {
        data.numbers(points, number)?
    };
    let scale = if is_inverted { -scale } else { scale };
    for height in &mut heights {
        let is_missing = has_missing && *height == lowest - MISSING_BELOW;
        *height = if is_missing { f64::NAN } else { *height * scale };
    }
    // Distances in the unit of the rows; another unit between rows is rare, and converted.
    let units = unit_along.zip(unit_between);
    let between_factor = units.map_or(1.0, |(along, between)| between.to_metres(1.0) / along.to_metres(1.0));
    let grid = RawGrid::of(columns, rows, Some([along, between * between_factor]));
    Ok(Reading::new(Format::Sur, heights, grid, [unit_along, height_unit]))
}

fn count(data: &mut Bytes<'_>) -> Result<usize, TopographyError> {
    let place = data.place();
    match data.number(Number::I32)? {
        count if count > 0.0 => Ok(count as usize),
        count => Err(refused(place, format!("{count} points along an axis"), "above 0")),
    }
}

/// Returns the unit in a field padded with spaces or zeros. Old files write µ in an MS-DOS code page, read as æ in
/// Windows-1252.
fn unit_of(field: &[u8], place: Place) -> Result<Option<Unit>, TopographyError> {
    let field = field.split(|byte| *byte == 0).next().unwrap_or_default();
    let text = match str::from_utf8(field) {
        Ok(text) => text.into(),
        Err(_) => WINDOWS_1252.decode_without_bom_handling(field).0,
    };
    Unit::stated(if text.trim() == "æm" { "µm" } else { text.trim() }, place)
}

/// Decompresses heights: a table of the sizes of the parts before and after, then the parts.
fn expand(data: &mut Bytes<'_>, points: usize, number: Number) -> Result<Vec<u8>, TopographyError> {
    let expected = points.saturating_mul(number.size());
    let most = most_expanded(data.left());
    let place = data.place();
    if expected > most {
        let fault = format!("{expected} bytes of heights");
        return Err(refused(place, fault, format!("at most 32 times the compressed size and 1 MiB, {most}")));
    }
    let parts = data.size(Number::U32)?;
    if parts > MOST_PARTS {
        return Err(refused(place, format!("{parts} compressed parts"), format!("at most {MOST_PARTS}")));
    }
    let mut sizes = data.part(8 * parts)?;
    let mut content = Vec::new();
    for _ in 0..parts {
        let (plain, packed) = (sizes.size(Number::U32)?, sizes.size(Number::U32)?);
        let place = data.place();
        if content.len() + plain > expected {
            return Err(refused(place, "more heights than points", format!("{expected} bytes in all")));
        }
        let part = read_limited(ZlibDecoder::new(data.take(packed)?), plain).map_err(|error| {
            refused(place.clone(), format!("a compressed part: {error}"), format!("{plain} bytes of zlib"))
        })?;
        if part.len() != plain {
            return Err(refused(place, format!("a part of {} bytes", part.len()), format!("{plain} bytes")));
        }
        content.extend(part);
    }
    Ok(content)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::ZlibEncoder;
    use std::io::Write;

    /// A file of 3 × 2 heights, 16 bits each.
    fn file(compressed: bool) -> Vec<u8> {
        let mut bytes = if compressed { b"DSCOMPRESSED".to_vec() } else { b"DIGITAL SURF".to_vec() };
        bytes.resize(512, 0);
        let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
        put(18, &2_u16.to_le_bytes());
        put(86, &1_u16.to_le_bytes());
        put(98, &16_u16.to_le_bytes());
        put(100, &(-5_i32).to_le_bytes());
        put(104, &6_i32.to_le_bytes());
        put(108, &3_i32.to_le_bytes());
        put(112, &2_i32.to_le_bytes());
        put(116, &6_i32.to_le_bytes());
        put(120, &0.5_f32.to_le_bytes());
        put(124, &0.25_f32.to_le_bytes());
        put(128, &2.0_f32.to_le_bytes());
        put(180, b"\xe6m");
        put(196, "µm".as_bytes());
        put(212, b"nm              ");
        put(334, &4_u16.to_le_bytes());
        bytes.extend(b"note");
        let heights: Vec<u8> =
            [1_i16, 2, 3, -5, -7, 6].iter().flat_map(|height| height.to_le_bytes()).collect();
        if !compressed {
            bytes.extend(heights);
            return bytes;
        }
        let parts = heights.chunks(8).map(|part| {
            let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(part).unwrap();
            (part.len(), encoder.finish().unwrap())
        });
        let parts: Vec<_> = parts.collect();
        bytes.extend((parts.len() as u32).to_le_bytes());
        for (plain, packed) in &parts {
            bytes.extend((*plain as u32).to_le_bytes());
            bytes.extend((packed.len() as u32).to_le_bytes());
        }
        parts.into_iter().for_each(|(_, packed)| bytes.extend(packed));
        bytes
    }

    #[test]
    fn plain_and_compressed_files_are_the_same_surface() {
        for compressed in [false, true] {
            let reading = read(&file(compressed)).unwrap();
            assert_eq!(reading.grid, RawGrid::Map { columns: 3, spacing: Some([0.5, 0.25]) });
            assert_eq!(reading.heights[..4], [2.0, 4.0, 6.0, -10.0]);
            assert!(reading.heights[4].is_nan());
            assert_eq!(reading.lateral_unit.map(Unit::name), Some("µm"));
            assert_eq!(reading.height_unit.map(Unit::name), Some("nm"));
        }
    }

    #[test]
    fn faults_have_a_place() {
        let with = |at: usize, value: &[u8], compressed: bool| {
            let mut bytes = file(compressed);
            bytes[at..at + value.len()].copy_from_slice(value);
            read(&bytes).unwrap_err().to_string()
        };
        assert!(with(18, &[5], false).starts_with("byte 18: a study of type 5"));
        assert!(with(98, &[8], false).starts_with("byte 98: heights of 8 bits"));
        assert!(with(108, &[0], false).starts_with("byte 108: 0 points along an axis"));
        assert!(with(112, &[9], false).starts_with("byte 516: 12 bytes up to the end"));
        assert!(with(180, b"Volt", false).starts_with("byte 180: \"Volt\" is no unit of length"));
        assert!(with(111, &[9], true).contains("allowed: at most 32 times the compressed size"));
        assert_eq!(
            with(516, &[1, 0, 1, 0], true),
            "byte 516: 65537 compressed parts; allowed: at most 65536"
        );
        assert!(with(516, &[9, 9, 0, 0], true).starts_with("byte 520: "));
        let file = file(true);
        assert!(read(&file[..file.len() - 3]).is_err());
    }
}
