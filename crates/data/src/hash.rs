//! SHA-256 hashes of files, by which copies of a file are recognised. The program `sha256sum`
//! prints the same digits.

use super::read::{ReadError, open_regular};
use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::Path;

/// Number of bytes in each read.
const BUFFER: usize = 1 << 16;

/// Returns the SHA-256 of all bytes that `hasher` has received, as 64 hexadecimal digits.
pub fn hexadecimal(hasher: Sha256) -> String {
    hasher
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

/// Returns the SHA-256 of the content of a file, as 64 hexadecimal digits. Two files with the same
/// SHA-256 are copies.
///
/// # Errors
/// Returns an error if the file cannot be read.
pub fn sha256_of(path: &Path) -> Result<String, ReadError> {
    let mut file = open_regular(path)?;
    let mut hasher = Sha256::new();
    let mut buffer = vec![0; BUFFER];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hexadecimal(hasher)),
            read => hasher.update(&buffer[..read]),
        }
    }
}
