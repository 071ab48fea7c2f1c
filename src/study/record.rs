//! One record of a shard file: a line with its key, its values and a checksum.

use std::fmt::Write;

/// Characters of the checksum and the comma behind it.
const CHECKSUM: usize = 9;

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
pub(super) fn unseal(line: &str) -> Option<&str> {
    let (checksum, payload) = (line.get(..CHECKSUM)?, line.get(CHECKSUM..)?);
    let checksum = checksum.strip_suffix(',')?;
    // One way of writing, so that equal records are equal text.
    let is_ours = checksum == format!("{:08x}", crc32fast::hash(payload.as_bytes()));
    is_ours.then_some(payload)
}

/// Appends the record of a cell and a seed. NaN, a missing value, becomes an empty column.
pub(super) fn encode(cell: u64, seed: u64, values: &[f64], into: &mut String) {
    let mut payload = format!("{cell},{seed}");
    for value in values {
        payload.push(',');
        if !value.is_nan() {
            // The shortest text that is read back bit for bit.
            let _ = write!(payload, "{value:?}");
        }
    }
    seal(&payload, into);
}

/// Cell, seed and values of a payload, NaN for empty columns; `None` unless it has so many values.
pub(super) fn decode(payload: &str, count: usize) -> Option<(u64, u64, Vec<f64>)> {
    let mut columns = payload.split(',');
    let (cell, seed) = (columns.next()?.parse().ok()?, columns.next()?.parse().ok()?);
    let value = |text: &str| if text.is_empty() { Some(f64::NAN) } else { text.parse().ok() };
    let values: Vec<f64> = columns.map(value).collect::<Option<_>>()?;
    (values.len() == count).then_some((cell, seed, values))
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
            encode(cell, seed, &values, &mut text);
            let line = text.trim_end_matches('\n');
            let payload = unseal(line).unwrap();
            let (of_cell, of_seed, read) = decode(payload, values.len()).unwrap();
            prop_assert_eq!((of_cell, of_seed), (cell, seed));
            prop_assert!(decode(payload, values.len() + 1).is_none());
            prop_assert!(decode(payload, values.len() - 1).is_none());
            for (read, value) in read.iter().zip(&values) {
                prop_assert!(read.to_bits() == value.to_bits() || (read.is_nan() && value.is_nan()));
            }
            // Every cut or change is noticed.
            for end in 0..line.len() {
                prop_assert_eq!(unseal(&line[..end]), None);
            }
            for place in 0..line.len() {
                let mut changed = line.as_bytes().to_vec();
                changed[place] ^= 1;
                prop_assert_eq!(unseal(std::str::from_utf8(&changed).unwrap()), None);
            }
        }
    }
}
