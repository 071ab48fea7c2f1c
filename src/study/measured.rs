//! The measured file of a study. Its content determines the results as much as the plan does, so the plan holds its
//! hash, and a run computes with exactly the bytes that were hashed.
//!
//! SHA-256 rather than the checksum of records: one in 4e9 accidental changes would pass a CRC of 32 bits, and
//! `sha256sum` identifies the right copy of a file.

use super::StudyError;
use super::plan::{PLAN_FILE, Plan};
use crate::io::hexadecimal;
use crate::surface::{MeasuredRoughness, read_faces};
use crate::text::path_name;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The measured file of a plan, that of the first face, if its scene has one.
pub(super) fn file_of(plan: &Plan) -> Option<PathBuf> {
    plan.scene.measured().map(|measured| PathBuf::from(&measured.file))
}

/// The plan with the present hash of its measured file.
///
/// # Errors
/// A file that cannot be read, or whose hash differs from that in the plan.
pub(super) fn with_hash(plan: &Plan) -> Result<Plan, StudyError> {
    let measured_sha256 = read(plan, || "the plan".into())?.map(|(_, hash)| hash);
    Ok(Plan { measured_sha256, ..plan.clone() })
}

/// The measured profile of a study in a folder, if the study has one.
///
/// # Errors
/// A file that cannot be read, is no profile, or whose hash differs from that in the plan.
pub(super) fn profile(plan: &Plan, folder: &Path) -> Result<Option<Arc<MeasuredRoughness>>, StudyError> {
    let read = read(plan, || path_name(&folder.join(PLAN_FILE)))?;
    Ok(read.map(|(profile, _)| Arc::new(profile)))
}

pub(super) fn changed(file: &Path, found: &str, plan: &str, expected: &str) -> StudyError {
    StudyError::folder(
        file,
        format!(
            "the content of this measured file has changed: its SHA-256 is {found}, {plan} has {expected}; bring \
             back the file the study began with, or begin another study in another folder"
        ),
    )
}

/// The surface of a plan, if it has one, and the hash of its bytes, which is that of the plan; several files are hashed
/// one after the other.
fn read(plan: &Plan, origin: impl Fn() -> String) -> Result<Option<(MeasuredRoughness, String)>, StudyError> {
    let Some(file) = file_of(plan) else { return Ok(None) };
    let faces = read_faces(&plan.scene.measured_paths(Path::new("")))?;
    let mut hasher = Sha256::new();
    faces.iter().flatten().for_each(|(_, content)| hasher.update(content));
    let found = hexadecimal(hasher);
    match &plan.measured_sha256 {
        Some(expected) if *expected != found => Err(changed(&file, &found, &origin(), expected)),
        _ => Ok(Some((MeasuredRoughness::new(&faces, &plan.scene.measured_options())?, found))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_those_of_sha256sum() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("line.csv");
        // A byte order mark, a comment, both kinds of line breaks, and none at the end.
        std::fs::write(&file, "\u{feff}# heights\r\n0 0\n1e-6 1e-9").unwrap();
        let known = "3301e005145807de31f1e613c0705281eacbe8fc66deec574eba4d53402a7e71";
        let scene = crate::scene::open("rough-sphere").unwrap();
        let scene = scene.set("roughness", &format!("Measured(file: {file:?}, as_line: true)")).unwrap();
        let plan = Plan::of_scene(scene.scene(), 1, &[]);
        assert_eq!(with_hash(&plan).unwrap().measured_sha256.as_deref(), Some(known));
    }
}
