//! Those parts of the format TIFF that makers of microscopes use: directories of tags, and images
//! without compression that have one number for each point.

use super::bytes::{Bytes, Number, Order, decoded};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::gathered;
use std::borrow::Cow;

pub(super) const SIGNATURES: [&[u8]; 2] = [b"II*\0", b"MM\0*"];

/// Largest number of directories that are read. This limit also ends the reading of a file in which
/// directories refer to each other in a circle.
const MOST_DIRECTORIES: usize = 1_024;

/// Size in bytes of the entry of a tag in a directory.
const TAG_SIZE: usize = 12;

/// Largest size in bytes of a value that is stored in the directory itself. A larger value is
/// stored elsewhere in the file.
const INLINE: usize = 4;

/// Numbers of the tags that describe an image.
mod tag {
    pub const WIDTH: u16 = 256;
    pub const LENGTH: u16 = 257;
    pub const BITS: u16 = 258;
    pub const COMPRESSION: u16 = 259;
    pub const STRIP_OFFSETS: u16 = 273;
    pub const SAMPLES: u16 = 277;
    pub const STRIP_SIZES: u16 = 279;
    pub const PREDICTOR: u16 = 317;
    pub const SAMPLE_FORMAT: u16 = 339;
}

/// Returns all directories of a file.
pub(super) fn directories(bytes: &[u8]) -> Result<Vec<Directory<'_>>, SurfaceError> {
    let order = if bytes.starts_with(SIGNATURES[0]) {
        Order::Little
    } else {
        Order::Big
    };
    let mut next = Bytes::from(bytes, order, SIGNATURES[0].len())?;
    let mut directories = Vec::new();
    while directories.len() < MOST_DIRECTORIES {
        let offset = next.size(Number::U32)?;
        if offset == 0 {
            break;
        }
        let mut directory = Bytes::from(bytes, order, offset)?;
        let count = directory.size(Number::U16)?;
        let mut tags = directory;
        let tags = tags.part(count.saturating_mul(TAG_SIZE))?;
        next = Bytes::from(bytes, order, offset + 2 + count * TAG_SIZE)?;
        directories.push(Directory { bytes, tags });
    }
    Ok(directories)
}

/// A directory of a TIFF file, which contains the tags of one image.
pub(super) struct Directory<'a> {
    /// Content of the whole file.
    bytes: &'a [u8],
    tags: Bytes<'a>,
}

/// Value of a tag: numbers, or the bytes of a text.
struct Value<'a> {
    /// Type of the numbers; `None` if the value is not a list of numbers.
    kind: Option<Number>,
    count: usize,
    content: Bytes<'a>,
}

/// Returns the type of the numbers of a tag, from its code in TIFF; `None` if the code is not that
/// of a type of numbers.
fn number_of(kind: usize) -> Option<Number> {
    match kind {
        1 | 7 => Some(Number::U8),
        3 => Some(Number::U16),
        4 => Some(Number::U32),
        6 => Some(Number::I8),
        8 => Some(Number::I16),
        9 => Some(Number::I32),
        11 => Some(Number::F32),
        12 => Some(Number::F64),
        _ => None,
    }
}

impl<'a> Directory<'a> {
    /// Returns the place of the directory in the file, which error messages state.
    pub fn place(&self) -> Place {
        self.tags.place()
    }

