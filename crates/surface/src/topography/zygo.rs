//! The format DAT of Zygo MetroPro. A file has a header of fixed fields, intensities, and heights
//! as integers in fractions of a wavelength, the top row first.

use super::bytes::{Bytes, Number, Order};
use super::reading::Reading;
use super::stated_units::StatedUnits;
use crate::error::{Place, SurfaceError, refused};

pub(super) const SIGNATURES: [&[u8]; 3] = [
    b"\x88\x1b\x03\x6f",
    b"\x88\x1b\x03\x70",
    b"\x88\x1b\x03\x71",
];

/// Smallest integer that marks a missing point. All larger integers mark missing points too.
const MISSING: f64 = 2_147_483_640.0;

/// Number of integer steps per wavelength. The index in this list is the code of the resolution in
/// the header.
const STEPS: [f64; 3] = [4_096.0, 32_768.0, 131_072.0];

/// Offsets in bytes of fields in the header.
mod field {
    pub const HEADER_SIZE: usize = 6;
    pub const INTENSITY_BYTES: usize = 60;
    pub const COLUMNS: usize = 68;
    pub const SCALE: usize = 164;
    pub const WAVELENGTH: usize = 168;
    pub const OBLIQUITY: usize = 176;
    pub const LATERAL_RESOLUTION: usize = 184;
    pub const PHASE_RESOLUTION: usize = 218;
    pub const SIGN: usize = 232;
}

/// Reads the heights of a Zygo file and converts them to m. If the header states the distance 0
/// between points, the distance is unknown.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    let number = |offset: usize, kind: Number| Bytes::from(bytes, Order::Big, offset)?.number(kind);
    let mut counts = Bytes::from(bytes, Order::Big, field::COLUMNS)?;
    let place = counts.place();
    let columns = counts.size(Number::U16)?;
    let rows = counts.size(Number::U16)?;
    let points = columns.saturating_mul(rows);
    if points == 0 {
        let found = format!("{columns} times {rows} heights");
        return Err(refused(
            place,
            found,
            "a file with heights, not of intensities alone",
        ));
    }
    let scale = number(field::SCALE, Number::F32)?
        * number(field::WAVELENGTH, Number::F32)?
        * number(field::OBLIQUITY, Number::F32)?
        / steps(bytes)?;
    if !scale.is_finite() || scale == 0.0 {
        let found = format!("a step of the heights of {scale:e} m");
        let allowed = "a scale, a wavelength and an obliquity above 0";
        return Err(refused(Place::Byte(field::SCALE), found, allowed));
    }
    let is_inverted = number(field::SIGN, Number::I16)? != 0.0;
    let distance = number(field::LATERAL_RESOLUTION, Number::F32)?;

    let header_size = number(field::HEADER_SIZE, Number::U32)? as usize;
    let intensity_bytes = number(field::INTENSITY_BYTES, Number::U32)? as usize;
    let mut data = Bytes::from(bytes, Order::Big, header_size)?;
    data.take(intensity_bytes)?;
    let heights = data.numbers(points, Number::I32)?;
    let spacing = (distance != 0.0).then_some([distance; 2]);
    let units = StatedUnits::METRES;
    let reading = Reading::even("Zygo DAT", heights, columns, spacing, units);
    let signed_scale = if is_inverted { -scale } else { scale };
    Ok(reading.scaled(|height| height >= MISSING, signed_scale))
}

