//! Lines of a text in sequence, in any supported encoding.

use super::super::error::{Place, TopographyError, refused};
use encoding_rs::{UTF_16BE, UTF_16LE, WINDOWS_1252};
use std::borrow::Cow;

/// Longest line, bytes: a row of a large matrix.
pub(super) const LONGEST_LINE: usize = 1 << 24;

/// The bytes of a text without a byte order mark; UTF-16 as UTF-8, with U+FFFD for invalid characters.
pub(super) fn decoded(bytes: &[u8]) -> Result<Cow<'_, [u8]>, TopographyError> {
    let encoding = match bytes {
        [0xff, 0xfe, ..] => UTF_16LE,
        [0xfe, 0xff, ..] => UTF_16BE,
        [0xef, 0xbb, 0xbf, rest @ ..] => return Ok(Cow::Borrowed(rest)),
        _ => return Ok(Cow::Borrowed(bytes)),
    };
    let mut decoder = encoding.new_decoder_with_bom_removal();
    let mut text = String::new();
    let reserved = decoder.max_utf8_buffer_length(bytes.len()).map(|length| text.try_reserve_exact(length));
    if !matches!(reserved, Some(Ok(()))) {
        return Err(TopographyError::Read(format!("not enough memory for {} bytes of UTF-16", bytes.len())));
    }
    let _ = decoder.decode_to_string(bytes, &mut text, true);
    Ok(Cow::Owned(text.into_bytes()))
}

/// Lines of a text in UTF-8, or, for invalid UTF-8, in Windows-1252, in which older programs write µ and °. Lines end
/// with a line feed, with or without a carriage return before.
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl<'a> Lines<'a> {
    pub fn new(text: &'a [u8]) -> Self {
        Lines { rest: text, number: 0 }
    }

    /// Passes at most `most` of the next bytes to `take`, which reads whole lines from their beginning and returns
    /// their bytes and number.
    pub fn take_block(&mut self, most: usize, take: impl FnOnce(&[u8]) -> (usize, usize)) {
        let (bytes, lines) = take(&self.rest[..self.rest.len().min(most)]);
        self.rest = &self.rest[bytes..];
        self.number += lines;
    }

    /// The next line without its end, and its number from 1, or `None` after the last.
    pub fn next(&mut self) -> Result<Option<(usize, Cow<'a, str>)>, TopographyError> {
        if self.rest.is_empty() {
            return Ok(None);
        }
        let end = self.rest.iter().take(LONGEST_LINE + 1).position(|byte| *byte == b'\n');
        let (line, rest) = self.rest.split_at(end.map_or(self.rest.len(), |end| end + 1));
        self.rest = rest;
        self.number += 1;
        let place = Place::Line(self.number);
        if line.len() > LONGEST_LINE {
            let fault = format!("longer than {LONGEST_LINE} bytes");
            return Err(refused(place, fault, format!("at most {LONGEST_LINE} bytes")));
        }
        if let Some(at) = line.iter().position(|byte| *byte == 0) {
            let fault = format!("byte {at} of the line is zero, so this is no text");
            return Err(refused(
                place,
                fault,
                "text, SDF, GSF, NumPy array, X3P, GWY, SUR, NetCDF, or these in gzip",
            ));
        }
        let line = line.trim_ascii_end();
        let text = str::from_utf8(line)
            .map_or_else(|_| WINDOWS_1252.decode_without_bom_handling(line).0, Cow::Borrowed);
        Ok(Some((self.number, text)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(bytes: &[u8]) -> Vec<String> {
        let text = decoded(bytes).unwrap();
        let mut lines = Lines::new(&text);
        let mut found = Vec::new();
        while let Some((number, line)) = lines.next().unwrap() {
            assert_eq!(number, found.len() + 1);
            found.push(line.into_owned());
        }
        found
    }

    #[test]
    fn every_encoding_gives_the_same_lines() {
        let expected = ["x [µm]", "1", "", "2"];
        let text = "x [µm]\n1\r\n\n2";
        let with_mark = |bytes: Vec<u8>, mark: &[u8]| [mark, &bytes].concat();
        let utf16 = |order: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(order).collect::<Vec<u8>>();
        for bytes in [
            text.as_bytes().to_vec(),
            with_mark(text.as_bytes().to_vec(), b"\xef\xbb\xbf"),
            with_mark(utf16(u16::to_le_bytes), b"\xff\xfe"),
            with_mark(utf16(u16::to_be_bytes), b"\xfe\xff"),
            text.chars().map(|c| c as u8).collect(),
        ] {
            assert_eq!(all(&bytes), expected, "{bytes:?}");
        }
        assert_eq!(all(b"").len(), 0);
    }

    #[test]
    fn binary_content_and_endless_lines_are_refused() {
        let mut lines = Lines::new(b"a\nb\0");
        lines.next().unwrap();
        assert!(lines.next().unwrap_err().to_string().starts_with("line 2: byte 1 of the line is zero"));
        let mut longest = vec![b'1'; LONGEST_LINE - 1];
        longest.push(b'\n');
        let mut lines = Lines::new(&longest);
        assert_eq!(lines.next().unwrap().map(|(_, line)| line.len()), Some(LONGEST_LINE - 1));
        let long = vec![b'1'; LONGEST_LINE + 1];
        assert!(Lines::new(&long).next().unwrap_err().to_string().contains("longer than"));
        // Half a character at the end.
        assert_eq!(all(b"\xff\xfe1\x00\x02"), ["1\u{fffd}"]);
    }
}