    /// Returns the value of a tag; `None` if the directory has no such tag.
    fn value(&self, tag: u16) -> Result<Option<Value<'a>>, SurfaceError> {
        let mut tags = self.tags;
        while tags.left() >= TAG_SIZE {
            let found = tags.size(Number::U16)?;
            let kind = tags.size(Number::U16)?;
            let count = tags.size(Number::U32)?;
            let mut inline = tags.part(INLINE)?;
            if found != usize::from(tag) {
                continue;
            }
            let kind = number_of(kind);
            let size = kind.map_or(1, Number::size).saturating_mul(count);
            let content = if size <= INLINE {
                inline.part(size)?
            } else {
                let offset = inline.size(Number::U32)?;
                Bytes::from(self.bytes, self.tags.order, offset)?.part(size)?
            };
            return Ok(Some(Value {
                kind,
                count,
                content,
            }));
        }
        Ok(None)
    }

    /// Returns the first number in the value of a tag; `None` if the directory has no such tag.
    ///
    /// # Errors
    /// Returns an error if the value lies beyond the end of the file.
    pub fn number(&self, tag: u16) -> Result<Option<f64>, SurfaceError> {
        let Some(mut value) = self.value(tag)? else {
            return Ok(None);
        };
        match value.kind {
            Some(kind) if value.count > 0 => value.content.number(kind).map(Some),
            _ => Ok(None),
        }
    }

    /// Returns the value of a tag as a text; `None` if the directory has no such tag.
    ///
    /// # Errors
    /// Returns an error if the value lies beyond the end of the file.
    pub fn text(&self, tag: u16) -> Result<Option<Cow<'a, str>>, SurfaceError> {
        let Some(value) = self.value(tag)? else {
            return Ok(None);
        };
        let mut content = value.content;
        let text = content.take(content.left())?;
        let end = text.iter().position(|byte| *byte == 0);
        Ok(Some(decoded(&text[..end.unwrap_or(text.len())])))
    }

    /// Returns the value of a tag as bytes; `None` if the directory has no such tag.
    ///
    /// # Errors
    /// Returns an error if the value lies beyond the end of the file.
    pub fn content(&self, tag: u16) -> Result<Option<Bytes<'a>>, SurfaceError> {
        Ok(self.value(tag)?.map(|value| value.content))
    }

    /// Returns the number of a tag whose value is a size or a code. Returns `otherwise` if the
    /// directory has no such tag.
    fn code(&self, tag: u16, otherwise: usize) -> Result<usize, SurfaceError> {
        let number = self.number(tag)?;
        Ok(number.map_or(otherwise, |number| number as usize))
    }

    fn refused(&self, found: String, allowed: &str) -> SurfaceError {
        refused(self.place(), found, allowed)
    }

    /// Returns the number of points in a row of the image; 0 if the directory does not state it.
    ///
    /// # Errors
    /// Returns an error if the value lies beyond the end of the file.
    pub fn columns(&self) -> Result<usize, SurfaceError> {
        self.code(tag::WIDTH, 0)
    }

    /// Returns the type of the numbers of the image.
    fn number_type(&self) -> Result<Number, SurfaceError> {
        let bits = self.code(tag::BITS, 1)?;
        let format = self.code(tag::SAMPLE_FORMAT, 1)?;
        match (format, bits) {
            (1, 16) => Ok(Number::U16),
            (1, 32) => Ok(Number::U32),
            (2, 16) => Ok(Number::I16),
            (2, 32) => Ok(Number::I32),
            (3, 32) => Ok(Number::F32),
            (3, 64) => Ok(Number::F64),
            _ => {
                let found = format!("an image of {bits} bits for each point in format {format}");
                let allowed = "integers of 16 or 32 bits, or real numbers of 32 or 64 bits";
                Err(self.refused(found, allowed))
            }
        }
    }

    /// Returns the numbers of the image, row by row in the order of the file.
    ///
    /// # Errors
    /// Returns an error if the image has a form that cannot be read, or if bytes are missing.
    pub fn image(&self) -> Result<Vec<f64>, SurfaceError> {
        for (tag, name) in [
            (tag::COMPRESSION, "compression"),
            (tag::PREDICTOR, "predictor"),
            (tag::SAMPLES, "samples"),
        ] {
            let code = self.code(tag, 1)?;
            if code != 1 {
                let found = format!("an image with {name} = {code}");
                let allowed = "an image of one number for each point, without compression; others \
                               saved as GWY or X3P in Gwyddion";
                return Err(self.refused(found, allowed));
            }
        }
        let kind = self.number_type()?;
        let rows = self.code(tag::LENGTH, 0)?;
        let points = self.columns()?.saturating_mul(rows);
        let strips = (
            self.value(tag::STRIP_OFFSETS)?,
            self.value(tag::STRIP_SIZES)?,
        );
        let (Some(offsets), Some(sizes)) = strips else {
            return Err(self.refused("an image without numbers".to_owned(), "strips of numbers"));
        };
        // Strips of an image may overlap, so their sizes prove nothing. The size of the image is
        // therefore compared with that of the file.
        let size = points.saturating_mul(kind.size());
        if points == 0 || size > self.bytes.len() {
            let found = format!("an image of {points} points in {} bytes", self.bytes.len());
            return Err(self.refused(found, "as many bytes as the points have, above 0"));
        }
        let mut numbers = gathered(points, std::iter::empty())?;
        let mut strips = Strips::new(self, offsets, sizes);
        while numbers.len() < points {
            let Some(mut strip) = strips.next(points - numbers.len(), kind)? else {
                let found = format!("{} of {points} points in the strips", numbers.len());
                return Err(self.refused(found, "a number for each point"));
            };
            while strip.left() >= kind.size() {
                numbers.push(strip.number(kind)?);
            }
        }
        Ok(numbers)
    }
}

