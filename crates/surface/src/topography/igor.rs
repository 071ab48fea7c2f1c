//! Binary waves, the array files of the program Igor Pro. A file has a header, an array of numbers
//! in up to four dimensions, a text (note), and names of the elements along each dimension. Numbers
//! that are neighbours in the file are neighbours along the first dimension of the array.

use super::bytes::{Bytes, Number, Order, decoded};
use crate::error::{Place, SurfaceError, refused};

/// Largest number of dimensions of a wave (the array in the file).
const DIMENSIONS: usize = 4;

/// Size in bytes of the name of an element of a dimension.
const LABEL_SIZE: usize = 32;

/// Number of padding bytes between the array and the note, in files before version 5. The check sum
/// of such a file covers the headers and as many bytes after them.
const PADDING: usize = 16;

/// Flags in the code that states the type of the numbers.
mod flag {
    pub const COMPLEX: usize = 0x01;
    pub const UNSIGNED: usize = 0x40;
}

/// A version of the file format.
struct Version {
    number: u16,
    /// Size in bytes of the header of the file, with which the file begins.
    file_header: usize,
    /// Size in bytes of the header of the wave. This header follows the header of the file.
    wave_header: usize,
    /// Offset in bytes of the number that states the size of the note; `None` if this version has
    /// no note.
    note_size: Option<usize>,
}

/// The versions of the format that can be read.
const VERSIONS: [Version; 4] = [
    version(1, 8, 110, None),
    version(2, 16, 110, Some(6)),
    version(3, 20, 110, Some(6)),
    version(5, 64, 320, Some(12)),
];

const fn version(
    number: u16,
    file_header: usize,
    wave_header: usize,
    note_size: Option<usize>,
) -> Version {
    Version {
        number,
        file_header,
        wave_header,
        note_size,
    }
}

/// Offsets in bytes of fields in the headers of version 5. An offset whose name contains `SIZE` is
/// counted from the header of the file, any other offset from the header of the wave.
mod field {
    pub const POINTS: usize = 12;
    pub const TYPE: usize = 16;
    pub const COUNTS: usize = 68;
    pub const STEPS: usize = 84;
    pub const UNIT: usize = 148;
    pub const UNITS_OF_DIMENSIONS: usize = 152;
    pub const FORMULA_SIZE: usize = 8;
    pub const UNIT_SIZE: usize = 16;
    pub const SIZES_OF_UNITS: usize = 20;
    pub const SIZES_OF_LABELS: usize = 36;
}

/// Offsets in bytes of fields in the header of the wave, in versions before 5.
mod old_field {
    pub const UNIT: usize = 34;
    pub const UNIT_OF_X: usize = 38;
    pub const POINTS: usize = 42;
    pub const STEP: usize = 48;
}

/// Number of bytes of a unit in the header of a wave.
const UNIT_LENGTH: usize = 4;

/// One dimension of a wave. The program Igor calls an array a wave.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WaveDimension {
    /// Number of elements of the array along this dimension; 0 if the array has fewer dimensions.
    pub count: usize,
    /// Distance between neighbouring elements, in the unit [`Self::unit`].
    pub step: f64,
    /// Unit of the distance [`Self::step`]; empty if the file states no unit.
    pub unit: String,
    /// Names of the elements along this dimension; empty if the elements have no names.
    pub labels: Vec<String>,
}

/// A binary wave of the program Igor: an array with its dimensions, its unit and its note. The
/// numbers of the array remain encoded as bytes until they are requested.
#[derive(Debug)]
pub struct IgorWave<'a> {
    /// Dimensions of the array. Numbers that are neighbours in the file are neighbours along the
    /// first dimension.
    pub dimensions: [WaveDimension; DIMENSIONS],
    /// Unit of the numbers in the array; empty if the file states no unit.
    pub unit: String,
    /// Text that programs attach to the array, with lines `key: value`.
    pub note: String,
    kind: Number,
    numbers: Bytes<'a>,
}

