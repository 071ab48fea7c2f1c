//! Bounded reading of binary files: numbers, decompression and ZIP archives in memory, each within
//! limits.

use super::reading::MOST_POINTS;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{gathered, read_limited, shown};
use encoding_rs::WINDOWS_1252;
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Cursor;
use zip::ZipArchive;

/// Largest size of a file in bytes.
pub const MOST_BYTES: usize = 1 << 30;

/// Number of decompressed bytes allowed for each byte of the file where no header states their
/// number. Numbers as text expand by factors of three to six.
pub(super) const MOST_EXPANSION: usize = 32;

/// Number of decompressed bytes allowed on top of that.
const LEAST_EXPANDED: usize = 1 << 20;

/// Returns the largest allowed number of bytes after decompression of `bytes` bytes.
pub(super) fn most_expanded(bytes: usize) -> usize {
    bytes
        .saturating_mul(MOST_EXPANSION)
        .saturating_add(LEAST_EXPANDED)
}

/// Decodes text as UTF-8, or if it is invalid as Windows-1252.
pub(super) fn decoded(text: &[u8]) -> Cow<'_, str> {
    let other = |_| WINDOWS_1252.decode_without_bom_handling(text).0;
    str::from_utf8(text).map_or_else(other, Cow::Borrowed)
}

/// Returns the size in bytes of compressed points of `size` bytes from their number in a header.
/// Refuses a size above the limits.
pub(super) fn unpacked_size(
    points: usize,
    size: usize,
    place: Place,
) -> Result<usize, SurfaceError> {
    let bytes = points.saturating_mul(size);
    if points <= MOST_POINTS && bytes <= MOST_BYTES {
        return Ok(bytes);
    }
    let fault = format!("{points} compressed heights of {size} bytes");
    Err(refused(
        place,
        fault,
        format!("at most {MOST_POINTS} heights and {MOST_BYTES} bytes"),
    ))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

macro_rules! numbers {
    ($($name:ident $code:literal: $type:ty $(= $value:path)?),*) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Number {
            $($name),*
        }

        impl Number {
            /// Returns the type that NumPy calls by this name.
            pub fn named(name: &str) -> Option<Number> {
                match name {
                    $($code => Some(Number::$name),)*
                    _ => None,
                }
            }

            pub fn size(self) -> usize {
                match self {
                    $(Number::$name => size_of::<$type>()),*
                }
            }

            /// Returns the number that the bytes encode; their count is [`Self::size`].
            fn value(self, bytes: &[u8], order: Order) -> f64 {
                match self {
                    $(Number::$name => {
                        let mut little = [0; size_of::<$type>()];
                        little.copy_from_slice(bytes);
                        if order == Order::Big {
                            little.reverse();
                        }
                        let value = <$type>::from_le_bytes(little);
                        $(let value = $value(value);)?
                        value as f64
                    })*
                }
            }
        }
    };
}

numbers!(U8 "u1": u8, I8 "i1": i8, U16 "u2": u16, I16 "i2": i16, U32 "u4": u32, I32 "i4": i32, U64 "u8": u64,
    I64 "i8": i64, F16 "f2": u16 = half, F32 "f4": f32, F64 "f8": f64);

/// Returns the half-precision number of 16 bits: the sign, 5 bits of an exponent, 10 bits of a
/// fraction.
fn half(bits: u16) -> f64 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023));
    let size = match exponent {
        0 => fraction * 2.0_f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + fraction) * 2.0_f64.powi(exponent - 25),
    };
    if bits >> 15 == 0 { size } else { -size }
}

/// Part of a binary file, read in sequence.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bytes<'a> {
    bytes: &'a [u8],
    at: usize,
    pub order: Order,
}

impl<'a> Bytes<'a> {
    pub fn new(bytes: &'a [u8], order: Order) -> Self {
        Bytes {
            bytes,
            at: 0,
            order,
        }
    }

