//! One record of a shard file: a line with its key, its values and a checksum.

use std::fmt::{self, Write};

/// Characters of the checksum and the comma behind it.
const CHECKSUM: usize = 9;

/// Unique key of a record: cell and seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key {
    /// Index of the cell.
    pub cell: u64,
    /// Seed of the profile.
    pub seed: u64,
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cell {}, seed {}", self.cell, self.seed)
    }
}

/// Set of the existing records of a study, one bit for each.
#[derive(Clone)]
pub(super) struct Done(Vec<u64>);

impl Done {
    pub fn none(count: u64) -> Done {
        Done(vec![0; count.div_ceil(64) as usize])
    }

    pub fn add(&mut self, place: u64) {
        self.0[place as usize / 64] |= 1 << (place % 64);
    }

    pub fn has(&self, place: u64) -> bool {
        self.0[place as usize / 64] & (1 << (place % 64)) != 0
    }

    /// Number of records.
    pub fn count(&self) -> u64 {
        self.0.iter().map(|word| u64::from(word.count_ones())).sum()
    }
}

/// Appends a line with its checksum in front; the payload holds no line break.
pub(super) fn seal(payload: &str, into: &mut String) {
    // Writing to a string cannot fail.
    let _ = writeln!(into, "{:08x},{payload}", crc32fast::hash(payload.as_bytes()));
}

/// The payload of a line without its break; `None` if the line was changed.
pub(super) fn unseal(line: &[u8]) -> Option<&str> {
    let line = std::str::from_utf8(line).ok()?;
    let (checksum, payload) = (line.get(..CHECKSUM)?, line.get(CHECKSUM..)?);
    let checksum = checksum.strip_suffix(',')?;
    // One way of writing, so that equal records are equal text.
    let is_ours = checksum == format!("{:08x}", crc32fast::hash(payload.as_bytes()));
    is_ours.then_some(payload)
}

/// Appends a record. NaN, a missing value, becomes an empty column.
pub(super) fn encode(key: Key, values: &[f64], into: &mut String) {
    let mut payload = format!("{},{}", key.cell, key.seed);
    for value in values {
        payload.push(',');
        if !value.is_nan() {
            // The shortest text that is read back bit for bit.
            let _ = write!(payload, "{value:?}");
        }
    }
    seal(&payload, into);
}

/// The key of a payload and the text of its values.
pub(super) fn key_of(payload: &str) -> Option<(Key, &str)> {
    let mut parts = payload.splitn(3, ',');
    let cell = parts.next()?.parse().ok()?;
    let seed = parts.next()?.parse().ok()?;
    Some((Key { cell, seed }, parts.next()?))
}

/// Reads so many values of a payload, NaN for empty columns. Returns false if the payload has other columns.
pub(super) fn values_into(text: &str, count: usize, values: &mut Vec<f64>) -> bool {
    values.clear();
    for text in text.split(',') {
        let value = if text.is_empty() { Ok(f64::NAN) } else { text.parse() };
        match value {
            Ok(value) if values.len() < count => values.push(value),
            _ => return false,
        }
    }
    values.len() == count
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn records_read_back_bit_for_bit(
            cell: u64,
            seed: u64,
            values in prop::collection::vec(prop::option::of(any::<f64>()), 1..6),
        ) {
            let values: Vec<f64> = values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect();
            let mut text = String::new();
            encode(Key { cell, seed }, &values, &mut text);
            let payload = unseal(text.trim_end_matches('\n').as_bytes()).unwrap();
            let (key, rest) = key_of(payload).unwrap();
            prop_assert_eq!(key, Key { cell, seed });
            let mut read = Vec::new();
            prop_assert!(values_into(rest, values.len(), &mut read));
            prop_assert!(!values_into(rest, values.len() + 1, &mut Vec::new()));
            prop_assert!(!values_into(rest, values.len() - 1, &mut Vec::new()));
            for (read, value) in read.iter().zip(&values) {
                prop_assert!(read.to_bits() == value.to_bits() || (read.is_nan() && value.is_nan()));
            }
            // Every cut or change is noticed.
            let line = text.trim_end_matches('\n').as_bytes();
            for end in 0..line.len() {
                prop_assert_eq!(unseal(&line[..end]), None);
            }
            for place in 0..line.len() {
                let mut changed = line.to_vec();
                changed[place] ^= 1;
                prop_assert_eq!(unseal(&changed), None);
            }
        }
    }
}
