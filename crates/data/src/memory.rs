//! Functions for large arrays: they reuse memory, and return an error if the memory is too small.

// The first use of new memory takes about as much time as one pass over it, because the system
// clears each page of memory at its first access. An array whose length depends on the input
// reserves its memory before use. Without this, a failed allocation would end the process.

use std::hint::black_box;
use thiserror::Error;

/// A buffer is released if its capacity is more than this many times the required number of values.
const MOST_SPARE: usize = 4;

/// Number of values below which memory is not worth a release: a buffer for [`MOST_SPARE`] times as
/// many values is never released.
const SMALL: usize = 1 << 16;

/// Number of bytes that the check adds to the known arrays, for stacks of threads and small arrays.
/// The sum exceeds any block that the allocator of glibc keeps for reuse, so the system takes the
/// memory of the check back at once.
const BESIDE: u64 = 33 << 20;

/// Number of bytes below which the check passes at once.
const FEW: u64 = 1 << 20;

/// Error of a request for more memory than the system can provide. Its message states the requested
/// memory in MiB.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("not enough memory for {} MiB", .0.div_ceil(1 << 20))]
pub struct OutOfMemory(u64);

impl OutOfMemory {
    fn of<T>(count: usize) -> Self {
        OutOfMemory((count as u64).saturating_mul(size_of::<T>() as u64))
    }
}

/// Returns an error unless the system can provide `bytes` more bytes of memory now. Less than 1 MiB
/// is never refused.
pub fn check_room(bytes: u64) -> Result<(), OutOfMemory> {
    if bytes < FEW {
        return Ok(());
    }
    let mut asked = Vec::<u8>::new();
    let count = usize::try_from(bytes.saturating_add(BESIDE)).unwrap_or(usize::MAX);
    asked
        .try_reserve_exact(count)
        .map_err(|_| OutOfMemory(bytes))?;
    // The compiler may remove an allocation without an observer.
    black_box(asked.as_ptr());
    Ok(())
}

/// Returns an empty vector with room for `count` values. The vector reuses the memory of `values`
/// if this memory is large enough. Returns an error if the memory of the system is too small.
pub fn emptied<T>(mut values: Vec<T>, count: usize) -> Result<Vec<T>, OutOfMemory> {
    values = unless_far_too_large(values, count);
    values.clear();
    values
        .try_reserve_exact(count)
        .map_err(|_| OutOfMemory::of::<T>(count))?;
    Ok(values)
}

/// Returns a vector of `count` values: first the values of `values`, then copies of `fill`. The
/// vector reuses the memory of `values` if possible. Returns an error if the memory of the system
/// is too small.
pub fn resized<T: Clone>(mut values: Vec<T>, count: usize, fill: T) -> Result<Vec<T>, OutOfMemory> {
    values = unless_far_too_large(values, count);
    let more = count.saturating_sub(values.len());
    values
        .try_reserve_exact(more)
        .map_err(|_| OutOfMemory::of::<T>(count))?;
    values.resize(count, fill);
    Ok(values)
}

/// Collects the `count` values of an iterator into a vector. Returns an error if the memory is too
/// small.
pub fn gathered<T>(count: usize, values: impl Iterator<Item = T>) -> Result<Vec<T>, OutOfMemory> {
    let mut gathered = emptied(Vec::new(), count)?;
    gathered.extend(values);
    Ok(gathered)
}

/// Appends `value` to the vector `values`. Returns an error if the memory is too small.
pub fn push<T>(values: &mut Vec<T>, value: T) -> Result<(), OutOfMemory> {
    reserve(values, 1)?;
    values.push(value);
    Ok(())
}

/// Reserves room for at least `more` further values in the vector `values`. Returns an error if the
/// memory is too small.
pub fn reserve<T>(values: &mut Vec<T>, more: usize) -> Result<(), OutOfMemory> {
    values
        .try_reserve(more)
        .map_err(|_| OutOfMemory::of::<T>(values.len() + more))
}

fn unless_far_too_large<T>(values: Vec<T>, count: usize) -> Vec<T> {
    if values.capacity() / MOST_SPARE > count.max(SMALL) {
        Vec::new()
    } else {
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_system_gives_is_refused() {
        assert_eq!(check_room(FEW), Ok(()));
        assert!(check_room(1 << 62).is_err() && check_room(u64::MAX).is_err());
    }

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
