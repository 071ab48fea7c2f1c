//! Functions that allocate large arrays. These functions reuse memory, and return an error if there
//! is not enough memory.

// Reuse saves time: the system clears each page of new memory at its first access, which takes
// about as long as one pass over the memory. Arrays whose length depends on the input reserve their
// memory before use, because any other failed allocation would end the process.

use std::hint::black_box;
use thiserror::Error;

/// A buffer is released if its capacity is more than this multiple of the number of values needed.
const MOST_SPARE: usize = 4;

/// Number of values below which memory is too small to be worth a release. A buffer for at most
/// [`MOST_SPARE`] times this number of values is never released.
const SMALL: usize = 1 << 16;

/// Number of bytes that [`check_room`] adds to the requested bytes, for stacks of threads and small
/// arrays. The sum exceeds any block that the allocator of glibc keeps for reuse. Therefore the
/// memory of the check returns to the system at once.
const BESIDE: u64 = 33 << 20;

/// Number of bytes below which [`check_room`] never returns an error.
const FEW: u64 = 1 << 20;

/// Error for a request for more memory than the system can provide. The message states the
/// requested memory in MiB.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("not enough memory for {} MiB", .0.div_ceil(1 << 20))]
pub struct OutOfMemory(u64);

impl OutOfMemory {
    fn of<T>(count: usize) -> Self {
        OutOfMemory((count as u64).saturating_mul(size_of::<T>() as u64))
    }
}

/// Returns an error if the system cannot provide `bytes` more bytes of memory now. A request for
/// less than 1 MiB never returns an error.
pub fn check_room(bytes: u64) -> Result<(), OutOfMemory> {
    if bytes < FEW {
        return Ok(());
    }
    let mut asked = Vec::<u8>::new();
    let count = usize::try_from(bytes.saturating_add(BESIDE)).unwrap_or(usize::MAX);
    asked
        .try_reserve_exact(count)
        .map_err(|_| OutOfMemory(bytes))?;
    // Without this line, the compiler could remove the allocation, because nothing uses it.
    black_box(asked.as_ptr());
    Ok(())
}

/// Returns an empty vector with room for `count` values. The vector reuses the memory of `values`
/// if that memory is large enough. Returns an error if there is not enough memory.
pub fn emptied<T>(mut values: Vec<T>, count: usize) -> Result<Vec<T>, OutOfMemory> {
    values = unless_far_too_large(values, count);
    values.clear();
    values
        .try_reserve_exact(count)
        .map_err(|_| OutOfMemory::of::<T>(count))?;
    Ok(values)
}

/// Returns a vector of the length `count`. The vector begins with the content of `values`, and the
/// rest is filled with copies of `fill`. The memory of `values` is used again if possible. Returns
/// an error if there is not enough memory.
pub fn resized<T: Clone>(mut values: Vec<T>, count: usize, fill: T) -> Result<Vec<T>, OutOfMemory> {
    values = unless_far_too_large(values, count);
    let more = count.saturating_sub(values.len());
    values
        .try_reserve_exact(more)
        .map_err(|_| OutOfMemory::of::<T>(count))?;
    values.resize(count, fill);
    Ok(values)
}

/// Collects the values of an iterator into a vector. `count` is the number of values. Returns an
/// error if there is not enough memory.
pub fn gathered<T>(count: usize, values: impl Iterator<Item = T>) -> Result<Vec<T>, OutOfMemory> {
    let mut gathered = emptied(Vec::new(), count)?;
    gathered.extend(values);
    Ok(gathered)
}

/// Appends `value` to the vector `values`. Returns an error if there is not enough memory.
pub fn push<T>(values: &mut Vec<T>, value: T) -> Result<(), OutOfMemory> {
    reserve(values, 1)?;
    values.push(value);
    Ok(())
}

/// Reserves room in the vector `values` for at least `more` further values. Returns an error if
/// there is not enough memory.
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
