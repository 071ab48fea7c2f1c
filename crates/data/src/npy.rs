//! Header of a NumPy file (`.npy`), which states the type, the order and the shape of its array.

use std::io;
use std::io::Write;

/// First bytes of a NumPy file.
pub const SIGNATURE: &[u8] = b"\x93NUMPY";

/// Version 1.0 of the format, in which two bytes state the length of the header.
const SHORT_HEADER: [u8; 2] = [1, 0];

/// Number of bytes before the header in version 1.0.
const PREFIX: usize = SIGNATURE.len() + SHORT_HEADER.len() + 2;

/// The bytes before the header and the header together are a multiple of this number of bytes.
const ALIGNMENT: usize = 64;

/// Writes the signature and the header of a NumPy file. `descr` is the type of a value in Python's
/// notation, such as `'<f8'`. `shape` contains the lengths of the axes as in a Python tuple, but
/// without brackets: `100,` or `3, 100`.
///
/// # Errors
/// Returns an error if `out` cannot be written.
pub fn write_header(out: &mut (impl Write + ?Sized), descr: &str, shape: &str) -> io::Result<()> {
    let mut header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': ({shape}), }}");
    let length = (PREFIX + header.len() + 1).next_multiple_of(ALIGNMENT) - PREFIX;
    header.extend(std::iter::repeat_n(' ', length - header.len() - 1));
    header.push('\n');
    let length =
        u16::try_from(length).map_err(|_| io::Error::other("a header of more than 65535 bytes"))?;
    out.write_all(SIGNATURE)?;
    out.write_all(&SHORT_HEADER)?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(header.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_those_of_numpy() {
        let mut array = Vec::new();
        write_header(&mut array, "'<f8'", "3,").unwrap();
        assert_eq!(array.len() % ALIGNMENT, 0);
        // `numpy.save` writes the same bytes for an array of three real numbers.
        let expected =
            b"\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }";
        assert!(
            array.starts_with(expected) && array.ends_with(b" \n"),
            "{array:?}"
        );
        assert!(write_header(&mut Vec::new(), &"x".repeat(70_000), "").is_err());
    }
}
