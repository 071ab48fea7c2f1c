//! Large arrays whose memory is used again: fresh memory costs about as much as a pass over it, because the
//! system clears each page when it is first touched.

use std::collections::TryReserveError;

/// Memory is given back when it holds more than so many times what is needed.
const MOST_SPARE: usize = 4;
/// Smaller arrays are never given back.
const SMALL: usize = 1 << 16;

/// An empty vector with room for `count` values, in this memory where it suffices.
pub(crate) fn emptied<T>(mut values: Vec<T>, count: usize) -> Result<Vec<T>, TryReserveError> {
    values = unless_far_too_large(values, count);
    values.clear();
    values.try_reserve_exact(count)?;
    Ok(values)
}

/// `count` values in this memory where it suffices: those that it held, then `fill`.
pub(crate) fn resized<T: Clone>(
    mut values: Vec<T>,
    count: usize,
    fill: T,
) -> Result<Vec<T>, TryReserveError> {
    values = unless_far_too_large(values, count);
    values.try_reserve_exact(count.saturating_sub(values.len()))?;
    values.resize(count, fill);
    Ok(values)
}

fn unless_far_too_large<T>(values: Vec<T>, count: usize) -> Vec<T> {
    if values.capacity() / MOST_SPARE > count.max(SMALL) { Vec::new() } else { values }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_kept_until_it_is_far_too_large() {
        let place = |values: &Vec<u64>| (values.as_ptr(), values.capacity());
        let values = vec![7; 4 * SMALL + 4];
        let before = place(&values);
        let values = resized(values, SMALL + 1, 0).unwrap();
        assert_eq!((place(&values), values.len()), (before, SMALL + 1));
        let values = emptied(values, 4 * SMALL).unwrap();
        assert_eq!((place(&values), values.len()), (before, 0));
        let values = resized(values, 3, 5).unwrap();
        assert_eq!(values, [5; 3]);
        assert!(values.capacity() < SMALL);
    }
}