/// Version and order of bytes of a file, which determine the layout of its headers.
struct Layout {
    version: &'static Version,
    order: Order,
}

impl Layout {
    /// Returns the layout that follows from the version in the first two bytes; `None` if the file
    /// is not a wave.
    fn of(bytes: &[u8]) -> Option<Self> {
        let first = [*bytes.first()?, *bytes.get(1)?];
        for version in &VERSIONS {
            let order = if first == version.number.to_le_bytes() {
                Order::Little
            } else if first == version.number.to_be_bytes() {
                Order::Big
            } else {
                continue;
            };
            let has_headers = bytes.len() >= version.file_header + version.wave_header;
            return has_headers.then_some(Layout { version, order });
        }
        None
    }

    /// Returns the sum of the headers of file and wave, as integers of 16 bits. This sum is 0 in an
    /// intact file. Before version 5 the [`PADDING`] bytes after the headers are added too.
    fn check_sum(&self, bytes: &[u8]) -> u16 {
        let size = self.version.file_header + self.version.wave_header;
        let counted = if self.is_old() { size + PADDING } else { size };
        let mut sum = 0_u16;
        for pair in bytes[..bytes.len().min(counted)].chunks_exact(2) {
            let pair = [pair[0], pair[1]];
            let number = match self.order {
                Order::Little => u16::from_le_bytes(pair),
                Order::Big => u16::from_be_bytes(pair),
            };
            sum = sum.wrapping_add(number);
        }
        sum
    }

    fn is_old(&self) -> bool {
        self.version.number < 5
    }
}

/// Returns true if a file is a binary wave, the array file of the program Igor: it begins with the
/// headers of a wave, and the check sum of the headers is right.
pub fn is_igor_wave(bytes: &[u8]) -> bool {
    Layout::of(bytes).is_some_and(|layout| layout.check_sum(bytes) == 0)
}

/// Returns an error if a file seems to be a binary wave of version 5, but the check sum of its
/// headers is wrong.
pub(super) fn check_sum(bytes: &[u8]) -> Result<(), SurfaceError> {
    match Layout::of(bytes) {
        Some(layout) if !layout.is_old() && layout.check_sum(bytes) != 0 => {
            let found = "headers of a binary wave of Igor with a wrong check sum";
            Err(refused(Place::Byte(2), found, "a file that is not damaged"))
        }
        _ => Ok(()),
    }
}

