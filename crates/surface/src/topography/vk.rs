//! The formats VK4 and VK3 of Keyence. A file has a table of offsets, the conditions of the
//! measurement, and up to three images of heights as unsigned integers, the top row first.

use super::bytes::{Bytes, Number, Order};
use super::channel::{self, Label, Wanted};
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};

pub(super) const SIGNATURES: [&[u8]; 2] = [b"VK4_", b"VK3_"];

/// Offset in bytes of the table of offsets, from the beginning of the file.
const TABLE: usize = 12;

/// Offset in bytes at which the file states the offset of the conditions of the measurement.
const CONDITIONS: usize = TABLE;

/// Offset in bytes at which the file states the offset of the first of three images of heights.
const HEIGHTS: usize = TABLE + 6 * 4;

/// Largest number of images of heights in a file.
const MOST_IMAGES: u32 = 3;

/// Offset in bytes, within the conditions, of three numbers in pm: the distances between points
/// along x and along y, and the height of one integer step.
const SCALES: usize = 42 * 4;

/// Size in bytes of the table of colours, which lies between the header of an image and its
/// numbers.
const PALETTE: usize = 3 * 256;

/// Reads one image of heights of a VK file. Images are numbered from 0; `wanted` chooses the image.
pub(super) fn read(bytes: &[u8], wanted: Wanted<'_>) -> Result<Reading, SurfaceError> {
    let mut table = Bytes::from(bytes, Order::Little, HEIGHTS)?;
    let mut labels = Vec::new();
    let mut offsets = Vec::new();
    for number in 0..MOST_IMAGES {
        let offset = table.size(Number::U32)?;
        if offset > 0 {
            offsets.push(offset);
            labels.push(Label {
                number,
                name: format!("Height {number}"),
                has_heights: true,
                ..Label::default()
            });
        }
    }
    let index = channel::chosen(&labels, "channel", wanted)?;
    let scales = Scales::read(bytes)?;
    image(bytes, offsets[index], &scales)
}

/// Distances between points, and height of one integer step, all in pm.
struct Scales {
    along: f64,
    between: f64,
    height: f64,
}

impl Scales {
    fn read(bytes: &[u8]) -> Result<Self, SurfaceError> {
        let conditions = Bytes::from(bytes, Order::Little, CONDITIONS)?.size(Number::U32)?;
        let offset = conditions.saturating_add(SCALES);
        let mut scales = Bytes::from(bytes, Order::Little, offset)?;
        let [along, between, height] = scales.array(Number::U32)?;
        if along == 0.0 || between == 0.0 || height == 0.0 {
            let found = format!("distances of {along} and {between} pm and a step of {height} pm");
            return Err(refused(Place::Byte(offset), found, "above 0"));
        }
        Ok(Scales {
            along,
            between,
            height,
        })
    }
}

