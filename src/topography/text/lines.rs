//! Encodings and lines of a text.

use super::super::error::{Place, TopographyError, refused};
use crate::memory::check_room;
use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};
use std::borrow::Cow;

/// Longest line, bytes: a row of a large matrix.
const LONGEST_LINE: usize = 1 << 24;

/// Returns the bytes of a text without a byte order mark; UTF-16 as UTF-8, with U+FFFD for invalid characters.
pub(super) fn decoded(bytes: &[u8]) -> Result<Cow<'_, [u8]>, TopographyError> {
    let (encoding, mark) = Encoding::for_bom(bytes).unwrap_or((UTF_8, 0));
    let text = &bytes[mark..];
    if encoding == UTF_8 {
        return Ok(Cow::Borrowed(text));
    }
    check_room(2 * text.len() as u64).map_err(|_| {
        TopographyError::Refused(format!("not enough memory for {} bytes of UTF-16", text.len()))
    })?;
    Ok(Cow::Owned(encoding.decode_without_bom_handling(text).0.into_owned().into_bytes()))
}

/// Returns a line without white space around it: UTF-8, or, if that is invalid, Windows-1252, in which older programs
/// write µ and °.
pub(super) fn line_text<'a>(line: &'a [u8], place: &Place) -> Result<Cow<'a, str>, TopographyError> {
    let (fault, allowed) = if line.len() > LONGEST_LINE {
        (format!("longer than {LONGEST_LINE} bytes"), format!("at most {LONGEST_LINE} bytes"))
    } else if let Some(at) = line.iter().position(|byte| *byte == 0) {
        let formats = "text, SDF, GSF, NumPy array, X3P, GWY, SUR, NetCDF, or these in gzip";
        (format!("byte {at} of the line is zero, so this is no text"), formats.to_owned())
    } else {
        let line = line.trim_ascii();
        let other = |_| WINDOWS_1252.decode_without_bom_handling(line).0;
        return Ok(str::from_utf8(line).map_or_else(other, Cow::Borrowed));
    };
    Err(refused(place.clone(), fault, allowed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn binary_content_and_endless_lines_are_refused() {
        let error = |line: &[u8]| line_text(line, &Place::Line(2)).unwrap_err().to_string();
        assert!(error(b"b\0").starts_with("line 2: byte 1 of the line is zero"));
        let mut long = vec![b'1'; LONGEST_LINE];
        assert_eq!(line_text(&long, &Place::File).unwrap().len(), LONGEST_LINE);
        long.push(b'1');
        assert!(error(&long).starts_with("line 2: longer than 16777216 bytes"));
    }
}