impl<'a> IgorWave<'a> {
    /// Parses the content of a file with a binary wave.
    ///
    /// # Errors
    /// Returns [`SurfaceError`] if the file is not a wave, is cut off, or does not contain real
    /// numbers.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, SurfaceError> {
        let Some(layout) = Layout::of(bytes) else {
            let found = "no headers of a binary wave of Igor";
            return Err(refused(Place::Byte(0), found, "version 1, 2, 3 or 5"));
        };
        if layout.is_old() {
            IgorWave::parse_old(bytes, &layout)
        } else {
            IgorWave::parse_new(bytes, &layout)
        }
    }

    /// Parses a file of a version before 5, whose array has one dimension.
    fn parse_old(bytes: &'a [u8], layout: &Layout) -> Result<Self, SurfaceError> {
        let start = layout.version.file_header;
        let at = |offset: usize| Bytes::from(bytes, layout.order, start + offset);
        let kind = number_type(at(0)?)?;
        let points = at(old_field::POINTS)?.size(Number::U32)?;
        let mut rest = at(layout.version.wave_header)?;
        let numbers = rest.part(points.saturating_mul(kind.size()))?;
        let note = match layout.version.note_size {
            Some(offset) => {
                let size = Bytes::from(bytes, layout.order, offset)?.size(Number::U32)?;
                if size > 0 {
                    rest.take(PADDING)?;
                }
                decoded(rest.take(size)?).into_owned()
            }
            None => String::new(),
        };
        let dimension = WaveDimension {
            count: points,
            step: at(old_field::STEP)?.number(Number::F64)?,
            unit: text(at(old_field::UNIT_OF_X)?.take(UNIT_LENGTH)?),
            labels: Vec::new(),
        };
        Ok(IgorWave {
            dimensions: [
                dimension,
                WaveDimension::default(),
                WaveDimension::default(),
                WaveDimension::default(),
            ],
            unit: text(at(old_field::UNIT)?.take(UNIT_LENGTH)?),
            note,
            kind,
            numbers,
        })
    }

    /// Parses a file of version 5. After the array follow the formula, the note, long units, and
    /// the names of the elements. The header of the file states the sizes of these parts.
    fn parse_new(bytes: &'a [u8], layout: &Layout) -> Result<Self, SurfaceError> {
        let start = layout.version.file_header;
        let in_file = |offset: usize| Bytes::from(bytes, layout.order, offset);
        let at = |offset: usize| in_file(start + offset);
        let kind = number_type(at(field::TYPE)?)?;
        let points = at(field::POINTS)?.size(Number::U32)?;
        let counts: [f64; DIMENSIONS] = at(field::COUNTS)?.array(Number::U32)?;
        let steps: [f64; DIMENSIONS] = at(field::STEPS)?.array(Number::F64)?;
        check_points(points, &counts, at(field::COUNTS)?.place())?;

        let mut rest = at(layout.version.wave_header)?;
        let numbers = rest.part(points.saturating_mul(kind.size()))?;
        let formula = in_file(field::FORMULA_SIZE)?.size(Number::U32)?;
        rest.take(formula)?;
        let size = match layout.version.note_size {
            Some(offset) => in_file(offset)?.size(Number::U32)?,
            None => 0,
        };
        let note = decoded(rest.take(size)?).into_owned();
        let mut unit = text(at(field::UNIT)?.take(UNIT_LENGTH)?);
        let long_unit = in_file(field::UNIT_SIZE)?.size(Number::U32)?;
        replace_if_stated(&mut unit, rest.take(long_unit)?);

        let mut units = at(field::UNITS_OF_DIMENSIONS)?;
        let mut sizes_of_units = in_file(field::SIZES_OF_UNITS)?;
        let mut sizes_of_labels = in_file(field::SIZES_OF_LABELS)?;
        let mut dimensions: [WaveDimension; DIMENSIONS] = Default::default();
        for (dimension, (count, step)) in dimensions.iter_mut().zip(counts.iter().zip(steps)) {
            dimension.count = *count as usize;
            dimension.step = step;
            dimension.unit = text(units.take(UNIT_LENGTH)?);
            let size = sizes_of_units.size(Number::U32)?;
            replace_if_stated(&mut dimension.unit, rest.take(size)?);
        }
        for dimension in &mut dimensions {
            let size = sizes_of_labels.size(Number::U32)?;
            // The first label is the name of the dimension itself, and is skipped.
            let labels = rest.take(size)?.chunks_exact(LABEL_SIZE).skip(1);
            dimension.labels = labels.map(text).collect();
        }
        Ok(IgorWave {
            dimensions,
            unit,
            note,
            kind,
            numbers,
        })
    }

    /// Returns `count` numbers of the array, beginning with the number at the index `first`.
    ///
    /// # Errors
    /// Returns [`SurfaceError`] if the array has too few numbers.
    pub fn numbers(&self, first: usize, count: usize) -> Result<Vec<f64>, SurfaceError> {
        let mut numbers = self.numbers;
        numbers.take(first.saturating_mul(self.kind.size()))?;
        numbers.numbers(count, self.kind)
    }

    /// Returns the value of a key in the note of the array. If several lines of the note have the
    /// key, the first line counts. Returns `None` if no line has the key.
    pub fn entry(&self, key: &str) -> Option<&str> {
        self.note.split(['\r', '\n']).find_map(|line| {
            let (name, value) = line.split_once(':')?;
            (name.trim() == key).then_some(value.trim())
        })
    }

    /// Returns the value of a key in the note of the array as a number. Returns `None` if the note
    /// does not have the key, or if the value is not a finite number.
    pub fn number(&self, key: &str) -> Option<f64> {
        let number: f64 = self.entry(key)?.parse().ok()?;
        number.is_finite().then_some(number)
    }
}

