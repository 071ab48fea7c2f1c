//! The measured file of a study. Its content decides the results as much as the plan does, so the plan has its
//! hash, and a run computes with the bytes that were hashed and no others.
//!
//! SHA-256 rather than the checksum of records: one in 4e9 accidental changes would pass a CRC of 32 bits, and
//! anyone can find out which copy of a file is meant, with `sha256sum`.

use super::SweepError;
use super::plan::Plan;
use super::store::PLAN;
use crate::io::{into_text, read_regular};
use crate::scene::Roughness;
use crate::surface::measured::LARGEST_FILE;
use crate::surface::{MeasuredProfile, SurfaceError};
use crate::text::path_name;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Returns true for a hash as plans write it.
pub(super) fn is_hash(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

/// The measured file of a plan, where its scene has one.
pub(super) fn file_of(plan: &Plan) -> Option<PathBuf> {
    match &plan.scene.roughness {
        Some(Roughness::Measured { file }) => Some(PathBuf::from(file)),
        _ => None,
    }
}

/// The plan with the hash of its measured file as the file is now.
///
/// # Errors
/// Where the file cannot be read, or the plan asks for another hash.
pub(super) fn with_hash(plan: &Plan) -> Result<Plan, SweepError> {
    let Some(file) = file_of(plan) else { return Ok(plan.clone()) };
    let found = hash(&read(&file)?);
    expect(plan, &file, &found, || "the plan".into())?;
    Ok(Plan { measured_sha256: Some(found), ..plan.clone() })
}

/// The measured profile of a study in a folder, where it has one.
///
/// # Errors
/// Where the file cannot be read, is no profile, or is not the one the plan has the hash of.
pub(super) fn profile(plan: &Plan, folder: &Path) -> Result<Option<Arc<MeasuredProfile>>, SweepError> {
    let Some(file) = file_of(plan) else { return Ok(None) };
    let bytes = read(&file)?;
    expect(plan, &file, &hash(&bytes), || path_name(&folder.join(PLAN)))?;
    let profile = into_text(bytes)
        .map_err(|error| error.to_string())
        .and_then(|text| MeasuredProfile::parse(&text))
        .map_err(|reason| failed(&file, reason))?;
    Ok(Some(Arc::new(profile)))
}

fn expect(plan: &Plan, file: &Path, found: &str, origin: impl Fn() -> String) -> Result<(), SweepError> {
    match &plan.measured_sha256 {
        Some(expected) if expected != found => Err(SweepError::MeasuredChanged {
            file: file.to_path_buf(),
            found: found.to_owned(),
            plan: origin(),
            expected: expected.clone(),
        }),
        _ => Ok(()),
    }
}

fn read(file: &Path) -> Result<Vec<u8>, SweepError> {
    Ok(read_regular(file, LARGEST_FILE as usize).map_err(|error| failed(file, error.to_string()))?)
}

fn failed(file: &Path, reason: String) -> SurfaceError {
    SurfaceError::Measured { file: file.display().to_string(), reason }
}

fn hash(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_those_of_sha256sum() {
        let empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
        assert_eq!(hash(b""), empty);
        assert!(is_hash(empty));
        for wrong in [&empty[1..], &empty.to_uppercase(), &format!("{empty}0"), "", &"x".repeat(64)] {
            assert!(!is_hash(wrong), "{wrong}");
        }
    }
}
