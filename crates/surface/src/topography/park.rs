//! Images of Park Systems, which are TIFF files. Tags of this maker contain a header and the
//! heights, the lowest row first.

use super::bytes::{Bytes, Number};
use super::channel::{self, Label, Wanted};
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::tiff::Directory;
use super::transpose::reverse_rows;
use super::unit::Unit;
use crate::error::{SurfaceError, refused};

/// Value of [`tag::MARK`] in files of Park Systems, by which these files are recognised.
const MARK: f64 = 235_082_497.0;

/// First version whose header states the type of the heights. In earlier versions the heights are
/// integers of 16 bits.
const WITH_TYPE: f64 = 16_777_218.0;

/// Unit of the size of the scan.
const MICROMETRE: &str = "µm";

/// Numbers of the tags that Park Systems uses in TIFF.
mod tag {
    pub const MARK: u16 = 50_432;
    pub const VERSION: u16 = 50_433;
    pub const HEIGHTS: u16 = 50_434;
    pub const HEADER: u16 = 50_435;
}

/// Offsets in bytes of the fields in the header.
mod field {
    pub const NAME: usize = 4;
    pub const COLUMNS: usize = 100;
    pub const SIZE: usize = 140;
    pub const GAIN: usize = 220;
    pub const UNIT: usize = 244;
    pub const TYPE: usize = 348;
}

/// Number of letters, of two bytes each, of the name of the channel.
const NAME_LETTERS: usize = 32;
/// Number of letters, of two bytes each, of the unit.
const UNIT_LETTERS: usize = 8;