/// Reads the code of the type of the numbers, and returns this type.
fn number_type(mut bytes: Bytes<'_>) -> Result<Number, SurfaceError> {
    let place = bytes.place();
    let code = bytes.size(Number::U16)?;
    let is_unsigned = code & flag::UNSIGNED != 0;
    let kind = match code & !flag::UNSIGNED {
        0x02 => Number::F32,
        0x04 => Number::F64,
        0x08 if is_unsigned => Number::U8,
        0x08 => Number::I8,
        0x10 if is_unsigned => Number::U16,
        0x10 => Number::I16,
        0x20 if is_unsigned => Number::U32,
        0x20 => Number::I32,
        0x80 if is_unsigned => Number::U64,
        0x80 => Number::I64,
        _ => {
            let found = if code & flag::COMPLEX != 0 {
                "a wave of complex numbers".to_owned()
            } else if code == 0 {
                "a wave of texts".to_owned()
            } else {
                format!("a wave of numbers of type {code}")
            };
            return Err(refused(place, found, "a wave of real numbers or integers"));
        }
    };
    Ok(kind)
}

/// Returns an error unless the number of points equals the product of the counts of the dimensions,
/// up to the first count of 0.
fn check_points(
    points: usize,
    counts: &[f64; DIMENSIONS],
    place: Place,
) -> Result<(), SurfaceError> {
    let used = counts.iter().take_while(|count| **count > 0.0);
    let product: f64 = used.product();
    if points == 0 || product != points as f64 {
        let found = format!("{points} numbers in {counts:?} elements of the dimensions");
        return Err(refused(
            place,
            found,
            "a number for each element, at least one",
        ));
    }
    Ok(())
}

/// Returns the text before the first zero byte.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0);
    decoded(&bytes[..end.unwrap_or(bytes.len())]).into_owned()
}

