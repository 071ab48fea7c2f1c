//! The format SUR of Digital Surf: a header of 512 bytes, comments, and integer heights, plain or
//! compressed.

use super::Unit;
use super::bytes::{Bytes, Number, Order, decoded, unpacked_size};
use super::reading::Reading;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::read_limited;
use flate2::read::ZlibDecoder;

/// The mark of missing points is this much below the smallest height, in integer steps.
const MISSING_BELOW: f64 = 2.0;

/// Limit of the number of compressed parts: each takes some microseconds, even for a single byte.
const MOST_PARTS: usize = 1 << 16;

pub(super) fn read(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    let mut data = Bytes::new(bytes, Order::Little);
    let is_compressed = data.take(12)? == b"DSCOMPRESSED";
    let [order, _objects, _version, study] = data.array(Number::U16)?;
    if order != 0.0 {
        return Err(refused(
            Place::Byte(12),
            "numbers in the order of Motorola",
            "the order of a PC",
        ));
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
        bits => {
            return Err(refused(
                Place::Byte(98),
                format!("heights of {bits} bits"),
                "16 or 32",
            ));
        }
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
    let units = [unit()?, unit()?, unit()?];
    // Units of axes and ratios of units, imprint; further on times.
    data.take(3 * 16 + 3 * 4 + 2)?;
    let is_inverted = data.size(Number::U16)? != 0;
    data.take(334 - 292)?;
    let (comment, private) = (data.size(Number::U16)?, data.size(Number::U16)?);
    data.take(512 - 338 + comment + private)?;
    let heights = if is_compressed {
        Bytes::new(&expand(&mut data, points, number)?, Order::Little).numbers(points, number)?
    } else {
        data.numbers(points, number)?
    };
    let scale = if is_inverted { -scale } else { scale };
    let missing = has_missing.then_some(lowest - MISSING_BELOW);
    let reading = Reading::even("SUR", heights, columns, Some([along, between]), units);
    Ok(reading.scaled(|height| Some(height) == missing, scale))
}

fn count(data: &mut Bytes<'_>) -> Result<usize, SurfaceError> {
    let place = data.place();
    match data.number(Number::I32)? {
        count if count > 0.0 => Ok(count as usize),
        count => Err(refused(
            place,
            format!("{count} points along an axis"),
            "above 0",
        )),
    }
}

/// Returns the unit in a field padded with spaces or zeros. Old files write µ in an MS-DOS code
/// page, which in Windows-1252 reads as æ.
fn unit_of(field: &[u8], place: Place) -> Result<Option<Unit>, SurfaceError> {
    let field = field.split(|byte| *byte == 0).next().unwrap_or_default();
    let text = decoded(field);
    Unit::stated(
        if text.trim() == "æm" {
            "µm"
        } else {
            text.trim()
        },
        place,
    )
}

/// Decompresses heights: a table with the size of each part before and after compression, then the
/// parts.
fn expand(data: &mut Bytes<'_>, points: usize, number: Number) -> Result<Vec<u8>, SurfaceError> {
    let place = data.place();
    let expected = unpacked_size(points, number.size(), place.clone())?;
    let parts = data.size(Number::U32)?;
    if parts > MOST_PARTS {
        return Err(refused(
            place,
            format!("{parts} compressed parts"),
            format!("at most {MOST_PARTS}"),
        ));
    }
    let mut sizes = data.part(8 * parts)?;
    let mut content = Vec::new();
    for _ in 0..parts {
        let (plain, packed) = (sizes.size(Number::U32)?, sizes.size(Number::U32)?);
        let place = data.place();
        if content.len() + plain > expected {
            return Err(refused(
                place,
                "more heights than points",
                format!("{expected} bytes in all"),
            ));
        }
        let part = read_limited(ZlibDecoder::new(data.take(packed)?), plain).map_err(|error| {
            refused(
                place.clone(),
                format!("a compressed part: {error}"),
                format!("{plain} bytes of zlib"),
            )
        })?;
        if part.len() != plain {
            return Err(refused(
                place,
                format!("a part of {} bytes", part.len()),
                format!("{plain} bytes"),
            ));
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

    /// A map of flat heights in µm, 2 µm apart along the rows and 3 nm between them.
    fn flat(columns: u32, rows: u32) -> Vec<u8> {
        let mut header = vec![0; 512];
        let (columns_at, bits) = (columns.to_le_bytes(), 32_u32.to_le_bytes());
        for (place, bytes) in [
            (0, &b"DSCOMPRESSED"[..]),
            (18, &[2]),
            (98, &bits[..2]),
            (108, &columns_at),
            (112, &rows.to_le_bytes()),
            (120, &2_f32.to_le_bytes()),
            (124, &3_f32.to_le_bytes()),
            (128, &1_f32.to_le_bytes()),
            (180, b"um"),
            (196, b"nm"),
            (212, b"um"),
        ] {
            header[place..place + bytes.len()].copy_from_slice(bytes);
        }
        let heights = vec![0; 4 * (columns * rows) as usize];
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(&heights).unwrap();
        let packed = encoder.finish().unwrap();
        let table = [1, heights.len() as u32, packed.len() as u32]
            .map(u32::to_le_bytes)
            .concat();
        [header, table, packed].concat()
    }

    #[test]
    fn heights_may_be_compressed_to_any_size_that_the_header_states() {
        let bytes = flat(1000, 600);
        assert!(bytes.len() < 4000, "{}", bytes.len());
        let reading = read(&bytes).unwrap();
        assert_eq!((reading.heights.len(), reading.columns), (600_000, 1000));
        let between = reading.units[1].map(|unit| unit.to_metres(3.0));
        assert_eq!((reading.spacing, between), (Some([2.0, 3.0]), Some(3e-9)));
        let mut more = bytes;
        more[112..116].copy_from_slice(&601_u32.to_le_bytes());
        let error = read(&more).unwrap_err().to_string();
        assert!(
            error.contains("2400000 bytes up to the end; allowed: at least 2404000 bytes"),
            "{error}"
        );
    }

    #[test]
    fn heights_below_the_lowest_are_missing_where_the_header_says_so() {
        let mut bytes = flat(2, 2);
        bytes[100..104].copy_from_slice(&(MISSING_BELOW as i32).to_le_bytes());
        for (flag, is_missing) in [(0, false), (1, true)] {
            bytes[86] = flag;
            let heights = read(&bytes).unwrap().heights;
            assert!(
                heights
                    .iter()
                    .all(|height| height.is_finite() != is_missing),
                "{flag}: {heights:?}"
            );
        }
    }
}