/// Returns true if the directories of a TIFF file are those of an image of Park Systems.
pub(super) fn is_park(directories: &[Directory<'_>]) -> bool {
    directories
        .first()
        .is_some_and(|first| matches!(first.number(tag::MARK), Ok(Some(MARK))))
}

/// Reads the only channel of the file. Returns an error if the options ask for another channel.
pub(super) fn read(
    directories: &[Directory<'_>],
    wanted: Wanted<'_>,
) -> Result<Reading, SurfaceError> {
    let directory = &directories[0];
    let missing = |name: &str| {
        let found = format!("a file of Park without {name}");
        refused(directory.place(), found, "a header and heights")
    };
    let header = directory.content(tag::HEADER)?;
    let header = Header::read(&header.ok_or_else(|| missing("a header"))?)?;
    let label = Label {
        name: header.name.clone(),
        unit: Some(header.unit.clone()),
        has_heights: true,
        ..Label::default()
    };
    channel::chosen(&[label], "channel", wanted)?;

    let version = directory.number(tag::VERSION)?.unwrap_or_default();
    let kind = if version >= WITH_TYPE {
        header.number_type(directory)?
    } else {
        Number::I16
    };
    let content = directory.content(tag::HEIGHTS)?;
    let mut content = content.ok_or_else(|| missing("heights"))?;
    let points = header.columns.saturating_mul(header.rows);
    if points == 0 || points.saturating_mul(kind.size()) != content.left() {
        let found = format!(
            "{} bytes for {} times {} heights of {} bytes",
            content.left(),
            header.columns,
            header.rows,
            kind.size()
        );
        return Err(refused(
            content.place(),
            found,
            "as many bytes as the heights have",
        ));
    }
    let unit = Unit::stated(&header.unit, directory.place())?;
    let mut heights = content.numbers(points, kind)?;
    for height in &mut heights {
        *height = header.gain * (*height * header.scale + header.offset);
    }
    reverse_rows(&mut heights, header.columns);
    let units = StatedUnits::new(MICROMETRE.parse().ok(), unit);
    let spacing = header.spacing();
    Ok(Reading::even(
        "Park",
        heights,
        header.columns,
        spacing,
        units,
    ))
}

/// What the header states about the scan.
struct Header {
    name: String,
    columns: usize,
    rows: usize,
    /// Width and height of the scan in µm.
    size: [f64; 2],
    gain: f64,
    scale: f64,
    offset: f64,
    unit: String,
    /// Code of the type of the heights; `None` if the header is too short to contain it.
    kind: Option<f64>,
}

impl Header {
    fn read(header: &Bytes<'_>) -> Result<Self, SurfaceError> {
        let at = |offset: usize| -> Result<Bytes<'_>, SurfaceError> {
            let mut rest = *header;
            rest.take(offset)?;
            Ok(rest)
        };
        let place = header.place();
        let image_type = at(0)?.number(Number::U32)?;
        if image_type != 0.0 {
            let found = format!("image type {image_type} of Park, a profile or a spectrum");
            return Err(refused(place, found, "a map, type 0"));
        }
        let mut counts = at(field::COLUMNS)?;
        let [gain, scale, offset] = at(field::GAIN)?.array(Number::F64)?;
        Ok(Header {
            name: text(at(field::NAME)?, NAME_LETTERS)?,
            columns: counts.size(Number::U32)?,
            rows: counts.size(Number::U32)?,
            size: at(field::SIZE)?.array(Number::F64)?,
            gain,
            // The value 0 means that the file states no scale.
            scale: if scale == 0.0 { 1.0 } else { scale },
            offset,
            unit: text(at(field::UNIT)?, UNIT_LETTERS)?,
            kind: match at(field::TYPE) {
                Ok(mut rest) if rest.left() >= 4 => Some(rest.number(Number::U32)?),
                _ => None,
            },
        })
    }

    fn number_type(&self, directory: &Directory<'_>) -> Result<Number, SurfaceError> {
        match self.kind {
            Some(0.0) => Ok(Number::I16),
            Some(1.0) => Ok(Number::I32),
            Some(2.0) => Ok(Number::F32),
            Some(other) => {
                let found = format!("type {other} of the heights");
                Err(refused(directory.place(), found, "0, 1 or 2"))
            }
            None => {
                let found = "a header without the type of the heights";
                Err(refused(directory.place(), found, "at least 352 bytes"))
            }
        }
    }

    /// Returns the distances between points along and between rows in µm; `None` if the size is 0.
    fn spacing(&self) -> Option<[f64; 2]> {
        let [width, height] = self.size;
        let has_size = width > 0.0 && height > 0.0;
        has_size.then_some([width / self.columns as f64, height / self.rows as f64])
    }
}

/// Returns a text of at most `letters` letters, of two bytes each, up to the first zero.
fn text(mut bytes: Bytes<'_>, letters: usize) -> Result<String, SurfaceError> {
    let letters = bytes.numbers(letters, Number::U16)?;
    let letters = letters.iter().map(|letter| *letter as u16);
    let letters: Vec<u16> = letters.take_while(|letter| *letter != 0).collect();
    Ok(String::from_utf16_lossy(&letters))
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::bytes::Order;
    use super::super::tiff::tests::{Tag, Writer};
    use super::super::tiff_maker;
    use super::*;

    const LITTLE: Writer = Writer {
        order: Order::Little,
    };

    /// Returns a file of 3 × 2 heights on an area of 6 µm × 2 µm. `kind` is the type of the
    /// heights: integers of 16 bits (0), integers of 32 bits (1) or real numbers (2). The length of
    /// the header depends on the version.
    pub fn file(version: u32, kind: u32, unit: &str) -> Vec<u8> {
        let mut header = vec![0; if version == 16_777_217 { 356 } else { 580 }];
        let mut put = |offset: usize, bytes: &[u8]| {
            header[offset..offset + bytes.len()].copy_from_slice(bytes);
        };
        let wide =
            |text: &str| -> Vec<u8> { text.encode_utf16().flat_map(u16::to_le_bytes).collect() };
        put(4, &wide("Z Height"));
        put(100, &3_u32.to_le_bytes());
        put(104, &2_u32.to_le_bytes());
        put(140, &[6.0_f64, 2.0].map(f64::to_le_bytes).concat());
        put(220, &[0.5_f64, 0.25, 10.0].map(f64::to_le_bytes).concat());
        put(244, &wide(unit));
        if version > 16_777_217 {
            put(348, &kind.to_le_bytes());
        }
        let numbers: [i16; 6] = [1, -2, 3, 40, 50, 60];
        let heights: Vec<u8> = numbers
            .iter()
            .flat_map(|number| match kind {
                0 => number.to_le_bytes().to_vec(),
                1 => i32::from(*number).to_le_bytes().to_vec(),
                _ => f32::from(*number).to_le_bytes().to_vec(),
            })
            .collect();
        let bytes = |tag: u16, content: Vec<u8>| Tag {
            tag,
            kind: 7,
            content,
        };
        let mut file = LITTLE.begin();
        let tags = [
            LITTLE.long(tag::MARK, &[235_082_497]),
            LITTLE.long(tag::VERSION, &[version]),
            bytes(tag::HEIGHTS, heights),
            bytes(tag::HEADER, header),
        ];
        LITTLE.directory(&mut file, 4, &tags);
        file
    }

    #[test]
    fn heights_follow_from_gain_scale_and_offset() {
        // The last row in the file is the upper row of the map.
        let upper_first = [40.0, 50.0, 60.0, 1.0, -2.0, 3.0];
        let expected = upper_first.map(|number| 0.5 * (number * 0.25 + 10.0));
        for (version, kind) in [
            (16_777_217, 0),
            (16_777_218, 0),
            (16_777_218, 1),
            (16_777_218, 2),
        ] {
            let found = tiff_maker::read(&file(version, kind, "um"), Wanted::Heights).unwrap();
            assert_eq!((found.format, found.columns), ("Park", 3));
            assert_eq!(found.spacing, Some([2.0, 1.0]));
            assert_eq!(found.heights, expected);
            let units = [found.units.along, found.units.heights];
            assert_eq!(units.map(|unit| unit.map(Unit::name)), [Some("µm"); 2]);
        }
        let whole = file(16_777_218, 1, "um");
        assert!(tiff_maker::read(&whole, Wanted::Name("z height")).is_ok());
        let error = tiff_maker::read(&whole, Wanted::Name("Phase"))
            .unwrap_err()
            .to_string();
        let expected = "no channel \"Phase\"; channels: 0 \"Z Height\" in um; allowed: ";
        assert!(error.starts_with(expected), "{error}");
    }

    #[test]
    fn faults_are_named() {
        let error = |bytes: &[u8]| {
            tiff_maker::read(bytes, Wanted::Heights)
                .unwrap_err()
                .to_string()
        };
        assert!(error(&file(16_777_218, 1, "V")).contains("\"V\" is not a unit of length"));
        assert!(error(&file(16_777_218, 3, "um")).contains("type 3 of the heights"));
        let whole = file(16_777_218, 1, "um");
        let header = whole.len() - 580 - 2 - 4 * 12 - 4;
        for (offset, byte, expected) in [
            (0, 1, "image type 1 of Park"),
            (100, 4, "24 bytes for 4 times 2 heights of 4 bytes"),
            (103, 255, "heights of 4 bytes; allowed: as many"),
        ] {
            let mut file = whole.clone();
            file[header + offset] = byte;
            assert!(error(&file).contains(expected), "{}", error(&file));
        }
        for end in 4..whole.len() {
            assert!(
                tiff_maker::read(&whole[..end], Wanted::Heights).is_err(),
                "{end}"
            );
        }
    }
}
