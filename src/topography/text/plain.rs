//! Plain lines of numbers, read where they are in the buffer: most lines of large files.
//!
//! A plain line has one to three decimal numbers of at most 2⁵³, one separator between them and nothing else. A power of
//! ten up to 10²² is exact, so that one multiplication or division rounds the number correctly (Clinger, 1990), as
//! [`str::parse`] does. Any other line is left to the general reader.

use super::layout::Separator;

/// Most columns of a plain line.
pub(super) const MOST_COLUMNS: usize = 3;

/// Powers of ten that are exact.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Most digits that fit into 64 bits whatever they are.
const MOST_DIGITS: usize = 19;

/// Numbers up to this one are exact.
const MOST_EXACT: u64 = 1 << 53;

/// Numbers of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlainLine {
    pub values: [f64; MOST_COLUMNS],
    /// A number has a decimal point.
    pub has_point: bool,
}

/// Reads plain lines of so many columns from the beginning of a block, until one is not plain, not whole or not taken.
/// Returns the bytes and the number of lines taken.
pub(super) fn read_lines(
    block: &[u8],
    separator: Separator,
    columns: usize,
    take: &mut dyn FnMut(PlainLine) -> bool,
) -> (usize, usize) {
    let (mut bytes, mut lines) = (0, 0);
    while let Some((line, length)) = read_line(&block[bytes..], separator, columns) {
        if !take(line) {
            break;
        }
        bytes += length;
        lines += 1;
    }
    (bytes, lines)
}

/// A plain line and its bytes, line break included.
fn read_line(bytes: &[u8], separator: Separator, columns: usize) -> Option<(PlainLine, usize)> {
    let mut line = PlainLine { values: [0.0; MOST_COLUMNS], has_point: false };
    let mut at = 0;
    for (index, value) in line.values.iter_mut().enumerate().take(columns) {
        if index > 0 {
            at += separator_length(&bytes[at..], separator)?;
        }
        let (number, length, has_point) = read_number(&bytes[at..])?;
        *value = number;
        line.has_point |= has_point;
        at += length;
    }
    match bytes[at..] {
        [b'\n', ..] => Some((line, at + 1)),
        [b'\r', b'\n', ..] => Some((line, at + 2)),
        _ => None,
    }
}

fn separator_length(bytes: &[u8], separator: Separator) -> Option<usize> {
    let mark = match separator {
        Separator::Semicolon => b';',
        Separator::Tab => b'\t',
        Separator::Comma => b',',
        Separator::Space => b' ',
    };
    match separator {
        Separator::Space => {
            Some(bytes.iter().take_while(|byte| **byte == mark).count()).filter(|count| *count > 0)
        }
        _ => (bytes.first() == Some(&mark)).then_some(1),
    }
}

/// A decimal number, its bytes, and true if it has a decimal point; `None` where another rule is needed.
fn read_number(bytes: &[u8]) -> Option<(f64, usize, bool)> {
    let is_signed = matches!(bytes.first()?, b'-' | b'+');
    let mut at = usize::from(is_signed);
    let (mut mantissa, whole) = digits(&bytes[at..], 0);
    at += whole;
    let mut count = whole;
    let mut exponent = 0;
    let has_point = bytes.get(at) == Some(&b'.');
    if has_point {
        let (longer, decimals) = digits(&bytes[at + 1..], mantissa);
        mantissa = longer;
        at += 1 + decimals;
        count += decimals;
        exponent = -(decimals as i32);
    }
    if whole == 0 || count > MOST_DIGITS || mantissa > MOST_EXACT {
        return None;
    }
    if let Some(b'e' | b'E') = bytes.get(at) {
        let is_negative = bytes.get(at + 1) == Some(&b'-');
        at += 1 + usize::from(is_negative || bytes.get(at + 1) == Some(&b'+'));
        let (power, length) = digits(&bytes[at..], 0);
        if !(1..=3).contains(&length) {
            return None;
        }
        at += length;
        exponent += if is_negative { -(power as i32) } else { power as i32 };
    }
    let power = *POWERS.get(exponent.unsigned_abs() as usize)?;
    let value = if exponent < 0 { mantissa as f64 / power } else { mantissa as f64 * power };
    Some((if bytes[0] == b'-' { -value } else { value }, at, has_point))
}

/// Digits at the beginning, behind those of `before`: their number modulo 2⁶⁴, and how many they are.
fn digits(bytes: &[u8], before: u64) -> (u64, usize) {
    let mut number = before;
    let mut count = 0;
    for byte in bytes {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            break;
        }
        number = number.wrapping_mul(10).wrapping_add(u64::from(digit));
        count += 1;
    }
    (number, count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn plain_numbers_are_those_of_the_standard_library(
            text in "[-+]?[0-9]{0,20}(\\.[0-9]{0,20})?([eE][-+]?[0-9]{0,4})?[ \n]"
        ) {
            if let Some((value, length, has_point)) = read_number(text.as_bytes()) {
                let number = &text[..length];
                prop_assert_eq!(number.parse::<f64>().map(f64::to_bits), Ok(value.to_bits()), "{}", number);
                prop_assert_eq!(has_point, number.contains('.'));
            }
        }

        #[test]
        fn usual_numbers_are_plain(value in -1e6..1e6_f64, decimals in 0..9_usize) {
            let text = format!("{value:.decimals$}");
            let (read, length, _) = read_number(text.as_bytes()).unwrap();
            prop_assert_eq!((read.to_bits(), length), (text.parse::<f64>().unwrap().to_bits(), text.len()));
        }
    }

    #[test]
    fn lines_that_are_not_plain_are_left() {
        fn read(block: &str, separator: Separator, columns: usize) -> (Vec<Vec<f64>>, &str) {
            let mut found = Vec::new();
            let (bytes, lines) = read_lines(block.as_bytes(), separator, columns, &mut |line| {
                found.push(line.values[..columns].to_vec());
                line.values[0] != 99.0
            });
            found.truncate(lines);
            (found, &block[bytes..])
        }
        let two = vec![vec![1.0, -2.5], vec![3e2, 4.0]];
        assert_eq!(read("1\t-2.5\r\n3e2\t4\n", Separator::Tab, 2), (two.clone(), ""));
        assert_eq!(read("1  -2.5\n3e2 4\n5 6", Separator::Space, 2), (two.clone(), "5 6"));
        for rest in [
            "# 1;2\n",
            "1;2;3\n",
            "1\n",
            ";2\n",
            "1; 2\n",
            "NaN;1\n",
            "1;2,5\n",
            "\n",
            "1e99;1\n",
            "99;1\n",
            "1;\u{0}\n",
        ] {
            let block = format!("1;-2.5\n3e2;4\n{rest}7;8\n");
            assert_eq!(read(&block, Separator::Semicolon, 2), (two.clone(), &block[13..]), "{rest}");
        }
        assert_eq!(read("1,2,3\n", Separator::Comma, 3), (vec![vec![1.0, 2.0, 3.0]], ""));
    }
}
