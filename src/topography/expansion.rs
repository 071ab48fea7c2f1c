//! Bounds on the decompression of files.

/// Bytes that decompression may give beside [`MOST_EXPANSION`].
const LEAST_EXPANDED: u64 = 1 << 20;

/// Bytes that decompression may give for each byte of the file: texts of numbers give three to six.
pub(super) const MOST_EXPANSION: u64 = 32;

/// Most bytes that decompression of `read` bytes may give.
pub(super) fn most_expanded(read: u64) -> u64 {
    read.saturating_mul(MOST_EXPANSION).saturating_add(LEAST_EXPANDED)
}