/// Returns the number of integer steps per wavelength.
fn steps(bytes: &[u8]) -> Result<f64, SurfaceError> {
    let mut header = Bytes::from(bytes, Order::Big, field::PHASE_RESOLUTION)?;
    let place = header.place();
    let resolution = header.number(Number::I16)?;
    match resolution {
        0.0 => Ok(STEPS[0]),
        1.0 => Ok(STEPS[1]),
        2.0 => Ok(STEPS[2]),
        _ => {
            let found = format!("resolution {resolution} of the heights");
            Err(refused(place, found, "0, 1 or 2"))
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Returns a file with intensities and these integer heights. Rows have three points, and the
    /// distance between points is 2 µm.
    pub fn file(signature: usize, resolution: i16, sign: i16, heights: &[i32]) -> Vec<u8> {
        let size: usize = if signature == 2 { 4_096 } else { 834 };
        let mut header = vec![0; size];
        let mut put = |offset: usize, bytes: &[u8]| {
            header[offset..offset + bytes.len()].copy_from_slice(bytes);
        };
        put(0, SIGNATURES[signature]);
        put(4, &(signature as u16 + 1).to_be_bytes());
        put(6, &(size as u32).to_be_bytes());
        // The file has one image of two intensities before the heights.
        put(52, &[0, 2, 0, 1, 0, 1]);
        put(60, &4_u32.to_be_bytes());
        put(68, &3_u16.to_be_bytes());
        put(70, &((heights.len() / 3) as u16).to_be_bytes());
        put(72, &(4 * heights.len() as u32).to_be_bytes());
        put(164, &0.5_f32.to_be_bytes());
        put(168, &6.25e-7_f32.to_be_bytes());
        put(176, &1.25_f32.to_be_bytes());
        put(184, &2e-6_f32.to_be_bytes());
        put(218, &resolution.to_be_bytes());
        put(232, &sign.to_be_bytes());
        let heights: Vec<u8> = heights.iter().flat_map(|z| z.to_be_bytes()).collect();
        [&header[..], &[9; 4], &heights].concat()
    }

    const HEIGHTS: [i32; 6] = [1, -2, 3, 2_147_483_640, 5, 700];

    #[test]
    fn heights_are_fractions_of_a_wavelength() {
        let step = f64::from(0.5_f32) * f64::from(6.25e-7_f32) * f64::from(1.25_f32);
        for (signature, resolution, sign, steps) in [
            (0, 0, 0, 4_096.0),
            (1, 1, 0, 32_768.0),
            (2, 2, 1, -131_072.0),
        ] {
            let found = read(&file(signature, resolution, sign, &HEIGHTS)).unwrap();
            assert_eq!(found.columns, 3);
            assert_eq!(found.spacing, Some([f64::from(2e-6_f32); 2]));
            assert!(found.heights[3].is_nan());
            for index in [0, 1, 2, 4, 5] {
                let expected = f64::from(HEIGHTS[index]) * step / steps;
                let error = (found.heights[index] / expected - 1.0).abs();
                assert!(error < 1e-15, "{index}: {error}");
            }
        }
    }

    #[test]
    fn faults_have_a_place() {
        let whole = file(0, 1, 0, &HEIGHTS);
        let changed = |offset: usize, bytes: &[u8]| {
            let mut file = whole.clone();
            file[offset..offset + bytes.len()].copy_from_slice(bytes);
            read(&file).unwrap_err().to_string()
        };
        for (offset, bytes, expected) in [
            (68, &[0, 0][..], "byte 68: 0 times 2 heights"),
            (
                218,
                &[0, 3],
                "byte 218: resolution 3 of the heights; allowed: 0, 1 or 2",
            ),
            (168, &[0; 4], "byte 164: a step of the heights of 0e0 m"),
            (
                68,
                &[0xff; 4],
                "byte 838: 24 bytes up to the end; allowed: at least 17",
            ),
            (6, &[0xff; 4], "byte 0: 862 bytes up to the end"),
        ] {
            let error = changed(offset, bytes);
            assert!(error.starts_with(expected), "{error}");
        }
        for end in 4..whole.len() {
            assert!(read(&whole[..end]).is_err(), "{end}");
        }
        // A distance of 0 means that the distance is unknown.
        let mut no_distance = whole.clone();
        no_distance[184..188].fill(0);
        assert_eq!(read(&no_distance).unwrap().spacing, None);
    }
}
