//! Limits of the decompression of files.

/// Decompressed bytes allowed in addition to [`MOST_EXPANSION`].
const LEAST_EXPANDED: u64 = 1 << 20;

/// Decompressed bytes allowed per byte of the file: texts of numbers expand by factors of three to six.
pub(super) const MOST_EXPANSION: u64 = 32;

/// Largest number of decompressed bytes from `read` bytes.
pub(super) fn most_expanded(read: u64) -> u64 {
    read.saturating_mul(MOST_EXPANSION).saturating_add(LEAST_EXPANDED)
}
