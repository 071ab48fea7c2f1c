//! Lines of a text in sequence, in any supported encoding.

use super::super::error::{Place, TopographyError, refused};
use encoding_rs::{CoderResult, Decoder, UTF_16BE, UTF_16LE, WINDOWS_1252};
use std::borrow::Cow;
use std::io::{self, BufRead, BufReader, Read};

/// Longest line, bytes: a row of a large matrix.
pub(super) const LONGEST_LINE: usize = 1 << 24;

/// Lines of a text in UTF-8, in UTF-16 with a byte order mark, or, for invalid UTF-8, in Windows-1252, in which
/// older programs write µ and °. A byte order mark is skipped. Lines end with a line feed, with or without a
/// carriage return before.
pub(super) struct Lines<R: BufRead> {
    source: Source<R>,
    line: Vec<u8>,
    number: usize,
}

enum Source<R: BufRead> {
    Bytes(R),
    Utf16(Box<BufReader<Recoded<R>>>),
}

impl<R: BufRead> Lines<R> {
    pub fn new(mut source: R) -> io::Result<Self> {
        let start = source.fill_buf()?;
        let encoding = match start {
            [0xff, 0xfe, ..] => Some(UTF_16LE),
            [0xfe, 0xff, ..] => Some(UTF_16BE),
            _ => None,
        };
        let source = match encoding {
            Some(encoding) => {
                let decoder = encoding.new_decoder_with_bom_removal();
                Source::Utf16(Box::new(BufReader::new(Recoded { source, decoder, ended: false })))
            }
            None => {
                if start.starts_with(b"\xef\xbb\xbf") {
                    source.consume(3);
                }
                Source::Bytes(source)
            }
        };
        Ok(Lines { source, line: Vec::new(), number: 0 })
    }

    /// Passes the next buffered bytes to `take`, which reads whole lines from their beginning and returns their
    /// bytes and number.
    pub fn take_block(&mut self, take: impl FnOnce(&[u8]) -> (usize, usize)) -> io::Result<()> {
        if let Source::Bytes(source) = &mut self.source {
            let (bytes, lines) = take(source.fill_buf()?);
            source.consume(bytes);
            self.number += lines;
        }
        Ok(())
    }

    /// The next line without its end, and its number from 1, or `None` after the last.
    pub fn next(&mut self) -> Result<Option<(usize, Cow<'_, str>)>, TopographyError> {
        self.line.clear();
        let most = LONGEST_LINE as u64 + 1;
        let taken = match &mut self.source {
            Source::Bytes(source) => source.take(most).read_until(b'\n', &mut self.line)?,
            Source::Utf16(source) => source.take(most).read_until(b'\n', &mut self.line)?,
        };
        if taken == 0 {
            return Ok(None);
        }
        self.number += 1;
        let place = Place::Line(self.number);
        if taken > LONGEST_LINE {
            let fault = format!("longer than {LONGEST_LINE} bytes");
            return Err(refused(place, fault, format!("at most {LONGEST_LINE} bytes")));
        }
        if let Some(at) = self.line.iter().position(|byte| *byte == 0) {
            let fault = format!("byte {at} of the line is zero, so this is no text");
            return Err(refused(
                place,
                fault,
                "text, SDF, GSF, NumPy array, X3P, GWY, SUR, NetCDF, or these in gzip",
            ));
        }
        let line = self.line.trim_ascii_end();
        let text = str::from_utf8(line)
            .map_or_else(|_| WINDOWS_1252.decode_without_bom_handling(line).0, Cow::Borrowed);
        Ok(Some((self.number, text)))
    }
}

/// UTF-16 as UTF-8; invalid characters become U+FFFD.
struct Recoded<R> {
    source: R,
    decoder: Decoder,
    ended: bool,
}

impl<R: BufRead> Read for Recoded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while !self.ended {
            let bytes = self.source.fill_buf()?;
            let last = bytes.is_empty();
            let (result, read, written, _) = self.decoder.decode_to_utf8(bytes, buffer, last);
            self.source.consume(read);
            self.ended = last && result == CoderResult::InputEmpty;
            if written > 0 {
                return Ok(written);
            }
            if result == CoderResult::OutputFull {
                // A buffer of fewer than four bytes has no room for a character.
                return Err(io::Error::other("a buffer that is too small"));
            }
        }
        Ok(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(bytes: &[u8]) -> Vec<String> {
        let mut lines = Lines::new(bytes).unwrap();
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
        let error = Lines::new(&b"a\nb\0"[..]).and_then(|mut lines| {
            lines.next().map_err(io::Error::other)?;
            Ok(lines.next().unwrap_err())
        });
        assert!(error.unwrap().to_string().starts_with("line 2: byte 1 of the line is zero"));
        let mut longest = vec![b'1'; LONGEST_LINE - 1];
        longest.push(b'\n');
        let mut lines = Lines::new(&longest[..]).unwrap();
        assert_eq!(lines.next().unwrap().map(|(_, line)| line.len()), Some(LONGEST_LINE - 1));
        let long = vec![b'1'; LONGEST_LINE + 1];
        assert!(Lines::new(&long[..]).unwrap().next().unwrap_err().to_string().contains("longer than"));
        // Half a character at the end.
        assert_eq!(all(b"\xff\xfe1\x00\x02"), ["1\u{fffd}"]);
    }
}