    /// Returns the place of the next byte in the file.
    pub fn place(&self) -> Place {
        Place::Byte(self.at)
    }

    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    pub fn take(&mut self, count: usize) -> Result<&'a [u8], SurfaceError> {
        let left = &self.bytes[self.at..];
        let taken = left.get(..count).ok_or_else(|| {
            let fault = format!("{} bytes up to the end", left.len());
            refused(self.place(), fault, format!("at least {count} bytes"))
        })?;
        self.at += count;
        Ok(taken)
    }

    /// Returns the next `count` bytes as a part of the file that keeps their places.
    pub fn part(&mut self, count: usize) -> Result<Bytes<'a>, SurfaceError> {
        let at = self.at;
        self.take(count)?;
        Ok(Bytes {
            bytes: &self.bytes[..self.at],
            at,
            order: self.order,
        })
    }

    pub fn number(&mut self, of: Number) -> Result<f64, SurfaceError> {
        Ok(of.value(self.take(of.size())?, self.order))
    }

    pub fn array<const N: usize>(&mut self, of: Number) -> Result<[f64; N], SurfaceError> {
        let mut array = [0.0; N];
        for value in &mut array {
            *value = self.number(of)?;
        }
        Ok(array)
    }

    /// Returns the next number as a size, an offset or a code; 0 for a negative one.
    pub fn size(&mut self, of: Number) -> Result<usize, SurfaceError> {
        Ok(self.number(of)? as usize)
    }

    pub fn numbers(&mut self, count: usize, of: Number) -> Result<Vec<f64>, SurfaceError> {
        let bytes = self.take(count.saturating_mul(of.size()))?;
        Ok(gathered(
            count,
            bytes
                .chunks_exact(of.size())
                .map(|bytes| of.value(bytes, self.order)),
        )?)
    }

    /// Returns the bytes up to the next zero, which is skipped.
    pub fn text(&mut self) -> Result<&'a [u8], SurfaceError> {
        let end = self.bytes[self.at..]
            .iter()
            .position(|byte| *byte == 0)
            .ok_or_else(|| {
                refused(
                    self.place(),
                    "a text without an end",
                    "a text that ends with a zero byte",
                )
            })?;
        let text = self.take(end)?;
        self.take(1)?;
        Ok(text)
    }
}

pub(super) const ZIP: &[u8] = b"PK\x03\x04";

pub(super) struct Archive<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    /// Index in the archive of each file, by its [`plain_name`].
    places: HashMap<String, usize>,
    /// Folder of the index file; names of other files are relative to it.
    folder: String,
    /// Number of bytes to which further files of unknown size may still expand.
    most: usize,
}

/// Returns the name of a file in an archive in one spelling: with slashes between folders and
/// without `.`.
fn plain_name(name: &str) -> String {
    let parts = name
        .split(['/', '\\'])
        .filter(|part| !matches!(*part, "" | "."));
    parts.collect::<Vec<_>>().join("/")
}