/// Reads the image of heights at this offset.
fn image(bytes: &[u8], offset: usize, scales: &Scales) -> Result<Reading, SurfaceError> {
    let mut image = Bytes::from(bytes, Order::Little, offset)?;
    let place = image.place();
    let columns = image.size(Number::U32)?;
    let rows = image.size(Number::U32)?;
    let [bits, compression, size, _, _] = image.array(Number::U32)?;
    let kind = match bits {
        8.0 => Number::U8,
        16.0 => Number::U16,
        32.0 => Number::U32,
        _ => {
            let found = format!("heights of {bits} bits");
            return Err(refused(place, found, "8, 16 or 32 bits"));
        }
    };
    if compression != 0.0 {
        let found = format!("heights with compression {compression}");
        return Err(refused(place, found, "heights without compression"));
    }
    let points = columns.saturating_mul(rows);
    if points == 0 || points.saturating_mul(kind.size()) != size as usize {
        let found = format!("{size} bytes for {columns} times {rows} heights of {bits} bits");
        return Err(refused(place, found, "as many bytes as the heights have"));
    }
    image.take(PALETTE)?;
    let heights = image.numbers(points, kind)?;
    let unit: Option<Unit> = "pm".parse().ok();
    let units = StatedUnits::new(unit, unit);
    let spacing = Some([scales.along, scales.between]);
    let reading = Reading::even("Keyence VK", heights, columns, spacing, units);
    Ok(reading.scaled(|_| false, scales.height))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Returns a file with one or two images of heights in rows of three points.
    pub fn file(signature: &[u8], bits: u32, images: usize) -> Vec<u8> {
        let table_size: usize = if signature == b"VK3_" { 17 } else { 18 } * 4;
        let conditions = TABLE + table_size;
        let mut file = [signature, &[1, 0, 0, 0, 0, 0, 0, 0]].concat();
        file.resize(conditions + 304, 0);
        let put = |file: &mut Vec<u8>, offset: usize, number: usize| {
            file[offset..offset + 4].copy_from_slice(&(number as u32).to_le_bytes());
        };
        put(&mut file, CONDITIONS, conditions);
        put(&mut file, conditions, 304);
        for (index, number) in [500_000, 250_000, 100].into_iter().enumerate() {
            put(&mut file, conditions + SCALES + 4 * index, number);
        }
        for image in 0..images {
            let offset = file.len();
            // The second of three possible images is left out.
            put(&mut file, HEIGHTS + 8 * image, offset);
            for number in [3, 2, bits, 0, 6 * bits / 8, 0, 255] {
                file.extend(number.to_le_bytes());
            }
            file.extend([7; PALETTE]);
            for height in [1_u32, 2, 3, 40, 50, 60] {
                let height = height + image as u32;
                file.extend(&height.to_le_bytes()[..bits as usize / 8]);
            }
        }
        file
    }

    #[test]
    fn heights_and_distances_are_in_picometres() {
        for signature in SIGNATURES {
            for bits in [8, 16, 32] {
                let found = read(&file(signature, bits, 1), Wanted::Heights).unwrap();
                assert_eq!((found.columns, found.spacing), (3, Some([5e5, 2.5e5])));
                assert_eq!(found.heights, [100.0, 200.0, 300.0, 4e3, 5e3, 6e3]);
                assert_eq!(found.units.heights.map(Unit::name), Some("pm"));
            }
        }
        let two = file(SIGNATURES[0], 16, 2);
        let error = read(&two, Wanted::Heights).unwrap_err().to_string();
        let expected = "2 channels of heights; channels: 0 \"Height 0\", 2 \"Height 2\"; ";
        assert!(error.starts_with(expected), "{error}");
        assert_eq!(read(&two, Wanted::Number(2)).unwrap().heights[0], 200.0);
        let named = read(&two, Wanted::Name("height 0")).unwrap();
        assert_eq!(named.heights[0], 100.0);
    }

    #[test]
    fn faults_have_a_place() {
        let whole = file(SIGNATURES[0], 32, 1);
        let image = whole.len() - 24 - PALETTE - 28;
        let conditions = TABLE + 72;
        for (offset, number, expected) in [
            (
                image + 8,
                24,
                format!("byte {image}: heights of 24 bits; allowed: 8"),
            ),
            (
                image + 12,
                1,
                format!("byte {image}: heights with compression 1"),
            ),
            (
                image,
                4,
                format!("byte {image}: 24 bytes for 4 times 2 heights of 32"),
            ),
            (image, 0, format!("byte {image}: 24 bytes for 0 times 2")),
            (
                conditions + SCALES + 8,
                0,
                format!("byte {}: dist", conditions + SCALES),
            ),
            (
                CONDITIONS,
                u32::MAX,
                "byte 0: 1208 bytes up to the end".to_owned(),
            ),
            (
                HEIGHTS,
                u32::MAX,
                "byte 0: 1208 bytes up to the end".to_owned(),
            ),
            (
                HEIGHTS,
                0,
                "no channel; allowed: a file with heights".to_owned(),
            ),
        ] {
            let mut file = whole.clone();
            file[offset..offset + 4].copy_from_slice(&number.to_le_bytes());
            let error = read(&file, Wanted::Heights).unwrap_err().to_string();
            assert!(error.starts_with(&expected), "{expected}: {error}");
        }
        for end in 4..whole.len() {
            assert!(read(&whole[..end], Wanted::Heights).is_err(), "{end}");
        }
    }
}
