//! The format SUR of Digital Surf. A file has a header of 512 bytes, a comment, a private part, and
//! heights as integers, which may be compressed.

use super::bytes::{Bytes, Number, Order, decoded, unpacked_size};
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::read_limited;
use flate2::read::ZlibDecoder;

/// First bytes of a file with heights that are not compressed.
pub(super) const PLAIN: &[u8] = b"DIGITAL SURF";

/// First bytes of a file with compressed heights.
pub(super) const COMPRESSED: &[u8] = b"DSCOMPRESSED";

/// Size of the header in bytes. The comment and the private part follow after it.
const HEADER: usize = 512;

/// The number that marks missing points is below the smallest height by this number of integer
/// steps.
const MISSING_BELOW: f64 = 2.0;

/// Largest allowed number of compressed parts. It limits the computing time, because decompressing
/// a part takes some microseconds, even if the part has a single byte.
const MOST_PARTS: usize = 1 << 16;

pub(super) fn read(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    let mut data = Bytes::new(bytes, Order::Little);
    let is_compressed = data.take(COMPRESSED.len())? == COMPRESSED;
    let header = Header::read(&mut data)?;
    let points = header.columns.saturating_mul(header.rows);
    let heights = if is_compressed {
        let content = expand(&mut data, points, header.number)?;
        Bytes::new(&content, Order::Little).numbers(points, header.number)?
    } else {
        data.numbers(points, header.number)?
    };
    let spacing = Some(header.spacing);
    let reading = Reading::even("SUR", heights, header.columns, spacing, header.units);
    Ok(reading.scaled(|height| Some(height) == header.missing, header.scale))
}

/// What the header states about the heights.
struct Header {
    columns: usize,
    rows: usize,
    /// Type of the heights.
    number: Number,
    /// Number that marks a missing point; `None` if no points are missing.
    missing: Option<f64>,
    /// Height of one integer step, in the unit of the heights that the header states.
    scale: f64,
    spacing: [f64; 2],
    units: StatedUnits,
}

impl Header {
    /// Reads the header after the signature. Then skips the comment and the private part.
    fn read(data: &mut Bytes<'_>) -> Result<Self, SurfaceError> {
        let [order, _objects, _version, study] = data.array(Number::U16)?;
        if order != 0.0 {
            let found = "numbers in the order of Motorola";
            return Err(refused(Place::Byte(12), found, "the order of a PC"));
        }
        if ![1.0, 2.0].contains(&study) {
            let found = format!("a study of type {study}");
            return Err(refused(Place::Byte(18), found, "1, a profile, or 2, a map"));
        }
        // The names of the object and the operator, and the codes of material, acquisition and
        // range, are not needed.
        data.take(30 + 30 + 6)?;
        let has_missing = data.size(Number::U16)? == 1;
        // The flag of absolute heights, the resolution and a reserved field are not needed.
        data.take(2 + 4 + 4)?;
        let number = match data.size(Number::U16)? {
            16 => Number::I16,
            32 => Number::I32,
            bits => {
                let found = format!("heights of {bits} bits");
                return Err(refused(Place::Byte(98), found, "16 or 32"));
            }
        };
        let [lowest, _highest] = data.array(Number::I32)?;
        let columns = count(data)?;
        let rows = count(data)?;
        data.take(4)?;
        let [along, between, scale] = data.array(Number::F32)?;
        // The names of the axes are not needed.
        data.take(3 * 16)?;
        let units = StatedUnits {
            along: unit(data)?,
            between: unit(data)?,
            heights: unit(data)?,
        };
        // The units of the axes, the ratios of the units and the flag of an imprint are not needed.
        // After the next field, the flag of inversion, times follow.
        data.take(3 * 16 + 3 * 4 + 2)?;
        let is_inverted = data.size(Number::U16)? != 0;
        data.take(334 - 292)?;
        let comment = data.size(Number::U16)?;
        let private = data.size(Number::U16)?;
        data.take(HEADER - 338 + comment + private)?;
        Ok(Header {
            columns,
            rows,
            number,
            missing: has_missing.then_some(lowest - MISSING_BELOW),
            scale: if is_inverted { -scale } else { scale },
            spacing: [along, between],
            units,
        })
    }
}

fn count(data: &mut Bytes<'_>) -> Result<usize, SurfaceError> {
    let place = data.place();
    let count = data.number(Number::I32)?;
    if count > 0.0 {
        return Ok(count as usize);
    }
    let found = format!("{count} points along an axis");
    Err(refused(place, found, "above 0"))
}

/// Returns the unit in the next field, which is padded with spaces or zeros. Old files encode µ in
/// a code page of MS-DOS, in which µ is the byte that means æ in Windows-1252.
fn unit(data: &mut Bytes<'_>) -> Result<Option<Unit>, SurfaceError> {
    let place = data.place();
    let field = data.take(16)?;
    let field = field.split(|byte| *byte == 0).next().unwrap_or_default();
    let text = decoded(field);
    match text.trim() {
        "æm" => Unit::stated("µm", place),
        text => Unit::stated(text, place),
    }
}

/// Decompresses the heights. A table states the size of each part before and after compression, and
/// the parts follow after the table.
fn expand(data: &mut Bytes<'_>, points: usize, number: Number) -> Result<Vec<u8>, SurfaceError> {
    let place = data.place();
    let expected = unpacked_size(points, number.size(), place.clone())?;
    let parts = data.size(Number::U32)?;
    if parts > MOST_PARTS {
        let found = format!("{parts} compressed parts");
        return Err(refused(place, found, format!("at most {MOST_PARTS}")));
    }
    let mut sizes = data.part(8 * parts)?;
    let mut content = Vec::new();
    for _ in 0..parts {
        let plain = sizes.size(Number::U32)?;
        let packed = sizes.size(Number::U32)?;
        let place = data.place();
        if content.len() + plain > expected {
            let allowed = format!("{expected} bytes in all");
            return Err(refused(place, "more heights than points", allowed));
        }
        let packed = data.take(packed)?;
        let part = match read_limited(ZlibDecoder::new(packed), plain) {
            Ok(part) => part,
            Err(error) => {
                let found = format!("a compressed part: {error}");
                return Err(refused(place, found, format!("{plain} bytes of zlib")));
            }
        };
        if part.len() != plain {
            let found = format!("a part of {} bytes", part.len());
            return Err(refused(place, found, format!("{plain} bytes")));
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

    /// Returns a file with a map of flat heights in µm. The distance of points is 2 µm along the
    /// rows and 3 nm between the rows.
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
        let between = reading.units.between.map(|unit| unit.to_metres(3.0));
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