impl<'a> Archive<'a> {
    pub fn new(bytes: &'a [u8]) -> Result<Self, SurfaceError> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| {
            refused(
                Place::File,
                format!("a damaged archive ({error})"),
                "an archive of ZIP",
            )
        })?;
        let named = |place: usize| Some((plain_name(&archive.name_for_index(place)?.ok()?), place));
        let places = (0..archive.len()).filter_map(named).collect();
        Ok(Archive {
            archive,
            places,
            folder: String::new(),
            most: most_expanded(bytes.len()),
        })
    }

    /// Returns the one of `names` that is the index of the archive, the file of such a name nearest
    /// to the root. Names of other files are then relative to its folder.
    pub fn index(&mut self, names: &[&'static str]) -> Result<Option<&'static str>, SurfaceError> {
        let of_path = |path: &String| {
            let (folder, file) = path.rsplit_once('/').unwrap_or(("", path));
            let name = names.iter().position(|name| *name == file)?;
            Some((path.matches('/').count(), name, folder.to_owned()))
        };
        let mut found: Vec<_> = self.places.keys().filter_map(of_path).collect();
        found.sort();
        if let [(depth, name, one), (other_depth, other_name, other), ..] = &found[..]
            && (depth, name) == (other_depth, other_name)
        {
            let fault = format!(
                "{} in the folders {} and {}",
                names[*name],
                shown(one),
                shown(other)
            );
            return Err(refused(
                Place::File,
                fault,
                "an archive with one surface, or a container",
            ));
        }
        Ok(found.into_iter().next().map(|(_, name, folder)| {
            self.folder = folder;
            names[name]
        }))
    }

    /// Returns the names of all files in one spelling.
    pub fn names(&self) -> impl Iterator<Item = &str> + Clone {
        self.places.keys().map(String::as_str)
    }

    /// Returns the content of a file of unknown size, at most `most` bytes.
    pub fn unpacked(&mut self, name: &str, most: usize) -> Result<Vec<u8>, SurfaceError> {
        let content = self.unpacked_up_to(name, most.min(self.most))?;
        self.most -= content.len();
        Ok(content)
    }

    /// Returns the content of a file that a header states to have at most `most` bytes.
    pub fn unpacked_up_to(&mut self, name: &str, most: usize) -> Result<Vec<u8>, SurfaceError> {
        let damaged = |error: &dyn std::fmt::Display| {
            let fault = format!("cannot be unpacked ({error})");
            refused(
                Place::Part(name.to_owned()),
                fault,
                "a file stored or deflated",
            )
        };
        let place = self
            .places
            .get(&plain_name(&format!("{}/{name}", self.folder)))
            .ok_or_else(|| {
                let fault = format!("no file {} in the archive", shown(name));
                refused(
                    Place::File,
                    fault,
                    "an archive with all files that it names",
                )
            })?;
        let entry = self
            .archive
            .by_index(*place)
            .map_err(|error| damaged(&error))?;
        read_limited(entry, most).map_err(|error| damaged(&error))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use std::io::Write;
    use zip::write::SimpleFileOptions;

    #[test]
    fn numbers_have_their_values_in_either_order() {
        let cases: [(Number, Vec<u8>, f64); 9] = [
            (Number::U8, vec![200], 200.0),
            (Number::I8, vec![200], -56.0),
            (Number::I16, (-2_i16).to_le_bytes().into(), -2.0),
            (Number::U32, u32::MAX.to_le_bytes().into(), 4_294_967_295.0),
            (Number::F16, vec![0, 0xbe], -1.5),
            (Number::F16, vec![1, 0], 2.0_f64.powi(-24)),
            (Number::F16, vec![0xff, 0x7b], 65_504.0),
            (Number::F32, 1.5_f32.to_le_bytes().into(), 1.5),
            (Number::F64, (-0.1_f64).to_le_bytes().into(), -0.1),
        ];
        for (of, mut bytes, value) in cases {
            assert_eq!(
                Bytes::new(&bytes, Order::Little).numbers(1, of).unwrap(),
                [value],
                "{of:?}"
            );
            bytes.reverse();
            assert_eq!(
                Bytes::new(&bytes, Order::Big).numbers(1, of).unwrap(),
                [value],
                "{of:?}"
            );
        }
    }

    pub fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, content) in files {
            writer
                .start_file(*name, SimpleFileOptions::default())
                .unwrap();
            writer.write_all(content).unwrap();
        }
        writer.finish().unwrap().into_inner()
    }

    #[test]
    fn files_of_an_archive_expand_to_a_limit_together() {
        let zeros = vec![0; 1 << 20];
        let bytes = archive(&[("one", &zeros), ("two", &zeros)]);
        let mut archive = Archive::new(&bytes).unwrap();
        assert!(archive.unpacked("one", usize::MAX).is_ok());
        let error = archive.unpacked("two", usize::MAX).unwrap_err().to_string();
        assert!(
            error.starts_with("two: cannot be unpacked (longer than"),
            "{error}"
        );
        let error = archive.unpacked("three", 1).unwrap_err().to_string();
        assert!(error.starts_with("no file three in the archive"), "{error}");
        let error = Archive::new(b"PK\x03\x04").err().unwrap().to_string();
        assert!(error.starts_with("a damaged archive"), "{error}");
    }
}
