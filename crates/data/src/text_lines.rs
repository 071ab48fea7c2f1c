//! Lines of a text in UTF-8, UTF-16 or Windows-1252.

use crate::PROVENANCE;
use crate::memory::{OutOfMemory, check_room};
use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};
use std::borrow::Cow;
use thiserror::Error;

/// Characters that begin a comment in a text table.
pub const COMMENT: [char; 3] = ['#', '%', '!'];

/// Reason why a text cannot be read as a table. Lines are counted from 1, and the bytes of a line
/// from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TextFault {
    /// The text contains a zero byte, so it is not text.
    #[error("line {line}: byte {byte} of the line is zero, so this is no text")]
    NotText {
        /// Number of the line, from 1.
        line: usize,
        /// Index of the byte in its line, from 0.
        byte: usize,
    },
    /// A line is longer than [`TextFault::LONGEST_LINE`] bytes.
    #[error("line {line}: longer than {} bytes", TextFault::LONGEST_LINE)]
    LongLine {
        /// Number of the line, from 1.
        line: usize,
    },
    /// The commas in the numbers can be decimal marks as well as thousands separators.
    #[error("each comma in a number may be a decimal mark or separate thousands, as in 1,234")]
    DoubtfulCommas,
    /// There is not enough memory to convert the text to UTF-8.
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
}

impl TextFault {
    /// Largest length of a line in bytes.
    pub const LONGEST_LINE: usize = 1 << 24;
}

/// Calls `take` for each line of a text. The arguments of `take` are the number of the line,
/// counted from 1, and the line without white space at its ends. If the text is a CSV file with
/// results of Asperity, the comments at its beginning are skipped.
///
/// # Errors
/// Returns the error of `take`, or a [`TextFault`] if the bytes cannot be read as text.
pub fn each_line<E: From<TextFault>>(
    bytes: &[u8],
    mut take: impl FnMut(usize, &str) -> Result<(), E>,
) -> Result<(), E> {
    let text = decoded(bytes).map_err(TextFault::from)?;
    let end_of_line = if text.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut in_provenance = false;
    for (index, line) in text.split(|byte| *byte == end_of_line).enumerate() {
        let line = line_text(line, index + 1)?;
        // Empty lines between the comments at the beginning of the file do not end these comments.
        if !line.is_empty() {
            let continues = in_provenance || line.starts_with(PROVENANCE);
            in_provenance = continues && line.starts_with(COMMENT);
        }
        if !in_provenance {
            take(index + 1, &line)?;
        }
    }
    Ok(())
}

/// Returns the bytes of a text without the byte order mark. UTF-16 is converted to UTF-8, and
/// invalid characters become U+FFFD.
fn decoded(bytes: &[u8]) -> Result<Cow<'_, [u8]>, OutOfMemory> {
    let (encoding, mark) = Encoding::for_bom(bytes).unwrap_or((UTF_8, 0));
    let text = &bytes[mark..];
    if encoding == UTF_8 {
        return Ok(Cow::Borrowed(text));
    }
    check_room(2 * text.len() as u64)?;
    let (decoded, _) = encoding.decode_without_bom_handling(text);
    Ok(Cow::Owned(decoded.into_owned().into_bytes()))
}

/// Returns a line as UTF-8, without white space at its ends. If the line is not valid UTF-8, it is
/// read as Windows-1252, in which older programs write µ and °.
fn line_text(text: &[u8], line: usize) -> Result<Cow<'_, str>, TextFault> {
    if text.len() > TextFault::LONGEST_LINE {
        return Err(TextFault::LongLine { line });
    }
    if let Some(byte) = text.iter().position(|byte| *byte == 0) {
        return Err(TextFault::NotText { line, byte });
    }
    let text = text.trim_ascii();
    if let Ok(line) = str::from_utf8(text) {
        return Ok(Cow::Borrowed(line));
    }
    let (decoded, _) = WINDOWS_1252.decode_without_bom_handling(text);
    Ok(decoded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn binary_content_and_endless_lines_are_refused() {
        assert_eq!(
            line_text(b"b\0", 2),
            Err(TextFault::NotText { line: 2, byte: 1 })
        );
        let mut long = vec![b'1'; TextFault::LONGEST_LINE];
        assert_eq!(line_text(&long, 1).unwrap().len(), TextFault::LONGEST_LINE);
        long.push(b'1');
        let error = line_text(&long, 2).unwrap_err();
        assert_eq!(error.to_string(), "line 2: longer than 16777216 bytes");
    }
}
