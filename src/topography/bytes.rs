//! Numbers of binary files, each read only if the file has its bytes, and the limits of their decompression.

use super::error::{Place, TopographyError, gathered, refused};

/// Decompressed bytes allowed per byte of the file: texts of numbers expand by factors of three to six.
pub(super) const MOST_EXPANSION: usize = 32;

/// Decompressed bytes allowed in addition.
const LEAST_EXPANDED: usize = 1 << 20;

/// Returns the largest allowed number of bytes decompressed from a number of compressed bytes.
pub(super) fn most_expanded(bytes: usize) -> usize {
    bytes.saturating_mul(MOST_EXPANSION).saturating_add(LEAST_EXPANDED)
}

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

macro_rules! numbers {
    ($($name:ident: $type:ty),*) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Number {
            $($name),*
        }

        impl Number {
            /// Returns the number of bytes.
            pub fn size(self) -> usize {
                match self {
                    $(Number::$name => size_of::<$type>()),*
                }
            }

            /// Returns the value of the bytes, [`Self::size`] of them.
            fn value(self, bytes: &[u8], order: Order) -> f64 {
                match self {
                    $(Number::$name => {
                        let mut little = [0; size_of::<$type>()];
                        little.copy_from_slice(bytes);
                        if order == Order::Big {
                            little.reverse();
                        }
                        <$type>::from_le_bytes(little) as f64
                    })*
                }
            }
        }
    };
}

numbers!(U8: u8, I8: i8, U16: u16, I16: i16, U32: u32, I32: i32, U64: u64, I64: i64, F32: f32, F64: f64);

/// Part of a binary file, read in sequence.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bytes<'a> {
    bytes: &'a [u8],
    at: usize,
    pub order: Order,
}

impl<'a> Bytes<'a> {
    pub fn new(bytes: &'a [u8], order: Order) -> Self {
        Bytes { bytes, at: 0, order }
    }

    /// Offset from the beginning of the file.
    pub fn place(&self) -> Place {
        Place::Byte(self.at)
    }

    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Returns the next `count` bytes.
    pub fn take(&mut self, count: usize) -> Result<&'a [u8], TopographyError> {
        let left = &self.bytes[self.at..];
        let taken = left.get(..count).ok_or_else(|| {
            let fault = format!("{} bytes up to the end", left.len());
            refused(self.place(), fault, format!("at least {count} bytes"))
        })?;
        self.at += count;
        Ok(taken)
    }

    /// Returns the next `count` bytes, with their places in the file.
    pub fn part(&mut self, count: usize) -> Result<Bytes<'a>, TopographyError> {
        let at = self.at;
        self.take(count)?;
        Ok(Bytes { bytes: &self.bytes[..self.at], at, order: self.order })
    }

    /// Returns the next number.
    pub fn number(&mut self, of: Number) -> Result<f64, TopographyError> {
        Ok(of.value(self.take(of.size())?, self.order))
    }

    /// Returns the next N numbers.
    pub fn array<const N: usize>(&mut self, of: Number) -> Result<[f64; N], TopographyError> {
        let mut array = [0.0; N];
        for value in &mut array {
            *value = self.number(of)?;
        }
        Ok(array)
    }

    /// Returns the next number as a size, an offset or a code; 0 for a negative one.
    pub fn size(&mut self, of: Number) -> Result<usize, TopographyError> {
        Ok(self.number(of)? as usize)
    }

    /// Returns the next `count` numbers of a type.
    pub fn numbers(&mut self, count: usize, of: Number) -> Result<Vec<f64>, TopographyError> {
        let bytes = self.take(count.saturating_mul(of.size()))?;
        gathered(count, bytes.chunks_exact(of.size()).map(|bytes| of.value(bytes, self.order)))
    }

    /// Returns the bytes up to the next zero, which is skipped.
    pub fn text(&mut self) -> Result<&'a [u8], TopographyError> {
        let end = self.bytes[self.at..].iter().position(|byte| *byte == 0).ok_or_else(|| {
            refused(self.place(), "a text without an end", "a text that ends with a zero byte")
        })?;
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
        let cases: [(Number, Vec<u8>, f64); 6] = [
            (Number::U8, vec![200], 200.0),
            (Number::I8, vec![200], -56.0),
            (Number::I16, (-2_i16).to_le_bytes().into(), -2.0),
            (Number::U32, u32::MAX.to_le_bytes().into(), 4_294_967_295.0),
            (Number::F32, 1.5_f32.to_le_bytes().into(), 1.5),
            (Number::F64, (-0.1_f64).to_le_bytes().into(), -0.1),
        ];
        for (of, mut bytes, value) in cases {
            assert_eq!(Bytes::new(&bytes, Order::Little).numbers(1, of).unwrap(), [value], "{of:?}");
            bytes.reverse();
            assert_eq!(Bytes::new(&bytes, Order::Big).numbers(1, of).unwrap(), [value], "{of:?}");
        }
    }
}
