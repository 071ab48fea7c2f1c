//! Arrays of NumPy: the header of a file, and a text as a second array after the first.
//!
//! A header holds exactly the type, the order and the shape of an array, or NumPy refuses the file. But a file may
//! hold several arrays in sequence: `numpy.load` of the name returns the first, and of an open file the next.

use std::io::{self, Write};

/// First bytes of an array.
pub(crate) const SIGNATURE: &[u8] = b"\x93NUMPY";

/// Versions in which the length of a header has two bytes.
const SHORT_HEADER: [u8; 2] = [1, 0];

/// Bytes before a header of that version.
const PREFIX: usize = SIGNATURE.len() + SHORT_HEADER.len() + 2;

/// Multiple of bytes that header and prefix fill together.
const ALIGNMENT: usize = 64;

/// Most bytes of the header of an appended text.
const TEXT_HEADER: usize = 2 * ALIGNMENT;

/// Writes the header of an array. `descr` is its type in Python's notation, `shape` the numbers in the brackets of
/// its shape.
pub(crate) fn write_header(out: &mut (impl Write + ?Sized), descr: &str, shape: &str) -> io::Result<()> {
    let mut header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': ({shape}), }}");
    let length = (PREFIX + header.len() + 1).next_multiple_of(ALIGNMENT) - PREFIX;
    header.extend(std::iter::repeat_n(' ', length - header.len() - 1));
    header.push('\n');
    let length = u16::try_from(length).map_err(|_| io::Error::other("a header of more than 65535 bytes"))?;
    out.write_all(SIGNATURE)?;
    out.write_all(&SHORT_HEADER)?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(header.as_bytes())
}

/// Writes a text as an array without axes, of bytes in UTF-8.
pub(crate) fn write_text(out: &mut (impl Write + ?Sized), text: &str) -> io::Result<()> {
    write_header(out, &format!("'|S{}'", text.len()), "")?;
    out.write_all(text.as_bytes())
}

/// Most bytes at the end of a file that hold an appended text of at most `longest` bytes.
pub(crate) fn most_appended(longest: usize) -> usize {
    longest + TEXT_HEADER
}

/// Text at the end of a file, from its last bytes; `None` without one.
pub(crate) fn appended_text(tail: &[u8]) -> Option<&str> {
    // Numbers, and the text itself, may contain the signature by chance.
    let starts = tail.windows(SIGNATURE.len()).enumerate().rev();
    starts.filter(|(_, bytes)| *bytes == SIGNATURE).find_map(|(start, _)| text_of(&tail[start..]))
}

/// Text of an array that ends with these bytes.
fn text_of(array: &[u8]) -> Option<&str> {
    let length = array.get(SIGNATURE.len() + SHORT_HEADER.len()..PREFIX)?;
    let content = PREFIX + usize::from(u16::from_le_bytes([length[0], length[1]]));
    let header = str::from_utf8(array.get(PREFIX..content)?).ok()?;
    let (_, rest) = header.split_once("'descr': '|S")?;
    let (count, rest) = rest.split_once('\'')?;
    let text = &array[content..];
    let is_whole = rest.contains("'shape': ()") && count.parse() == Ok(text.len());
    str::from_utf8(text).ok().filter(|_| is_whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_those_of_numpy() {
        let mut array = Vec::new();
        write_header(&mut array, "'<f8'", "3,").unwrap();
        assert_eq!(array.len() % ALIGNMENT, 0);
        // As written by `numpy.save`.
        let expected = b"\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }";
        assert!(array.starts_with(expected) && array.ends_with(b" \n"), "{array:?}");
        assert!(write_header(&mut Vec::new(), &"x".repeat(70_000), "").is_err());
    }

    #[test]
    fn a_text_is_found_behind_whatever_is_before() {
        for text in ["", "a", "œNUMPY\u{1}", &"x\u{93}NUMPY".repeat(50)] {
            for before in [&b""[..], SIGNATURE, b"\x93NUMPY\x01\x00\x05\x00'descr': '|S3', 'shape': ()"] {
                let mut file = before.to_vec();
                write_text(&mut file, text).unwrap();
                assert!(file.len() - before.len() <= most_appended(text.len()));
                assert_eq!(appended_text(&file), Some(text));
                file.push(b' ');
                assert_eq!(appended_text(&file), None);
            }
        }
        assert_eq!(appended_text(b""), None);
    }
}
