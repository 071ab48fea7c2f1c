//! Numbers of binary files, each read only if the file has its bytes.

use super::error::{Place, TopographyError, gathered, refused};

/// Part of a binary file, read in sequence.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bytes<'a> {
    bytes: &'a [u8],
    at: usize,
}

/// Little-endian numbers of a fixed size.
macro_rules! numbers {
    ($($name:ident: $type:ty),*) => {
        $(pub fn $name(&mut self) -> Result<$type, TopographyError> {
            Ok(<$type>::from_le_bytes(self.array()?))
        })*
    };
}

impl<'a> Bytes<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Bytes { bytes, at: 0 }
    }

    numbers!(u16: u16, u32: u32, i32: i32, f32: f32, f64: f64);

    /// Big-endian number.
    pub fn big_u32(&mut self) -> Result<u32, TopographyError> {
        Ok(u32::from_be_bytes(self.array()?))
    }

    /// Big-endian number.
    pub fn big_u64(&mut self) -> Result<u64, TopographyError> {
        Ok(u64::from_be_bytes(self.array()?))
    }

    /// Offset from the beginning of the file.
    pub fn place(&self) -> Place {
        Place::Byte(self.at)
    }

    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The next `count` bytes.
    pub fn take(&mut self, count: usize) -> Result<&'a [u8], TopographyError> {
        let left = &self.bytes[self.at..];
        let taken = left.get(..count).ok_or_else(|| {
            refused(
                self.place(),
                format!("{} bytes up to the end", left.len()),
                format!("at least {count} bytes"),
            )
        })?;
        self.at += count;
        Ok(taken)
    }

    /// The next `count` bytes, with their places in the file.
    pub fn part(&mut self, count: usize) -> Result<Bytes<'a>, TopographyError> {
        let begin = self.at;
        self.take(count)?;
        Ok(Bytes { bytes: &self.bytes[..begin + count], at: begin })
    }

    /// The next `count` numbers of a type.
    pub fn numbers(&mut self, count: usize, of: Number, order: Order) -> Result<Vec<f64>, TopographyError> {
        let size = of.size();
        let bytes = count.checked_mul(size).ok_or_else(|| {
            refused(self.place(), format!("{count} points"), "as many as the file has bytes for")
        })?;
        let bytes = self.take(bytes)?;
        gathered(count, bytes.chunks_exact(size).map(|bytes| of.value(bytes, order)))
    }

    /// Bytes up to the next zero, which is skipped.
    pub fn text(&mut self) -> Result<&'a [u8], TopographyError> {
        let left = &self.bytes[self.at..];
        let end = left.iter().position(|byte| *byte == 0).ok_or_else(|| {
            refused(self.place(), "a text without an end", "a text that ends with a zero byte")
        })?;
        self.at += end + 1;
        Ok(&left[..end])
    }

    fn array<const SIZE: usize>(&mut self) -> Result<[u8; SIZE], TopographyError> {
        let mut array = [0; SIZE];
        array.copy_from_slice(self.take(SIZE)?);
        Ok(array)
    }
}

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F32,
    F64,
}

impl Number {
    /// Number of bytes.
    pub fn size(self) -> usize {
        match self {
            Number::U8 | Number::I8 => 1,
            Number::U16 | Number::I16 => 2,
            Number::U32 | Number::I32 | Number::F32 => 4,
            Number::U64 | Number::I64 | Number::F64 => 8,
        }
    }

    /// Value of the bytes, [`Self::size`] of them.
    fn value(self, bytes: &[u8], order: Order) -> f64 {
        let mut little = [0; 8];
        little[..bytes.len()].copy_from_slice(bytes);
        if order == Order::Big {
            little[..bytes.len()].reverse();
        }
        let bits = u64::from_le_bytes(little);
        match self {
            Number::U8 | Number::U16 | Number::U32 | Number::U64 => bits as f64,
            Number::I8 => f64::from(bits as u8 as i8),
            Number::I16 => f64::from(bits as u16 as i16),
            Number::I32 => f64::from(bits as u32 as i32),
            Number::I64 => bits as i64 as f64,
            Number::F32 => f64::from(f32::from_bits(bits as u32)),
            Number::F64 => f64::from_bits(bits),
        }
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
            assert_eq!(Bytes::new(&bytes).numbers(1, of, Order::Little).unwrap(), [value], "{of:?}");
            bytes.reverse();
            assert_eq!(Bytes::new(&bytes).numbers(1, of, Order::Big).unwrap(), [value], "{of:?}");
        }
    }

    #[test]
    fn no_byte_beyond_the_end_is_read() {
        let mut bytes = Bytes::new(b"ab\0cd");
        assert_eq!(bytes.text().unwrap(), b"ab");
        let error = bytes.f64().unwrap_err();
        assert_eq!(error.to_string(), "byte 3: 2 bytes up to the end; allowed: at least 8 bytes");
        assert!(bytes.numbers(usize::MAX, Number::F64, Order::Little).is_err());
        assert!(bytes.text().unwrap_err().to_string().starts_with("byte 3: a text without an end"));
    }
}
