//! Reading of binary files: numbers and texts, and limits of the sizes of files.

use super::resolve::MOST_POINTS;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::gathered;
use encoding_rs::WINDOWS_1252;
use std::borrow::Cow;

/// Largest size of a file in bytes.
pub const MOST_BYTES: usize = 1 << 30;

/// Largest number of decompressed bytes for each byte of a file, if no header states the
/// decompressed size. The limit is generous: numbers written as text expand only by factors of
/// three to six.
pub(super) const MOST_EXPANSION: usize = 32;

/// Number of decompressed bytes that are allowed in any case, so that small files may expand more.
const LEAST_EXPANDED: usize = 1 << 20;

/// Returns the largest number of bytes to which `bytes` compressed bytes may be decompressed.
pub(super) fn most_expanded(bytes: usize) -> usize {
    bytes
        .saturating_mul(MOST_EXPANSION)
        .saturating_add(LEAST_EXPANDED)
}

/// Decodes text as UTF-8, or as Windows-1252 if the bytes are invalid in UTF-8.
pub(super) fn decoded(text: &[u8]) -> Cow<'_, str> {
    match str::from_utf8(text) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => WINDOWS_1252.decode_without_bom_handling(text).0,
    }
}

/// Returns the size in bytes that compressed points have after decompression. `points` is the
/// number of points that a header states, and `size` is the number of bytes of a point. Returns an
/// error if the result is above the limits.
pub(super) fn unpacked_size(
    points: usize,
    size: usize,
    place: Place,
) -> Result<usize, SurfaceError> {
    let bytes = points.saturating_mul(size);
    if points <= MOST_POINTS && bytes <= MOST_BYTES {
        return Ok(bytes);
    }
    let found = format!("{points} compressed heights of {size} bytes");
    let allowed = format!("at most {MOST_POINTS} heights and {MOST_BYTES} bytes");
    Err(refused(place, found, allowed))
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
            /// Returns the type of numbers that has this name in NumPy, such as `f8`; `None` if
            /// there is no such type.
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

            /// Returns the number that is encoded in `bytes`. There must be exactly [`Self::size`]
            /// bytes.
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

/// Returns the value of a half-precision number of 16 bits: a sign bit, 5 bits of an exponent and
/// 10 bits of a fraction.
fn half(bits: u16) -> f64 {
    let exponent = i32::from(bits >> 10 & 31);
    let fraction = f64::from(bits & 1023);
    let size = match exponent {
        0 => fraction * 2.0_f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + fraction) * 2.0_f64.powi(exponent - 25),
    };
    if bits >> 15 == 0 { size } else { -size }
}

/// Part of a binary file whose bytes are read one after another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bytes<'a> {
    /// Bytes of the file from its beginning to the end of the part.
    bytes: &'a [u8],
    /// Offset of the next byte to be read, counted from the beginning of the file.
    offset: usize,
    pub order: Order,
}

impl<'a> Bytes<'a> {
    pub fn new(bytes: &'a [u8], order: Order) -> Self {
        Bytes {
            bytes,
            offset: 0,
            order,
        }
    }

    /// Returns a reader of the bytes of a file, beginning at an offset.
    ///
    /// # Errors
    /// Returns an error if the file has fewer bytes than `offset`.
    pub fn from(bytes: &'a [u8], order: Order, offset: usize) -> Result<Self, SurfaceError> {
        let mut file = Bytes::new(bytes, order);
        file.take(offset)?;
        Ok(file)
    }

    /// Returns the place of the next byte in the file.
    pub fn place(&self) -> Place {
        Place::Byte(self.offset)
    }

    pub fn left(&self) -> usize {
        self.bytes.len() - self.offset
    }

    pub fn take(&mut self, count: usize) -> Result<&'a [u8], SurfaceError> {
        let left = &self.bytes[self.offset..];
        let Some(taken) = left.get(..count) else {
            let found = format!("{} bytes up to the end", left.len());
            let allowed = format!("at least {count} bytes");
            return Err(refused(self.place(), found, allowed));
        };
        self.offset += count;
        Ok(taken)
    }

    /// Returns a reader of the next `count` bytes, and skips these bytes in this reader. The places
    /// of bytes in the new reader are also counted from the beginning of the file.
    ///
    /// # Errors
    /// Returns an error if fewer than `count` bytes are left.
    pub fn part(&mut self, count: usize) -> Result<Bytes<'a>, SurfaceError> {
        let offset = self.offset;
        self.take(count)?;
        Ok(Bytes {
            bytes: &self.bytes[..self.offset],
            offset,
            order: self.order,
        })
    }

    pub fn number(&mut self, kind: Number) -> Result<f64, SurfaceError> {
        let bytes = self.take(kind.size())?;
        Ok(kind.value(bytes, self.order))
    }

    pub fn array<const N: usize>(&mut self, kind: Number) -> Result<[f64; N], SurfaceError> {
        let mut array = [0.0; N];
        for value in &mut array {
            *value = self.number(kind)?;
        }
        Ok(array)
    }

    /// Reads the next number, which is a size, an offset or a code. Returns 0 if the number is
    /// negative.
    ///
    /// # Errors
    /// Returns an error if too few bytes are left.
    pub fn size(&mut self, kind: Number) -> Result<usize, SurfaceError> {
        Ok(self.number(kind)? as usize)
    }

    pub fn numbers(&mut self, count: usize, kind: Number) -> Result<Vec<f64>, SurfaceError> {
        let bytes = self.take(count.saturating_mul(kind.size()))?;
        let numbers = bytes
            .chunks_exact(kind.size())
            .map(|bytes| kind.value(bytes, self.order));
        Ok(gathered(count, numbers)?)
    }

    /// Returns the bytes before the next zero byte, and skips the zero byte.
    ///
    /// # Errors
    /// Returns an error if no zero byte is left.
    pub fn text(&mut self) -> Result<&'a [u8], SurfaceError> {
        let left = &self.bytes[self.offset..];
        let Some(end) = left.iter().position(|byte| *byte == 0) else {
            let allowed = "a text that ends with a zero byte";
            return Err(refused(self.place(), "a text without an end", allowed));
        };
        let text = self.take(end)?;
        self.take(1)?;
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        for (number, mut bytes, value) in cases {
            assert_eq!(
                Bytes::new(&bytes, Order::Little)
                    .numbers(1, number)
                    .unwrap(),
                [value],
                "{number:?}"
            );
            bytes.reverse();
            assert_eq!(
                Bytes::new(&bytes, Order::Big).numbers(1, number).unwrap(),
                [value],
                "{number:?}"
            );
        }
    }
}