fn replace_if_stated(unit: &mut String, long: &[u8]) {
    if !long.is_empty() {
        *unit = text(long);
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Content of a wave of version 5, from which a test writes a file.
    #[derive(Default)]
    pub struct Written<'a> {
        pub counts: [u32; DIMENSIONS],
        pub steps: [f64; DIMENSIONS],
        pub unit: &'a str,
        pub units: [&'a str; DIMENSIONS],
        pub labels: [&'a [&'a str]; DIMENSIONS],
        pub note: &'a str,
        /// Code of the type of the numbers.
        pub kind: u16,
        pub numbers: Vec<u8>,
    }

    struct Header {
        bytes: Vec<u8>,
        order: Order,
    }

    impl Header {
        fn put(&mut self, offset: usize, little: &[u8]) {
            let place = &mut self.bytes[offset..offset + little.len()];
            place.copy_from_slice(little);
            if self.order == Order::Big {
                place.reverse();
            }
        }

        fn put_text(&mut self, offset: usize, text: &[u8]) {
            self.bytes[offset..offset + text.len()].copy_from_slice(text);
        }

        /// Sets the check sum of the headers so that the sum of all their integers is 0.
        fn sum(&mut self, offset: usize) {
            let layout = Layout::of(&self.bytes).unwrap();
            let sum = layout.check_sum(&self.bytes);
            self.put(offset, &sum.wrapping_neg().to_le_bytes());
        }
    }

    /// Returns the file of a wave of version 5.
    pub fn file(wave: &Written<'_>, order: Order) -> Vec<u8> {
        let mut header = Header {
            bytes: vec![0; 384],
            order,
        };
        let points: u32 = wave.counts.iter().filter(|count| **count > 0).product();
        header.put(0, &5_u16.to_le_bytes());
        header.put(4, &(320 + wave.numbers.len() as u32).to_le_bytes());
        header.put(12, &(wave.note.len() as u32).to_le_bytes());
        header.put(64 + field::POINTS, &points.to_le_bytes());
        header.put(64 + field::TYPE, &wave.kind.to_le_bytes());
        header.put_text(64 + field::UNIT, wave.unit.as_bytes());
        let mut labels = Vec::new();
        for axis in 0..DIMENSIONS {
            header.put(
                64 + field::COUNTS + 4 * axis,
                &wave.counts[axis].to_le_bytes(),
            );
            header.put(
                64 + field::STEPS + 8 * axis,
                &wave.steps[axis].to_le_bytes(),
            );
            let place = 64 + field::UNITS_OF_DIMENSIONS + 4 * axis;
            header.put_text(place, wave.units[axis].as_bytes());
            if wave.labels[axis].is_empty() {
                continue;
            }
            let size = (LABEL_SIZE * (wave.labels[axis].len() + 1)) as u32;
            header.put(field::SIZES_OF_LABELS + 4 * axis, &size.to_le_bytes());
            labels.extend([0; LABEL_SIZE]);
            for label in wave.labels[axis] {
                labels.extend(label.as_bytes());
                labels.resize(labels.len().next_multiple_of(LABEL_SIZE), 0);
            }
        }
        header.sum(2);
        [
            &header.bytes[..],
            &wave.numbers,
            wave.note.as_bytes(),
            &labels,
        ]
        .concat()
    }

    /// Returns a file of version 2 with these numbers, a note, and a distance of 2 between points.
    pub fn old_file(numbers: &[f64], order: Order) -> Vec<u8> {
        let mut header = Header {
            bytes: vec![0; 126],
            order,
        };
        let note = b"scan: 7\rby: hand";
        header.put(0, &2_u16.to_le_bytes());
        header.put(2, &(126 + 8 * numbers.len() as u32).to_le_bytes());
        header.put(6, &(note.len() as u32).to_le_bytes());
        header.put(16, &4_u16.to_le_bytes());
        header.put_text(16 + old_field::UNIT, b"nm");
        header.put_text(16 + old_field::UNIT_OF_X, b"um");
        header.put(
            16 + old_field::POINTS,
            &(numbers.len() as u32).to_le_bytes(),
        );
        header.put(16 + old_field::STEP, &2.0_f64.to_le_bytes());
        let numbers: Vec<u8> = numbers
            .iter()
            .flat_map(|number| in_order(*number, order))
            .collect();
        header.bytes.extend(&numbers);
        header.bytes.extend([0; PADDING]);
        header.sum(14);
        [&header.bytes[..], note].concat()
    }

    pub fn in_order(number: f64, order: Order) -> [u8; 8] {
        match order {
            Order::Little => number.to_le_bytes(),
            Order::Big => number.to_be_bytes(),
        }
    }

    #[test]
    fn waves_have_dimensions_units_labels_and_a_note() {
        for order in [Order::Little, Order::Big] {
            let numbers = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
            let wave = Written {
                counts: [2, 2, 2, 0],
                steps: [0.5, 0.25, 1.0, 1.0],
                unit: "m",
                units: ["um", "nm", "", ""],
                labels: [&[], &[], &["Height", "Phase"], &[]],
                note: "ScanSize: 2e-05\rInvOLS: 1e-07\rImagingMode:AC Mode",
                kind: 4,
                numbers: numbers
                    .iter()
                    .flat_map(|number| in_order(*number, order))
                    .collect(),
            };
            let bytes = file(&wave, order);
            assert!(is_igor_wave(&bytes));
            let found = IgorWave::parse(&bytes).unwrap();
            assert_eq!(found.numbers(0, 8).unwrap(), numbers);
            assert_eq!(found.numbers(4, 2).unwrap(), [5.0, 6.0]);
            assert!(found.numbers(4, 5).is_err());
            let [x, y, layers, _] = &found.dimensions;
            assert_eq!((x.count, x.step, &*x.unit), (2, 0.5, "um"));
            assert_eq!((y.count, y.step, &*y.unit), (2, 0.25, "nm"));
            assert_eq!(layers.labels, ["Height", "Phase"]);
            assert_eq!(
                (&*found.unit, found.entry("ImagingMode")),
                ("m", Some("AC Mode"))
            );
            assert_eq!(
                (found.number("ScanSize"), found.number("Size")),
                (Some(2e-5), None)
            );

            let bytes = old_file(&numbers, order);
            assert!(is_igor_wave(&bytes));
            let found = IgorWave::parse(&bytes).unwrap();
            assert_eq!(found.numbers(0, 8).unwrap(), numbers);
            assert_eq!((&*found.unit, found.entry("by")), ("nm", Some("hand")));
            let [x, y, ..] = &found.dimensions;
            assert_eq!((x.count, x.step, &*x.unit, y.count), (8, 2.0, "um", 0));
        }
    }

    #[test]
    fn numbers_have_any_real_type() {
        let read = |kind: u16, number: &[u8]| {
            let wave = Written {
                counts: [2, 0, 0, 0],
                kind,
                numbers: [number, number].concat(),
                ..Written::default()
            };
            let bytes = file(&wave, Order::Little);
            let found = IgorWave::parse(&bytes).map_err(|error| error.to_string())?;
            found.numbers(1, 1).map_err(|error| error.to_string())
        };
        for (kind, number, expected) in [
            (0x02, &1.5_f32.to_le_bytes()[..], 1.5),
            (0x04, &(-2.5_f64).to_le_bytes(), -2.5),
            (0x08, &[0xff], -1.0),
            (0x48, &[0xff], 255.0),
            (0x10, &[0xfe, 0xff], -2.0),
            (0x50, &[0xfe, 0xff], 65_534.0),
            (0x20, &[0xfd, 0xff, 0xff, 0xff], -3.0),
            (0x60, &[1, 0, 0, 1], 16_777_217.0),
        ] {
            assert_eq!(read(kind, number), Ok(vec![expected]), "{kind:x}");
        }
        for (kind, expected) in [
            (
                0x03,
                "byte 80: a wave of complex numbers; allowed: a wave of real",
            ),
            (0x00, "byte 80: a wave of texts"),
            (0x07, "byte 80: a wave of complex numbers"),
            (0x06, "byte 80: a wave of numbers of type 6"),
        ] {
            let error = read(kind, &[0; 8]).unwrap_err();
            assert!(error.starts_with(expected), "{error}");
        }
    }

    #[test]
    fn headers_that_contradict_the_file_are_refused() {
        let wave = Written {
            counts: [3, 2, 0, 0],
            kind: 2,
            numbers: vec![0; 24],
            note: "a: b",
            labels: [&[], &["x", "y"], &[], &[]],
            ..Written::default()
        };
        let whole = file(&wave, Order::Little);
        assert!(is_igor_wave(&whole));
        for end in 0..whole.len() {
            assert!(IgorWave::parse(&whole[..end]).is_err(), "{end}");
        }
        let mut changed = whole.clone();
        changed[64 + field::COUNTS] = 4;
        assert!(!is_igor_wave(&changed) && check_sum(&whole).is_ok());
        let error = check_sum(&changed).unwrap_err().to_string();
        assert!(
            error.starts_with("byte 2: headers of a binary wave"),
            "{error}"
        );
        let error = IgorWave::parse(&changed).unwrap_err().to_string();
        assert!(
            error.starts_with("byte 132: 6 numbers in [4.0, 2.0, 0.0, 0.0]"),
            "{error}"
        );
    }
}
