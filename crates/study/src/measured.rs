//! The measured files of a study: surfaces, and the table of the form of the body. The plan
//! contains a hash of these files, because the results depend on their content.
//!
//! The hash is SHA-256. A checksum of 32 bits would miss one in 4e9 accidental changes.

use super::error::StudyError;
use super::plan::{PLAN_FILE, Plan};
use asperity_data::{hexadecimal, path_name, sha256_of};
use asperity_surface::Form;
use asperity_surface::lines::{MeasuredRoughness, read_faces};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Returns the path of the first measured file of a plan; `None` if its scene has no file.
pub(super) fn file_of(plan: &Plan) -> Option<PathBuf> {
    plan.scene.measured_files().first().map(PathBuf::from)
}

/// Returns the plan with the hash of its measured files as they are now.
///
/// # Errors
/// Returns an error if a file cannot be read, or if the hash differs from the hash in the plan.
pub(super) fn with_hash(plan: &Plan) -> Result<Plan, StudyError> {
    let (_, measured_sha256) = read(plan, || "the plan".into())?;
    Ok(Plan {
        measured_sha256,
        ..plan.clone()
    })
}

/// Returns the measured roughness of the study in a folder; `None` if the study has none.
///
/// # Errors
/// Returns an error if a file cannot be read or is no surface, or if the hash differs from the hash
/// in the plan.
pub(super) fn profile(
    plan: &Plan,
    folder: &Path,
) -> Result<Option<Arc<MeasuredRoughness>>, StudyError> {
    let (surface, _) = read(plan, || path_name(&folder.join(PLAN_FILE)))?;
    Ok(surface.map(Arc::new))
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

/// Returns the measured roughness of a plan, if it has one, and the hash of all its measured files.
/// This hash must equal the hash in the plan. The contents of several surface files are hashed one
/// after another, followed by the hash of the table of the form.
fn read(
    plan: &Plan,
    origin: impl Fn() -> String,
) -> Result<(Option<MeasuredRoughness>, Option<String>), StudyError> {
    let Some(file) = file_of(plan) else {
        return Ok((None, None));
    };
    let faces = read_faces(&plan.scene.measured_paths(Path::new("")))?;
    let mut table = None;
    if let Some(file) = plan.scene.form.as_ref().and_then(Form::table_file) {
        let file = Path::new(file);
        table = Some(sha256_of(file).map_err(|error| StudyError::folder(file, error))?);
    }
    let found = match table {
        Some(table) if faces.is_empty() => table,
        table => {
            let mut hasher = Sha256::new();
            faces
                .iter()
                .flatten()
                .for_each(|(_, content)| hasher.update(content));
            hasher.update(table.unwrap_or_default());
            hexadecimal(hasher)
        }
    };
    if let Some(expected) = plan
        .measured_sha256
        .as_ref()
        .filter(|expected| **expected != found)
    {
        return Err(changed(&file, &found, &origin(), expected));
    }
    let surface = match plan.scene.measured() {
        Some(_) => Some(MeasuredRoughness::new(
            &faces,
            &plan.scene.measured_options(),
        )?),
        None => None,
    };
    Ok((surface, Some(found)))
}