/// Strips of an image, which are read one after another.
struct Strips<'a> {
    bytes: &'a [u8],
    order: Order,
    offsets: Value<'a>,
    sizes: Value<'a>,
}

impl<'a> Strips<'a> {
    fn new(directory: &Directory<'a>, offsets: Value<'a>, sizes: Value<'a>) -> Self {
        Strips {
            bytes: directory.bytes,
            order: directory.tags.order,
            offsets,
            sizes,
        }
    }

    /// Returns the next strip, but at most `most` numbers of it; `None` after the last strip.
    fn next(&mut self, most: usize, kind: Number) -> Result<Option<Bytes<'a>>, SurfaceError> {
        let Some(offset) = self.offsets.next_size()? else {
            return Ok(None);
        };
        let Some(size) = self.sizes.next_size()? else {
            return Ok(None);
        };
        let size = size.min(most.saturating_mul(kind.size()));
        let strip = Bytes::from(self.bytes, self.order, offset)?.part(size)?;
        Ok(Some(strip))
    }
}

impl Value<'_> {
    /// Returns the next number of the value as a size or an offset.
    fn next_size(&mut self) -> Result<Option<usize>, SurfaceError> {
        match self.kind {
            Some(kind) if self.content.left() >= kind.size() => self.content.size(kind).map(Some),
            _ => Ok(None),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A tag that a test writes.
    pub struct Tag {
        pub tag: u16,
        pub kind: u16,
        pub content: Vec<u8>,
    }

    /// Writer of a file in either order of bytes, for tests.
    pub struct Writer {
        pub order: Order,
    }

    impl Writer {
        fn bytes(&self, little: &[u8]) -> Vec<u8> {
            let mut bytes = little.to_vec();
            if self.order == Order::Big {
                bytes.reverse();
            }
            bytes
        }

        pub fn short(&self, tag: u16, number: u16) -> Tag {
            let content = self.bytes(&number.to_le_bytes());
            Tag {
                tag,
                kind: 3,
                content,
            }
        }

        pub fn long(&self, tag: u16, numbers: &[u32]) -> Tag {
            let bytes = numbers.iter().flat_map(|n| self.bytes(&n.to_le_bytes()));
            Tag {
                tag,
                kind: 4,
                content: bytes.collect(),
            }
        }

        pub fn double(&self, tag: u16, number: f64) -> Tag {
            let content = self.bytes(&number.to_le_bytes());
            Tag {
                tag,
                kind: 12,
                content,
            }
        }

        pub fn text(&self, tag: u16, text: &str) -> Tag {
            Tag {
                tag,
                kind: 2,
                content: [text.as_bytes(), b"\0"].concat(),
            }
        }

        /// Appends an image of integers to the file, and returns the tags of this image. The
        /// integers have 16 or 32 bits. Each strip of the image has one row of three points.
        pub fn image(&self, file: &mut Vec<u8>, numbers: &[i32], bits: u16) -> Vec<Tag> {
            let row = 3 * u32::from(bits) / 8;
            let mut offsets = Vec::new();
            for numbers in numbers.chunks(3) {
                offsets.push(file.len() as u32);
                for number in numbers {
                    let little = number.to_le_bytes();
                    file.extend(self.bytes(&little[..usize::from(bits) / 8]));
                }
            }
            vec![
                self.long(256, &[3]),
                self.long(257, &[offsets.len() as u32]),
                self.short(258, bits),
                self.short(259, 1),
                self.short(262, 1),
                self.long(273, &offsets),
                self.short(277, 1),
                self.long(278, &[1]),
                self.long(279, &vec![row; offsets.len()]),
                self.short(339, 2),
            ]
        }

        pub fn begin(&self) -> Vec<u8> {
            let signature = match self.order {
                Order::Little => SIGNATURES[0],
                Order::Big => SIGNATURES[1],
            };
            [signature, &[0; 4]].concat()
        }

        /// Appends a directory to the file and writes its offset to the place `link`. Returns the
        /// place to which the offset of the next directory is to be written.
        pub fn directory(&self, file: &mut Vec<u8>, link: usize, tags: &[Tag]) -> usize {
            let mut entries = Vec::new();
            for tag in tags {
                let size = match tag.kind {
                    3 => 2,
                    4 => 4,
                    12 => 8,
                    _ => 1,
                };
                entries.extend(self.bytes(&tag.tag.to_le_bytes()));
                entries.extend(self.bytes(&tag.kind.to_le_bytes()));
                entries.extend(self.bytes(&((tag.content.len() / size) as u32).to_le_bytes()));
                if tag.content.len() <= 4 {
                    entries.extend(&tag.content);
                    entries.resize(entries.len() + 4 - tag.content.len(), 0);
                } else {
                    entries.extend(self.bytes(&(file.len() as u32).to_le_bytes()));
                    file.extend(&tag.content);
                }
            }
            let offset = file.len() as u32;
            file[link..link + 4].copy_from_slice(&self.bytes(&offset.to_le_bytes()));
            file.extend(self.bytes(&(tags.len() as u16).to_le_bytes()));
            file.extend(entries);
            file.extend([0; 4]);
            file.len() - 4
        }
    }

    const LITTLE: Writer = Writer {
        order: Order::Little,
    };

    /// Makes a file with one image whose tags are changed by `change`, and reads its numbers.
    fn image(change: impl FnOnce(&mut Vec<Tag>)) -> Result<Vec<f64>, String> {
        let mut file = LITTLE.begin();
        let mut tags = LITTLE.image(&mut file, &[1, -2, 3, 4, 5, 6], 16);
        change(&mut tags);
        LITTLE.directory(&mut file, 4, &tags);
        let found = directories(&file).and_then(|directories| directories[0].image());
        found.map_err(|error| error.to_string())
    }

    #[test]
    fn images_have_one_number_for_each_point() {
        assert_eq!(image(|_| ()).unwrap(), [1.0, -2.0, 3.0, 4.0, 5.0, 6.0]);
        let set = |tag: u16, value: u16| {
            let error = image(|tags| {
                tags.retain(|other| other.tag != tag);
                tags.push(LITTLE.short(tag, value));
            });
            error.unwrap_err()
        };
        for (tag, value, expected) in [
            (
                259,
                5,
                "an image with compression = 5; allowed: an image of one number",
            ),
            (277, 3, "an image with samples = 3"),
            (317, 2, "an image with predictor = 2"),
            (258, 8, "an image of 8 bits for each point in format 2"),
            (257, 60_000, "an image of 180000 points in 162 bytes"),
            (257, 3, "6 of 9 points in the strips"),
            (256, 0, "an image of 0 points"),
            (273, 60_000, "byte 0: "),
        ] {
            let error = set(tag, value);
            assert!(error.contains(expected), "{expected}: {error}");
        }
        let error = image(|tags| tags.retain(|tag| tag.tag != 273)).unwrap_err();
        assert!(error.contains("an image without numbers"), "{error}");
    }

    #[test]
    fn a_circle_of_directories_ends() {
        let mut file = LITTLE.begin();
        let tags = LITTLE.image(&mut file, &[1, 2, 3], 16);
        let link = LITTLE.directory(&mut file, 4, &tags);
        assert_eq!(directories(&file).unwrap().len(), 1);
        // The directory states its own offset as that of the next directory.
        let own = file[4..8].to_vec();
        file[link..].copy_from_slice(&own);
        assert_eq!(directories(&file).unwrap().len(), MOST_DIRECTORIES);
        for end in 4..file.len() {
            assert!(directories(&file[..end]).is_err(), "{end}");
        }
    }
}
